//! The law of Demiray.

use sinew_fem::hyperelastic::{
    Deformation, HyperelasticLaw, LawParameter, LawValues, ParameterError, Point, Range, Tensor,
};
use sinew_sparse::simd::Number;

/// `psi = mu/(2 b) (exp(b (I1 - 3)) - 1) - mu ln J + (lambda/2 - b mu) (J - 1)^2` (Demiray, Journal of Biomechanics 5, 1972,
/// with the volume terms of Simo and Pister, so that lambda and mu are those at small strain): tissue that stiffens
/// exponentially. The term with lambda is added by the loops. Refused at J <= 0.
#[derive(Clone, Copy, Debug)]
pub struct Demiray {
    lambda: f64,
    mu: f64,
    b: f64,
}

const B: LawParameter = LawParameter::number(
    "stiffening",
    "b",
    "The exponent b of exp(b (I1 - 3)): with 0 the law would be neo-Hookean.",
    Range::above_zero("a finite number above 0"),
    &[0.5],
);

impl HyperelasticLaw for Demiray {
    const ID: &'static str = "demiray";
    const MEANING: &'static str = "stiffens exponentially";
    const PARAMETERS: &'static [LawParameter] = &[
        LawParameter::YOUNGS_MODULUS,
        LawParameter::POISSONS_RATIO,
        B,
    ];
    const DEFINED_WHEN_INVERTED: bool = false;

    /// `exp(b (I1 - 3))`.
    type Own<N: Number> = N;

    fn from_values(values: &LawValues<'_>) -> Result<Self, ParameterError> {
        let (lambda, mu) = values.lame();
        let b = values.number(&B);
        Ok(Self { lambda, mu, b })
    }

    fn lame(&self) -> (f64, f64) {
        (self.lambda, self.mu)
    }

    #[inline(always)]
    fn own<N: Number>(&self, deformation: &Deformation<N>) -> N {
        (N::of(self.b) * deformation.first_invariant_change()).exp()
    }

    #[inline(always)]
    fn energy<N: Number>(&self, at: &Point<N, N>) -> N {
        let grown = (N::of(self.b) * at.first_invariant_change()).exp_m1();
        let change = at.volume_change;
        N::of(self.mu)
            * (N::of(0.5 / self.b) * grown - change.ln_1p() - N::of(self.b) * change * change)
    }

    /// `mu (exp F - c/J - 2 b (J - 1) c)`, by parts that are small near rest.
    #[inline(always)]
    fn stress<N: Number>(&self, at: &Point<N, N>) -> Tensor<N> {
        let grown = (N::of(self.b) * at.first_invariant_change()).exp_m1();
        let share = at.volume_change / at.volume_ratio - N::of(2.0 * self.b) * at.volume_change;
        let stress = at
            .distortion
            .plus(grown, at.gradient)
            .plus(share, at.cofactor);
        stress.scaled(N::of(self.mu))
    }

    #[inline(always)]
    fn tangent<N: Number>(&self, at: &Point<N, N>, change: Tensor<N>) -> Tensor<N> {
        let (over, twice) = (at.volume_ratio.recip(), N::of(2.0 * self.b));
        let along = twice * at.own * at.gradient.contracted(change);
        let changed = change.scaled(at.own).plus(along, at.gradient);
        let volume = (over * over - twice) * at.cofactor.contracted(change);
        let changed = changed
            .plus(-over - twice * at.volume_change, at.cofactor_change(change))
            .plus(volume, at.cofactor);
        changed.scaled(N::of(self.mu))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_fem::hyperelastic::{Parameters, conformance};

    #[test]
    fn the_suite_holds() {
        let parameters = Parameters::new(3500.0, 0.45).with("stiffening", &[0.5]);
        conformance::check(Demiray::new(&parameters).unwrap());
    }
}
