//! The mesh that a simulation needs: points, 4-node tetrahedra and groups.

mod add_group;
mod boundary;
mod boundary_surface;
mod collect_data;
mod collect_groups;
mod cut;
mod cut_faces;
mod error;
pub(crate) mod faces;
mod find_data;
mod find_group;
mod from_mesh;
mod group;
mod node_data;
mod overlap;
mod placement;
mod refine;
mod split_in_place;
mod surface;
mod tet_data;
mod to_mesh;

pub use add_group::AddGroupError;
pub use boundary_surface::BoundarySurface;
pub use cut::{CutBody, CutMesh, MovedNode};
pub use error::TetMeshError;
pub use find_data::TetDataError;
pub use find_group::FindGroupError;
pub use group::{Group, GroupMembers};
pub use node_data::NodeData;
pub use refine::RefineError;
pub use split_in_place::{Split, SplitFollower};
pub(crate) use surface::OUTWARD_FACES;
pub use surface::SurfaceError;
pub use tet_data::TetData;

use crate::vector::{cross, dot, sub};

/// The vertices of each edge of a tetrahedron.
const EDGES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// Points, tetrahedra and groups, every point being a corner of some tetrahedron.
///
/// The fields are public so that a program can build a mesh. The methods expect every index to be in range, as
/// [`Mesh::to_tet_mesh`](crate::Mesh::to_tet_mesh), [`TetMesh::new`] and the
/// [`structured`](crate::structured) generators guarantee, and panic otherwise. Flat and inverted tetrahedra are
/// allowed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TetMesh {
    /// Coordinates of the nodes, in the file's length unit (metres in a scene).
    pub points: Vec<[f64; 3]>,
    /// The four nodes of each tetrahedron: with positive orientation, the fourth node lies on the side of the first three
    /// from which they run counter-clockwise.
    pub tets: Vec<[u32; 4]>,
    /// The tag of each tetrahedron in the file, for messages.
    pub tet_tags: Vec<u64>,
    /// The tag of each node in the file, for messages.
    pub node_tags: Vec<u64>,
    /// The groups, highest dimension first, then by tag.
    pub groups: Vec<Group>,
    /// Values in the tetrahedra.
    pub data: Vec<TetData>,
    /// Values at the nodes.
    pub node_data: Vec<NodeData>,
    /// Notes for the user, one sentence each, on cells and nodes that were merged or dropped in the conversion from
    /// the file.
    pub notes: Vec<String>,
}

impl TetMesh {
    /// A mesh without groups; tags count from 1.
    ///
    /// # Errors
    ///
    /// If there are no tetrahedra, or one names a node that does not exist.
    ///
    /// ```
    /// use sinew_mesh::TetMesh;
    /// let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mesh = TetMesh::new(corners, vec![[0, 1, 2, 3]])?;
    /// assert_eq!(mesh.volume(0), 1.0 / 6.0);
    /// # Ok::<(), sinew_mesh::TetMeshError>(())
    /// ```
    pub fn new(points: Vec<[f64; 3]>, tets: Vec<[u32; 4]>) -> Result<TetMesh, TetMeshError> {
        if tets.is_empty() {
            return Err(TetMeshError::NoTetrahedra {
                found: "no cells".to_owned(),
                is_surface: false,
            });
        }
        for (tag, tet) in (1..).zip(&tets) {
            if let Some(&node) = tet.iter().find(|&&node| node as usize >= points.len()) {
                return Err(TetMeshError::NodeOutOfRange {
                    kind: crate::CellType::Tetra,
                    element_tag: tag,
                    node,
                    nodes: points.len(),
                });
            }
        }
        Ok(TetMesh {
            tet_tags: (1..).take(tets.len()).collect(),
            node_tags: (1..).take(points.len()).collect(),
            points,
            tets,
            groups: Vec::new(),
            data: Vec::new(),
            node_data: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// Signed volume of tetrahedron `t`: positive if it is positively oriented, zero if flat.
    #[must_use]
    pub fn volume(&self, t: usize) -> f64 {
        let [a, b, c, d] = self.tets[t].map(|node| self.points[node as usize]);
        dot(cross(sub(b, a), sub(c, a)), sub(d, a)) / 6.0
    }

    /// Area of a triangle of these nodes.
    #[must_use]
    pub fn area(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|node| self.points[node as usize]);
        let normal = cross(sub(b, a), sub(c, a));
        dot(normal, normal).sqrt() / 2.0
    }

    /// Signed volume of every tetrahedron.
    #[must_use]
    pub fn signed_volumes(&self) -> Vec<f64> {
        (0..self.tets.len()).map(|t| self.volume(t)).collect()
    }

    /// The least and greatest coordinates; (+infinity, -infinity) for a mesh without points.
    #[must_use]
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in &self.points {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        (low, high)
    }

    /// Each edge of the tetrahedra once, lower node first, in ascending order.
    #[must_use]
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let pairs = || {
            let of_tet = |tet: &[u32; 4]| {
                let tet = *tet;
                EDGES.map(|(i, j)| [tet[i].min(tet[j]), tet[i].max(tet[j])])
            };
            // A collapsed tetrahedron may name a node twice.
            let pairs = self.tets.iter().flat_map(of_tet);
            pairs.filter(|[low, high]| low != high)
        };
        // Sorted by lower nodes by counting, which takes time in proportion to their number.
        let mut ends = vec![0usize; self.points.len()];
        pairs().for_each(|[low, _]| ends[low as usize] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        let mut higher = vec![0; sum];
        for [low, high] in pairs() {
            let end = &mut ends[low as usize];
            higher[*end] = high;
            *end += 1;
        }
        let (mut edges, mut start) = (Vec::with_capacity(sum / 4), 0);
        for (low, end) in (0u32..).zip(ends) {
            let of_node = &mut higher[start..end];
            of_node.sort_unstable();
            let same = of_node.chunk_by(|a, b| a == b);
            edges.extend(same.map(|same| [low, same[0]]));
            start = end;
        }
        edges
    }

    /// The node nearest to a point, and its distance; of equally near nodes, the lowest.
    ///
    /// Checks every node. In a mesh without nodes, or for a point that is not finite, the result is node 0 at
    /// infinity.
    #[must_use]
    pub fn nearest_node(&self, point: [f64; 3]) -> (u32, f64) {
        let mut nearest = (0, f64::INFINITY);
        for (node, &candidate) in (0u32..).zip(&self.points) {
            let offset = sub(candidate, point);
            let distance_squared = dot(offset, offset);
            if distance_squared < nearest.1 {
                nearest = (node, distance_squared);
            }
        }
        (nearest.0, nearest.1.sqrt())
    }

    /// The tetrahedron (0-based) that contains a point, and the point's barycentric coordinates in it; if none contains
    /// it, the tetrahedron in whose coordinates the point is least outside, with a coordinate below 0. If several have
    /// equal coordinates, the first one.
    ///
    /// Checks every tetrahedron. `None` in a mesh without tetrahedra, and for a point that is not finite.
    #[must_use]
    pub fn tet_at(&self, point: [f64; 3]) -> Option<(u32, [f64; 4])> {
        let mut best: Option<(u32, [f64; 4])> = None;
        let least = |shares: &[f64; 4]| shares.iter().copied().fold(f64::INFINITY, f64::min);
        for (tet, nodes) in (0u32..).zip(&self.tets) {
            let [a, b, c, d] = nodes.map(|node| sub(self.points[node as usize], point));
            let triple = |p, q, r| dot(p, cross(q, r));
            let volumes = [
                triple(b, d, c),
                triple(a, c, d),
                triple(a, d, b),
                triple(a, b, c),
            ];
            let whole: f64 = volumes.iter().sum();
            let shares = volumes.map(|volume| volume / whole);
            let is_number = shares.iter().all(|share| share.is_finite());
            if is_number && best.is_none_or(|(_, found)| least(&shares) > least(&found)) {
                best = Some((tet, shares));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_tets() -> TetMesh {
        let points = vec![
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, 4.0],
            [0.0, 0.0, -1.0],
        ];
        TetMesh::new(points, vec![[0, 1, 2, 3], [0, 1, 2, 4]]).expect("valid indices")
    }

    #[test]
    fn the_tetrahedron_around_a_point_has_it_as_the_mean_of_its_vertices() {
        let mesh = two_tets();
        for (point, expected) in [([0.2, 0.3, 1.0], 0), ([0.2, 0.3, -0.4], 1)] {
            let (tet, shares) = mesh.tet_at(point).expect("it is inside");
            assert_eq!(tet, expected);
            assert!(shares.iter().all(|share| *share > 0.0));
            for (axis, expected) in point.iter().enumerate() {
                let nodes = mesh.tets[tet as usize].iter().zip(shares);
                let terms = nodes.map(|(node, share)| share * mesh.points[*node as usize][axis]);
                assert!((terms.sum::<f64>() - expected).abs() < 1e-15);
            }
        }
        let (tet, shares) = mesh.tet_at([0.1, 0.1, 9.0]).expect("there are tetrahedra");
        assert!(tet == 0 && shares.iter().any(|share| *share < 0.0));
        assert_eq!(mesh.tet_at([f64::NAN; 3]), None);
    }

    #[test]
    fn volumes_carry_the_orientation() {
        assert_eq!(two_tets().signed_volumes(), [4.0, -1.0]);
    }

    #[test]
    fn an_area_is_that_of_a_right_triangle_whatever_the_order_of_its_nodes() {
        assert_eq!(two_tets().area([0, 1, 2]), 3.0);
        assert_eq!(two_tets().area([3, 1, 0]), 4.0);
    }

    #[test]
    fn edges_are_unique_and_sorted() {
        let edges = two_tets().edges();
        assert_eq!(
            edges,
            [
                [0, 1],
                [0, 2],
                [0, 3],
                [0, 4],
                [1, 2],
                [1, 3],
                [1, 4],
                [2, 3],
                [2, 4]
            ]
        );
    }

    #[test]
    fn box_and_nearest_node() {
        let mesh = two_tets();
        assert_eq!(mesh.bounding_box(), ([0.0, 0.0, -1.0], [2.0, 3.0, 4.0]));
        assert_eq!(mesh.nearest_node([0.0, 0.0, 6.0]), (3, 2.0));
        assert_eq!(
            mesh.nearest_node([1.0, 0.0, 0.0]).0,
            0,
            "a tie goes to the lowest node"
        );
        assert_eq!(mesh.nearest_node([f64::NAN; 3]), (0, f64::INFINITY));
    }

    #[test]
    fn a_node_that_does_not_exist_is_refused() {
        let error = TetMesh::new(vec![[0.0; 3]; 4], vec![[0, 1, 2, 3], [0, 1, 2, 4]]);
        let message = error.expect_err("node 4 of 4").to_string();
        assert_eq!(
            message,
            "tetra with tag 2 has node index 4, but there are 4 nodes (0..=3)"
        );
    }
}
