//! The visible triangle at each of four points of a pixel.

use super::camera::{Camera, Seen};
use super::model::{Model, Vertex};
use crate::vector::{between, unit};

/// Rows of a band: a band's samples stay in the second-level cache.
pub(super) const BAND: usize = 16;

/// Points of a pixel, from its middle, rotated so that vertical and horizontal edges get four steps.
pub(super) const SAMPLES: [[f32; 2]; 4] = [
    [-0.125, -0.375],
    [0.375, -0.125],
    [-0.375, 0.125],
    [0.125, 0.375],
];

/// No triangle.
pub(super) const NOTHING: u32 = u32::MAX;

/// Triangles in the projection of a camera.
pub(super) struct Projected {
    pub(super) vertices: Vec<Vertex>,
    pub(super) seen: Vec<Seen>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The triangle of the model of each.
    pub(super) origins: Vec<u32>,
}

impl Projected {
    /// The triangles of a model, without the parts behind the eye.
    pub(super) fn of(model: &Model, camera: &Camera) -> Self {
        let mut projected = Self {
            vertices: model.vertices.clone(),
            seen: Vec::new(),
            triangles: Vec::with_capacity(model.triangles.len()),
            origins: Vec::with_capacity(model.triangles.len()),
        };
        for (origin, (corners, _)) in model.triangles.iter().enumerate() {
            let is_before = |corner: &u32| camera.is_before(model.vertices[*corner as usize].place);
            let count = corners.iter().filter(|corner| is_before(corner)).count();
            if count == 3 {
                projected.triangles.push(*corners);
                projected.origins.push(origin as u32);
            } else if count > 0 {
                projected.add_clipped(*corners, camera, origin as u32);
            }
        }
        let seen = projected
            .vertices
            .iter()
            .map(|vertex| camera.seen(vertex.place));
        projected.seen = seen.collect();
        projected
    }

    /// Adds the part of a triangle that is in front of the eye.
    fn add_clipped(&mut self, corners: [u32; 3], camera: &Camera, origin: u32) {
        let mut outline = Vec::with_capacity(4);
        for place in 0..3 {
            let [from, to] = [corners[place], corners[(place + 1) % 3]];
            let [a, b] = [from, to].map(|corner| self.vertices[corner as usize]);
            let is_before = [a, b].map(|vertex| camera.is_before(vertex.place));
            if is_before[0] {
                outline.push(from);
            }
            if is_before[0] != is_before[1] {
                let (inside, outside) = if is_before[0] { (a, b) } else { (b, a) };
                let share = camera.end_of(inside.place, outside.place);
                outline.push(self.vertices.len() as u32);
                self.vertices.push(Vertex {
                    place: between(inside.place, outside.place, share),
                    normal: unit(between(inside.normal, outside.normal, share)),
                    rest: between(inside.rest, outside.rest, share),
                    value: inside.value + share * (outside.value - inside.value),
                });
            }
        }
        for corner in 1..outline.len().saturating_sub(1) {
            self.triangles
                .push([outline[0], outline[corner], outline[corner + 1]]);
            self.origins.push(origin);
        }
    }

    /// The triangles that touch each band of a picture with a number of rows, in their order.
    pub(super) fn bands(&self, rows: usize) -> Vec<Vec<u32>> {
        let mut bands = vec![Vec::new(); rows.div_ceil(BAND)];
        for (index, corners) in self.triangles.iter().enumerate() {
            let y = corners.map(|corner| self.seen[corner as usize].y);
            let low = y[0].min(y[1]).min(y[2]) - 0.5;
            let high = y[0].max(y[1]).max(y[2]) + 0.5;
            if high < 0.0 || low >= rows as f32 || !(high - low).is_finite() {
                continue;
            }
            let first = low.max(0.0) as usize / BAND;
            let last = (high as usize).min(rows - 1) / BAND;
            for band in &mut bands[first..=last] {
                band.push(index as u32);
            }
        }
        bands
    }
}

/// The samples of a band: the nearest triangle at each, and its nearness.
#[derive(Debug, Default)]
pub(super) struct Samples {
    near: Vec<[f32; 4]>,
    pub(super) triangles: Vec<[u32; 4]>,
}

impl Samples {
    /// Empties the samples of a number of pixels.
    pub(super) fn clear(&mut self, pixels: usize) {
        self.near.clear();
        self.near.resize(pixels, [f32::MIN; 4]);
        self.triangles.clear();
        self.triangles.resize(pixels, [NOTHING; 4]);
    }

    /// Fills in a triangle within a band whose first row is `top`. If two are equally near, the first stays.
    pub(super) fn fill(&mut self, index: u32, corners: [Seen; 3], width: usize, top: usize) {
        let rows = self.near.len() / width;
        let [a, mut b, mut c] = corners;
        let mut area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area < 0.0 {
            (b, c, area) = (c, b, -area);
        }
        if area <= 0.0 || !area.is_finite() {
            return;
        }
        let low = |axis: fn(&Seen) -> f32| axis(&a).min(axis(&b)).min(axis(&c)) - 0.5;
        let high = |axis: fn(&Seen) -> f32| axis(&a).max(axis(&b)).max(axis(&c)) + 0.5;
        let bottom = top + rows;
        let first_row = (low(|seen| seen.y).max(top as f32) as usize).max(top);
        let end_row = (high(|seen| seen.y).min(bottom as f32).max(0.0).ceil() as usize).min(bottom);
        let first = low(|seen| seen.x).max(0.0) as usize;
        let end = (high(|seen| seen.x).min(width as f32).max(0.0).ceil() as usize).min(width);
        // Twice the area between each edge and a point: above 0 within. Slopes to the right and down.
        let edges = [(b, c), (c, a), (a, b)].map(|(p, q)| (p, [p.y - q.y, q.x - p.x]));
        let steps = edges.map(|(_, [right, down])| SAMPLES.map(|[x, y]| right * x + down * y));
        let most = steps.map(|steps| steps.into_iter().fold(f32::MIN, f32::max));
        let least = steps.map(|steps| steps.into_iter().fold(f32::MAX, f32::min));
        let [near_b, near_c] = [b.near - a.near, c.near - a.near].map(|near| near / area);
        for row in first_row..end_row {
            let y = row as f32 + 0.5;
            let line = (row - top) * width;
            // The pixels of the row that the edges leave, and one more on either side for rounding.
            let (mut from, mut to) = (first as f32, end as f32);
            for ((p, [right, down]), most) in edges.iter().zip(most) {
                let bound = p.x - (down * (y - p.y) + most) / right;
                if *right > 0.0 {
                    from = from.max(bound - 1.5);
                } else if *right < 0.0 {
                    to = to.min(bound + 1.5);
                }
            }
            for column in from as usize..to.max(0.0) as usize {
                let x = column as f32 + 0.5;
                let at = edges.map(|(p, [right, down])| right * (x - p.x) + down * (y - p.y));
                if at[0] + most[0] < 0.0 || at[1] + most[1] < 0.0 || at[2] + most[2] < 0.0 {
                    continue;
                }
                let is_whole =
                    at[0] + least[0] >= 0.0 && at[1] + least[1] >= 0.0 && at[2] + least[2] >= 0.0;
                let pixel = line + column;
                let (nears, triangles) = (&mut self.near[pixel], &mut self.triangles[pixel]);
                for sample in 0..SAMPLES.len() {
                    let [of_a, of_b, of_c] =
                        [0, 1, 2].map(|edge: usize| at[edge] + steps[edge][sample]);
                    let is_within = is_whole || (of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0);
                    let near = a.near + of_b * near_b + of_c * near_c;
                    if is_within && near > nears[sample] {
                        nears[sample] = near;
                        triangles[sample] = index;
                    }
                }
            }
        }
    }
}
