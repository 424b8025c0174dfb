//! Pictures of the body.

use sinew_draw::{Page, Surface as Picture};
use sinew_mesh::BoundarySurface;

use super::beside;
use crate::summary::Summary;

/// Triangles beyond which a page with two pictures takes long to open.
const MOST_TRIANGLES: usize = 80_000;

/// Share of the body's size below which a displacement cannot be seen.
const SEEN: f64 = 0.02;

/// Size of a displacement in the picture, as a share of the body's size, if it would be invisible at true scale.
const DRAWN: f64 = 0.08;

/// The viewing direction of pictures.
const AWAY: [f64; 3] = [1.0, 1.0, -1.0];

/// The body at rest and at its largest motion.
pub(super) fn section(
    page: &mut Page,
    summary: &Summary<'_>,
    surface: &BoundarySurface,
    largest: &[f64],
) {
    page.section("body", "The body");
    let seen = summary.progress.seen.displacement;
    let moved = largest.as_chunks::<3>().0;
    // Of a body that was cut there are displacements also where all of them are 0, and no scale would show them.
    if moved.len() != surface.points.len() || seen.value == 0.0 {
        page.paragraph("It did not move at any instant of the fields.");
        return;
    }
    if surface.triangles.len() > MOST_TRIANGLES {
        page.paragraph(&format!(
            "A picture of {} triangles would make this page slow: `surface.vtu` and `fields.pvd` show them.",
            surface.triangles.len()
        ));
        return;
    }
    let extent = summary.body.system().extent().unwrap_or(1.0);
    let scale = match seen.value < SEEN * extent {
        true => round_down(DRAWN * extent / seen.value),
        false => 1.0,
    };
    let place = |factor: f64| -> Vec<[f64; 3]> {
        let points = surface.points.iter().zip(moved);
        points
            .map(|(point, u)| std::array::from_fn(|axis| point[axis] + factor * u[axis]))
            .collect()
    };
    let sizes: Vec<f64> = moved
        .iter()
        .map(|u| 1e3 * u.iter().map(|x| x * x).sum::<f64>().sqrt())
        .collect();
    let (rest, then) = (surface.points.clone(), place(scale));
    let view = bounds(rest.iter().chain(&then));
    let range = Some((0.0, 1e3 * seen.value));
    let body = summary.body.model().body();
    let when = match body.is_some_and(|body| body.cut.is_some()) {
        true => "After the cuts, in the last frame".to_owned(),
        false => format!("At t = {:.4} s", seen.t),
    };
    let words = match scale > 1.0 {
        true => format!("{when}, displacements drawn {scale} times as large"),
        false => when,
    };
    let pictures = [
        ("At rest".to_owned(), rest, vec![0.0; sizes.len()]),
        (words, then, sizes),
    ];
    let drawn = pictures.map(|(title, points, values)| {
        let facing: Vec<[u32; 3]> = surface
            .triangles
            .iter()
            .filter(|triangle| faces(&triangle.map(|point| points[point as usize])))
            .copied()
            .collect();
        let picture = Picture {
            range,
            view: Some(view),
            ..Picture::new(title, &points, &facing, &values, "displacement [mm]")
        };
        picture.svg()
    });
    beside::figures(page, &drawn);
}

/// True if a triangle shows its outside to the viewer.
fn faces([a, b, c]: &[[f64; 3]; 3]) -> bool {
    let edge = |to: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| to[axis] - a[axis]) };
    let (p, q) = (edge(b), edge(c));
    let normal = [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ];
    normal
        .iter()
        .zip(AWAY)
        .map(|(n, away)| n * away)
        .sum::<f64>()
        < 0.0
}

fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for point in points {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(point[axis]);
            bounds[1][axis] = bounds[1][axis].max(point[axis]);
        }
    }
    bounds
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
