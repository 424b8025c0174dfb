//! Connections between the tetrahedra of a mesh, real and apparent.

mod findings;
mod lying;
mod merge;
mod place;
mod places;
mod sets;
mod surfaces;

use std::collections::BTreeSet;

pub use findings::JointFinding;
pub use places::Places;

pub(crate) use sets::Sets;
pub(crate) use surfaces::Surfaces;

use crate::tet_mesh::TetMesh;
use crate::tet_mesh::faces::is_sound;
use lying::is_within;
use surfaces::{middle, parts};

/// Connections between the tetrahedra of a mesh, real and apparent. Parts share no node with each other.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Joints {
    /// Number of parts.
    pub parts: usize,
    /// Number of parts after joining touching parts.
    pub parts_apart: usize,
    /// Faces of a part that coincide with faces of another part node by node, without common nodes; each pair once,
    /// given by its middle.
    pub touching: Places,
    /// Faces of a part that touch a face of another part without matching it, given by their middles.
    pub touching_partly: Places,
    /// Number of nodes that [`crate::Mesh::merge_nodes`] would merge into others: nodes of touching faces, at the
    /// position of a node of another part.
    pub mergeable: usize,
    /// Faces within a part that lie on others with different corners, given by their middles: faces that are split
    /// along different diagonals, or have nodes of others inside.
    pub mismatched: Places,
    /// Hanging nodes: nodes inside a face or an edge of another face on which their face lies, without being its
    /// corners. They can move away from it.
    pub hanging: Places,
    /// Nodes that join blocks of tetrahedra without a common face: hinges.
    pub hinges: Places,
    /// Blocks that are connected by hinges only.
    pub hinged_blocks: usize,
    /// Faces with both tetrahedra on the same side, given by their middles: the mesh is tangled there.
    pub tangled: Places,
}

impl TetMesh {
    /// The part of each node, counted from 0 in the order of their lowest nodes, and the number of parts: tetrahedra
    /// that share a node belong to one part.
    #[must_use]
    pub fn part_of_nodes(&self) -> (Vec<u32>, usize) {
        let mut sets = parts(&self.points, &self.tets);
        let (mut parts, mut part_of) = (0, vec![0; self.points.len()]);
        for node in 0..self.points.len() {
            let lowest = sets.root(node as u32) as usize;
            if lowest == node {
                part_of[node] = parts;
                parts += 1;
            } else {
                part_of[node] = part_of[lowest];
            }
        }
        (part_of, parts as usize)
    }

    /// Finds the connections of tetrahedra and defects of them: parts that touch without common nodes, hinges, faces
    /// that do not match.
    ///
    /// The two faces of a cut, which lie on each other node by node within a part, do not count.
    ///
    /// ```
    /// use sinew_mesh::TetMesh;
    /// let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]];
    /// let mesh = TetMesh::new(points, vec![[0, 1, 2, 3], [0, 2, 4, 3]])?;
    /// let joints = mesh.joints();
    /// assert_eq!((joints.parts, joints.hinges.total), (1, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn joints(&self) -> Joints {
        Surfaces::of(&self.points, &self.tets).joints()
    }
}

impl Surfaces<'_> {
    pub(crate) fn joints(mut self) -> Joints {
        let contacts = self.contacts();
        let mut joints = Joints {
            tangled: std::mem::take(&mut self.tangled),
            mergeable: merge::merged_nodes(&mut self, &contacts).len(),
            ..Joints::default()
        };
        let sound = |tet: &&[u32; 4]| is_sound(tet, self.points.len());
        let roots = |parts: &mut Sets| {
            let of_tets = self.tets.iter().filter(sound).map(|tet| parts.root(tet[0]));
            of_tets.collect::<BTreeSet<u32>>().len()
        };
        joints.parts = roots(&mut self.parts);
        let mut joined = self.parts.clone();
        for pair in &contacts.matched {
            let [a, b] = pair.map(|face| self.part(face));
            if a != b {
                joints
                    .touching
                    .add(middle(self.points, self.boundary[pair[0]].0));
                joined.join(a, b);
            }
        }
        // Blocks whose faces lie on each other hang together by more than hinges.
        let mut held = self.blocks.clone();
        let (mut seen, mut hanging) = (usize::MAX, BTreeSet::new());
        for pair in &contacts.lying {
            let [face, other] = *pair;
            let [a, b] = pair.map(|face| self.part(face));
            self.add_hanging(face, other, &mut hanging);
            self.add_hanging(other, face, &mut hanging);
            held.join(self.boundary[face].1, self.boundary[other].1);
            joined.join(a, b);
            if seen != face {
                seen = face;
                let place = middle(self.points, self.boundary[face].0);
                match a == b {
                    true => joints.mismatched.add(place),
                    false => joints.touching_partly.add(place),
                }
            }
        }
        for node in hanging {
            joints.hanging.add(self.points[node as usize]);
        }
        joints.parts_apart = roots(&mut joined);
        self.find_hinges(held, &mut joints);
        joints
    }

    /// Adds nodes of a face that lie on another one, but not at one of its corners.
    fn add_hanging(&self, face: usize, other: usize, hanging: &mut BTreeSet<u32>) {
        let corners = self.corners(other);
        let places = self.boundary[other].0.map(|node| self.place(node));
        for node in self.boundary[face].0 {
            let is_corner = places.contains(&self.place(node));
            if !is_corner && is_within(self.points[node as usize], &corners) {
                hanging.insert(node);
            }
        }
    }

    /// Finds nodes of several blocks.
    fn find_hinges(&self, mut held: Sets, joints: &mut Joints) {
        let mut block_of: Vec<Option<u32>> = vec![None; self.points.len()];
        let mut is_hinge = vec![false; self.points.len()];
        let mut hinged = BTreeSet::new();
        for (tet, nodes) in (0u32..).zip(self.tets) {
            if !is_sound(nodes, self.points.len()) {
                continue;
            }
            let block = held.root(tet);
            for node in nodes.map(|node| node as usize) {
                let first = *block_of[node].get_or_insert(block);
                if first != block {
                    hinged.extend([first, block]);
                    is_hinge[node] = true;
                }
            }
        }
        joints.hinged_blocks = hinged.len();
        for (point, _) in self.points.iter().zip(is_hinge).filter(|(_, is)| *is) {
            joints.hinges.add(*point);
        }
    }
}
