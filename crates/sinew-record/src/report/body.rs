//! Pictures of the body.

use std::io;

use sinew_draw::Page;
use sinew_draw::markup::escape;
use sinew_film::{Clip, Colouring, Film, FilmError, Look, Run, Tool, View};
use sinew_mesh::BoundarySurface;
use sinew_scene::output::OwnedFolder;

use crate::instruments::Instruments;
use crate::summary::Summary;

/// Triangles beyond which pictures take longer than a short run.
const MOST_TRIANGLES: usize = 100_000;

/// Share of the body's size below which a displacement cannot be seen.
const SEEN: f64 = 0.02;

/// Size of a displacement in the picture, as a share of the body's size, if it would be invisible at true scale.
const DRAWN: f64 = 0.08;

/// Width and height of a picture.
const SIZE: &str = "480x270";

/// Views of the body.
const VIEWS: [&str; 4] = ["iso", "front", "right", "top"];

/// Colours of the body at its largest motion; a run without the field has no such picture.
const COLOURS: [&str; 2] = ["displacement", "stress"];

/// Rules by which the chosen view is shown.
pub(super) const STYLE: &str = ".views > .beside { display: none; margin-top: .5rem; }\n\
     .views img { max-width: 100%; height: auto; }\n\
     .views > label { margin-right: 1rem; }\n\
     .views > input:nth-of-type(1):checked ~ .beside:nth-of-type(1),\n\
     .views > input:nth-of-type(2):checked ~ .beside:nth-of-type(2),\n\
     .views > input:nth-of-type(3):checked ~ .beside:nth-of-type(3),\n\
     .views > input:nth-of-type(4):checked ~ .beside:nth-of-type(4) { display: flex; }\n\
     @media print { .views > .beside { display: flex; } }\n";

/// The body at rest, and at its largest motion from four sides, coloured by displacement and by stress.
pub(super) fn section(
    page: &mut Page,
    summary: &Summary<'_>,
    surface: &BoundarySurface,
    folder: &OwnedFolder,
) {
    page.section("body", "The body");
    if summary.progress.seen.displacement.value == 0.0 {
        page.paragraph("It did not move at any instant of the fields.");
        return;
    }
    if surface.triangles.len() > MOST_TRIANGLES {
        page.paragraph(&format!(
            "Pictures of {} triangles would take long: `sinew film` draws them, and ParaView shows `fields.pvd`.",
            surface.triangles.len()
        ));
        return;
    }
    match Pictures::of(summary, folder) {
        Ok(pictures) => page.markup(&pictures.markup()),
        Err(error) => page.paragraph(&format!("There are no pictures: {error}.")),
    }
}

/// Pictures of the body as markup, in a list for each view.
#[derive(Default)]
struct Pictures {
    of_views: [Vec<String>; VIEWS.len()],
}

impl Pictures {
    fn of(summary: &Summary<'_>, folder: &OwnedFolder) -> Result<Self, FilmError> {
        let read = |name: &str| match folder.read(name) {
            Ok(Some(content)) => Ok(content),
            Ok(None) => Err(io::Error::from(io::ErrorKind::NotFound)),
            Err(error) => Err(io::Error::other(error)),
        };
        let run = Run::open(&read)?;
        let body = summary.body.model().body();
        let is_cut = body.is_some_and(|body| body.cut.is_some());
        let seen = summary.progress.seen.displacement;
        let wanted = match is_cut {
            // The largest displacement may be that of a piece that is gone.
            true => f64::INFINITY,
            false => seen.t,
        };
        let apart = |t: &f64| (t - wanted).abs();
        let nearest = run.times().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let t = match is_cut {
            true => run.times().last(),
            false => nearest,
        };
        let t = t.ok_or(FilmError::NothingToShow)?;
        let extent = summary.body.system().extent().unwrap_or(1.0);
        let magnified = match seen.value < SEEN * extent {
            true => round_down(DRAWN * extent / seen.value),
            false => 1.0,
        };
        let then = match is_cut {
            true => "In the last frame",
            false => "At the largest displacement",
        };
        let then = match magnified > 1.0 {
            true => format!("{then}, drawn {magnified} times as large"),
            false => then.to_owned(),
        };
        let mut pictures = Self::default();
        // Where displacements are not to scale, tools would be in the body or away from it.
        let tools = match magnified > 1.0 {
            true => Vec::new(),
            false => Instruments::of(summary.scene.scene(), &read).tools,
        };
        for name in COLOURS {
            // A run of a surface alone has no stress.
            let Ok(colouring) = run.colouring(name) else {
                continue;
            };
            let clip = run.clip_of(&colouring, |other| other == t)?;
            let clip = clip.magnified(magnified);
            if pictures.of_views[0].is_empty() {
                let tissue = run.colouring("tissue")?;
                let first = run.times().next().unwrap_or(0.0);
                pictures.add(0, ("At the start", first), &tissue, &clip, &tools)?;
            }
            for view in 0..VIEWS.len() {
                pictures.add(view, (&then, t), &colouring, &clip, &tools)?;
            }
        }
        Ok(pictures)
    }

    /// Adds a picture at a time (s) to those of a view.
    fn add(
        &mut self,
        view: usize,
        (title, t): (&str, f64),
        colouring: &Colouring,
        clip: &Clip,
        tools: &[Tool],
    ) -> Result<(), FilmError> {
        let side = VIEWS[view];
        let look = Look {
            size: SIZE.parse()?,
            view: side.parse::<View>()?,
            colouring: colouring.clone(),
            range: None,
            title: title.to_owned(),
        };
        let picture = Film::new(clip.clone(), tools.to_vec(), &look)?.picture(t);
        let data = data_encoding::BASE64.encode(&picture.to_png()?);
        let alt = escape(&format!("The body from {side}: {title}"));
        self.of_views[view].push(format!(
            "<figure><img alt=\"{alt}\" src=\"data:image/png;base64,{data}\"></figure>\n"
        ));
        Ok(())
    }

    /// Buttons for the views, and the pictures of each.
    fn markup(&self) -> String {
        let mut html = "<div class=\"views\">\n".to_owned();
        for (place, view) in VIEWS.iter().enumerate() {
            let checked = if place == 0 { " checked" } else { "" };
            html.push_str(&format!(
                "<input type=\"radio\" name=\"view\" id=\"view-{view}\"{checked}><label for=\"view-{view}\">{view}</label>\n"
            ));
        }
        for pictures in &self.of_views {
            html.push_str("<div class=\"beside\">\n");
            html.extend(pictures.iter().map(String::as_str));
            html.push_str("</div>\n");
        }
        html.push_str("</div>\n");
        html
    }
}

/// The largest of 1, 2, 5, 10, 20, ... that is not larger.
fn round_down(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let steps = [5.0, 2.0, 1.0].into_iter().map(|step| step * decade);
    steps
        .into_iter()
        .find(|step| *step <= value)
        .unwrap_or(1.0)
        .max(1.0)
}
