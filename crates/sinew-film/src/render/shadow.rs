//! Shadows with soft edges.

use super::model::Model;
use crate::vector::{V3, add, cross, dot, scaled, unit};

/// Pixels along an edge of the map.
const EDGE: usize = 448;

/// Half the width of the map, in units of the body's radius.
const REACH: f32 = 1.9;

/// Number of pixels by which a shadow's edge is spread to each side, twice.
const SPREAD: usize = 4;

/// The distance from its surface at which a point is looked up, so that no surface shades itself.
const OFF: f32 = 0.025;

/// The share of light that counts as no light, since the mean of several depths lets some light through everywhere.
const DARK: f32 = 0.25;

/// Depths seen from the light, and their squares: W. Donnelly and A. Lauritzen, Variance Shadow Maps (2006).
pub(super) struct Shadow {
    right: V3,
    up: V3,
    towards: V3,
    means: Vec<[f32; 2]>,
}

impl Shadow {
    /// The shadows of a model under light from the direction `towards`.
    pub(super) fn of(model: &Model, towards: V3) -> Self {
        let aside = if towards[2].abs() > 0.99 {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let right = unit(cross(aside, towards));
        let up = cross(towards, right);
        let mut highest = vec![-REACH; EDGE * EDGE];
        let pixels = EDGE as f32 / (2.0 * REACH);
        let seen: Vec<V3> = model
            .vertices
            .iter()
            .map(|vertex| {
                let [x, y] = [right, up].map(|axis| (dot(vertex.place, axis) + REACH) * pixels);
                [x, y, dot(vertex.place, towards)]
            })
            .collect();
        for (corners, _) in &model.triangles {
            spread_over(
                corners.map(|corner| seen[corner as usize]),
                EDGE,
                |place, height| {
                    highest[place] = highest[place].max(height);
                },
            );
        }
        let means = highest.into_iter().map(|height| [height, height * height]);
        let mut means: Vec<[f32; 2]> = means.collect();
        for _ in 0..2 {
            means = smoothed(&smoothed(&means, 1), EDGE);
        }
        Self {
            right,
            up,
            towards,
            means,
        }
    }

    /// The share of light that reaches a point of a surface with this normal.
    pub(super) fn lit(&self, place: V3, normal: V3) -> f32 {
        let place = add(place, scaled(normal, OFF));
        let pixels = EDGE as f32 / (2.0 * REACH);
        let [x, y] = [self.right, self.up].map(|axis| (dot(place, axis) + REACH) * pixels - 0.5);
        let last = (EDGE - 1) as f32;
        if !(x >= 0.0 && y >= 0.0 && x < last && y < last) {
            return 1.0;
        }
        let (column, row) = (x as i32 as usize, y as i32 as usize);
        let [along, down] = [x - column as f32, y - row as f32];
        let first = row * EDGE + column;
        let mix = |moment: usize| {
            let value = |place: usize| self.means[place][moment];
            let upper = value(first) + along * (value(first + 1) - value(first));
            let below = first + EDGE;
            let lower = value(below) + along * (value(below + 1) - value(below));
            upper + down * (lower - upper)
        };
        let (mean, square) = (mix(0), mix(1));
        let beyond = mean - dot(place, self.towards);
        if beyond <= 0.0 {
            return 1.0;
        }
        let variance = (square - mean * mean).max(2e-4);
        let most = variance / (variance + beyond * beyond);
        ((most - DARK) / (1.0 - DARK)).clamp(0.0, 1.0)
    }
}

/// Calls `at` with each pixel whose middle a triangle covers and the third number there, on a square of `edge` pixels.
pub(super) fn spread_over([a, b, c]: [V3; 3], edge: usize, mut at: impl FnMut(usize, f32)) {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let range = |axis: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]).max(0.0);
        let high = a[axis].max(b[axis]).max(c[axis]).min(edge as f32);
        (low as usize)..(high.max(0.0).ceil() as usize).min(edge)
    };
    for row in range(1) {
        for column in range(0) {
            let [x, y] = [column as f32 + 0.5, row as f32 + 0.5];
            let share =
                |p: V3, q: V3| ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / area;
            let [of_a, of_b, of_c] = [share(b, c), share(c, a), share(a, b)];
            if of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0 {
                at(row * edge + column, of_a * a[2] + of_b * b[2] + of_c * c[2]);
            }
        }
    }
}

/// Means over neighbours along rows (`stride` 1) or columns (`stride` [`EDGE`]).
fn smoothed(values: &[[f32; 2]], stride: usize) -> Vec<[f32; 2]> {
    let mut means = vec![[0.0; 2]; values.len()];
    let across = if stride == 1 { EDGE } else { 1 };
    let of = |line: usize, place: usize| line * across + place * stride;
    for line in 0..EDGE {
        let mut sum = [0.0_f32; 2];
        let mut count = 0.0;
        for place in 0..EDGE + SPREAD {
            if place < EDGE {
                let [first, second] = values[of(line, place)];
                sum = [sum[0] + first, sum[1] + second];
                count += 1.0;
            }
            if place > 2 * SPREAD {
                let [first, second] = values[of(line, place - 2 * SPREAD - 1)];
                sum = [sum[0] - first, sum[1] - second];
                count -= 1.0;
            }
            if place >= SPREAD {
                means[of(line, place - SPREAD)] = sum.map(|sum| sum / count);
            }
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Paint, Vertex};

    #[test]
    fn a_plate_keeps_the_light_from_what_lies_below_it() {
        let vertex = |x: f32, y: f32| Vertex {
            place: [x, y, 0.5],
            normal: [0.0, 0.0, 1.0],
            rest: [0.0; 3],
            value: 0.0,
        };
        let model = Model {
            vertices: vec![
                vertex(-0.5, -0.5),
                vertex(0.5, -0.5),
                vertex(0.5, 0.5),
                vertex(-0.5, 0.5),
            ],
            triangles: vec![([0, 1, 2], Paint::Steel), ([0, 2, 3], Paint::Steel)],
        };
        let up = [0.0, 0.0, 1.0];
        let shadow = Shadow::of(&model, up);
        let lit = |x: f32, z: f32| shadow.lit([x, 0.0, z], up);
        assert!(lit(0.0, -0.5) < 0.01, "{}", lit(0.0, -0.5));
        assert!(lit(0.0, 0.5) > 0.99, "{}", lit(0.0, 0.5));
        assert!(lit(1.0, -0.5) > 0.99, "{}", lit(1.0, -0.5));
        // Between both it grows, through half shade.
        let across: Vec<f32> = (0..100).map(|step| lit(0.01 * step as f32, -0.5)).collect();
        assert!(across.is_sorted_by(|a, b| *b > a - 1e-3), "{across:?}");
        assert!(
            across.iter().any(|lit| (0.2..0.8).contains(lit)),
            "{across:?}"
        );
        assert!(lit(50.0, 0.0) > 0.99);
    }
}
