//! The law of Saint Venant and Kirchhoff.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, Point};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::{Tensor, dot};

/// `psi = mu E:E + lambda/2 (tr E)^2`, E being Green's strain `(F'F - I)/2`: linear elasticity that is independent of
/// rotations (Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2008, section 6.4.1).
///
/// For comparison with programs that have it. Compressed to less than .58 of its length, a bar becomes weaker and then
/// inverts without resistance: a mirrored body is at rest. In tension it is far too stiff.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stvk {
    lambda: f64,
    mu: f64,
}

impl HyperelasticLaw for Stvk {
    const ID: &'static str = "stvk";
    const MEANING: &'static str = "(Saint Venant and Kirchhoff) collapses under strong compression";
    const PARAMETERS: &'static [LawParameter] = LawParameter::MODULI;
    const WEAKNESS: Option<[&'static str; 2]> = Some([
        "compressed to less than 58 % of its length it loses its resistance and can invert",
        "model = \"neo-hookean\" resists the more the farther it is pressed",
    ]);
    const OWN_DILATION: bool = true;
    const DEFINED_WHEN_INVERTED: bool = true;
    const STIFFENS_GENTLY: bool = true;

    /// `2E`.
    type Own<N: Number> = Tensor<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame();
        Ok(Self { lambda, mu })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Tensor<N> {
        deformation.twice_green_strain()
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Tensor<N>>) -> N {
        N::of(0.25 * self.mu) * at.own.squared()
    }

    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Tensor<N>>) -> Tensor<N> {
        (at.gradient * at.own).scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Tensor<N>>, change: Tensor<N>) -> Tensor<N> {
        let one_side = at.gradient.transposed_times(change);
        let strain = one_side + one_side.transposed();
        (change * at.own + at.gradient * strain).scaled(N::of(self.mu))
    }

    /// `tr E`.
    #[inline(always)]
    fn dilation<N: Number>(&self, at: &Point<N, Tensor<N>>) -> N {
        N::of(0.5) * at.own.trace()
    }

    #[inline(always)]
    fn dilation_gradient<N: Number>(&self, at: &Point<N, Tensor<N>>) -> Tensor<N> {
        at.gradient
    }

    #[inline(always)]
    fn dilation_tangent<N: Number>(&self, _: &Point<N, Tensor<N>>, change: Tensor<N>) -> Tensor<N> {
        change
    }

    /// `(g.S g) I + mu (|g|^2 F F' + F g (F g)') + modulus F g (F g)'` without the negative part of the stress S.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Tensor<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let mu = N::of(self.mu);
        let length = dot(gradient, gradient);
        let pull = mu * dot(gradient, at.own.on(gradient));
        let pull = bulk.stress.mul_add(length, pull).max(N::of(0.0));
        let along = at.gradient.on(gradient);
        Tensor::diagonal(pull)
            .plus(mu * length, at.gradient.times_transposed(at.gradient))
            .plus(mu + bulk.modulus, Tensor::outer(along, along))
    }
}
