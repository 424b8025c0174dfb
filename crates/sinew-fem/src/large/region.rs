//! A region of hyperelastic tetrahedra.

use sinew_mesh::TetMesh;

use super::rest::Rest;
use crate::hyperelastic::{Hyperelastic, Tensor};
use crate::smoothing::{Sets, Smoothing};

/// A region of hyperelastic tetrahedra, numbered by itself.
#[derive(Clone, Debug)]
pub(crate) struct HyperelasticRegion {
    pub(super) law: Hyperelastic,
    pub(super) rest: Rest,
    /// Place of its first tetrahedron among those of all such regions.
    pub(super) first: usize,
    /// Share of the local energy that is averaged over edges.
    pub(super) edge_share: f64,
    /// The tetrahedra at each edge; none where `edge_share` is 0.
    pub(super) edges: Sets,
    /// The six edges of each tetrahedron.
    pub(super) edges_of: Vec<[u32; 6]>,
    /// The tetrahedra of each patch; none where the dilation of each tetrahedron is its own.
    pub(super) patches: Sets,
    /// The patch of each tetrahedron.
    pub(super) patch_of: Vec<u32>,
}

impl HyperelasticRegion {
    /// The region of some tetrahedra, whose sets are among those of the body.
    pub(super) fn new(
        mesh: &TetMesh,
        smoothing: &Smoothing,
        (law, edge_share): (Hyperelastic, f64),
        members: &[u32],
        first: usize,
    ) -> Self {
        let mut edges_of: Vec<[u32; 6]> = Vec::new();
        let mut patch_of = Vec::new();
        for tet in members {
            edges_of.extend(smoothing.edges_of(*tet as usize));
            patch_of.extend(smoothing.patch_of(*tet as usize).map(|patch| patch as u32));
        }
        let edges = numbered_anew(edges_of.as_flattened_mut());
        let patches = numbered_anew(&mut patch_of);
        let of_edge = (0u32..).zip(&edges_of);
        let of_edge = of_edge.flat_map(|(tet, edges)| edges.iter().map(move |edge| (*edge, tet)));
        Self {
            law,
            rest: Rest::of(mesh, members),
            first,
            edge_share,
            edges: Sets::from_pairs(edges, of_edge),
            patches: Sets::from_pairs(patches, patch_of.iter().copied().zip(0..)),
            edges_of,
            patch_of,
        }
    }

    /// Whether tetrahedra take any mean with others.
    pub(super) fn is_smoothed(&self) -> bool {
        !self.patch_of.is_empty()
    }

    /// The mean over a set by volume.
    #[inline(always)]
    pub(super) fn mean<const K: usize>(
        &self,
        tets: &[u32],
        of: impl Fn(usize) -> [f64; K],
    ) -> [f64; K] {
        let (mut sum, mut volumes) = ([0.0; K], 0.0);
        for tet in tets {
            let volume = self.rest.volume(*tet as usize);
            for (sum, value) in sum.iter_mut().zip(of(*tet as usize)) {
                *sum += volume * value;
            }
            volumes += volume;
        }
        sum.map(|sum| sum / volumes)
    }

    /// The mean of tensors over a set by volume.
    #[inline(always)]
    pub(super) fn mean_tensor(
        &self,
        tets: &[u32],
        of: impl Fn(usize) -> Tensor<f64>,
    ) -> Tensor<f64> {
        let (mut sum, mut volumes) = (Tensor::zero(), 0.0);
        for tet in tets {
            let volume = self.rest.volume(*tet as usize);
            sum = sum.plus(volume, of(*tet as usize));
            volumes += volume;
        }
        sum.scaled(volumes.recip())
    }

    /// The volume (m^3) of some tetrahedra.
    pub(super) fn volume_of(&self, tets: &[u32]) -> f64 {
        tets.iter().map(|tet| self.rest.volume(*tet as usize)).sum()
    }
}

/// Replaces numbers by 0, 1, .. in the order in which they first appear; returns how many there are.
fn numbered_anew(numbers: &mut [u32]) -> usize {
    let mut known = std::collections::HashMap::new();
    for number in numbers {
        let next = known.len() as u32;
        *number = *known.entry(*number).or_insert(next);
    }
    known.len()
}
