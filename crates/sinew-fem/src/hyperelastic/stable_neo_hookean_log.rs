//! The stable neo-Hookean law with a logarithm.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point, block_of};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// `psi = mu'/2 (I1 - 3) - mu'/2 ln((I1 + 1)/4) + lambda'/2 ((J - alpha)^2 - (1 - alpha)^2)` with `mu' = 4/3 mu`, `lambda' = lambda + 5/6 mu`,
/// `alpha = 1 + 3 mu'/(4 lambda')`.
///
/// Smith, de Goes and Kim, Stable neo-Hookean flesh simulation, ACM Transactions on Graphics 37(2), 2018; mu' and
/// lambda' follow their section 3.4, so that moduli at small strain are the true ones.
///
/// For comparison, and for elements that may be crushed to a point, from which the logarithm drives them away.
/// Otherwise use [`super::StableNeoHookean`], which is nearer to the neo-Hookean law: this one is 11 % stiffer at a
/// stretch of 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StableNeoHookeanLog {
    lambda: f64,
    mu: f64,
}

impl StableNeoHookeanLog {
    /// The modulus mu' in the formula of the law (Pa).
    #[inline(always)]
    fn remapped(&self) -> f64 {
        4.0 / 3.0 * self.mu
    }

    /// The part of `lambda' (J - 1)` not due to lambda (Pa).
    #[inline(always)]
    fn rest_of_lambda(&self) -> f64 {
        5.0 / 6.0 * self.mu
    }
}

impl HyperelasticLaw for StableNeoHookeanLog {
    const ID: &'static str = "stable-neo-hookean-log";
    const MEANING: &'static str = "is there for comparison with other programs";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const DEFINED_WHEN_INVERTED: bool = true;
    const STIFFENS_GENTLY: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    /// `1/(I1 + 1)`.
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
        (deformation.first_invariant_change() + N::of(4.0)).recip()
    }

    /// `mu'/2 (I1 - 3) - mu'/2 ln((I1 + 1)/4) - mu (J - 1) + 5/12 mu (J - 1)^2`.
    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, N>) -> N {
        let i1 = at.first_invariant_change();
        let shape = i1 - (i1 * N::of(0.25)).ln_1p();
        let volume = at.volume_change;
        let quadratic = N::of(0.5 * self.rest_of_lambda()) * volume - N::of(self.mu);
        N::of(0.5 * self.remapped()).mul_add(shape, quadratic * volume)
    }

    /// `mu' (1 - 1/(I1 + 1)) F - mu c + 5/6 mu (J - 1) c`, the first factor being `3/4 + (I1 - 3)/(4 (I1 + 1))`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, N>) -> Tensor<N> {
        let above = N::of(0.25 * self.remapped()) * at.first_invariant_change() * at.own;
        at.distortion
            .scaled(N::of(self.mu))
            .plus(above, at.gradient)
            .plus(N::of(self.rest_of_lambda()) * at.volume_change, at.cofactor)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, N>, change: Tensor<N>) -> Tensor<N> {
        let (one, mu, rest) = (N::of(1.0), N::of(self.mu), N::of(self.rest_of_lambda()));
        let remapped = N::of(self.remapped());
        let stretch = N::of(2.0) * remapped * at.own * at.own * at.gradient.contracted(change);
        let volume = rest * at.cofactor.contracted(change);
        change
            .scaled(remapped * (one - at.own))
            .plus(stretch, at.gradient)
            .plus(rest * at.volume_change - mu, at.cofactor_change(change))
            .plus(volume, at.cofactor)
    }

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, N>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let remapped = N::of(self.remapped());
        let a = remapped * (N::of(1.0) - at.own);
        let d = N::of(2.0) * remapped * at.own * at.own;
        let along = at.gradient.on(gradient);
        block_of(at, gradient, a, N::of(self.rest_of_lambda()) + bulk.modulus)
            .plus(d, Tensor::outer(along, along))
    }
}
