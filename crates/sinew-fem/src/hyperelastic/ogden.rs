//! The law of Ogden.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{HyperelasticLaw, Point};
use super::parameters::{Column, LawParameter, LawValues, ParameterError, Range};
use super::powers::{SMALL, exp_m1, largest_lawful_exponent, sinh_share};
use super::stretches::Stretches;
use super::tensor::Tensor;
use super::volume;

/// `psi = sum 2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3) + kappa/2 (J - 1)^2` over terms [mu, alpha], with
/// principal stretches `l = J^-1/3 lambda` without change of volume; the shear modulus at small strain is the sum of
/// mu, and `kappa = lambda + 2/3 mu`.
///
/// Ogden (Proceedings of the Royal Society A 326, 1972), whose mu are `2 mu/alpha` here; the stresses in principal
/// stretches after Simo and Taylor (Computer Methods in Applied Mechanics and Engineering 85, 1991).
///
/// For rubber over all of its range, and for tissue whose papers give terms, such as brain with alpha below 0. It takes
/// up to three times as long as a law in invariants; prefer [`super::Yeoh`] if that fits as well. With mu of different
/// signs states may be unstable. Not for elements that may invert: refused at J <= 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ogden {
    lambda: f64,
    mu: f64,
    /// mu (Pa) and alpha of each term; 0 and 1 after the last.
    terms: [[f64; 2]; MOST_TERMS],
    count: usize,
    /// The largest size of an alpha.
    steepest: f64,
}

const MOST_TERMS: usize = 6;

const TERMS: LawParameter = LawParameter::number(
    "terms",
    "terms",
    "The terms [mu, alpha] of the sum of 2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3) over principal stretches l without change of \
     volume. The shear modulus at small strain is the sum of mu. A book's mu_p/alpha_p (l1^alpha_p + ..) has mu_p alpha_p/2 here.",
    Range::finite("a finite number"),
    &[1000.0, 1.3, 200.0, 5.0, 50.0, -2.0],
)
.tuples(
    &[
        Column {
            name: "mu in Pa",
            is_modulus: true,
            range: Range::finite("a finite modulus in Pa"),
        },
        Column {
            name: "alpha",
            is_modulus: false,
            range: Range::finite("a finite exponent other than 0"),
        },
    ],
    1,
    MOST_TERMS,
);

/// Values cached per deformation gradient.
#[derive(Clone, Copy, Debug)]
pub struct Spectral<N> {
    stretches: Stretches<N>,
    /// `sum 2 mu/alpha^2 (l^alpha - 1)` over all (Pa).
    energy: N,
    /// Kirchhoff's stress without pressure along each axis (Pa).
    stress: [N; 3],
    /// The derivative of `sum 2 mu/alpha l^alpha` by the logarithm of each l (Pa).
    slopes: [N; 3],
    /// The difference of two of `stress` over that of their `l^2`, for the axes (0, 1), (0, 2) and (1, 2) (Pa).
    shears: [N; 3],
}

impl Ogden {
    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(2.0 / 3.0 * self.mu)
    }

    /// The largest exponent `alpha ln l` in size.
    #[inline(always)]
    fn largest_power<N: Number>(&self, stretches: &Stretches<N>) -> N {
        let [x, y, z] = stretches.logs;
        x.abs().max(y.abs()).max(z.abs()) * N::of(self.steepest)
    }
}

/// A term at a deformation.
struct Term<N> {
    /// `alpha/2`.
    half: N,
    /// `2 mu` (Pa).
    twice: N,
    /// `2 mu/alpha` (Pa).
    factor: N,
    /// `l^(alpha/2) - 1`.
    halves: [N; 3],
    /// `l^alpha - 1`.
    powers: [N; 3],
}

impl<N: Number> Term<N> {
    /// Contribution of the term to the shear of two axes: the difference of `2 mu/alpha l^alpha` over that of the
    /// squares of the stretches, from that of their logarithms if both are near.
    #[inline(always)]
    fn shear<const A: usize, const B: usize>(&self, stretches: &Stretches<N>, of_logs: N) -> N {
        let one = N::of(1.0);
        let x = self.half * (stretches.logs[A] - stretches.logs[B]);
        let middle = (self.halves[A] + one) * (self.halves[B] + one);
        let near = self.twice * middle * sinh_share(x * x) * of_logs;
        let difference = stretches.strains[A] - stretches.strains[B];
        let apart = self.factor * (self.powers[A] - self.powers[B]) / difference;
        N::select_le(x.abs(), N::of(SMALL), near, apart)
    }
}

/// `(1 + x)^2 - 1`.
#[inline(always)]
fn squared<N: Number>(x: N) -> N {
    x.mul_add(x, x + x)
}

impl HyperelasticLaw for Ogden {
    const ID: &'static str = "ogden";
    const MEANING: &'static str = "follows rubber and brain by powers of stretches";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[TERMS, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;

    type Own<N: Number> = Spectral<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let mut terms = [[0.0, 1.0]; MOST_TERMS];
        let given = values.numbers(&TERMS).as_chunks::<2>().0;
        for (own, given) in terms.iter_mut().zip(given) {
            *own = *given;
        }
        if let Some([_, alpha]) = given.iter().find(|[_, alpha]| *alpha == 0.0) {
            return Err(TERMS.refused(*alpha, "an alpha other than 0 in each term"));
        }
        let mu = given.iter().map(|[mu, _]| mu).sum();
        if mu <= 0.0 {
            return Err(TERMS.refused(mu, "a sum of mu above 0 Pa"));
        }
        let sizes = given.iter().map(|[_, alpha]| alpha.abs());
        Ok(Self {
            lambda: values.lambda(mu)?,
            mu,
            terms,
            count: given.len(),
            steepest: sizes.fold(0.0, f64::max),
        })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        Some(
            "ends where a power of a stretch is beyond numbers to compute with, and the tetrahedron is there",
        )
    }

    #[inline(always)]
    fn margin<N: Number>(&self, at: &Point<N, Spectral<N>>) -> N {
        N::of(largest_lawful_exponent::<N>()) - self.largest_power(&at.own.stretches)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Spectral<N> {
        let zero = N::of(0.0);
        let stretches = Stretches::of(deformation);
        let of_logs = [
            stretches.slope_of_logs(0, 1),
            stretches.slope_of_logs(0, 2),
            stretches.slope_of_logs(1, 2),
        ];
        let (mut energy, mut stress, mut slopes, mut shears) =
            (zero, [zero; 3], [zero; 3], [zero; 3]);
        for term in self.terms.iter().take(self.count) {
            let [mu, alpha] = *term;
            let (half, twice) = (N::of(0.5 * alpha), N::of(2.0 * mu));
            let logs = stretches.logs;
            let halves = [
                exp_m1(half * logs[0]),
                exp_m1(half * logs[1]),
                exp_m1(half * logs[2]),
            ];
            let powers = [squared(halves[0]), squared(halves[1]), squared(halves[2])];
            let sum = powers[0] + powers[1] + powers[2];
            energy = sum.mul_add(N::of(2.0 * mu / (alpha * alpha)), energy);
            let factor = N::of(2.0 * mu / alpha);
            for i in 0..3 {
                stress[i] = powers[i].mul_add(factor, stress[i]);
                slopes[i] = powers[i].mul_add(twice, slopes[i] + twice);
            }
            let of = Term {
                half,
                twice,
                factor,
                halves,
                powers,
            };
            shears[0] = shears[0] + of.shear::<0, 1>(&stretches, of_logs[0]);
            shears[1] = shears[1] + of.shear::<0, 2>(&stretches, of_logs[1]);
            shears[2] = shears[2] + of.shear::<1, 2>(&stretches, of_logs[2]);
        }
        let mean = (stress[0] + stress[1] + stress[2]) * N::of(1.0 / 3.0);
        Spectral {
            stretches,
            energy,
            stress: [stress[0] - mean, stress[1] - mean, stress[2] - mean],
            slopes,
            shears,
        }
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Spectral<N>>) -> N {
        volume::energy(at, self.of_volume(), at.own.energy)
    }

    /// The sum of `tau_a/l_a^2 F v_a v_a'` over axes v, and `2/3 mu (J - 1) c`.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, Spectral<N>>) -> Tensor<N> {
        let Spectral {
            stretches, stress, ..
        } = &at.own;
        let Stretches { axes, images, .. } = stretches;
        let over = &stretches.over;
        let local = Tensor::outer(images[0], axes[0])
            .scaled(stress[0] * over[0])
            .plus(stress[1] * over[1], Tensor::outer(images[1], axes[1]))
            .plus(stress[2] * over[2], Tensor::outer(images[2], axes[2]));
        volume::stress(at, self.of_volume(), local)
    }

    /// In the axes, with `m_ab = F v_a . dF v_b`, `o_a = 1/l_a^2` and tau's slopes A by the logarithms of stretches:
    /// `o_a (A_ab o_b m_bb - tau_a o_a m_aa)` on the diagonal and `o_a D m_ab + K o_a o_b m_ba` off it, where D is
    /// the difference of tau over that of l^2, and `K = ((l_a^2 + l_b^2) D - tau_a - tau_b)/2`.
    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, Spectral<N>>, change: Tensor<N>) -> Tensor<N> {
        let own = &at.own;
        let stretches = &own.stretches;
        let (over, stress) = (stretches.over, own.stress);
        let axes = Tensor::from_columns(stretches.axes);
        let images = Tensor::from_columns(stretches.images);
        let m = (images.transposed_times(change) * axes).0;
        let third = N::of(1.0 / 3.0);
        let diagonal = [m[0][0] * over[0], m[1][1] * over[1], m[2][2] * over[2]];
        let mean = third * (diagonal[0] + diagonal[1] + diagonal[2]);
        // Slopes of each stress by its own logarithm, less the mean.
        let changes = [
            own.slopes[0] * (diagonal[0] - mean),
            own.slopes[1] * (diagonal[1] - mean),
            own.slopes[2] * (diagonal[2] - mean),
        ];
        let all = third * (changes[0] + changes[1] + changes[2]);
        let mut turned = Tensor::zero();
        for i in 0..3 {
            turned.0[i][i] = over[i] * ((changes[i] - all) - stress[i] * diagonal[i]);
        }
        for (pair, [a, b]) in [[0, 1], [0, 2], [1, 2]].into_iter().enumerate() {
            let shear = own.shears[pair];
            let squares = stretches.strains[a] + stretches.strains[b] + N::of(2.0);
            let twice = squares.mul_add(shear, -(stress[a] + stress[b]));
            let cross = N::of(0.5) * twice * over[a] * over[b];
            turned.0[a][b] = (over[a] * shear).mul_add(m[a][b], cross * m[b][a]);
            turned.0[b][a] = (over[b] * shear).mul_add(m[b][a], cross * m[a][b]);
        }
        let local = (images * turned).times_transposed(axes);
        volume::tangent(at, self.of_volume(), local, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::same::are_one_law;
    use crate::hyperelastic::{
        MooneyRivlin, NeoHookeanIso, Parameters, conformance, sample_deformations,
    };

    fn of(terms: &[f64], nu: f64) -> Ogden {
        let parameters = Parameters::default()
            .with("terms", terms)
            .with("poissons_ratio", &[nu]);
        Ogden::new(&parameters).unwrap()
    }

    #[test]
    fn the_suite_holds_for_terms_of_either_sign() {
        for terms in [
            &[1200.0, 2.0][..],
            &[1200.0, -3.5],
            &[1000.0, 1.3, 200.0, 5.0, 50.0, -2.0],
            &[1500.0, 1.0, -300.0, 3.0],
            &[
                300.0, -5.0, 10.0, 5.5, 20.0, 0.5, 30.0, -0.5, 40.0, 4.0, 50.0, 6.0,
            ],
        ] {
            conformance::check(of(terms, 0.45));
        }
    }

    #[test]
    fn with_alpha_2_it_is_the_neo_hookean_law_of_the_first_invariant() {
        let (mu, nu) = (1200.0, 0.45);
        let iso = NeoHookeanIso::new(&Parameters::new(2.0 * mu * (1.0 + nu), nu)).unwrap();
        are_one_law(of(&[mu, 2.0], nu), iso, 1e-12);
        are_one_law(of(&[0.25 * mu, 2.0, 0.75 * mu, 2.0], nu), iso, 1e-12);
    }

    #[test]
    fn with_alpha_2_and_minus_2_it_is_the_law_of_mooney_and_rivlin() {
        let (mu, nu) = (1200.0, 0.45);
        let parameters = Parameters::new(2.0 * mu * (1.0 + nu), nu).with("c1_over_c2", &[4.0]);
        let mooney = MooneyRivlin::new(&parameters).unwrap();
        are_one_law(of(&[0.8 * mu, 2.0, 0.2 * mu, -2.0], nu), mooney, 1e-12);
    }

    /// F with these principal stretches, with a rotation on both sides.
    fn turned(stretches: [f64; 3]) -> Tensor<f64> {
        let [left, right] = [
            [[0.3, -0.8, 0.1], [0.5, 0.2, 0.9], [-0.7, 0.4, 0.6]],
            [[0.9, 0.2, -0.3], [-0.1, 0.4, 0.8], [0.5, -0.6, 0.3]],
        ]
        .map(|rows| crate::hyperelastic::SingularValues::of(Tensor(rows)).rotation());
        let mut middle = Tensor::zero();
        for (axis, stretch) in stretches.into_iter().enumerate() {
            middle.0[axis][axis] = stretch;
        }
        (left * middle).times_transposed(right) - Tensor::identity()
    }

    #[test]
    fn stretches_that_are_alike_are_the_limit_of_those_that_are_not() {
        let law = of(&[1000.0, 1.3, 200.0, 5.0, 50.0, -2.0], 0.45);
        let change = Tensor([[0.3, -0.2, 0.5], [0.1, -1.4, 0.2], [-0.6, 0.7, 0.1]]);
        for (alike, apart) in [
            ([1.0, 1.0, 1.0], [0.0, 1e-10, -1e-10]),
            ([1.7, 1.7, 1.7], [1e-10, -1e-10, 0.0]),
            ([1.4, 1.4, 0.6], [1e-10, 0.0, 0.0]),
            ([0.7, 1.6, 1.6], [0.0, -1e-10, 1e-10]),
            ([0.8, 1.3, 0.8], [1e-10, 0.0, -1e-10]),
        ] {
            let near = [0, 1, 2].map(|axis| alike[axis] + apart[axis]);
            let [one, other] = [alike, near].map(|stretches| law.at(turned(stretches)));
            let (p, q) = (law.stress(&one), law.stress(&other));
            let size = law.mu + p.largest();
            assert!((p - q).largest() < 1e-9 * size, "{alike:?}: {p:?}, {q:?}");
            let (p, q) = (law.tangent(&one, change), law.tangent(&other, change));
            let size = law.mu + p.largest();
            assert!((p - q).largest() < 1e-9 * size, "{alike:?}: {p:?}, {q:?}");
        }
    }

    /// Divided differences are series for nearly equal stretches and differences otherwise: both agree at the
    /// transition.
    #[test]
    fn tangents_have_no_seam_where_series_end() {
        let law = of(&[1000.0, 1.3, 200.0, 5.0, 50.0, -2.0], 0.45);
        let change = Tensor([[0.3, -0.2, 0.5], [0.1, -1.4, 0.2], [-0.6, 0.7, 0.1]]);
        let of_gap = |gap: f64| law.tangent(&law.at(turned([1.2 * (1.0 + gap), 1.2, 0.7])), change);
        for step in 1..4000 {
            let gap = f64::from(step) * 1e-4;
            let middle = (of_gap(gap - 1e-6) + of_gap(gap + 1e-6)).scaled(0.5);
            let off = (middle - of_gap(gap)).largest();
            assert!(off < 1e-10 * middle.largest(), "{gap}: {off:e}");
        }
    }

    #[test]
    fn at_rest_the_tangent_is_linear_elasticity() {
        for terms in [&[1000.0, 1.3, 200.0, 5.0, 50.0, -2.0][..], &[700.0, -11.0]] {
            let law = of(terms, 0.45);
            let (lambda, mu) = law.lame();
            let at = law.at(Tensor::<f64>::zero());
            for [_, change] in sample_deformations(law).take(20) {
                let found = law.tangent_with(&at, law.own_bulk(&at), change);
                let expected =
                    change.symmetric().scaled(2.0 * mu) + Tensor::diagonal(lambda * change.trace());
                assert!((found - expected).largest() < 1e-12 * (lambda + 2.0 * mu));
            }
        }
    }

    #[test]
    fn terms_that_make_no_law_are_refused() {
        let said = |terms: &[f64]| {
            let parameters = Parameters::default()
                .with("terms", terms)
                .with("poissons_ratio", &[0.3]);
            Ogden::new(&parameters).unwrap_err().to_string()
        };
        assert_eq!(
            said(&[1.0, 0.0]),
            "terms = 0: expected an alpha other than 0 in each term"
        );
        assert_eq!(
            said(&[1.0, 2.0, -1.0, 3.0]),
            "terms = 0: expected a sum of mu above 0 Pa"
        );
        assert_eq!(
            said(&[1.0, 2.0, 1.0]),
            "terms has 3 numbers: expected 2 to 12"
        );
        assert_eq!(said(&[1.0; 14]), "terms has 14 numbers: expected 2 to 12");
        assert_eq!(
            said(&[1.0, f64::NAN]),
            "terms = NaN: expected a finite exponent other than 0"
        );
    }

    #[test]
    fn a_power_without_end_is_refused_and_sooner_in_single_precision() {
        let law = of(&[100.0, 40.0], 0.45);
        let pulled = |l: f64| {
            let mut h = Tensor::diagonal(1.0 / l.sqrt() - 1.0);
            h.0[2][2] = l - 1.0;
            h
        };
        for (l, in_double, in_single) in
            [(2.5, true, true), (3.0, true, false), (1e5, false, false)]
        {
            assert_eq!(law.admits(&law.at(pulled(l))), in_double, "{l}");
            let single = law.at(Tensor::<f32>::of(pulled(l).0));
            assert_eq!(law.admits(&single), in_single, "{l} in f32");
        }
    }
}
