//! The law of Yeoh.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, Point, block_of};
use super::mooney_rivlin::Isochoric;
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::tensor::Tensor;

/// `psi = c1 i + c2 i^2 + c3 i^3 + kappa/2 (J - 1)^2` with `i = J^-2/3 I1 - 3`, `mu = 2 c1` and
/// `kappa = lambda + 2/3 mu`.
///
/// Yeoh (Rubber Chemistry and Technology 66, 1993); the invariant without change of volume after Flory (Transactions of
/// the Faraday Society 57, 1961).
///
/// For tissue and rubber that stiffen with stretch, alike in all directions; its curves of tension and shear are bent
/// by c2 and c3 alone. With c2 or c3 below 0 it may soften, and a state beyond that need not be stable. Not where
/// elements may invert: refused at J <= 0.
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
    fn slopes<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> [N; 2] {
        let own = &at.own;
        // 0 at rest, where J^-2/3 is exactly 1.
        let beyond = N::of(3.0).mul_add(own.scale - N::of(1.0), own.scale * own.first);
        let [c1, c2, c3] = self.c;
        let second = N::of(6.0 * c3).mul_add(beyond, N::of(2.0 * c2));
        let half = N::of(3.0 * c3).mul_add(beyond, N::of(2.0 * c2));
        [half.mul_add(beyond, N::of(c1)), second]
    }

    /// `(F - I1/(3J) c)`, by parts that are 0 at rest: half the gradient of i over `J^-2/3`.
    #[inline(always)]
    fn half_gradient<N: Number>(at: &Point<N, Isochoric<N>>) -> Tensor<N> {
        let beyond = at.own.beyond_rest(at.own.first, at.volume_change);
        at.distortion.plus(beyond * N::of(-1.0 / 3.0), at.cofactor)
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
        let (own, volume) = (&at.own, at.volume_change);
        // `J^-2/3 - 1` without a difference of large numbers.
        let shrink = (N::of(-2.0 / 3.0) * volume.ln_1p()).exp_m1();
        let beyond = own.scale.mul_add(own.first, N::of(3.0) * shrink);
        let [c1, c2, c3] = self.c.map(N::of);
        let local = c3.mul_add(beyond, c2).mul_add(beyond, c1) * beyond;
        (N::of(0.5) * self.of_volume::<N>() * volume).mul_add(volume, local)
    }

    /// `2 psi' J^-2/3 (F - I1/(3J) c) + 2/3 mu (J - 1) c`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> Tensor<N> {
        let [slope, _] = self.slopes(at);
        let stress = Self::half_gradient(at).scaled(N::of(2.0) * slope * at.own.scale);
        stress.plus(self.of_volume::<N>() * at.volume_change, at.cofactor)
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Isochoric<N>>, change: Tensor<N>) -> Tensor<N> {
        let own = &at.own;
        let (f, c) = (at.gradient, at.cofactor);
        let [slope, curvature] = self.slopes(at);
        let twice = N::of(2.0) * own.scale;
        let volume = c.contracted(change);
        // dJ/J.
        let relative = volume * own.over;
        let turned = at.cofactor_change(change);
        let third = N::of(1.0 / 3.0);
        let along = f.contracted(change);
        let of_c = third * own.over * (N::of(5.0) * third * own.i1() * relative - (along + along));
        let first = change
            .plus(N::of(-2.0) * third * relative, f)
            .plus(of_c, c)
            .plus(-(third * own.i1() * own.over), turned);
        let half = Self::half_gradient(at);
        let bulk = self.of_volume::<N>();
        first
            .scaled(slope * twice)
            .plus(curvature * twice * twice * half.contracted(change), half)
            .plus(bulk * volume, c)
            .plus(bulk * at.volume_change, turned)
    }

    /// The exact block, with derivatives of psi by i that are below 0 taken as 0: the gradient of i is an outer product
    /// in it, and i is rank-one convex.
    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Isochoric<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let (own, zero) = (&at.own, N::of(0.0));
        let [slope, curvature] = self.slopes(at).map(|of_psi| of_psi.max(zero));
        let twice = N::of(2.0) * own.scale;
        let a = slope * twice;
        let squared = own.over * own.over;
        let first = a * N::of(5.0 / 9.0) * own.i1() * squared;
        let (along, normal) = (at.gradient.on(gradient), at.cofactor.on(gradient));
        let mixed = Tensor::outer(along, normal).symmetric();
        let sloped = Self::half_gradient(at).on(gradient);
        let of_volume = self.of_volume::<N>() + bulk.modulus;
        block_of(at, gradient, a, first + of_volume)
            .plus(N::of(-4.0 / 3.0) * a * own.over, mixed)
            .plus(curvature * twice * twice, Tensor::outer(sloped, sloped))
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
        for [h, change] in sample_deformations::<Yeoh>() {
            let (a, b) = (yeoh.at(h), iso.at(h));
            let size = 1.0 + yeoh.stress(&a).largest();
            assert!((yeoh.energy(&a) - iso.energy(&b)).abs() < 1e-11 * size);
            assert!((yeoh.stress(&a) - iso.stress(&b)).largest() < 1e-12 * size);
            let [a, b] = [yeoh.tangent(&a, change), iso.tangent(&b, change)];
            assert!((a - b).largest() < 1e-12 * (1.0 + a.largest()));
        }
    }

    /// Simple shear by g keeps the volume and has `I1 - 3 = g^2`: the shear stress is `2 g psi'`, whatever the bulk
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
