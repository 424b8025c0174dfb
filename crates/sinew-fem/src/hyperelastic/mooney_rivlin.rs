//! The law of Mooney and Rivlin.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, Point, block_of};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::second_invariant;
use super::tensor::Tensor;
use super::{first_invariant, volume};

/// `psi = C1 (J^-2/3 I1 - 3) + C2 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2` with `mu = 2 (C1 + C2)` and `kappa = lambda + 2/3 mu`.
///
/// Mooney (Journal of Applied Physics 11, 1940) and Rivlin (Philosophical Transactions of the Royal Society A 241, 1948), the invariants
/// without change of volume after Flory (Transactions of the Faraday Society 57, 1961).
///
/// For rubber-like material whose curve of a tension test bends more than the neo-Hookean one: gels and phantoms. Not
/// for elements that may invert: refused at J <= 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    lambda: f64,
    c1: f64,
    c2: f64,
}

impl MooneyRivlin {
    /// The law from its own constants (Pa); C2 may be 0.
    pub(super) fn of(lambda: f64, c1: f64, c2: f64) -> Self {
        Self { lambda, c1, c2 }
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(4.0 / 3.0 * (self.c1 + self.c2))
    }
}

/// C1/C2.
const C1_OVER_C2: LawParameter = LawParameter::number(
    "c1_over_c2",
    "C1/C2",
    "The ratio of Mooney and Rivlin's two shear constants, which the moduli leave open.",
    Range::above_zero("a finite ratio above 0"),
    &[4.0],
);

impl HyperelasticLaw for MooneyRivlin {
    const ID: &'static str = "mooney-rivlin";
    const MEANING: &'static str = "fits rubber-like tissue better in shear";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[LawParameter::YOUNGS_MODULUS, ratio, bulk, C1_OVER_C2]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const STIFFENS_GENTLY: bool = true;
    const HAS_ISOCHORIC_PART: bool = true;

    type Own<N: Number> = Isochoric<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame_by_volume()?;
        let ratio = values.number(&C1_OVER_C2);
        let c2 = 0.5 * mu / (1.0 + ratio);
        Ok(Self::of(lambda, ratio * c2, c2))
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, 2.0 * (self.c1 + self.c2))
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Isochoric<N> {
        Isochoric::at(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> N {
        let own = &at.own;
        let (three, volume) = (N::of(3.0), at.volume_change);
        // `J^-2/3 - 1` without a difference of large numbers.
        let shrink = (N::of(-2.0 / 3.0) * volume.ln_1p()).exp_m1();
        let first = own.scale.mul_add(own.first, three * shrink);
        let squared = shrink * (shrink + N::of(2.0));
        let second = (own.scale * own.scale).mul_add(own.second, three * squared);
        let bulk = N::of(2.0 / 3.0 * (self.c1 + self.c2));
        (bulk * volume).mul_add(
            volume,
            N::of(self.c1).mul_add(first, N::of(self.c2) * second),
        )
    }

    /// `2 C1 J^-2/3 (F - I1/(3J) c) + 2 C2 J^-4/3 (B - 2 I2/(3J) c) + 2/3 mu (J - 1) c`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> Tensor<N> {
        let own = &at.own;
        let a1 = N::of(2.0 * self.c1) * own.scale;
        let first = first_invariant::half_gradient(at, own).scaled(a1);
        let stress = volume::stress(at, self.of_volume(), first);
        if self.c2 == 0.0 {
            return stress;
        }
        let a2 = N::of(2.0 * self.c2) * own.scale * own.scale;
        second_invariant::stress_with(stress, at, own, a2)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Isochoric<N>>, change: Tensor<N>) -> Tensor<N> {
        let own = &at.own;
        let a1 = N::of(2.0 * self.c1) * own.scale;
        let first = first_invariant::changed_half_gradient(at, own, change).scaled(a1);
        let tangent = volume::tangent(at, self.of_volume(), first, change);
        if self.c2 == 0.0 {
            return tangent;
        }
        let a2 = N::of(2.0 * self.c2) * own.scale * own.scale;
        tangent.plus(a2, second_invariant::tangent(at, own, change))
    }

    /// The exact block, but with the coefficient 16/9 in place of 14/9 in the contribution of I2 along c g
    /// (the shared part of laws in I2). The part of I1 is rank-one convex.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Isochoric<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let own = &at.own;
        let (f, c) = (at.gradient, at.cofactor);
        let a1 = N::of(2.0 * self.c1) * own.scale;
        let squared = own.over * own.over;
        let of_volume = self.of_volume::<N>() + bulk.modulus;
        let first = a1 * N::of(5.0 / 9.0) * own.i1() * squared;
        let (along, normal) = (f.on(gradient), c.on(gradient));
        let mixed = Tensor::outer(along, normal).symmetric();
        let block = block_of(at, gradient, a1, first + of_volume)
            .plus(N::of(-4.0 / 3.0) * a1 * own.over, mixed);
        if self.c2 == 0.0 {
            return block;
        }
        let a2 = N::of(2.0 * self.c2) * own.scale * own.scale;
        second_invariant::block_with(block, at, own, (a2, second_invariant::SQUARE), gradient)
    }
}
