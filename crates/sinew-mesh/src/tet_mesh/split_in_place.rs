//! Updates of a mesh in place after splits of its body.

use super::cut::{Owners, part_key};
use super::{CutBody, CutMesh, Group, GroupMembers, MovedNode, TetMesh};

/// The parts of a mesh's groups, sorted by the tetrahedra that they follow, for [`CutMesh::follow_split`]. It is made
/// from the uncut mesh.
#[derive(Clone, Debug)]
pub struct SplitFollower {
    /// Triangles and lines, in the order of their tetrahedra.
    parts: Vec<FollowedPart>,
    /// Number of nodes of the uncut mesh, and the largest tag of a node.
    nodes: usize,
    last_tag: u64,
}

/// A triangle or a line of a group.
#[derive(Clone, Copy, Debug)]
struct FollowedPart {
    tet: u32,
    group: u32,
    /// Index among the parts of the group that belong to some tetrahedron.
    part: u32,
    /// The vertices of the tetrahedron at its corners; a line has two.
    corners: [u8; 3],
}

/// Changes that a split made to a body without removed tetrahedra.
#[derive(Clone, Copy, Debug)]
pub struct Split<'a> {
    /// The current body.
    pub body: CutBody<'a>,
    /// Nodes that were moved at rest.
    pub moved: &'a [MovedNode],
    /// Tetrahedra whose nodes have changed.
    pub tets: &'a [u32],
}

impl SplitFollower {
    /// The follower for the body of this uncut mesh.
    #[must_use]
    pub fn new(uncut: &TetMesh) -> Self {
        let parts = |group: &Group| match &group.members {
            GroupMembers::Triangles(parts) => parts.iter().map(|part| part_key(part)).collect(),
            GroupMembers::Lines(parts) => parts.iter().map(|part| part_key(part)).collect(),
            GroupMembers::Tets(_) | GroupMembers::Nodes(_) => Vec::new(),
        };
        let owners = Owners::new(uncut, uncut.groups.iter().flat_map(parts));
        let mut followed = Vec::new();
        for (group, of_group) in (0..).zip(&uncut.groups) {
            match &of_group.members {
                GroupMembers::Triangles(parts) => add(uncut, &owners, group, parts, &mut followed),
                GroupMembers::Lines(parts) => add(uncut, &owners, group, parts, &mut followed),
                GroupMembers::Tets(_) | GroupMembers::Nodes(_) => {}
            }
        }
        followed.sort_by_key(|part| part.tet);
        Self {
            parts: followed,
            nodes: uncut.points.len(),
            last_tag: uncut.node_tags.iter().copied().max().unwrap_or(0),
        }
    }

    fn parts_of(&self, tet: u32) -> impl Iterator<Item = &FollowedPart> {
        let first = self.parts.partition_point(|part| part.tet < tet);
        let parts = self.parts[first..].iter();
        parts.take_while(move |part| part.tet == tet)
    }
}

/// Adds the parts of a group that belong to some tetrahedron.
fn add<const N: usize>(
    uncut: &TetMesh,
    owners: &Owners,
    group: u32,
    parts: &[[u32; N]],
    followed: &mut Vec<FollowedPart>,
) {
    let owned = parts.iter().filter_map(|part| {
        let tet = owners.of(part)?;
        let nodes = uncut.tets[tet as usize];
        let mut corners = [0; 3];
        for (corner, node) in corners.iter_mut().zip(part) {
            *corner = nodes.iter().position(|other| other == node)? as u8;
        }
        Some((tet, corners))
    });
    followed.extend((0..).zip(owned).map(|(part, (tet, corners))| FollowedPart {
        tet,
        group,
        part,
        corners,
    }));
}

impl CutMesh {
    /// Updates the mesh after a split: with the result of [`TetMesh::after_cuts`], at the cost of the changed parts
    /// only.
    pub fn follow_split(&mut self, split: &Split<'_>, follower: &SplitFollower) {
        self.mesh.follow_split(split, follower);
        for node in self.nodes.len()..split.body.points.len() {
            self.nodes.push(node as u32);
            self.origins.push(split.body.origins[node]);
        }
    }

    /// Reserves space for `nodes` further nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.mesh.reserve(nodes);
        self.nodes.reserve(nodes);
        self.origins.reserve(nodes);
    }
}

impl TetMesh {
    /// Updates this mesh after a split of its body, as [`CutMesh::follow_split`] does for a cut mesh.
    pub fn follow_split(&mut self, split: &Split<'_>, follower: &SplitFollower) {
        let body = split.body;
        for moved in split.moved {
            if let Some(point) = self.points.get_mut(moved.node as usize) {
                *point = body.points[moved.node as usize];
            }
        }
        for node in self.points.len()..body.points.len() {
            self.points.push(body.points[node]);
            let copies = (node - follower.nodes) as u64;
            self.node_tags.push(follower.last_tag + 1 + copies);
            for data in &mut self.node_data {
                data.copy(body.origins[node] as usize);
            }
            for group in &mut self.groups {
                if let GroupMembers::Nodes(nodes) = &mut group.members
                    && nodes.binary_search(&body.origins[node]).is_ok()
                {
                    nodes.push(node as u32);
                }
            }
        }
        for tet in split.tets {
            let nodes = body.tets[*tet as usize];
            self.tets[*tet as usize] = nodes;
            for part in follower.parts_of(*tet) {
                let now = |corner: u8| nodes[usize::from(corner)];
                let (place, corners) = (part.part as usize, part.corners);
                match &mut self.groups[part.group as usize].members {
                    GroupMembers::Triangles(parts) => parts[place] = corners.map(now),
                    GroupMembers::Lines(parts) => parts[place] = [now(corners[0]), now(corners[1])],
                    GroupMembers::Tets(_) | GroupMembers::Nodes(_) => {}
                }
            }
        }
    }

    /// The first tetrahedron that has each of some triangles; `None` if one has none.
    #[must_use]
    pub fn first_tets_of(&self, triangles: &[[u32; 3]]) -> Option<Vec<u32>> {
        let owners = Owners::new(self, triangles.iter().map(|part| part_key(part)));
        let first = triangles.iter().map(|part| owners.of(part));
        first.collect()
    }

    /// Reserves space for `nodes` further nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.points.reserve(nodes);
        self.node_tags.reserve(nodes);
        for data in &mut self.node_data {
            data.values.reserve(nodes * data.components);
        }
        for group in &mut self.groups {
            if let GroupMembers::Nodes(members) = &mut group.members {
                members.reserve(nodes);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cut::tests::split;
    use super::*;

    #[test]
    fn a_mesh_that_follows_a_split_is_the_one_after_the_cut() {
        let (mesh, expected) = split();
        let whole = CutBody {
            points: &mesh.points,
            origins: &[0, 1, 2, 3, 4],
            tets: &mesh.tets,
            is_removed: &[false; 2],
        };
        let mut cut = mesh.after_cuts(whole);
        let moved = MovedNode {
            node: 4,
            nodes: [1, 2, 3, 4],
            shares: [0.0, 0.0, 0.0, 1.0],
        };
        let mut points = expected.mesh.points.clone();
        points[4] = [1.5; 3];
        let body = CutBody {
            points: &points,
            origins: &expected.origins,
            tets: &expected.mesh.tets,
            is_removed: &[false; 2],
        };
        let follower = SplitFollower::new(&mesh);
        let followed = Split {
            body,
            moved: &[moved],
            tets: &[1],
        };
        cut.follow_split(&followed, &follower);
        let anew = mesh.after_cuts(body);
        assert_eq!(cut.mesh, anew.mesh);
        assert_eq!((cut.nodes, cut.origins), (anew.nodes, anew.origins));
        assert_ne!(cut.mesh, expected.mesh, "a node was moved");
    }
}
