//! The law of Veronda and Westmann.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::first_invariant::{self, Slopes};
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::powers::{exp_m1, largest_lawful_exponent};
use super::second_invariant;
use super::semidefinite::surely_semidefinite;
use super::tensor::Tensor;
use super::volume;

/// `psi = c1 (exp(c2 i) - 1) - c1 c2/2 (J^-4/3 I2 - 3) + kappa/2 (J - 1)^2` with `i = J^-2/3 I1 - 3`, `mu = c1 c2` and
/// `kappa = lambda + 2/3 mu`.
///
/// Veronda and Westmann (Journal of Biomechanics 3, 1970), for the skin of a cat; the invariants without change of
/// volume after Flory (Transactions of the Faraday Society 57, 1961).
///
/// For skin, breast and other soft tissue whose stress grows exponentially with stretch. Not for small motions only, in
/// which its part in I2 takes away half of the shear modulus of the other part, and not for elements that may invert:
/// refused at J <= 0, and if the exponential comes near the largest floating-point number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerondaWestmann {
    lambda: f64,
    c1: f64,
    c2: f64,
}

const C1: LawParameter = LawParameter::number(
    "c1",
    "c1",
    "The modulus c1 before the exponential. The shear modulus at small strain is c1 c2.",
    Range::above_zero("a finite modulus above 0 Pa"),
    &[2400.0],
)
.unit("Pa");

const C2: LawParameter = LawParameter::number(
    "c2",
    "c2",
    "The factor c2 of I1 - 3 in the exponent, I1 being the first invariant without change of volume.",
    Range::above_zero("a finite number above 0"),
    &[0.5],
);

/// Values cached per deformation gradient.
#[derive(Clone, Copy, Debug)]
pub struct Grown<N> {
    invariants: Isochoric<N>,
    /// `c2 i`.
    exponent: N,
    /// `exp(c2 i) - 1`.
    grown: N,
}

impl VerondaWestmann {
    /// `c1 c2` (Pa).
    #[inline(always)]
    fn shear(&self) -> f64 {
        self.c1 * self.c2
    }

    #[inline(always)]
    fn slopes<N: Number>(&self, own: &Grown<N>) -> Slopes<N> {
        let slope = own.grown.mul_add(N::of(self.shear()), N::of(self.shear()));
        [slope, slope * N::of(self.c2)]
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(2.0 / 3.0 * self.shear())
    }

    /// `2 C2 J^-4/3` (Pa), C2 being the coefficient of I2.
    #[inline(always)]
    fn of_second<N: Number>(&self, own: &Isochoric<N>) -> N {
        N::of(-self.shear()) * own.scale * own.scale
    }
}

impl HyperelasticLaw for VerondaWestmann {
    const ID: &'static str = "veronda-westmann";
    const MEANING: &'static str = "stiffens exponentially, as skin does";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[C1, C2, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Majorant;

    type Own<N: Number> = Grown<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (c1, c2) = (values.number(&C1), values.number(&C2));
        let lambda = values.lambda(c1 * c2)?;
        Ok(Self { lambda, c1, c2 })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.shear())
    }

    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        Some(
            "ends where exp(c2 (I1 - 3)) is beyond numbers to compute with, and the tetrahedron is there",
        )
    }

    #[inline(always)]
    fn margin<N: Number>(&self, at: &Point<N, Grown<N>>) -> N {
        N::of(largest_lawful_exponent::<N>()) - at.own.exponent
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Grown<N> {
        let invariants = Isochoric::at(deformation);
        let exponent = N::of(self.c2) * first_invariant::beyond(&invariants);
        Grown {
            invariants,
            exponent,
            grown: exp_m1(exponent),
        }
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Grown<N>>) -> N {
        let (own, three) = (&at.own.invariants, N::of(3.0));
        let shrink = (N::of(-2.0 / 3.0) * at.volume_change.ln_1p()).exp_m1();
        let first = own.scale.mul_add(own.first, three * shrink);
        let squared = shrink * (shrink + N::of(2.0));
        let second = (own.scale * own.scale).mul_add(own.second, three * squared);
        let local = N::of(self.c1) * exp_m1(N::of(self.c2) * first);
        let local = N::of(-0.5 * self.shear()).mul_add(second, local);
        volume::energy(at, self.of_volume(), local)
    }

    /// `2 c1 c2 exp(c2 i) J^-2/3 (F - I1/(3J) c) - c1 c2 J^-4/3 (B - 2 I2/(3J) c) + 2/3 mu (J - 1) c`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Grown<N>>) -> Tensor<N> {
        let own = &at.own.invariants;
        let [slope, _] = self.slopes(&at.own);
        let first = first_invariant::stress(at, own, slope);
        let stress = volume::stress(at, self.of_volume(), first);
        second_invariant::stress_with(stress, at, own, self.of_second(own))
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Grown<N>>, change: Tensor<N>) -> Tensor<N> {
        let own = &at.own.invariants;
        let second = second_invariant::tangent(at, own, change);
        let local = first_invariant::tangent(at, own, self.slopes(&at.own), change)
            .plus(self.of_second(own), second);
        volume::tangent(at, self.of_volume(), local, change)
    }

    /// The exact block of the local energy with its negative eigenvalues set to 0, and that of the dilation: the part
    /// in I2 has a negative coefficient, and at rest takes half of the other's shear modulus.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Grown<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let own = &at.own.invariants;
        let (slopes, of_volume) = (self.slopes(&at.own), self.of_volume::<N>());
        let first = first_invariant::node_block(at, own, slopes, of_volume, gradient);
        let second = (self.of_second(own), second_invariant::EXACT);
        let local = second_invariant::block_with(first, at, own, second, gradient);
        let normal = at.cofactor.on(gradient);
        surely_semidefinite(local).plus(bulk.modulus, Tensor::outer(normal, normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{Parameters, conformance};

    fn of(c1: f64, c2: f64, nu: f64) -> VerondaWestmann {
        let parameters = Parameters::default()
            .with("c1", &[c1])
            .with("c2", &[c2])
            .with("poissons_ratio", &[nu]);
        VerondaWestmann::new(&parameters).unwrap()
    }

    #[test]
    fn the_suite_holds_for_exponents_small_and_large() {
        for c2 in [0.05, 0.3, 1.0] {
            conformance::check(of(1200.0 / c2, c2, 0.45));
        }
    }

    /// Simple shear by g keeps the volume and has `I1 - 3 = I2 - 3 = g^2`.
    #[test]
    fn simple_shear_has_its_closed_form() {
        let (c1, c2) = (400.0, 3.0);
        let law = of(c1, c2, 0.49);
        for g in [0.1, 0.5, 1.0, 2.0_f64] {
            let at = law.at(Tensor([[0.0, g, 0.0], [0.0; 3], [0.0; 3]]));
            let stress = law.stress_with(&at, law.own_bulk(&at));
            let cauchy = stress.times_transposed(at.gradient).0[0][1];
            let expected = c1 * c2 * g * (2.0 * (c2 * g * g).exp() - 1.0);
            assert!(
                (cauchy / expected - 1.0).abs() < 1e-13,
                "{g}: {cauchy}, {expected}"
            );
        }
    }

    #[test]
    fn an_exponential_without_end_is_refused_and_sooner_in_single_precision() {
        let law = of(400.0, 3.0, 0.45);
        // I1 - 3 = g^2.
        let sheared = |g: f64| Tensor([[0.0, g, 0.0], [0.0; 3], [0.0; 3]]);
        for (g, in_double, in_single) in [
            (3.5, true, true),
            (5.0, true, false),
            (7.6, true, false),
            (7.7, false, false),
            (1e6, false, false),
        ] {
            assert_eq!(law.admits(&law.at(sheared(g))), in_double, "{g}");
            let single = law.at(Tensor::<f32>::of(sheared(g).0));
            assert_eq!(law.admits(&single), in_single, "{g} in f32");
        }
    }
}
