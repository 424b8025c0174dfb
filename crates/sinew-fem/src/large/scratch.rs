//! Room for evaluations.

use super::region::HyperelasticRegion;
use crate::hyperelastic::Tensor;

/// Room for one evaluation, used again by the next.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// Displacement (m) of all mesh nodes, and a number to fill a row.
    pub(crate) displacement: Vec<[f64; 4]>,
    /// Its change, for products.
    pub(crate) change: Vec<[f64; 4]>,
    /// Forces (N) at the four corners of each tetrahedron, each with 0 to fill a row.
    pub(super) corners: Vec<[f64; 4]>,
    /// Their sums (N) at each mesh node that has corners.
    pub(super) sums: Vec<[f64; 4]>,
    /// What force loops keep.
    pub(super) kept: Kept,
    /// Gradient of the displacement in each tetrahedron of a region, where means are taken.
    pub(super) gradients: Vec<Tensor<f64>>,
    /// Gradient of its change.
    pub(super) changes: Vec<Tensor<f64>>,
    /// Stress (Pa), or its change, at each edge.
    pub(super) at_edges: Vec<Tensor<f64>>,
    /// Mean dilation of each patch, and its change.
    pub(super) dilations: Vec<[f64; 2]>,
}

/// What the force loops of regions that take means keep from one pass to the next.
#[derive(Debug)]
pub(super) struct Kept {
    /// The mean dilation of the patch of each tetrahedron.
    pub(super) dilations: Vec<f64>,
    /// The gradients of the displacement in the tetrahedra of a chunk, vector by vector.
    pub(super) chunk: Vec<f64>,
    /// The gradient of the displacement in each tetrahedron times its volume, by rows; where edges take means.
    pub(super) gradients: Vec<Rows>,
    /// The stress (Pa) at each edge by rows, and room to fill a vector.
    pub(super) at_edges: Vec<Rows>,
}

/// A tensor, whose rows end in 0.
pub(super) type Rows = [[f64; 4]; 3];

impl Kept {
    fn new(regions: &[HyperelasticRegion]) -> Self {
        let most = |count: fn(&HyperelasticRegion) -> usize| {
            let smoothed = regions.iter().filter(|region| region.is_smoothed());
            smoothed.map(count).max().unwrap_or(0)
        };
        let chunk = most(|region| {
            let sizes = region.chunks.iter().map(|chunk| chunk.slots.len());
            sizes.max().unwrap_or(0)
        });
        Self {
            dilations: vec![0.0; most(|region| region.rest.count())],
            chunk: vec![0.0; 9 * chunk],
            gradients: vec![[[0.0; 4]; 3]; most(|region| region.edges_of.len())],
            at_edges: vec![[[0.0; 4]; 3]; most(|region| region.edge_volumes.len())],
        }
    }
}

impl Scratch {
    pub(super) fn new(nodes: usize, tets: usize, regions: &[HyperelasticRegion]) -> Self {
        let most = |count: fn(&HyperelasticRegion) -> usize| {
            let smoothed = regions.iter().filter(|region| region.is_smoothed());
            smoothed.map(count).max().unwrap_or(0)
        };
        let smoothed = most(|region| region.rest.count());
        Self {
            displacement: vec![[0.0; 4]; nodes],
            change: vec![[0.0; 4]; nodes],
            corners: vec![[0.0; 4]; 4 * tets],
            sums: vec![[0.0; 4]; nodes],
            kept: Kept::new(regions),
            gradients: vec![Tensor::zero(); smoothed],
            changes: vec![Tensor::zero(); smoothed],
            at_edges: vec![Tensor::zero(); most(|region| region.edges.count())],
            dilations: vec![[0.0; 2]; most(|region| region.patches.count())],
        }
    }
}

/// Writes a field over all nodes.
pub(crate) fn fill(out: &mut [[f64; 4]], field: impl Fn(u32) -> [f64; 3]) {
    for (node, out) in (0..).zip(out) {
        let [x, y, z] = field(node);
        *out = [x, y, z, 0.0];
    }
}
