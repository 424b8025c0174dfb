//! The neo-Hookean law.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point, block_of, wave_moduli_of};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// `psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2`.
///
/// The first two terms are Simo and Pister's (Computer Methods in Applied Mechanics and Engineering 46, 1984), the third the simplest
/// volumetric energy (Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2008, chapter 6). Polyconvex; the stress needs no logarithm.
///
/// The first choice: soft tissue in compression, tension and large rotation. Not for elements that may invert, since it
/// is infinite at J = 0 and refused beyond, and not for tissue that stiffens, which needs fibres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookean {
    lambda: f64,
    mu: f64,
}

impl HyperelasticLaw for NeoHookean {
    const ID: &'static str = "neo-hookean";
    const MEANING: &'static str = "is the one to begin with";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const DEFINED_WHEN_INVERTED: bool = false;
    const STIFFENS_GENTLY: bool = true;
    const IS_COMMON: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    /// 1/J.
    type Own<N: Number> = N;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame();
        Ok(Self { lambda, mu })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> N {
        deformation.volume_ratio.recip()
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, N>) -> N {
        let half = N::of(0.5) * at.first_invariant_change();
        N::of(self.mu) * (half - at.volume_change.ln_1p())
    }

    /// `mu (F - c/J)`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, N>) -> Tensor<N> {
        let share = at.volume_change * at.own;
        at.distortion
            .plus(share, at.cofactor)
            .scaled(N::of(self.mu))
    }

    /// The sum of [`Self::stress`] and the stress of the dilation.
    #[inline(always)]
    fn stress_of<N: Number>(&self, at: &Point<N, N>, share: N, bulk: N) -> Tensor<N> {
        let mu = share * N::of(self.mu);
        let of_volume = (mu * at.volume_change).mul_add(at.own, bulk);
        at.distortion.scaled(mu).plus(of_volume, at.cofactor)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, N>, change: Tensor<N>) -> Tensor<N> {
        let over = at.own;
        let volume = at.cofactor.contracted(change);
        let changed = change
            .plus(-over, at.cofactor_change(change))
            .plus(over * over * volume, at.cofactor);
        changed.scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, N>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let mu = N::of(self.mu);
        let b = (mu * at.own).mul_add(at.own, bulk.modulus);
        block_of(at, gradient, mu, b)
    }

    #[inline(always)]
    fn wave_moduli<N: Number>(&self, at: &Point<N, N>, bulk: Bulk<N>) -> Tensor<N> {
        let mu = N::of(self.mu);
        let b = (mu * at.own).mul_add(at.own, bulk.modulus);
        wave_moduli_of(at, mu, b)
    }
}
