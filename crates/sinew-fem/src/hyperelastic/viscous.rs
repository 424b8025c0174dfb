//! The viscosity of a law, which the factor of stiffness damping multiplies.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::{Tensor, dot};

/// A law whose tangent is the viscosity of stiffness damping, and whose stress is 0, so that loops over tangents make products, matrices and own
/// blocks of damping too.
///
/// Its second Piola-Kirchhoff stress is that of the elasticity at rest for the rate of Green's strain E, with the law's
/// own dilation theta: `S = 2 mu E' + lambda theta' d theta/dE`, that is `P = 2 mu F sym(F'dF) + lambda (d theta/dF :
/// dF) d theta/dF` for a rate dF of F. It is objective, since E and theta are; `S : E' = 2 mu E':E' + lambda theta'^2`
/// is never below 0, in any state; at rest it is the tangent of the law.
///
/// The law given names the dilation; laws with the same one have the same viscosity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viscous<L> {
    dilation: L,
    /// Lame's constants (Pa).
    lambda: f64,
    mu: f64,
}

impl Viscous<OfVolume> {
    /// The viscosity of laws whose dilation is `J - 1`, from their constants (lambda, mu) (Pa).
    pub(crate) fn of_volume(lame: (f64, f64)) -> Self {
        Self::new(OfVolume, lame)
    }
}

impl<L> Viscous<L> {
    pub(crate) fn new(dilation: L, (lambda, mu): (f64, f64)) -> Self {
        Self {
            dilation,
            lambda,
            mu,
        }
    }
}

impl<L: HyperelasticLaw> HyperelasticLaw for Viscous<L> {
    const ID: &'static str = L::ID;
    const MEANING: &'static str = L::MEANING;
    const PARAMETERS: &'static [LawParameter] = L::PARAMETERS;
    const OWN_DILATION: bool = L::OWN_DILATION;
    const DEFINED_WHEN_INVERTED: bool = L::DEFINED_WHEN_INVERTED;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    type Own<N: Number> = L::Own<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let law = L::from_values(values)?;
        Ok(Self::new(law, law.lame()))
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Self::Own<N> {
        self.dilation.own(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, _at: &Point<N, Self::Own<N>>) -> N {
        N::of(0.0)
    }

    #[inline(always)]
    fn stress<N: Number>(&self, _at: &Point<N, Self::Own<N>>) -> Tensor<N> {
        Tensor::zero()
    }

    /// `2 mu F sym(F'dF)`.
    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Self::Own<N>>, change: Tensor<N>) -> Tensor<N> {
        let one_side = at.gradient.transposed_times(change);
        let strain = one_side + one_side.transposed();
        (at.gradient * strain).scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn dilation<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> N {
        self.dilation.dilation(at)
    }

    #[inline(always)]
    fn dilation_gradient<N: Number>(&self, at: &Point<N, Self::Own<N>>) -> Tensor<N> {
        self.dilation.dilation_gradient(at)
    }

    /// 0: the rate of the dilation acts along its gradient alone.
    #[inline(always)]
    fn dilation_tangent<N: Number>(&self, _at: &Point<N, Self::Own<N>>, _: Tensor<N>) -> Tensor<N> {
        Tensor::zero()
    }

    #[inline(always)]
    fn tangent_with<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        bulk: Bulk<N>,
        change: Tensor<N>,
    ) -> Tensor<N> {
        let gradient = self.dilation_gradient(at);
        let local = self.tangent(at, change);
        local.plus(bulk.modulus * gradient.contracted(change), gradient)
    }

    /// `mu (|g|^2 F F' + F g (F g)') + modulus c g (c g)'`, c being the gradient of the dilation.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Self::Own<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let mu = N::of(self.mu);
        let along = at.gradient.on(gradient);
        let normal = self.dilation_gradient(at).on(gradient);
        let squared = at.gradient.times_transposed(at.gradient);
        Tensor::outer(along, along)
            .plus(dot(gradient, gradient), squared)
            .scaled(mu)
            .plus(bulk.modulus, Tensor::outer(normal, normal))
    }
}

/// The dilation `J - 1` alone, without energy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OfVolume;

impl HyperelasticLaw for OfVolume {
    const ID: &'static str = "of volume";
    const MEANING: &'static str = "has no energy";
    const PARAMETERS: &'static [LawParameter] = &[];
    const DEFINED_WHEN_INVERTED: bool = true;

    type Own<N: Number> = ();

    fn from_values(_: &LawValues<'_>) -> Result<Self, ParameterError> {
        Ok(Self)
    }

    fn lame(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    #[inline(always)]
    fn own<N: Number>(&self, _: &Deformation<N>) {}

    #[inline(always)]
    fn energy<N: Number>(&self, _: &Point<N, ()>) -> N {
        N::of(0.0)
    }

    #[inline(always)]
    fn stress<N: Number>(&self, _: &Point<N, ()>) -> Tensor<N> {
        Tensor::zero()
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, _: &Point<N, ()>, _: Tensor<N>) -> Tensor<N> {
        Tensor::zero()
    }
}
