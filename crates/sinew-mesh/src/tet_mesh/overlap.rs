//! The volume in which cut faces overlap.

use super::CutMesh;
use crate::vector::{cross, dot, sub};

type Corners = [[f64; 3]; 4];

impl CutMesh {
    /// The volume (m^3) in which tetrahedra at the faces of cuts overlap, with the nodes of the mesh at these positions
    /// (m): the sum over pairs of tetrahedra. Inverted tetrahedra do not count.
    ///
    /// One of two tetrahedra is cut by the planes of the other (Sutherland and Hodgman 1974).
    #[must_use]
    pub fn overlap_of_lips(&self, places: &[[f64; 3]]) -> f64 {
        let is_copied = self.is_copied();
        let at_lips = |nodes: &&[u32; 4]| nodes.iter().any(|node| is_copied[*node as usize]);
        let mut boxed: Vec<Boxed> = self
            .mesh
            .tets
            .iter()
            .filter(at_lips)
            .filter_map(|nodes| {
                let corners = nodes.map(|node| places.get(node as usize));
                let [Some(a), Some(b), Some(c), Some(d)] = corners else {
                    return None;
                };
                Some(Boxed::of([*a, *b, *c, *d]))
            })
            .filter(|boxed| volume(&boxed.corners) > 0.0)
            .collect();
        boxed.sort_by(|one, other| one.low[0].total_cmp(&other.low[0]));
        let mut sum = 0.0;
        for (number, one) in boxed.iter().enumerate() {
            let rest = boxed[number + 1..].iter();
            for other in rest.take_while(|other| other.low[0] < one.high[0]) {
                if (1..3).all(|axis| {
                    one.low[axis] < other.high[axis] && other.low[axis] < one.high[axis]
                }) {
                    sum += inside(one.corners, &other.planes());
                }
            }
        }
        sum
    }
}

/// A tetrahedron, and the box around it.
struct Boxed {
    corners: Corners,
    low: [f64; 3],
    high: [f64; 3],
}

impl Boxed {
    fn of(corners: Corners) -> Self {
        let along = |axis: usize| corners.into_iter().map(move |corner| corner[axis]);
        Self {
            corners,
            low: [0, 1, 2].map(|axis| along(axis).fold(f64::INFINITY, f64::min)),
            high: [0, 1, 2].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max)),
        }
    }

    /// A point in each of its faces, and the normal into it.
    fn planes(&self) -> [[[f64; 3]; 2]; 4] {
        super::surface::OUTWARD_FACES.map(|face| {
            let [a, b, c] = face.map(|corner| self.corners[corner]);
            [a, cross(sub(c, a), sub(b, a))]
        })
    }
}

/// Volume (m^3) of a tetrahedron, negative if it is inverted.
fn volume([a, b, c, d]: &Corners) -> f64 {
    dot(sub(*b, *a), cross(sub(*c, *a), sub(*d, *a))) / 6.0
}

/// Volume (m^3) of the part of a tetrahedron on the inner side of all planes.
fn inside(corners: Corners, planes: &[[[f64; 3]; 2]]) -> f64 {
    let Some(([point, normal], others)) = planes.split_first() else {
        return volume(&corners).abs();
    };
    let mut heights = corners.map(|corner| dot(sub(corner, *point), *normal));
    let mut corners = corners;
    // Those inside come first.
    for end in (1..4).rev() {
        for place in 0..end {
            if heights[place] < heights[place + 1] {
                heights.swap(place, place + 1);
                corners.swap(place, place + 1);
            }
        }
    }
    let within = heights.iter().filter(|height| **height > 0.0).count();
    let cut = |from: usize, to: usize| {
        let share = heights[from] / (heights[from] - heights[to]);
        let way = sub(corners[to], corners[from]);
        [0, 1, 2].map(|axis| corners[from][axis] + share * way[axis])
    };
    let [a, b, c, _] = corners;
    match within {
        0 => 0.0,
        1 => inside([a, cut(0, 1), cut(0, 2), cut(0, 3)], others),
        2 => wedge([a, cut(0, 2), cut(0, 3)], [b, cut(1, 2), cut(1, 3)], others),
        3 => wedge([a, b, c], [cut(0, 3), cut(1, 3), cut(2, 3)], others),
        _ => inside(corners, others),
    }
}

/// Volume (m^3) of the part of a wedge between two triangles on the inner side of all planes.
fn wedge([a, b, c]: [[f64; 3]; 3], [d, e, f]: [[f64; 3]; 3], planes: &[[[f64; 3]; 2]]) -> f64 {
    inside([a, b, c, d], planes) + inside([b, c, d, e], planes) + inside([c, d, e, f], planes)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn overlap(one: Corners, other: Corners) -> f64 {
        inside(one, &Boxed::of(other).planes())
    }

    fn moved(by: [f64; 3]) -> Corners {
        UNIT.map(|corner| [0, 1, 2].map(|axis| corner[axis] + by[axis]))
    }

    #[test]
    fn a_corner_cut_off_and_two_shifted_corners_have_the_volumes_of_similar_tetrahedra() {
        assert!((overlap(UNIT, UNIT) - 1.0 / 6.0).abs() < 1e-15);
        // Shifted along an edge by s, what both fill is similar with the factor 1 - s.
        for (by, factor) in [
            ([0.25, 0.0, 0.0], 0.75_f64),
            ([0.2, 0.3, 0.1], 0.4),
            ([0.5, 0.5, 0.0], 0.0),
        ] {
            for volume in [overlap(UNIT, moved(by)), overlap(moved(by), UNIT)] {
                assert!(
                    (volume - factor.powi(3) / 6.0).abs() < 1e-15,
                    "{by:?} {volume}"
                );
            }
        }
        assert_eq!(overlap(UNIT, moved([-2.0, 0.0, 0.0])), 0.0);
    }

    #[test]
    fn a_tetrahedron_in_another_counts_whole() {
        let small = UNIT.map(|corner| corner.map(|x| 0.1 + 0.2 * x));
        for volume in [overlap(small, UNIT), overlap(UNIT, small)] {
            assert!((volume - 0.008 / 6.0).abs() < 1e-16, "{volume}");
        }
    }
}
