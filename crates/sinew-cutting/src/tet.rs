//! Measures of one tetrahedron.

use sinew_mesh::vector::{Vector, cross, dot, scaled, sub};

/// The nodes of each face, opposite the node with the same index; their normals point outwards if the volume is
/// positive.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The nodes of each edge.
pub(crate) const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Signed volume.
pub(crate) fn volume([a, b, c, d]: &[Vector; 4]) -> f64 {
    dot(cross(sub(*b, *a), sub(*c, *a)), sub(*d, *a)) / 6.0
}

/// Mean ratio, 1 for the regular tetrahedron, 0 for a flat one and negative for an inverted one (Liu and Joe 1994).
pub(crate) fn quality(vertices: &[Vector; 4]) -> f64 {
    let squares = EDGES.map(|[i, j]| {
        let edge = sub(vertices[j], vertices[i]);
        dot(edge, edge)
    });
    let volume = volume(vertices);
    12.0 * (3.0 * volume.abs()).cbrt().powi(2) * volume.signum() / squares.iter().sum::<f64>()
}

/// Gradients of the four shape functions; not finite if the tetrahedron is flat.
pub(crate) fn gradients(vertices: &[Vector; 4]) -> [Vector; 4] {
    let factor = 1.0 / (6.0 * volume(vertices));
    std::array::from_fn(|vertex| {
        let [a, b, c] = FACES[vertex].map(|corner| vertices[corner]);
        // The outward normal is twice the area long; the function falls along it.
        scaled(cross(sub(b, a), sub(c, a)), -factor)
    })
}

/// True if a segment between two points meets the tetrahedron, inside or on its surface.
pub(crate) fn is_met(vertices: &[Vector; 4], [from, to]: [Vector; 2]) -> bool {
    // The shares of the segment between which it is on the inner side of all faces so far.
    let [mut first, mut last] = [0.0_f64, 1.0_f64];
    for (vertex, face) in FACES.into_iter().enumerate() {
        let [a, b, c] = face.map(|corner| vertices[corner]);
        let normal = cross(sub(b, a), sub(c, a));
        let inwards = dot(normal, sub(vertices[vertex], a)).signum();
        let [start, end] = [from, to].map(|point| inwards * dot(normal, sub(point, a)));
        match (start < 0.0, end < 0.0) {
            (true, true) => return false,
            (true, false) => first = first.max(start / (start - end)),
            (false, true) => last = last.min(start / (start - end)),
            (false, false) => {}
        }
    }
    first <= last
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_mesh::vector::add;

    const SKEW: [Vector; 4] = [
        [0.1, 0.0, 0.2],
        [1.3, 0.2, 0.0],
        [0.0, 0.9, 0.3],
        [0.2, 0.1, 1.1],
    ];

    #[test]
    fn shape_functions_are_one_at_their_vertex_and_zero_at_the_others() {
        for (vertex, gradient) in gradients(&SKEW).into_iter().enumerate() {
            for (other, place) in SKEW.into_iter().enumerate() {
                let expected = if vertex == other { 0.0 } else { -1.0 };
                assert!((dot(gradient, sub(place, SKEW[vertex])) - expected).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_segment_is_met_within_across_and_at_no_other_place() {
        let middle = sinew_mesh::vector::mean(SKEW);
        let [a, b, c, d] = SKEW;
        for vertices in [[a, b, c, d], [b, a, c, d]] {
            let near = add(middle, [1e-3, 0.0, 0.0]);
            assert!(is_met(&vertices, [middle, near]), "within");
            assert!(
                is_met(&vertices, [[-5.0, 0.3, 0.3], [5.0, 0.5, 0.5]]),
                "across"
            );
            assert!(is_met(&vertices, [middle, [9.0; 3]]), "out of it");
            assert!(!is_met(&vertices, [[3.0; 3], [9.0; 3]]));
            assert!(
                !is_met(&vertices, [[-1.0, 0.0, -1.0], [2.0, 0.0, -1.0]]),
                "beside"
            );
            assert!(
                !is_met(&vertices, [[1.5, 1.5, 0.0], [0.0, 1.5, 1.5]]),
                "past an edge"
            );
        }
    }

    #[test]
    fn the_regular_tetrahedron_has_quality_one_in_any_size_and_a_mirrored_one_the_negative() {
        let regular = [
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [1.0, -1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ];
        for size in [1e-3, 1.0, 40.0] {
            let scaled = regular.map(|corner| add(corner.map(|value| value * size), [1.0; 3]));
            assert!((quality(&scaled) - 1.0).abs() < 1e-9);
            let [a, b, c, d] = scaled;
            assert!((quality(&[b, a, c, d]) + 1.0).abs() < 1e-9);
        }
    }
}
