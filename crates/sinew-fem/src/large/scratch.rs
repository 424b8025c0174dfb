//! Room for evaluations.

use super::region::HyperelasticRegion;
use crate::hyperelastic::Tensor;

/// Room for one evaluation, used again by the next.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// Displacement (m) of all mesh nodes.
    pub(crate) displacement: Vec<[f64; 3]>,
    /// Its change, for products.
    pub(crate) change: Vec<[f64; 3]>,
    /// Forces (N) at the four corners of each tetrahedron.
    pub(super) corners: Vec<[f64; 12]>,
    /// Gradient of the displacement in each tetrahedron of a region, where means are taken.
    pub(super) gradients: Vec<Tensor<f64>>,
    /// Gradient of its change.
    pub(super) changes: Vec<Tensor<f64>>,
    /// Stress (Pa), or its change, at each edge.
    pub(super) at_edges: Vec<Tensor<f64>>,
    /// Mean dilation of each patch, and its change.
    pub(super) dilations: Vec<[f64; 2]>,
}

impl Scratch {
    pub(super) fn new(nodes: usize, tets: usize, regions: &[HyperelasticRegion]) -> Self {
        let most = |count: fn(&HyperelasticRegion) -> usize| {
            let smoothed = regions.iter().filter(|region| region.is_smoothed());
            smoothed.map(count).max().unwrap_or(0)
        };
        let smoothed = most(|region| region.rest.count());
        Self {
            displacement: vec![[0.0; 3]; nodes],
            change: vec![[0.0; 3]; nodes],
            corners: vec![[0.0; 12]; tets],
            gradients: vec![Tensor::zero(); smoothed],
            changes: vec![Tensor::zero(); smoothed],
            at_edges: vec![Tensor::zero(); most(|region| region.edges.count())],
            dilations: vec![[0.0; 2]; most(|region| region.patches.count())],
        }
    }
}
