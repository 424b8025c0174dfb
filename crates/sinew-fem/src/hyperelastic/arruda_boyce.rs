//! The law of Arruda and Boyce.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::first_invariant::{self, Slopes};
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::tensor::Tensor;
use super::volume;

/// `psi = mu sum C_k lm^(2 - 2k) (I1^k - 3^k) + kappa/2 (J - 1)^2` with the isochoric `I1` and `C = 1/2, 1/20, 11/1050,
/// 19/7000, 519/673750`.
///
/// Arruda and Boyce (Journal of the Mechanics and Physics of Solids 41, 1993, equation 11): chains along the eight
/// diagonals of a cube, whose inverse Langevin function is taken to its fifth term. The shear modulus at small strain is
/// `mu (1 + 3/(5 lm^2) + 99/(175 lm^4) + 513/(875 lm^6) + 42039/(67375 lm^8))`.
///
/// For rubber and gels up to some 80 % of the locking stretch, with constants from papers. At the locking stretch the
/// stress of [`super::Gent`] grows without bound, which five terms do not show. Not for elements that may invert:
/// refused at J <= 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrudaBoyce {
    lambda: f64,
    /// The coefficients (Pa) of i, i^2, .., i^5, `i = J^-2/3 I1 - 3`.
    c: [f64; TERMS],
}

const TERMS: usize = 5;

const C: [f64; TERMS] = [
    0.5,
    1.0 / 20.0,
    11.0 / 1050.0,
    19.0 / 7000.0,
    519.0 / 673750.0,
];

const SHEAR_MODULUS: LawParameter = LawParameter::number(
    "shear_modulus",
    "mu",
    "The modulus mu of the chains; the shear modulus at small strain is a little larger, by the factor \
     1 + 3/(5 lm^2) + 99/(175 lm^4) + 513/(875 lm^6) + 42039/(67375 lm^8).",
    Range::above_zero("a finite modulus above 0 Pa"),
    &[1200.0],
)
.unit("Pa");

const LOCKING_STRETCH: LawParameter = LawParameter::number(
    "locking_stretch",
    "lm",
    "The stretch lm at which a chain is straight: in a bar that is pulled to the stretch l the chains have \
     ((l^2 + 2/l)/3)^(1/2).",
    Range::between(
        "a finite stretch above 1",
        std::ops::Bound::Excluded(1.0),
        std::ops::Bound::Unbounded,
    ),
    &[2.8],
);

impl ArrudaBoyce {
    #[inline(always)]
    fn slopes<N: Number>(&self, own: &Isochoric<N>) -> Slopes<N> {
        let beyond = first_invariant::beyond(own);
        let [c1, c2, c3, c4, c5] = self.c;
        let term = |factor: f64, of: N| of.mul_add(beyond, N::of(factor));
        let slope = term(2.0 * c2, term(3.0 * c3, term(4.0 * c4, N::of(5.0 * c5))));
        let curvature = term(2.0 * c2, term(6.0 * c3, term(12.0 * c4, N::of(20.0 * c5))));
        [slope.mul_add(beyond, N::of(c1)), curvature]
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(4.0 / 3.0 * self.c[0])
    }
}

/// The coefficients of powers of `I1 - 3` of the sum of `C_k lm^(2 - 2k) (I1^k - 3^k)`.
fn coefficients(locking: f64) -> [f64; TERMS] {
    let mut powers = [0.0; TERMS];
    // (3 + i)^k by its coefficients, 1 first.
    let mut power = [0.0; TERMS + 1];
    power[0] = 1.0;
    let mut share = locking * locking;
    for c in C {
        let before = power;
        for (place, entry) in power.iter_mut().enumerate() {
            let lower = place.checked_sub(1).map_or(0.0, |lower| before[lower]);
            *entry = 3.0 * before[place] + lower;
        }
        share /= locking * locking;
        for (sum, entry) in powers.iter_mut().zip(&power[1..]) {
            *sum += c * share * entry;
        }
    }
    powers
}

impl HyperelasticLaw for ArrudaBoyce {
    const ID: &'static str = "arruda-boyce";
    const MEANING: &'static str = "is that of networks of chains, such as rubber and gels";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[SHEAR_MODULUS, LOCKING_STRETCH, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    type Own<N: Number> = Isochoric<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let mu = values.number(&SHEAR_MODULUS);
        let c = coefficients(values.number(&LOCKING_STRETCH)).map(|c| mu * c);
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
        let mut local = N::of(0.0);
        for c in self.c.iter().rev() {
            local = local.mul_add(beyond, N::of(*c));
        }
        volume::energy(at, self.of_volume(), local * beyond)
    }

    /// `2 psi' J^-2/3 (F - I1/(3J) c) + 2/3 mu (J - 1) c`, with the shear modulus at small strain in the second.
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

    #[inline(always)]
    fn node_block<N: Number>(
        &self,
        at: &Point<N, Isochoric<N>>,
        bulk: Bulk<N>,
        gradient: [N; 3],
    ) -> Tensor<N> {
        let of_volume = self.of_volume::<N>() + bulk.modulus;
        first_invariant::node_block(at, &at.own, self.slopes(&at.own), of_volume, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::same::are_one_law;
    use crate::hyperelastic::{NeoHookeanIso, Parameters, conformance};

    fn of(mu: f64, locking: f64, nu: f64) -> ArrudaBoyce {
        let parameters = Parameters::default()
            .with("shear_modulus", &[mu])
            .with("locking_stretch", &[locking])
            .with("poissons_ratio", &[nu]);
        ArrudaBoyce::new(&parameters).unwrap()
    }

    #[test]
    fn the_suite_holds_for_chains_short_and_long() {
        for locking in [1.3, 2.8, 10.0, 1e6] {
            conformance::check(of(1200.0, locking, 0.45));
        }
    }

    #[test]
    fn with_chains_that_never_end_it_is_the_neo_hookean_law_of_the_same_invariant() {
        let (mu, nu) = (1200.0, 0.45);
        let iso = NeoHookeanIso::new(&Parameters::new(2.0 * mu * (1.0 + nu), nu)).unwrap();
        are_one_law(of(mu, 1e6, nu), iso, 1e-10);
    }

    #[test]
    fn the_shear_modulus_at_rest_is_that_of_the_series() {
        let locking: f64 = 2.8;
        let over = 1.0 / (locking * locking);
        let series = [
            1.0,
            3.0 / 5.0,
            99.0 / 175.0,
            513.0 / 875.0,
            42039.0 / 67375.0,
        ];
        let sum = series.iter().rev().fold(0.0, |sum, c| sum * over + c);
        let (_, mu) = of(1000.0, locking, 0.3).lame();
        assert!((mu / (1000.0 * sum) - 1.0).abs() < 1e-14, "{mu}");
    }

    #[test]
    fn the_energy_is_that_of_powers_of_the_invariant() {
        let (mu, locking) = (1000.0, 2.8_f64);
        let law = of(mu, locking, 0.3);
        // A pull to 3 that keeps the volume.
        let across = 1.0 / 3_f64.sqrt() - 1.0;
        let h = Tensor([[2.0, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]]);
        let i1 = 9.0 + 2.0 / 3.0_f64;
        let terms = (1..)
            .zip(C)
            .map(|(k, c)| c * locking.powi(2 - 2 * k) * (i1.powi(k) - 3_f64.powi(k)));
        let expected = mu * terms.sum::<f64>();
        let found = law.whole_energy(&law.at(h));
        assert!(
            (found / expected - 1.0).abs() < 1e-13,
            "{found}, {expected}"
        );
    }
}
