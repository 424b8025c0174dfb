//! The law of Yeoh.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::first_invariant::{self, Slopes};
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, Point};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::tensor::Tensor;
use super::volume;

/// `psi = c1 i + c2 i^2 + c3 i^3 + kappa/2 (J - 1)^2` with `i = J^-2/3 I1 - 3`, `mu = 2 c1` and
/// `kappa = lambda + 2/3 mu`.
///
/// Yeoh (Rubber Chemistry and Technology 66, 1993); the invariant without change of volume after Flory (Transactions of
/// the Faraday Society 57, 1961).
///
/// For isotropic tissue and rubber that stiffen with stretch; only c2 and c3 bend its curves of tension and shear. With
/// c2 or c3 below 0 it may soften, and a state beyond that need not be stable. Not for elements that may invert:
/// refused at J <= 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yeoh {
    lambda: f64,
    c: [f64; 3],
}

const C: LawParameter = LawParameter::number(
    "c",
    "c",
    "The constants c1, c2 and c3 of c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3, I1 being the first invariant without change of volume; those left \
     out are 0. The shear modulus at small strain is 2 c1.",
    Range::finite("a finite modulus in Pa, the first above 0"),
    &[600.0, 60.0, 20.0],
)
.unit("Pa")
.list(1, 3);

impl Yeoh {
    /// First and second derivative of `c1 i + c2 i^2 + c3 i^3` by i.
    #[inline(always)]
    fn slopes<N: Number>(&self, own: &Isochoric<N>) -> Slopes<N> {
        let beyond = first_invariant::beyond(own);
        let [c1, c2, c3] = self.c;
        let second = N::of(6.0 * c3).mul_add(beyond, N::of(2.0 * c2));
        let half = N::of(3.0 * c3).mul_add(beyond, N::of(2.0 * c2));
        [half.mul_add(beyond, N::of(c1)), second]
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(4.0 / 3.0 * self.c[0])
    }
}

impl HyperelasticLaw for Yeoh {
    const ID: &'static str = "yeoh";
    const MEANING: &'static str = "stiffens with stretch, by constants that papers give";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[C, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;

    type Own<N: Number> = Isochoric<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let mut c = [0.0; 3];
        for (own, given) in c.iter_mut().zip(values.numbers(&C)) {
            *own = *given;
        }
        if c[0] <= 0.0 {
            return Err(C.refused(c[0], "c1 above 0 Pa"));
        }
        let lambda = values.lambda(2.0 * c[0])?;
        Ok(Self { lambda, c })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, 2.0 * self.c[0])
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Isochoric<N> {
        Isochoric::at(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> N {
        let beyond = first_invariant::exactly_beyond(at);
        let [c1, c2, c3] = self.c;
        let (c1, c2, c3) = (N::of(c1), N::of(c2), N::of(c3));
        let local = c3.mul_add(beyond, c2).mul_add(beyond, c1) * beyond;
        volume::energy(at, self.of_volume(), local)
    }

    /// `2 psi' J^-2/3 (F - I1/(3J) c) + 2/3 mu (J - 1) c`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> Tensor<N> {
        let [slope, _] = self.slopes(&at.own);
        let local = first_invariant::stress(at, &at.own, slope);
        volume::stress(at, self.of_volume(), local)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Isochoric<N>>, change: Tensor<N>) -> Tensor<N> {
        let local = first_invariant::tangent(at, &at.own, self.slopes(&at.own), change);
        volume::tangent(at, self.of_volume(), local, change)
    }

    /// The exact block, with derivatives of psi by i that are below 0 taken as 0.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Isochoric<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let [first, second] = self.slopes(&at.own);
        let none = N::of(0.0);
        let slopes = [first.max(none), second.max(none)];
        let of_volume = self.of_volume::<N>() + bulk.modulus;
        first_invariant::node_block(at, &at.own, slopes, of_volume, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::{NeoHookeanIso, Parameters, conformance, sample_deformations};

    fn of(c: &[f64], nu: f64) -> Yeoh {
        Yeoh::new(
            &Parameters::default()
                .with("c", c)
                .with("poissons_ratio", &[nu]),
        )
        .unwrap()
    }

    #[test]
    fn the_suite_holds_for_one_two_and_three_constants_of_either_sign() {
        for c in [
            &[600.0][..],
            &[600.0, -20.0],
            &[600.0, -50.0, 10.0],
            &[600.0, 0.0, 60.0],
        ] {
            conformance::check(of(c, 0.45));
        }
    }

    #[test]
    fn with_c1_alone_it_is_the_neo_hookean_law_of_the_same_invariant() {
        let (mu, nu) = (1200.0, 0.45);
        let yeoh = of(&[0.5 * mu], nu);
        let iso = NeoHookeanIso::new(&Parameters::new(2.0 * mu * (1.0 + nu), nu)).unwrap();
        for [h, change] in sample_deformations(yeoh) {
            let (a, b) = (yeoh.at(h), iso.at(h));
            let size = 1.0 + yeoh.stress(&a).largest();
            assert!((yeoh.energy(&a) - iso.energy(&b)).abs() < 1e-11 * size);
            assert!((yeoh.stress(&a) - iso.stress(&b)).largest() < 1e-12 * size);
            let [a, b] = [yeoh.tangent(&a, change), iso.tangent(&b, change)];
            assert!((a - b).largest() < 1e-12 * (1.0 + a.largest()));
        }
    }

    /// Simple shear by g keeps the volume and has `I1 - 3 = g^2`: the shear stress is `2 g psi'`, for any bulk
    /// modulus.
    #[test]
    fn simple_shear_has_its_closed_form() {
        let c = [600.0, -40.0, 12.0];
        let law = of(&c, 0.49);
        for g in [0.1, 0.5, 1.0, 2.0_f64] {
            let at = law.at(Tensor([[0.0, g, 0.0], [0.0; 3], [0.0; 3]]));
            let stress = law.stress_with(&at, law.own_bulk(&at));
            let cauchy = stress.times_transposed(at.gradient).0[0][1];
            let i = g * g;
            let expected = 2.0 * g * (c[0] + 2.0 * c[1] * i + 3.0 * c[2] * i * i);
            assert!(
                (cauchy / expected - 1.0).abs() < 1e-13,
                "{g}: {cauchy}, {expected}"
            );
        }
    }

    #[test]
    fn either_stiffness_of_volume_is_taken_and_none_or_both_are_refused() {
        let c = || Parameters::default().with("c", &[600.0]);
        let of_ratio = Yeoh::new(&c().with("poissons_ratio", &[0.25])).unwrap();
        let bulk = 2.0 * 1200.0 * 1.25 / (3.0 * 0.5);
        let of_bulk = Yeoh::new(&c().with("bulk_modulus", &[bulk])).unwrap();
        assert!((of_ratio.lambda / of_bulk.lambda - 1.0).abs() < 1e-14);
        let both = c()
            .with("poissons_ratio", &[0.25])
            .with("bulk_modulus", &[bulk]);
        for refused in [c(), both] {
            let said = Yeoh::new(&refused).unwrap_err().to_string();
            let expected = "the law `yeoh` needs exactly one of poissons_ratio, bulk_modulus";
            assert_eq!(said, expected);
        }
        let soft = Yeoh::new(&c().with("bulk_modulus", &[700.0])).unwrap_err();
        assert!(
            soft.to_string()
                .starts_with("bulk_modulus = 700: expected at least 2/3")
        );
        let inside_out = Parameters::default()
            .with("c", &[-1.0])
            .with("poissons_ratio", &[0.3]);
        let said = Yeoh::new(&inside_out).unwrap_err().to_string();
        assert_eq!(said, "c = -1: expected c1 above 0 Pa");
    }
}
