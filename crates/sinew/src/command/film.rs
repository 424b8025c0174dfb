//! `sinew film`.

mod arguments;
mod goal;
mod known;
mod run_files;

use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};
use sinew_film::{Film, FilmError, Look, Run, Size, Timing};
use sinew_scene::Scene;
use sinew_scene::output::{Destination, OwnedFolder, Voice, complain};

use self::goal::{Goal, KIND};
use self::known::known_of;
use self::run_files::read_within;
use super::Failure;
use super::interruption::Interruption;
use super::mp4::Mp4;
use super::results::{Results, names_scene};

pub(crate) use self::arguments::Arguments;

/// Sizes of films as PNG, which should have few bytes, and of all others.
const SMALL: &str = "720x405";
const LARGE: &str = "1280x720";

/// Files of a run folder that are never overwritten.
const READ: [&str; 4] = ["fields.pvd", "tools.csv", "scene.toml", "run.json"];

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let refused = |source: FilmError| Failure::Film {
        run: arguments.run.clone(),
        source,
    };
    let inputs = inputs(&arguments.run);
    let view = arguments.view.parse().map_err(refused)?;
    let goal = Goal::of(arguments, &inputs)?;
    let size = size(arguments, &goal).map_err(refused)?;
    // A rate that is none is said before a scene is run.
    Timing::new([0.0, 1.0], arguments.fps, arguments.seconds).map_err(refused)?;
    let results = Results::of(&arguments.run, &interruption)?;
    let folder = results.folder();
    let files = |name: &str| read_within(folder, name);
    let frames = Run::open(&files).map_err(refused)?;
    let colouring = frames.colouring(&arguments.colour).map_err(refused)?;
    let clip = frames.clip(&colouring).map_err(refused)?;
    let known = known_of(folder);
    for missing in &known.instruments.missing {
        complain(&format!("warning: {missing}"));
    }
    let look = Look {
        size,
        view,
        colouring,
        range: match arguments.range.as_deref() {
            Some(&[from, to]) => Some([from, to]),
            _ => None,
        },
        title: known.title.unwrap_or_default(),
    };
    let film = Film::new(clip, known.instruments.tools, &look).map_err(refused)?;
    let film = match arguments.bare {
        true => film.without_words(),
        false => film,
    };
    let maker = Maker {
        arguments,
        film: &film,
        size,
        interruption: &interruption,
    };
    maker.make(goal, &inputs)
}

/// Files that are read and never overwritten.
fn inputs(run: &Path) -> Vec<PathBuf> {
    match names_scene(run) {
        true => Scene::input_files_of(run),
        false => READ.iter().map(|name| run.join(name)).collect(),
    }
}

/// The requested size, or the default of the goal.
fn size(arguments: &Arguments, goal: &Goal) -> Result<Size, FilmError> {
    let usual = match goal {
        Goal::Film(_) => SMALL,
        _ => LARGE,
    };
    let size: Size = arguments.size.as_deref().unwrap_or(usual).parse()?;
    Ok(match goal {
        Goal::Mp4(_) => size.even(),
        _ => size,
    })
}

/// Arguments and film from which pictures are made.
struct Maker<'a> {
    arguments: &'a Arguments,
    film: &'a Film,
    size: Size,
    interruption: &'a Interruption,
}

impl Maker<'_> {
    fn make(&self, goal: Goal, inputs: &[PathBuf]) -> Result<(), Failure> {
        match goal {
            Goal::Picture(file) => {
                let t = self.arguments.at.unwrap_or_default();
                let picture = self
                    .film
                    .picture_at(t)
                    .map_err(|error| self.refused(error))?;
                let png = picture.to_png().map_err(|error| self.refused(error))?;
                self.write(file, &png, "a picture")
            }
            Goal::Film(file) => {
                let timing = self.timing()?;
                let bar = bar(timing.pictures());
                let mut seen = 0;
                let film = self.film.animation(timing, &mut |done| {
                    bar.set_position(done as u64);
                    seen = done;
                    !self.interruption.is_asked_for()
                });
                bar.finish_and_clear();
                let film = film.map_err(|error| match error {
                    FilmError::Stopped => self.interrupted(timing, seen),
                    error => self.refused(error),
                })?;
                self.write(file, &film, &in_words(timing))
            }
            Goal::Mp4(file) => {
                let timing = self.timing()?;
                let mut mp4 = Mp4::begin(self.size, timing.fps())?;
                self.each(timing, |_, picture| Ok(mp4.add(picture)?))?;
                self.write(file, &mp4.finish()?, &in_words(timing))
            }
            Goal::Folder(path) => {
                let timing = self.timing()?;
                let name = |picture: usize| format!("{picture:05}.png");
                let names: Vec<String> = (0..timing.pictures()).map(name).collect();
                let folder = OwnedFolder::claim(&path, KIND, inputs, &names)?;
                self.each(timing, |place, picture| {
                    let png = picture.to_png().map_err(|error| self.refused(error))?;
                    Ok(folder.write(&name(place), &png)?)
                })?;
                folder.finish(true)?;
                let words = in_words(timing);
                Voice::StandardOutput.say(&format!("{}: {words}", path.display()))?;
                Ok(())
            }
        }
    }

    /// Draws each picture and passes it on.
    fn each(
        &self,
        timing: Timing,
        mut take: impl FnMut(usize, &sinew_film::Picture) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let bar = bar(timing.pictures());
        for (place, t) in timing.instants(self.film.span()).into_iter().enumerate() {
            if self.interruption.is_asked_for() {
                bar.finish_and_clear();
                return Err(self.interrupted(timing, place));
            }
            take(place, &self.film.picture(t))?;
            bar.set_position(place as u64 + 1);
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn timing(&self) -> Result<Timing, Failure> {
        let Arguments { fps, seconds, .. } = self.arguments;
        let timing = Timing::new(self.film.span(), *fps, *seconds);
        timing.map_err(|error| self.refused(error))
    }

    /// Writes a file and reports its content.
    fn write(&self, file: Destination, content: &[u8], what: &str) -> Result<(), Failure> {
        let voice = Voice::apart_from(&file);
        let path = file.path().display().to_string();
        let _ = file.write(content)?;
        let (width, height) = (self.size.width(), self.size.height());
        let size = match content.len() {
            bytes if bytes < 1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
            bytes => format!("{:.1} MB", bytes as f64 / 1e6),
        };
        voice.say(&format!("{path}: {what}, {width} x {height}, {size}"))?;
        Ok(())
    }

    fn refused(&self, source: FilmError) -> Failure {
        let run = self.arguments.run.clone();
        Failure::Film { run, source }
    }

    /// The failure for an interrupt by the user after `done` pictures.
    fn interrupted(&self, timing: Timing, done: usize) -> Failure {
        let instants = timing.instants(self.film.span());
        Failure::Interrupted {
            t: instants
                .get(done)
                .or(instants.last())
                .copied()
                .unwrap_or_default(),
            remedy: String::new(),
        }
    }
}

fn in_words(timing: Timing) -> String {
    match (timing.pictures(), timing.fps()) {
        (1, _) => "a picture".to_owned(),
        (count, fps) => format!("{count} pictures, {fps} a second"),
    }
}

/// The progress on a terminal.
fn bar(pictures: usize) -> ProgressBar {
    let bar = ProgressBar::new(pictures as u64);
    let style = ProgressStyle::with_template("{bar:30} {pos} of {len} pictures, {eta} left");
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}
