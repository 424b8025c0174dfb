//! The mesh of a body that was cut.

use super::surface::OUTWARD_FACES;
use super::{Group, GroupMembers, TetData, TetMesh};

/// Marks a node or a tetrahedron that is absent.
const NONE: u32 = u32::MAX;

/// The mesh of a body that was cut, and the origin of its parts.
#[derive(Clone, Debug)]
pub struct CutMesh {
    /// The mesh: the remaining nodes and tetrahedra, in the body's order.
    pub mesh: TetMesh,
    /// Node of the body for each node of the mesh.
    pub nodes: Vec<u32>,
    /// Node of the uncut mesh for each node of the mesh: the node itself, or the original of a copy.
    pub origins: Vec<u32>,
    /// Tetrahedron of the uncut mesh for each tetrahedron.
    pub tets: Vec<u32>,
}

/// A node that was moved at rest through unmoved tissue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedNode {
    /// The node.
    pub node: u32,
    /// The nodes of the tetrahedron that contains its new position, among them the node itself at its old position.
    pub nodes: [u32; 4],
    /// Their weights at the new position: fields at the node become this mean.
    pub shares: [f64; 4],
}

/// A mesh's body after cuts, in its own numbers.
#[derive(Clone, Copy, Debug)]
pub struct CutBody<'a> {
    /// Positions of the nodes: those of the mesh, then copies.
    pub points: &'a [[f64; 3]],
    /// Node of the mesh for each node: the node itself, or the original of a copy.
    pub origins: &'a [u32],
    /// The nodes of each tetrahedron of the mesh.
    pub tets: &'a [[u32; 4]],
    /// One flag per tetrahedron: true if it was removed.
    pub is_removed: &'a [bool],
}

impl TetMesh {
    /// The mesh of a body that was cut, with the groups and the data of this mesh, from which it was made.
    ///
    /// Groups of triangles and lines follow the first tetrahedron that has them, groups of nodes have all copies, and
    /// members that lost their tetrahedra are removed. Copies have tags beyond the last one.
    ///
    /// # Panics
    ///
    /// If the body was not made from this mesh.
    #[must_use]
    pub fn after_cuts(&self, body: CutBody<'_>) -> CutMesh {
        let left = || (0..body.tets.len()).filter(|tet| !body.is_removed[*tet]);
        let mut number = vec![NONE; body.points.len()];
        left().for_each(|tet| {
            body.tets[tet]
                .into_iter()
                .for_each(|node| number[node as usize] = 0);
        });
        let mut nodes = Vec::with_capacity(number.len());
        for (node, number) in (0..).zip(&mut number) {
            if *number != NONE {
                *number = nodes.len() as u32;
                nodes.push(node);
            }
        }
        let renumbered = |tet: usize| body.tets[tet].map(|node| number[node as usize]);
        let last_tag = self.node_tags.iter().copied().max().unwrap_or(0);
        let node_tag = |node: &u32| match self.node_tags.get(*node as usize) {
            Some(tag) => *tag,
            None => last_tag + 1 + u64::from(*node) - self.points.len() as u64,
        };
        let tags = self.tet_tags.iter().zip(body.is_removed);
        let tags = tags.filter(|(_, is_removed)| !**is_removed);
        let origins = nodes.iter().map(|node| body.origins[*node as usize]);
        let mut cut = CutMesh {
            mesh: TetMesh {
                points: nodes
                    .iter()
                    .map(|node| body.points[*node as usize])
                    .collect(),
                tets: left().map(renumbered).collect(),
                tet_tags: tags.map(|(tag, _)| *tag).collect(),
                node_tags: nodes.iter().map(node_tag).collect(),
                groups: Vec::new(),
                data: self
                    .data
                    .iter()
                    .map(|data| data.without(body.is_removed))
                    .collect(),
                node_data: {
                    let origins = || {
                        nodes
                            .iter()
                            .map(|node| body.origins[*node as usize] as usize)
                    };
                    self.node_data
                        .iter()
                        .map(|data| data.at(origins()))
                        .collect()
                },
                notes: self.notes.clone(),
            },
            origins: origins.collect(),
            nodes,
            tets: left().map(|tet| tet as u32).collect(),
        };
        let parts = |group: &Group| match &group.members {
            GroupMembers::Triangles(parts) => parts.iter().map(|part| part_key(part)).collect(),
            GroupMembers::Lines(parts) => parts.iter().map(|part| part_key(part)).collect(),
            GroupMembers::Tets(_) | GroupMembers::Nodes(_) => Vec::new(),
        };
        let owners = Owners::new(self, self.groups.iter().flat_map(parts));
        let followed = self.groups.iter().map(|group| Group {
            members: cut.members(self, &owners, &group.members),
            ..group.clone()
        });
        cut.mesh.groups = followed.collect();
        cut
    }
}

impl CutMesh {
    /// The remaining triangles of the uncut mesh, each following the first tetrahedron that has it.
    #[must_use]
    pub fn triangles(&self, uncut: &TetMesh, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        let owners = Owners::new(uncut, triangles.iter().map(|part| part_key(part)));
        self.followed(uncut, &owners, triangles)
    }

    /// The nodes that are one of these nodes of the uncut mesh or a copy, increasing.
    #[must_use]
    pub fn with_copies(&self, uncut: &TetMesh, nodes: &[u32]) -> Vec<u32> {
        let mut is_member = vec![false; uncut.points.len()];
        for node in nodes {
            is_member[*node as usize] = true;
        }
        let with_origin = (0..).zip(&self.origins);
        let kept = with_origin.filter(|(_, origin)| is_member[**origin as usize]);
        kept.map(|(node, _)| node).collect()
    }

    /// The nodes that replace these nodes of the uncut mesh, without removed ones: each itself, or its first copy if
    /// it has lost its own tetrahedra.
    #[must_use]
    pub fn without_copies(&self, uncut: &TetMesh, nodes: &[u32]) -> Vec<u32> {
        let mut seen = vec![false; uncut.points.len()];
        let mut first = self.with_copies(uncut, nodes);
        first.retain(|node| {
            !std::mem::replace(&mut seen[self.origins[*node as usize] as usize], true)
        });
        first
    }

    fn members(&self, uncut: &TetMesh, owners: &Owners, members: &GroupMembers) -> GroupMembers {
        match members {
            GroupMembers::Tets(tets) => {
                let mut is_member = vec![false; uncut.tets.len()];
                tets.iter().for_each(|tet| is_member[*tet as usize] = true);
                let kept = (0..)
                    .zip(&self.tets)
                    .filter(|(_, tet)| is_member[**tet as usize]);
                GroupMembers::Tets(kept.map(|(number, _)| number).collect())
            }
            GroupMembers::Triangles(parts) => {
                GroupMembers::Triangles(self.followed(uncut, owners, parts))
            }
            GroupMembers::Lines(parts) => GroupMembers::Lines(self.followed(uncut, owners, parts)),
            GroupMembers::Nodes(nodes) => GroupMembers::Nodes(self.with_copies(uncut, nodes)),
        }
    }

    /// Triangles or lines with the current nodes of their tetrahedra, if these still exist.
    fn followed<const N: usize>(
        &self,
        uncut: &TetMesh,
        owners: &Owners,
        parts: &[[u32; N]],
    ) -> Vec<[u32; N]> {
        let follow = |part: &[u32; N]| {
            let owner = owners.of(part)?;
            let now = self.mesh.tets[self.tets.binary_search(&owner).ok()?];
            let before = uncut.tets[owner as usize];
            let mut followed = [0; N];
            for (followed, node) in followed.iter_mut().zip(part) {
                *followed = now[before.iter().position(|corner| corner == node)?];
            }
            Some(followed)
        };
        parts.iter().filter_map(follow).collect()
    }
}

impl TetData {
    /// The same without the values of some tetrahedra.
    fn without(&self, is_removed: &[bool]) -> TetData {
        let rows = self.rows().zip(is_removed);
        let kept = rows.filter(|(_, is_removed)| !**is_removed);
        TetData {
            values: kept.flat_map(|(row, _)| row).copied().collect(),
            name: self.name.clone(),
            ..*self
        }
    }
}

/// The first tetrahedron that has each of some triangles and lines.
pub(super) struct Owners {
    /// The parts, given by their nodes, increasing.
    parts: Vec<PartKey>,
    /// The tetrahedron that has each, or [`NONE`].
    owners: Vec<u32>,
}

/// The nodes of a triangle or a line in ascending order; for a line the third one is [`NONE`].
pub(super) type PartKey = [u32; 3];

impl Owners {
    pub(super) fn new(mesh: &TetMesh, parts: impl Iterator<Item = PartKey>) -> Self {
        let mut parts: Vec<PartKey> = parts.collect();
        parts.sort_unstable();
        parts.dedup();
        let mut owners = Self {
            owners: vec![NONE; parts.len()],
            parts,
        };
        let mut is_corner = vec![false; mesh.points.len()];
        let corners = owners.parts.iter().flatten();
        corners
            .filter(|node| **node != NONE)
            .for_each(|node| is_corner[*node as usize] = true);
        let has_lines = owners.parts.iter().any(|part| part[2] == NONE);
        let fewest = if has_lines { 2 } else { 3 };
        for (tet, corners) in (0..).zip(&mesh.tets) {
            let are_corners = corners.map(|node| is_corner[node as usize]);
            if are_corners.iter().filter(|is_corner| **is_corner).count() < fewest {
                continue;
            }
            let mut own = |part: &[u32]| {
                let is_known = part.iter().all(|node| is_corner[*node as usize]);
                if let Some(place) = is_known.then(|| owners.place(part)).flatten()
                    && owners.owners[place] == NONE
                {
                    owners.owners[place] = tet;
                }
            };
            for face in OUTWARD_FACES {
                own(&face.map(|corner| corners[corner]));
            }
            if has_lines {
                for (i, j) in super::EDGES {
                    own(&[corners[i], corners[j]]);
                }
            }
        }
        owners
    }

    pub(super) fn of(&self, part: &[u32]) -> Option<u32> {
        let owner = self.owners[self.place(part)?];
        (owner != NONE).then_some(owner)
    }

    fn place(&self, part: &[u32]) -> Option<usize> {
        self.parts.binary_search(&part_key(part)).ok()
    }
}

/// The key of a triangle or a line.
pub(super) fn part_key(part: &[u32]) -> PartKey {
    let mut key = [NONE; 3];
    key.iter_mut()
        .zip(part)
        .for_each(|(own, node)| *own = *node);
    key.sort_unstable();
    key
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Two tetrahedra at a face, which is cut: 5, 6 and 7 are copies of 1, 2 and 3.
    pub(in super::super) fn split() -> (TetMesh, CutMesh) {
        let points = vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0; 3],
        ];
        let mut mesh = TetMesh::new(points, vec![[0, 1, 2, 3], [1, 2, 3, 4]]).expect("it is sound");
        let group = |name: &str, members| Group {
            name: name.to_owned(),
            dim: 2,
            tag: 1,
            members,
        };
        mesh.groups = vec![
            group("tets", GroupMembers::Tets(vec![1])),
            group(
                "faces",
                GroupMembers::Triangles(vec![[4, 3, 2], [0, 2, 1], [1, 2, 3]]),
            ),
            group("lines", GroupMembers::Lines(vec![[4, 2], [2, 3]])),
            group("nodes", GroupMembers::Nodes(vec![2, 4])),
        ];
        mesh.data = vec![TetData {
            name: "values".to_owned(),
            step: 0,
            components: 2,
            values: vec![1.0, 2.0, 3.0, 4.0],
        }];
        let mut points = mesh.points.clone();
        points.extend_from_within(1..4);
        let body = CutBody {
            points: &points,
            origins: &[0, 1, 2, 3, 4, 1, 2, 3],
            tets: &[[0, 1, 2, 3], [5, 6, 7, 4]],
            is_removed: &[false, false],
        };
        let cut = mesh.after_cuts(body);
        (mesh, cut)
    }

    #[test]
    fn triangles_and_lines_follow_their_tetrahedron_and_nodes_have_their_copies() {
        let (mesh, cut) = split();
        let members: Vec<_> = cut
            .mesh
            .groups
            .iter()
            .map(|group| group.members.clone())
            .collect();
        assert_eq!(
            members,
            [
                GroupMembers::Tets(vec![1]),
                GroupMembers::Triangles(vec![[4, 7, 6], [0, 2, 1], [1, 2, 3]]),
                GroupMembers::Lines(vec![[4, 6], [2, 3]]),
                GroupMembers::Nodes(vec![2, 4, 6]),
            ]
        );
        assert_eq!(cut.mesh.node_tags, [1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(cut.without_copies(&mesh, &[2, 4]), [2, 4]);
        assert_eq!(cut.triangles(&mesh, &[[2, 3, 4]]), [[6, 7, 4]]);
    }

    #[test]
    fn what_is_removed_takes_its_nodes_groups_and_data_along() {
        let (mesh, whole) = split();
        let mut points = mesh.points.clone();
        points.extend_from_within(1..4);
        let cut = mesh.after_cuts(CutBody {
            points: &points,
            origins: &[0, 1, 2, 3, 4, 1, 2, 3],
            tets: &[[0, 1, 2, 3], [5, 6, 7, 4]],
            is_removed: &[true, false],
        });
        assert_eq!(cut.nodes, [4, 5, 6, 7]);
        assert_eq!(cut.origins, [4, 1, 2, 3]);
        assert_eq!(cut.mesh.tets, [[1, 2, 3, 0]]);
        assert_eq!(cut.mesh.tet_tags, [2]);
        assert_eq!(cut.mesh.data[0].values, [3.0, 4.0]);
        let faces = cut.mesh.group("faces").expect("it is kept");
        assert_eq!(faces.members, GroupMembers::Triangles(vec![[0, 3, 2]]));
        // A node that is gone is replaced by its copy.
        assert_eq!(cut.without_copies(&mesh, &[0, 2]), [2]);
        assert_eq!(whole.mesh.volume(1), cut.mesh.volume(0));
    }
}
