//! Sets of tetrahedra over which regions average strain.

mod average;
mod edges;
mod faces;
mod patches;
mod sets;
mod strain;

pub(crate) use average::Average;
pub(crate) use edges::{Edges, NO_EDGE};
pub(crate) use sets::Sets;
pub(crate) use strain::{MeanStrains, SmoothedStrain, scaled};

use sinew_mesh::TetMesh;

use crate::Element;
use patches::{NO_PATCH, patches};

/// The edges and patches of a body; empty if all regions are made of plain tetrahedra. None of them crosses a boundary
/// between regions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Smoothing {
    pub(crate) edges: Edges,
    /// The tetrahedra of each patch.
    pub(crate) patches: Sets,
    /// The patch of each tetrahedron; empty without patches.
    patch_of_tet: Vec<u32>,
}

impl Smoothing {
    /// The sets of a body whose tetrahedra are in the regions `region_of`, of these elements.
    pub(crate) fn new(mesh: &TetMesh, elements: &[Element], region_of: &[u32]) -> Self {
        if !elements.iter().any(|element| element.has_patches()) {
            return Self::default();
        }
        let by_edges = |region: u32| elements[region as usize].edge_share() > 0.0;
        let (patch_of_tet, count) = patches(&mesh.tets, region_of, elements);
        let members = (0..).zip(&patch_of_tet);
        let members = members.filter(|(_, patch)| **patch != NO_PATCH);
        Self {
            edges: Edges::new(&mesh.tets, region_of, by_edges),
            patches: Sets::from_pairs(count, members.map(|(tet, patch)| (*patch, tet))),
            patch_of_tet,
        }
    }

    /// True if there are no sets.
    pub(crate) fn is_empty(&self) -> bool {
        self.patch_of_tet.is_empty()
    }

    /// The tetrahedra of each edge and each patch, edges first.
    pub(crate) fn sets(&self) -> impl Iterator<Item = &[u32]> {
        let edges = (0..self.edges.tets.count()).map(|edge| self.edges.tets.of(edge));
        let patches = (0..self.patches.count()).map(|patch| self.patches.of(patch));
        edges.chain(patches)
    }

    /// The patch of a tetrahedron; `None` if its region has none.
    pub(crate) fn patch_of(&self, tet: usize) -> Option<usize> {
        let patch = *self.patch_of_tet.get(tet)?;
        (patch != NO_PATCH).then_some(patch as usize)
    }

    /// Number of patches that some tetrahedra, with all others of their region, are in.
    pub(crate) fn patches_among(&self, tets: &[u32]) -> usize {
        let begins = |tet: &&u32| {
            let patch = self.patch_of(**tet as usize);
            patch.is_some_and(|patch| self.patches.of(patch).first() == Some(*tet))
        };
        tets.iter().filter(begins).count()
    }

    /// The six edges of a tetrahedron; `None` if its region does not average over them.
    pub(crate) fn edges_of(&self, tet: usize) -> Option<&[u32; 6]> {
        let edges = self.edges.of_tet.get(tet)?;
        (edges[0] != NO_EDGE).then_some(edges)
    }
}

/// Writes the nodes of some tetrahedra, each once.
pub(crate) fn nodes_of(mesh: &TetMesh, tets: &[u32], out: &mut Vec<u32>) {
    out.clear();
    for tet in tets {
        for node in mesh.tets[*tet as usize] {
            if !out.contains(&node) {
                out.push(node);
            }
        }
    }
}
