//! The shape of a tetrahedron.

use crate::cell_type::CellType;
use crate::mesh::Mesh;
use crate::vector::{cross, dot, sub};

/// The corners of a cell if it is a tetrahedron of any order.
pub(crate) fn tet_corners(mesh: &Mesh, kind: CellType, row: &[u32]) -> Option<[[f64; 3]; 4]> {
    if !kind.is_tetrahedron() {
        return None;
    }
    let corner = |i: usize| mesh.points.get(*row.get(i)? as usize).copied();
    Some([corner(0)?, corner(1)?, corner(2)?, corner(3)?])
}

/// The quantities of a tetrahedron that the checks use.
pub(crate) struct TetShape {
    /// Signed volume, a sixth of the triple product of three edges. Negative if the tetrahedron is inverted.
    pub(crate) volume: f64,
    /// Lengths of the edges 01, 02, 03, 23, 13, 12: opposite edges are three apart.
    pub(crate) edges: [f64; 6],
    /// Normals of the faces opposite each corner, of twice the area's length, outward unless the tetrahedron is inverted.
    normals: [[f64; 3]; 4],
}

impl TetShape {
    pub(crate) fn of([a, b, c, d]: [[f64; 3]; 4]) -> TetShape {
        let (ab, ac, ad) = (sub(b, a), sub(c, a), sub(d, a));
        let (bc, bd, cd) = (sub(c, b), sub(d, b), sub(d, c));
        let length = |v: [f64; 3]| dot(v, v).sqrt();
        TetShape {
            volume: dot(cross(ab, ac), ad) / 6.0,
            edges: [ab, ac, ad, cd, bd, bc].map(length),
            normals: [cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)],
        }
    }

    pub(crate) fn longest_edge(&self) -> f64 {
        self.edges.iter().copied().fold(0.0, f64::max)
    }

    /// True if the volume is at most `share` times the cube of the longest edge.
    pub(crate) fn is_flat(&self, share: f64) -> bool {
        // A NaN counts as flat as well.
        let limit = share * self.longest_edge().powi(3);
        self.volume.is_nan() || self.volume.abs() <= limit
    }

    /// The least angle between two faces, in degrees.
    pub(crate) fn least_dihedral(&self) -> f64 {
        const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let angles = PAIRS.map(|(i, j)| {
            let (n, m) = (self.normals[i], self.normals[j]);
            let sine = cross(n, m);
            // The arc tangent stays accurate near 0, where the arc cosine does not.
            dot(sine, sine).sqrt().atan2(-dot(n, m)).to_degrees()
        });
        angles.into_iter().fold(180.0, f64::min)
    }

    /// Three times the inradius over the circumradius: 1 for a regular tetrahedron, 0 for a flat one.
    ///
    /// The circumradius R comes from Crelle's formula: 24 R |V| = sqrt((p+q+r)(p+q-r)(p-q+r)(q+r-p)), where p, q, r are
    /// the products of opposite edges.
    pub(crate) fn radius_ratio(&self) -> f64 {
        let volume = self.volume.abs();
        let area: f64 = self.normals.iter().map(|&n| dot(n, n).sqrt() / 2.0).sum();
        let inradius = 3.0 * volume / area;
        let [p, q, r] = [0, 1, 2].map(|i| self.edges[i] * self.edges[i + 3]);
        let product = (p + q + r) * (p + q - r) * (p - q + r) * (q + r - p);
        let circumradius = product.max(0.0).sqrt() / (24.0 * volume);
        if circumradius > 0.0 {
            3.0 * inradius / circumradius
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_tetrahedron_is_as_good_as_can_be() {
        let corners = [
            [1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [1.0, -1.0, -1.0],
        ];
        let shape = TetShape::of(corners);
        assert!((shape.radius_ratio() - 1.0).abs() < 1e-14);
        let expected = (1.0f64 / 3.0).acos().to_degrees();
        assert!((shape.least_dihedral() - expected).abs() < 1e-12);
        assert!((shape.volume.abs() - 8.0 / 3.0).abs() < 1e-14);
    }

    #[test]
    fn the_corner_of_a_cube_has_known_angles() {
        let shape = TetShape::of([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        let expected = 2.0f64.sqrt().atan().to_degrees();
        assert!((shape.least_dihedral() - expected).abs() < 1e-12);
        let (inradius, circumradius) = (1.0 / (3.0 + 3.0f64.sqrt()), 3.0f64.sqrt() / 2.0);
        assert!((shape.radius_ratio() - 3.0 * inradius / circumradius).abs() < 1e-14);
    }

    #[test]
    fn a_sliver_of_four_points_near_a_circle_is_seen() {
        let h = 1e-3;
        let shape = TetShape::of([
            [1.0, 0.0, h],
            [0.0, 1.0, -h],
            [-1.0, 0.0, h],
            [0.0, -1.0, -h],
        ]);
        assert!(shape.least_dihedral() < 0.3, "{}", shape.least_dihedral());
        assert!(shape.radius_ratio() < 0.01, "{}", shape.radius_ratio());
        assert!(!shape.is_flat(1e-9) && shape.is_flat(1e-2));
    }
}
