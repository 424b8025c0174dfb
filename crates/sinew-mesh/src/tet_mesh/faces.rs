//! Faces of tetrahedra, each with all its tetrahedra.

use super::surface::OUTWARD_FACES;

/// A face as a part of one of its tetrahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Owner {
    /// The tetrahedron (0-based).
    pub(crate) tet: u32,
    /// Its node opposite the face (0..4).
    pub(crate) opposite: u8,
}

impl Owner {
    /// The face, counter-clockwise from outside if the tetrahedron has positive orientation.
    pub(crate) fn face(self, tets: &[[u32; 4]]) -> [u32; 3] {
        let nodes = tets[self.tet as usize];
        OUTWARD_FACES[usize::from(self.opposite)].map(|corner| nodes[corner])
    }
}

/// Calls a function for each face once, with its nodes in ascending order and its owners in ascending order. Tetrahedra
/// that name a node twice, or a node from `nodes` on, have no faces.
///
/// Faces are sorted by their smallest node by counting, which takes time in proportion to their number.
pub(crate) fn for_each_face(
    tets: &[[u32; 4]],
    nodes: usize,
    mut see: impl FnMut([u32; 3], &[Owner]),
) {
    let faces = || {
        let sound = (0u32..).zip(tets).filter(|(_, tet)| is_sound(tet, nodes));
        sound.flat_map(|(tet, _)| {
            [0, 1, 2, 3].map(|opposite| {
                let owner = Owner { tet, opposite };
                let mut face = owner.face(tets);
                face.sort_unstable();
                (face, owner)
            })
        })
    };
    // Three faces of a tetrahedron have its smallest node, the fourth begins with the next.
    let mut starts = vec![0usize; nodes + 1];
    for tet in tets.iter().filter(|tet| is_sound(tet, nodes)) {
        let mut tet = *tet;
        tet.sort_unstable();
        starts[tet[0] as usize + 1] += 3;
        starts[tet[1] as usize + 1] += 1;
    }
    for node in 0..nodes {
        starts[node + 1] += starts[node];
    }
    let mut next = starts.clone();
    let nothing = Owner {
        tet: 0,
        opposite: 0,
    };
    let mut sorted = vec![([0; 2], nothing); starts[nodes]];
    for ([least, middle, greatest], owner) in faces() {
        let at = &mut next[least as usize];
        sorted[*at] = ([middle, greatest], owner);
        *at += 1;
    }
    let mut owners = Vec::new();
    for (least, range) in (0u32..).zip(starts.windows(2)) {
        let of_node = &mut sorted[range[0]..range[1]];
        of_node.sort_by_key(|(others, _)| *others);
        for same in of_node.chunk_by(|a, b| a.0 == b.0) {
            let [middle, greatest] = same[0].0;
            owners.clear();
            owners.extend(same.iter().map(|(_, owner)| *owner));
            see([least, middle, greatest], &owners);
        }
    }
}

/// True if a tetrahedron has four different nodes, all of them below `nodes`.
pub(crate) fn is_sound(tet: &[u32; 4], nodes: usize) -> bool {
    let differ = (0..4).all(|i| (0..i).all(|j| tet[i] != tet[j]));
    differ && tet.iter().all(|node| (*node as usize) < nodes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structured::{Split, block};

    #[test]
    fn inner_faces_have_two_owners_and_the_boundary_is_that_of_the_mesh() {
        let mesh = block([3, 2, 2], [0.3, 0.2, 0.2], Split::Kuhn).expect("valid");
        let (mut inner, mut outer) = (0, Vec::new());
        for_each_face(&mesh.tets, mesh.points.len(), |face, owners| {
            assert!(face[0] < face[1] && face[1] < face[2]);
            match owners {
                [owner] => outer.push(owner.face(&mesh.tets)),
                [a, b] if a < b => inner += 1,
                _ => panic!("{face:?} {owners:?}"),
            }
        });
        assert_eq!(2 * inner + outer.len(), 4 * mesh.tets.len());
        let turned = |mut face: [u32; 3]| {
            let least = (0..3).min_by_key(|i| face[*i]).expect("three nodes");
            face.rotate_left(least);
            face
        };
        let mut expected: Vec<_> = mesh.boundary(None).into_iter().map(turned).collect();
        let mut outer: Vec<_> = outer.into_iter().map(turned).collect();
        expected.sort_unstable();
        outer.sort_unstable();
        assert_eq!(outer, expected);
    }

    #[test]
    fn what_is_no_tetrahedron_has_no_faces() {
        let tets = [[0, 1, 1, 2], [0, 1, 2, 9]];
        for_each_face(&tets, 4, |face, _| panic!("{face:?}"));
    }
}
