//! The neo-Hookean law with a logarithm of the volume.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, Point, block_of};
use super::neo_hookean::NeoHookean;
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// `psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2` (Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2008, section 6.4.3).
///
/// For comparison with textbooks and programs that have this form. Not polyconvex: beyond J = e it becomes weaker as it
/// expands. Otherwise the same as [`NeoHookean`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeoHookeanLog {
    base: NeoHookean,
}

impl HyperelasticLaw for NeoHookeanLog {
    const ID: &'static str = "neo-hookean-log";
    const MEANING: &'static str = "is there for comparison with other programs";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const OWN_DILATION: bool = true;
    const DEFINED_WHEN_INVERTED: bool = false;
    const STIFFENS_GENTLY: bool = true;

    /// 1/J.
    type Own<N: Number> = N;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let base = NeoHookean::from_values(values)?;
        Ok(Self { base })
    }

    fn lame(&self) -> (f64, f64) {
        self.base.lame()
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> N {
        self.base.own(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, N>) -> N {
        self.base.energy(at)
    }

    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, N>) -> Tensor<N> {
        self.base.stress(at)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, N>, change: Tensor<N>) -> Tensor<N> {
        self.base.tangent(at, change)
    }

    /// `ln J`.
    #[inline(always)]
    fn dilation<N: Number>(&self, at: &Point<N, N>) -> N {
        at.volume_change.ln_1p()
    }

    #[inline(always)]
    fn dilation_gradient<N: Number>(&self, at: &Point<N, N>) -> Tensor<N> {
        at.cofactor.scaled(at.own)
    }

    #[inline(always)]
    fn dilation_tangent<N: Number>(&self, at: &Point<N, N>, change: Tensor<N>) -> Tensor<N> {
        let gradient = self.dilation_gradient(at);
        let volume = gradient.contracted(change);
        at.cofactor_change(change)
            .scaled(at.own)
            .plus(-volume, gradient)
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, N>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let mu = N::of(self.lame().1);
        // Below 0 far beyond J = e.
        let b = (mu + bulk.modulus - bulk.stress).max(N::of(0.0));
        block_of(at, gradient, mu, b * at.own * at.own)
    }
}
