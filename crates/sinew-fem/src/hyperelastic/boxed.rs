//! A law that is known at run time only.

use std::fmt::Debug;

use sinew_sparse::simd::Number;

use super::decomposition::MOST_LANES;
use super::deformation::Deformation;
use super::law::{HyperelasticLaw, Point};
use super::parameters::{LawParameter, LawValues, ParameterError};
use super::tensor::Tensor;

/// A hyperelastic law of an isotropic material without a type of its own, such as one that a script states.
///
/// Each method is called once for a tetrahedron: force loops on vectors take much longer than with a
/// [`HyperelasticLaw`], whose loops are compiled for its type. The energy is split as there, with the dilation `J - 1`.
/// Deformations with `J <= 0` are refused.
///
/// Arguments are gradients of the displacement: row i, column j is `du_i/dX_j`. Stresses are first Piola-Kirchhoff ones
/// (Pa).
pub trait PointLaw: Debug + Send + Sync {
    /// Name in messages.
    fn id(&self) -> &'static str;

    /// Lame's constants (lambda, mu) (Pa) at small strain.
    fn lame(&self) -> (f64, f64);

    /// The reason for which the law is not defined beyond its [`Self::margin`], as half a sentence after its name
    /// ([`HyperelasticLaw::limit`]); `None` for a law that ends only where elements invert.
    fn limit(&self) -> Option<&str> {
        None
    }

    /// A number above 0 if the law is defined, J aside ([`HyperelasticLaw::margin`]).
    fn margin(&self, _h: Tensor<f64>) -> f64 {
        1.0
    }

    /// The local energy density (J/m^3): all but `lambda/2 (J - 1)^2`.
    fn energy(&self, h: Tensor<f64>) -> f64;

    /// The local stress (Pa).
    fn stress(&self, h: Tensor<f64>) -> Tensor<f64>;

    /// The change of the local stress (Pa) by a change of F.
    fn tangent(&self, h: Tensor<f64>, change: Tensor<f64>) -> Tensor<f64>;
}

/// A [`PointLaw`] in the form that loops need.
#[derive(Clone, Copy, Debug)]
pub struct Boxed<'a>(pub &'a dyn PointLaw);

/// The tensor of a lane.
fn lane_of<N: Number>(tensor: Tensor<N>, lane: usize) -> Tensor<f64> {
    Tensor(tensor.0.map(|row| row.map(|entry| entry.lane(lane))))
}

/// A tensor from its lanes.
fn by_lanes<N: Number>(of: impl Fn(usize) -> Tensor<f64>) -> Tensor<N> {
    let mut lanes = [Tensor::<f64>::zero(); MOST_LANES];
    for (lane, tensor) in lanes.iter_mut().enumerate().take(N::LANES) {
        *tensor = of(lane);
    }
    let entry = |i: usize, j: usize| N::from_lanes(|lane| lanes[lane].0[i][j]);
    Tensor([0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))))
}

impl HyperelasticLaw for Boxed<'_> {
    const ID: &'static str = "boxed";
    const MEANING: &'static str = "is known at run time only";
    const PARAMETERS: &'static [LawParameter] = &[];
    const DEFINED_WHEN_INVERTED: bool = false;

    type Own<N: Number> = ();

    fn from_values(_: &LawValues<'_>) -> Result<Self, ParameterError> {
        Err(ParameterError::NotStated { law: Self::ID })
    }

    fn id(&self) -> &'static str {
        self.0.id()
    }

    fn lame(&self) -> (f64, f64) {
        self.0.lame()
    }

    fn limit(&self) -> Option<&str> {
        self.0.limit()
    }

    #[inline(never)]
    fn margin<N: Number>(&self, at: &Point<N, ()>) -> N {
        N::from_lanes(|lane| self.0.margin(lane_of(at.displacement_gradient, lane)))
    }

    fn own<N: Number>(&self, _: &Deformation<N>) {}

    #[inline(never)]
    fn energy<N: Number>(&self, at: &Point<N, ()>) -> N {
        N::from_lanes(|lane| self.0.energy(lane_of(at.displacement_gradient, lane)))
    }

    #[inline(never)]
    fn stress<N: Number>(&self, at: &Point<N, ()>) -> Tensor<N> {
        by_lanes(|lane| self.0.stress(lane_of(at.displacement_gradient, lane)))
    }

    #[inline(never)]
    fn tangent<N: Number>(&self, at: &Point<N, ()>, change: Tensor<N>) -> Tensor<N> {
        let h = at.displacement_gradient;
        by_lanes(|lane| self.0.tangent(lane_of(h, lane), lane_of(change, lane)))
    }
}
