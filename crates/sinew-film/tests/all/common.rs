//! Surfaces and pictures for tests.

use std::sync::Arc;

use sinew_film::{Clip, Colouring, Film, Frame, Kind, Look, Picture, Size, Surface};

/// A look from a direction without a title.
pub(crate) fn look(view: &str, size: (usize, usize), colouring: Colouring) -> Look {
    Look {
        size: Size::new(size.0, size.1).expect("a size"),
        view: view.parse().expect("a view"),
        colouring,
        range: None,
        title: String::new(),
    }
}

/// A clip of one frame.
pub(crate) fn still(points: Vec<[f64; 3]>, triangles: &[[u32; 3]], values: Vec<f32>) -> Clip {
    let kinds = vec![Kind::Tissue(1); triangles.len()];
    let surface = Arc::new(Surface::new(points, triangles, &kinds));
    Clip::new(vec![Frame::new(0.0, surface, Vec::new(), values)])
}

/// A film of a clip without instruments.
pub(crate) fn film(clip: Clip, look: &Look) -> Film {
    Film::new(clip, Vec::new(), look).expect("a film")
}

/// The picture of a clip at t = 0.
pub(crate) fn picture(clip: Clip, look: &Look) -> Picture {
    film(clip, look).picture(0.0)
}

/// A sphere about the origin.
pub(crate) fn sphere(radius: f64, around: usize) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let rows = around / 2;
    let mut points = Vec::new();
    for row in 0..=rows {
        let down = std::f64::consts::PI * row as f64 / rows as f64;
        for column in 0..around {
            let about = std::f64::consts::TAU * column as f64 / around as f64;
            let [x, y, z] = [
                down.sin() * about.cos(),
                down.sin() * about.sin(),
                down.cos(),
            ];
            points.push([radius * x, radius * y, radius * z]);
        }
    }
    let at = |row: usize, column: usize| (row * around + column % around) as u32;
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..around {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    (points, triangles)
}

/// A square across the view from the front, at a position along y, as two triangles.
pub(crate) fn square(y: f64, half: f64) -> Vec<[f64; 3]> {
    vec![
        [-half, y, -half],
        [half, y, -half],
        [half, y, half],
        [-half, y, half],
    ]
}

/// The triangles of a square whose first corner has this number.
pub(crate) fn of_square(first: u32) -> [[u32; 3]; 2] {
    [[first, first + 1, first + 2], [first, first + 2, first + 3]]
}

/// A cube with corners at 0 and 0.1 m, as two frames: at rest, and sheared by `by` after a second.
pub(crate) fn sheared_cube(by: f32) -> Clip {
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|corner| [0, 1, 2].map(|axis| 0.1 * f64::from((corner >> axis) & 1)))
        .collect();
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let kinds = [Kind::Tissue(1); 12];
    let sheared = corners
        .iter()
        .map(|corner| [by * corner[2] as f32, 0.0, 0.0])
        .collect();
    let surface = Arc::new(Surface::new(corners, triangles.as_flattened(), &kinds));
    let frame = |t: f64, u: Vec<[f32; 3]>| {
        let values = (0..8)
            .map(|corner| corner as f32 * (1.0 + t as f32))
            .collect();
        Frame::new(t, Arc::clone(&surface), u, values)
    };
    Clip::new(vec![frame(0.0, Vec::new()), frame(1.0, sheared)])
}
