//! Triangles of an instrument's parts.

use std::f32::consts::FRAC_PI_2;

use super::part::Shape;
use crate::vector::{V3, add, cross, scaled, sub, unit};

/// Points of a quarter of a circle: round parts have four times as many about their axis.
const QUARTER: usize = 12;

/// Share of a box's shortest edge by which its edges are rounded.
const BEVEL: f32 = 0.08;

/// Sizes of plates, in radii of the body: half the length of an edge, and the thickness.
const PLATE: [f32; 2] = [1.15, 0.06];

/// Sizes of blades, in lengths of the edge: from edge to back, of the ground part, and half the thickness.
const BLADE: [f32; 3] = [0.75, 0.22, 0.035];

/// A closed surface with normals at its points.
#[derive(Debug, Default)]
pub(crate) struct Solid {
    pub(crate) points: Vec<V3>,
    pub(crate) normals: Vec<V3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// The surface of a shape (m). `radius` (m) is that of the body, which gives the size of plates.
pub(crate) fn solid(shape: &Shape, radius: f32) -> Solid {
    match *shape {
        Shape::Sphere { radius } => rounded([0.0; 3], radius as f32),
        Shape::Capsule { radius, length } => {
            rounded([0.0, 0.0, 0.5 * length as f32], radius as f32)
        }
        Shape::Box { size } => {
            let half = size.map(|edge| 0.5 * edge as f32);
            let round = BEVEL * 2.0 * half[0].min(half[1]).min(half[2]);
            rounded(half.map(|half| half - round), round)
        }
        Shape::Plane => {
            let [half, thickness] = PLATE.map(|share| share * radius);
            let round = 0.2 * thickness;
            let core = [half - round, half - round, 0.5 * thickness - round];
            let mut plate = rounded(core, round);
            for point in &mut plate.points {
                point[2] -= 0.5 * thickness;
            }
            plate
        }
        Shape::Blade { length, back } => blade(length as f32, back.map(|x| x as f32)),
    }
}

/// The surface around all points within a distance of a box about the origin with these half edges.
fn rounded(core: V3, round: f32) -> Solid {
    let mut solid = Solid::default();
    let side = |quarter: usize| if matches!(quarter, 0 | 3) { 1.0 } else { -1.0 };
    let other = |quarter: usize| if quarter < 2 { 1.0 } else { -1.0 };
    let columns = 4 * (QUARTER + 1);
    for half in 0..2 {
        for step in 0..=QUARTER {
            let height = (half as f32 - 1.0) * FRAC_PI_2 + step as f32 / QUARTER as f32 * FRAC_PI_2;
            let z = if half == 0 { -core[2] } else { core[2] };
            for quarter in 0..4 {
                for turn in 0..=QUARTER {
                    let about = (quarter as f32 + turn as f32 / QUARTER as f32) * FRAC_PI_2;
                    let normal = [
                        height.cos() * about.cos(),
                        height.cos() * about.sin(),
                        height.sin(),
                    ];
                    let corner = [side(quarter) * core[0], other(quarter) * core[1], z];
                    solid.points.push(add(corner, scaled(normal, round)));
                    solid.normals.push(normal);
                }
            }
        }
    }
    let rows = 2 * (QUARTER + 1);
    let at = |row: usize, column: usize| (row * columns + column % columns) as u32;
    for row in 0..rows - 1 {
        for column in 0..columns {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            solid.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    // The flat ends between the four corners.
    let corner = |row: usize, quarter: usize| at(row, quarter * (QUARTER + 1));
    let [a, b, c, d] = [0, 1, 2, 3].map(|quarter| corner(rows - 1, quarter));
    solid.triangles.extend([[a, b, c], [a, c, d]]);
    let [a, b, c, d] = [0, 1, 2, 3].map(|quarter| corner(0, quarter));
    solid.triangles.extend([[a, c, b], [a, d, c]]);
    solid
}

/// A blade whose edge is on the z axis.
fn blade(length: f32, back: V3) -> Solid {
    let back = unit([back[0], back[1], 0.0]);
    let back = if back == [0.0; 3] {
        [1.0, 0.0, 0.0]
    } else {
        back
    };
    let across = cross([0.0, 0.0, 1.0], back);
    let [height, ground, thick] = BLADE.map(|share| share * length);
    let along = |far: f32, aside: f32| add(scaled(back, far), scaled(across, aside));
    let outline = [
        along(0.0, 0.0),
        along(ground, thick),
        along(height, thick),
        along(height, -thick),
        along(ground, -thick),
    ];
    let ends = [-0.5 * length, 0.5 * length];
    let raised = |point: V3, z: f32| [point[0], point[1], z];
    let mut solid = Solid::default();
    for (place, from) in outline.iter().enumerate() {
        let to = outline[(place + 1) % outline.len()];
        let [low, high] = ends;
        solid.add_facet(&[
            raised(to, low),
            raised(*from, low),
            raised(*from, high),
            raised(to, high),
        ]);
    }
    solid.add_facet(&outline.map(|point| raised(point, ends[0])));
    let mut top = outline.map(|point| raised(point, ends[1]));
    top.reverse();
    solid.add_facet(&top);
    solid
}

impl Solid {
    /// Adds a flat polygon.
    fn add_facet(&mut self, outline: &[V3]) {
        let [a, b, c] = match outline {
            [a, b, c, ..] => [*a, *b, *c],
            _ => return,
        };
        let normal = unit(cross(sub(b, a), sub(c, a)));
        let first = self.points.len() as u32;
        self.points.extend_from_slice(outline);
        self.normals.extend(outline.iter().map(|_| normal));
        let corners = outline.len() as u32;
        let fan = (1..corners - 1).map(|corner| [first, first + corner, first + corner + 1]);
        self.triangles.extend(fan);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    use crate::vector::dot;

    /// The volume within a closed surface whose triangles are counter-clockwise from outside.
    fn volume(solid: &Solid) -> f32 {
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| solid.points[corner as usize]);
            dot(a, cross(b, c)) / 6.0
        };
        solid.triangles.iter().map(of).sum()
    }

    #[test]
    fn solids_have_the_volumes_of_their_shapes() {
        let near = |shape: Shape, expected: f32, within: f32| {
            let found = volume(&solid(&shape, 1.0));
            let share = (found / expected - 1.0).abs();
            assert!(share < within, "{shape:?}: {found}, expected {expected}");
        };
        near(Shape::Sphere { radius: 2.0 }, 4.0 / 3.0 * PI * 8.0, 0.01);
        let rod = PI * 0.25 * 3.0 + 4.0 / 3.0 * PI * 0.125;
        near(
            Shape::Capsule {
                radius: 0.5,
                length: 3.0,
            },
            rod,
            0.01,
        );
        near(
            Shape::Box {
                size: [1.0, 2.0, 3.0],
            },
            6.0,
            0.02,
        );
        let blade = Shape::Blade {
            length: 1.0,
            back: [0.0, -2.0, 0.0],
        };
        near(blade, 0.035 * (2.0 * 0.75 - 0.22), 1e-3);
    }

    #[test]
    fn a_plate_lies_below_its_plane() {
        let plate = solid(&Shape::Plane, 0.1);
        let highest = plate
            .points
            .iter()
            .map(|point| point[2])
            .fold(f32::MIN, f32::max);
        assert!(highest.abs() < 1e-7, "{highest}");
    }
}
