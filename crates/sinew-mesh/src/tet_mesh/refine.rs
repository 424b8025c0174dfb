//! Refinement: each tetrahedron cut into eight.

use super::{Group, GroupMembers, TetData, TetMesh};
use crate::vector::{dot, sub};

/// A mesh cannot be refined.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RefineError {
    /// More nodes or tetrahedra than a 32-bit index can count.
    #[error(
        "refined, the mesh would have {nodes} nodes and {tets} tetrahedra; at most {} of each are supported",
        u32::MAX - 1
    )]
    TooLarge {
        /// Nodes of the refined mesh.
        nodes: u64,
        /// Tetrahedra of the refined mesh.
        tets: u64,
    },
}

/// Corners of the eight tetrahedra, in the numbering of Bey (1995) ("Tetrahedral grid refinement", Computing 55): entries below
/// 4 are corners, the others the midpoints of [`MIDPOINTS`].
const CHILDREN: [[usize; 4]; 8] = [
    [0, 4, 5, 6],
    [4, 1, 7, 8],
    [5, 7, 2, 9],
    [6, 8, 9, 3],
    [4, 5, 6, 8],
    [4, 5, 7, 8],
    [5, 6, 8, 9],
    [5, 7, 8, 9],
];

/// One flag per tetrahedron of [`CHILDREN`]: true if it is oriented against its parent.
const IS_TURNED: [bool; 8] = [false, false, false, false, false, true, false, true];

/// The edges with midpoints 4 to 9.
const MIDPOINTS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The orders of a parent's corners that put each of the three diagonals of its inner octahedron between the midpoints
/// of the edges 0-2 and 1-3, along which [`CHILDREN`] cuts; with a flag, true if the order reverses the parent's
/// orientation.
const ORDERS: [([usize; 4], bool); 3] = [
    ([0, 1, 2, 3], false),
    ([0, 2, 1, 3], true),
    ([0, 1, 3, 2], true),
];

impl TetMesh {
    /// This mesh with each tetrahedron cut into eight at the midpoints of its edges.
    ///
    /// The four at the corners have the shape of the whole. The octahedron between them is cut along the diagonal that
    /// gives the best shapes. In the next refinement, each part has a diagonal that gives only parts of the shapes that
    /// exist already (Bey 1995), so further refinement gives no worse shapes than the first one. A cube of
    /// [`Split::Kuhn`](crate::structured::Split::Kuhn) becomes the one with twice as many cells.
    ///
    /// Old nodes come first and keep their tags; tetrahedra are renumbered, the eight of tetrahedron `t` being `8 t..8
    /// t + 8`. The eight have the data of their parent, and new nodes the mean of the data at the ends of their edge,
    /// or none if these are different labels. All groups stay: tetrahedra become eight, triangles four, lines two.
    /// Triangles and lines with edges that do not belong to a tetrahedron are unchanged, as [`TetMesh::notes`] reports.
    /// New nodes on curved surfaces lie on the straight edges.
    ///
    /// # Errors
    ///
    /// If nodes or tetrahedra become too many for 32-bit indices.
    ///
    /// ```
    /// use sinew_mesh::structured::{Split, cube};
    /// let coarse = cube(2, 0.1, Split::Kuhn)?;
    /// let fine = coarse.refined()?;
    /// assert_eq!((fine.points.len(), fine.tets.len()), (125, 8 * coarse.tets.len()));
    /// assert_eq!(fine.group("top")?.members.len(), 4 * coarse.group("top")?.members.len());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn refined(&self) -> Result<TetMesh, RefineError> {
        let midpoints = Midpoints::of(self)?;
        let middles = midpoints.edges.iter().map(|&[a, b]| {
            let (a, b) = (self.points[a as usize], self.points[b as usize]);
            [0, 1, 2].map(|i| f64::midpoint(a[i], b[i]))
        });
        let points: Vec<[f64; 3]> = self.points.iter().copied().chain(middles).collect();
        let mut tets = Vec::with_capacity(8 * self.tets.len());
        for tet in &self.tets {
            tets.extend(self.cut(tet, &midpoints));
        }
        let mut notes = self.notes.clone();
        let groups = self.groups.iter().map(|group| {
            let (members, whole) = refined_members(&group.members, &midpoints);
            if whole > 0 {
                notes.push(format!(
                    "cells of group \"{}\" (dimension {}, tag {}) that are not made of edges of tetrahedra and were not \
                     refined: {whole}",
                    group.name, group.dim, group.tag
                ));
            }
            Group {
                members,
                ..group.clone()
            }
        });
        let groups = groups.collect();
        Ok(TetMesh {
            node_tags: tags_with_new(&self.node_tags, self.points.len(), points.len()),
            tet_tags: (1..).take(tets.len()).collect(),
            points,
            tets,
            groups,
            data: self.data.iter().map(TetData::refined).collect(),
            node_data: {
                let data = self.node_data.iter();
                data.map(|data| data.refined(&midpoints.edges)).collect()
            },
            notes,
        })
    }

    /// The eight tetrahedra of a parent, with its orientation.
    fn cut(&self, tet: &[u32; 4], midpoints: &Midpoints) -> [[u32; 4]; 8] {
        let (order, is_turned) = self.best_order(tet);
        let corners = order.map(|i| tet[i]);
        let mut nodes = [0; 10];
        nodes[..4].copy_from_slice(&corners);
        for (node, [a, b]) in nodes[4..].iter_mut().zip(MIDPOINTS) {
            // A collapsed tetrahedron may name a node twice.
            *node = midpoints
                .between(corners[a], corners[b])
                .unwrap_or(corners[a]);
        }
        let mut children = CHILDREN.map(|child| child.map(|i| nodes[i]));
        for (child, turned) in children.iter_mut().zip(IS_TURNED) {
            if turned != is_turned {
                // Bey's diagonal stays the first to be considered, and is taken where others are as good.
                child.swap(0, 2);
            }
        }
        children
    }

    /// The order of a tetrahedron's corners for which the worst of its inner parts is best.
    ///
    /// The measure is the mean ratio of Liu and Joe (1994) ("Relationship between tetrahedron shape measures", BIT 34);
    /// since the parts have equal volumes, the best ones have the least sum of squared edges.
    fn best_order(&self, tet: &[u32; 4]) -> ([usize; 4], bool) {
        /// Sums that differ by less than this share of them are equal up to rounding.
        const EQUAL: f64 = 1e-9;
        let greatest_sum = |(order, _): &([usize; 4], bool)| {
            let mut points = [[0.0; 3]; 10];
            for (point, i) in points.iter_mut().zip(order) {
                *point = self.points[tet[*i] as usize];
            }
            for (middle, [a, b]) in (4..).zip(MIDPOINTS) {
                points[middle] = [0, 1, 2].map(|i| f64::midpoint(points[a][i], points[b][i]));
            }
            let sums = CHILDREN[4..].iter().map(|part| {
                let edges = MIDPOINTS.map(|[a, b]| sub(points[part[a]], points[part[b]]));
                edges.iter().map(|&edge| dot(edge, edge)).sum::<f64>()
            });
            sums.fold(0.0, f64::max)
        };
        let [mut best, ..] = ORDERS;
        for order in ORDERS {
            if greatest_sum(&order) < (1.0 - EQUAL) * greatest_sum(&best) {
                best = order;
            }
        }
        best
    }
}

/// The nodes in the middle of the edges of a mesh.
struct Midpoints {
    /// The edges, lower node first, in ascending order.
    edges: Vec<[u32; 2]>,
    /// For each node the index of the first edge of which it is the lower one, and the number of edges at the end.
    first_edge: Vec<usize>,
    /// The node in the middle of the first edge.
    first_node: u32,
}

impl Midpoints {
    fn of(mesh: &TetMesh) -> Result<Midpoints, RefineError> {
        let edges = mesh.edges();
        let nodes = (mesh.points.len() + edges.len()) as u64;
        let tets = 8 * mesh.tets.len() as u64;
        let (true, Ok(first_node)) = (
            nodes.max(tets) < u64::from(u32::MAX),
            u32::try_from(mesh.points.len()),
        ) else {
            return Err(RefineError::TooLarge { nodes, tets });
        };
        let mut first_edge = vec![0; mesh.points.len() + 1];
        for &[lower, _] in &edges {
            first_edge[lower as usize + 1] += 1;
        }
        for node in 0..mesh.points.len() {
            first_edge[node + 1] += first_edge[node];
        }
        Ok(Midpoints {
            edges,
            first_edge,
            first_node,
        })
    }

    /// The node in the middle of an edge, if the mesh has the edge.
    fn between(&self, a: u32, b: u32) -> Option<u32> {
        let (lower, upper) = (a.min(b), a.max(b));
        let start = *self.first_edge.get(lower as usize)?;
        let end = *self.first_edge.get(lower as usize + 1)?;
        let edges = self.edges.get(start..end)?;
        let place = edges.binary_search(&[lower, upper]).ok()?;
        // Fits, because all nodes do.
        Some(self.first_node + (start + place) as u32)
    }
}

/// The members of a refined group, and the number of unrefined ones.
fn refined_members(members: &GroupMembers, midpoints: &Midpoints) -> (GroupMembers, usize) {
    let mut whole = 0;
    let members = match members {
        GroupMembers::Tets(tets) => {
            GroupMembers::Tets(tets.iter().flat_map(|&t| 8 * t..8 * t + 8).collect())
        }
        GroupMembers::Triangles(triangles) => {
            let mut fine = Vec::with_capacity(4 * triangles.len());
            for &[a, b, c] in triangles {
                let middles = (
                    midpoints.between(a, b),
                    midpoints.between(b, c),
                    midpoints.between(c, a),
                );
                if let (Some(ab), Some(bc), Some(ca)) = middles {
                    fine.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
                } else {
                    whole += 1;
                    fine.push([a, b, c]);
                }
            }
            GroupMembers::Triangles(fine)
        }
        GroupMembers::Lines(lines) => {
            let mut fine = Vec::with_capacity(2 * lines.len());
            for &[a, b] in lines {
                if let Some(middle) = midpoints.between(a, b) {
                    fine.extend([[a, middle], [middle, b]]);
                } else {
                    whole += 1;
                    fine.push([a, b]);
                }
            }
            GroupMembers::Lines(fine)
        }
        GroupMembers::Nodes(nodes) => GroupMembers::Nodes(nodes.clone()),
    };
    (members, whole)
}

/// The tags of the `old` nodes and new ones after the greatest of them; all are renumbered if such tags would overflow.
fn tags_with_new(tags: &[u64], old: usize, all: usize) -> Vec<u64> {
    let greatest = tags.iter().max().copied().unwrap_or(0);
    let new = (all - old) as u64;
    if tags.len() != old || greatest.checked_add(new).is_none() {
        return (1..).take(all).collect();
    }
    tags.iter()
        .copied()
        .chain((1..=new).map(|n| greatest + n))
        .collect()
}
