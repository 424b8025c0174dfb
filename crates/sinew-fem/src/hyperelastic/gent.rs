//! The law of Gent.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::first_invariant::{self, Slopes};
use super::isochoric::Isochoric;
use super::law::{Bulk, HyperelasticLaw, NodeBlock, Point};
use super::parameters::{LawParameter, LawValues, ParameterError, Range};
use super::tensor::Tensor;
use super::volume;

/// `psi = -mu Jm/2 ln(1 - i/Jm) + kappa/2 (J - 1)^2` with `i = J^-2/3 I1 - 3` and `kappa = lambda + 2/3 mu`.
///
/// Gent (Rubber Chemistry and Technology 69, 1996); the invariant without change of volume after Flory (Transactions of
/// the Faraday Society 57, 1961).
///
/// For tissue and rubber whose fibres or chains are straight at a certain stretch, with two constants that can be read
/// from a curve: the initial slope, and the stretch at its vertical asymptote. Not for motions that may reach `i >=
/// Jm`, where the law is not defined and a tetrahedron is refused, and not for elements that may invert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gent {
    lambda: f64,
    mu: f64,
    limit: f64,
}

const SHEAR_MODULUS: LawParameter = LawParameter::number(
    "shear_modulus",
    "mu",
    "The shear modulus at small strain.",
    Range::above_zero("a finite modulus above 0 Pa"),
    &[1200.0],
)
.unit("Pa");

const LIMIT: LawParameter = LawParameter::number(
    "limit",
    "Jm",
    "The value Jm of I1 - 3 at which the material stretches no further, I1 being the first invariant without change of volume: not a stretch. \
     A bar that is pulled to the stretch l has I1 - 3 = l^2 + 2/l - 3. A tetrahedron that comes there is refused.",
    Range::above_zero("a finite number above 0"),
    &[97.2],
);

impl Gent {
    /// `1 - i/Jm`.
    #[inline(always)]
    fn left<N: Number>(&self, own: &Isochoric<N>) -> N {
        first_invariant::beyond(own).mul_add(N::of(-1.0 / self.limit), N::of(1.0))
    }

    #[inline(always)]
    fn slopes<N: Number>(&self, own: &Isochoric<N>) -> Slopes<N> {
        let over = self.left(own).recip();
        let slope = N::of(0.5 * self.mu) * over;
        [slope, slope * over * N::of(1.0 / self.limit)]
    }

    /// Second derivative (Pa) of the local energy of volume, `mu/3 (J - 1)^2`.
    #[inline(always)]
    fn of_volume<N: Number>(&self) -> N {
        N::of(2.0 / 3.0 * self.mu)
    }
}

impl HyperelasticLaw for Gent {
    const ID: &'static str = "gent";
    const MEANING: &'static str = "stiffens without end towards a stretch that nothing goes beyond";
    const PARAMETERS: &'static [LawParameter] = {
        let [ratio, bulk] = LawParameter::VOLUME;
        &[SHEAR_MODULUS, LIMIT, ratio, bulk]
    };
    const DEFINED_WHEN_INVERTED: bool = false;
    const HAS_ISOCHORIC_PART: bool = true;
    const NODE_BLOCK: NodeBlock = NodeBlock::Exact;

    type Own<N: Number> = Isochoric<N>;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let mu = values.number(&SHEAR_MODULUS);
        let limit = values.number(&LIMIT);
        let lambda = values.lambda(mu)?;
        Ok(Self { lambda, mu, limit })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        Some(
            "ends where its chains are straight, at I1 - 3 = `limit`, and the tetrahedron is there",
        )
    }

    #[inline(always)]
    fn margin<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> N {
        self.left(&at.own)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> Isochoric<N> {
        Isochoric::at(deformation)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, Isochoric<N>>) -> N {
        let share = first_invariant::exactly_beyond(at) * N::of(-1.0 / self.limit);
        let local = N::of(-0.5 * self.mu * self.limit) * share.ln_1p();
        volume::energy(at, self.of_volume(), local)
    }

    /// `mu/(1 - i/Jm) J^-2/3 (F - I1/(3J) c) + 2/3 mu (J - 1) c`.
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

    fn of(mu: f64, limit: f64, nu: f64) -> Gent {
        let parameters = Parameters::default()
            .with("shear_modulus", &[mu])
            .with("limit", &[limit])
            .with("poissons_ratio", &[nu]);
        Gent::new(&parameters).unwrap()
    }

    #[test]
    fn the_suite_holds_for_limits_near_and_far() {
        for limit in [2.0, 30.0, 97.2, 1e6] {
            conformance::check(of(1200.0, limit, 0.45));
        }
    }

    #[test]
    fn with_a_limit_far_away_it_is_the_neo_hookean_law_of_the_same_invariant() {
        let (mu, nu) = (1200.0, 0.45);
        let iso = NeoHookeanIso::new(&Parameters::new(2.0 * mu * (1.0 + nu), nu)).unwrap();
        are_one_law(of(mu, 1e9, nu), iso, 2e-7);
    }

    /// A pull to the stretch l that keeps the volume has `I1 - 3 = l^2 + 2/l - 3`.
    #[test]
    fn what_is_beyond_the_limit_is_refused_in_either_precision() {
        let law = of(1200.0, 2.0, 0.45);
        let pulled = |l: f64| {
            let mut h = Tensor::diagonal(1.0 / l.sqrt() - 1.0);
            h.0[2][2] = l - 1.0;
            h
        };
        for (l, is_admitted) in [(1.9, true), (1.99, true), (2.01, false), (3.0, false)] {
            let at = law.at(pulled(l));
            assert_eq!(law.admits(&at), is_admitted, "{l}");
            let single = law.at(Tensor::<f32>::of(pulled(l).0));
            assert_eq!(law.admits(&single), is_admitted, "{l} in f32");
        }
    }
}
