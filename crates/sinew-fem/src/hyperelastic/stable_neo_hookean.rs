//! The stable neo-Hookean law.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point, block_of};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// `psi = mu/2 (I1 - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2`.
///
/// Smith, de Goes and Kim, Stable neo-Hookean flesh simulation, ACM Transactions on Graphics 37(2), 2018, in the form
/// without a logarithm of Kim and Eberle, Dynamic Deformables (SIGGRAPH courses, 2022). Its volumetric modulus is
/// `lambda + mu`, so that moduli at small strain are the true ones; with lambda alone Poisson's ratio would be 0 when
/// 1/4 is requested.
///
/// For elements that may invert: the law is finite and pushes them back. Between stretches of .5 and 2 it is within .2
/// % of [`super::NeoHookean`]. Not for elements that may be crushed to a point, which is a shallow local minimum of the
/// energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableNeoHookean {
    lambda: f64,
    mu: f64,
}

impl HyperelasticLaw for StableNeoHookean {
    const ID: &'static str = "stable-neo-hookean";
    const MEANING: &'static str = "also has a meaning where tetrahedra turn inside out";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const DEFINED_WHEN_INVERTED: bool = true;
    const STIFFENS_GENTLY: bool = true;
    const IS_COMMON: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    type Own<N: Number> = ();

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame();
        Ok(Self { lambda, mu })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, _deformation: &Deformation<N>) {}

    /// `mu/2 (I1 - 3) - mu (J - 1) + mu/2 (J - 1)^2`.
    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, ()>) -> N {
        let volume = at.volume_change;
        let half = volume.mul_add(volume, at.first_invariant_change()) * N::of(0.5);
        N::of(self.mu) * (half - volume)
    }

    /// `mu (F - c + (J - 1) c)`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, ()>) -> Tensor<N> {
        let strained = at.distortion.plus(at.volume_change, at.cofactor);
        strained.scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, ()>, change: Tensor<N>) -> Tensor<N> {
        let changed = change
            .plus(at.volume_change - N::of(1.0), at.cofactor_change(change))
            .plus(at.cofactor.contracted(change), at.cofactor);
        changed.scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, ()>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let mu = N::of(self.mu);
        block_of(at, gradient, mu, mu + bulk.modulus)
    }
}
