//! Faces that lie on each other.

use std::collections::HashMap;

use crate::vector::{cross, dot, sub};

/// Largest distance of a face outside, or inside, another face on which it lies, as a share of its longest edge.
const OUTSIDE: f64 = 1e-3;
const INSIDE: f64 = 1e-6;

/// Least opposed component of two normals.
const OPPOSED: f64 = 0.999;

/// Least edge of a cell of the grid, as a share of the longest edge of a face: so that a large face is in few cells.
const COARSEST: f64 = 0.02;

/// Rounding of barycentric coordinates.
const ROUNDING: f64 = 1e-6;

/// Points of a face that are searched on others, in barycentric coordinates.
const SAMPLES: [[f64; 3]; 4] = {
    const THIRD: f64 = 1.0 / 3.0;
    const FAR: f64 = 2.0 / 3.0;
    const NEAR: f64 = 1.0 / 6.0;
    [
        [THIRD, THIRD, THIRD],
        [FAR, NEAR, NEAR],
        [NEAR, FAR, NEAR],
        [NEAR, NEAR, FAR],
    ]
};

/// A face in space: its corners (m), counter-clockwise from outside.
pub(super) type Corners = [[f64; 3]; 3];

/// Pairs (face, other) of faces with opposite outward normals, with a point of the first on the other.
pub(super) fn pairs(faces: &[Corners]) -> Vec<[usize; 2]> {
    let lengths = faces.iter().map(longest_edge);
    let edge = lengths.clone().fold(0.0, f64::max);
    let mean = lengths.sum::<f64>() / faces.len().max(1) as f64;
    if !(edge > 0.0 && edge.is_finite()) {
        return Vec::new();
    }
    let grid = Grid::new(faces, mean.max(COARSEST * edge));
    let mut pairs = Vec::new();
    for (face, corners) in faces.iter().enumerate() {
        let reach = OUTSIDE * longest_edge(corners);
        for sample in SAMPLES {
            let point = [0, 1, 2].map(|axis| (0..3).map(|i| sample[i] * corners[i][axis]).sum());
            for &other in grid.near(point) {
                if other as usize != face && lies_on(corners, point, reach, &faces[other as usize])
                {
                    pairs.push([face, other as usize]);
                }
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// True if a point of a face lies on another face with an opposite outward normal.
fn lies_on(face: &Corners, point: [f64; 3], reach: f64, other: &Corners) -> bool {
    let (Some(own), Some(normal)) = (normal(face), normal(other)) else {
        return false;
    };
    if dot(own, normal) > -OPPOSED {
        return false;
    }
    // Beyond the other's outside where there is a gap; inside, it would be the far side of a thin sheet.
    let height = dot(normal, sub(point, other[0]));
    (-reach * INSIDE / OUTSIDE..=reach).contains(&height) && is_within(point, other)
}

/// True if the foot of a point on the plane of a face is in that face.
pub(super) fn is_within(point: [f64; 3], face: &Corners) -> bool {
    let [a, b, c] = *face;
    let normal = cross(sub(b, a), sub(c, a));
    let square = dot(normal, normal);
    [[a, b], [b, c], [c, a]]
        .into_iter()
        .all(|[from, to]| dot(cross(sub(to, from), sub(point, from)), normal) >= -ROUNDING * square)
}

fn normal([a, b, c]: &Corners) -> Option<[f64; 3]> {
    let normal = cross(sub(*b, *a), sub(*c, *a));
    let length = dot(normal, normal).sqrt();
    (length > 0.0).then(|| normal.map(|x| x / length))
}

pub(super) fn longest_edge([a, b, c]: &Corners) -> f64 {
    let edges = [sub(*b, *a), sub(*c, *b), sub(*a, *c)];
    let squares = edges.map(|edge| dot(edge, edge));
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

/// Faces, sorted into the cells of a grid that their boxes overlap.
struct Grid {
    cell: f64,
    faces: HashMap<[i64; 3], Vec<u32>>,
}

impl Grid {
    fn new(faces: &[Corners], cell: f64) -> Self {
        let mut grid = Self {
            cell,
            faces: HashMap::new(),
        };
        for (face, corners) in (0u32..).zip(faces) {
            let reach = OUTSIDE * longest_edge(corners);
            let bound = |of: fn(f64, f64) -> f64, shift: f64| {
                grid.place([0, 1, 2].map(|axis| {
                    let values = corners.map(|corner| corner[axis]);
                    of(of(values[0], values[1]), values[2]) + shift
                }))
            };
            let (low, high) = (bound(f64::min, -reach), bound(f64::max, reach));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        grid.faces.entry([x, y, z]).or_default().push(face);
                    }
                }
            }
        }
        grid
    }

    fn place(&self, point: [f64; 3]) -> [i64; 3] {
        point.map(|x| (x / self.cell).floor() as i64)
    }

    fn near(&self, point: [f64; 3]) -> &[u32] {
        self.faces
            .get(&self.place(point))
            .map_or(&[], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn turned(face: Corners, height: f64, scale: f64) -> Corners {
        let [a, b, c] = face.map(|[x, y, _]| [scale * x, scale * y, height]);
        [a, c, b]
    }

    #[test]
    fn a_face_lies_on_one_that_is_turned_to_it_and_not_on_the_far_side_of_a_sheet() {
        for (height, is_on) in [(0.0, true), (5e-4, true), (-5e-4, false), (0.01, false)] {
            let faces = [UNIT, turned(UNIT, height, 1.0)];
            assert_eq!(!pairs(&faces).is_empty(), is_on, "{height}");
        }
        assert!(pairs(&[UNIT, UNIT]).is_empty());
    }

    #[test]
    fn a_small_face_lies_on_a_large_one_and_one_beside_it_does_not() {
        assert_eq!(pairs(&[UNIT, turned(UNIT, 0.0, 0.01)]), [[1, 0]]);
        let beside = turned(UNIT, 0.0, 1.0).map(|[x, y, z]| [x + 1.0, y, z]);
        assert!(pairs(&[UNIT, beside]).is_empty());
    }
}
