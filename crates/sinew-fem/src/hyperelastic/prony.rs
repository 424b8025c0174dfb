//! Linear viscoelasticity at large deformation, by a Prony series.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::parameters::{ParameterError, within};
use super::tensor::Tensor;

/// A symmetric tensor: xx, yy, zz, xy, yz, zx.
pub type Symmetric<N> = [N; 6];

/// A part of the stress that relaxes: `S = (1 - sum g) S0 + sum h_i`, S0 being the second Piola-Kirchhoff stress (Pa)
/// of the elastic law and each h_i the history variable of a term, `h_i' = g_i S0' - h_i/tau_i` (Simo, Computer Methods
/// in Applied Mechanics and Engineering 60, 1987).
///
/// Its history variables are S0 and h of the last step, six numbers each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// g: the share of the instantaneous stress that relaxes.
    pub share: f64,
    /// tau: the time in which it falls to 1/e (s).
    pub time: f64,
}

/// Coefficients of a term over one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TermStep {
    /// `e^-x`, x = dt/tau.
    decay: f64,
    /// `g (1 - e^-x)/x`.
    gain: f64,
}

/// Refuses terms outside their ranges.
///
/// # Errors
///
/// [`ParameterError`] if a share or a time is not above 0, or if no stress would remain.
pub fn check(terms: &[Term]) -> Result<(), ParameterError> {
    for term in terms {
        let expected = "a finite number above 0";
        within("share", term.share, expected, term.share > 0.0)?;
        within(
            "time",
            term.time,
            "a finite time above 0 s",
            term.time > 0.0,
        )?;
    }
    let sum = relaxing(terms);
    within("sum of shares", sum, "a sum below 1", sum < 1.0)
}

/// The share of the instantaneous stress that relaxes: sum g.
#[must_use]
pub fn relaxing(terms: &[Term]) -> f64 {
    terms.iter().map(|term| term.share).sum()
}

/// The factor from long-term moduli to the instantaneous ones that laws use.
#[must_use]
pub(crate) fn instantaneous_over_longterm(terms: &[Term]) -> f64 {
    1.0 / (1.0 - relaxing(terms))
}

impl Term {
    /// The coefficients of the term over a step of dt (s), 0 or above; after an infinite step h is 0.
    #[must_use]
    pub fn over(&self, dt: f64) -> TermStep {
        let x = dt / self.time;
        let lost = -(-x).exp_m1();
        let mean = if x > 0.0 { lost / x } else { 1.0 };
        TermStep {
            decay: (-x).exp(),
            gain: self.share * mean,
        }
    }

    /// The history variable h after an instantaneous change of S0. A step of finite length would lose a part of it.
    #[inline(always)]
    #[must_use]
    pub fn jump<N: Number>(&self, memory: Symmetric<N>, change: Symmetric<N>) -> Symmetric<N> {
        let share = N::of(self.share);
        plus(memory, share, change)
    }
}

impl TermStep {
    /// `e^-x`, x = dt/tau: the factor by which h decays in a step.
    #[inline(always)]
    #[must_use]
    pub fn decay(&self) -> f64 {
        self.decay
    }

    /// `g (1 - e^-x)/x`: the share of a change of S0 that is added to h.
    #[inline(always)]
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// The history variable h after the step, from h before it and the change of S0 over it: exact if S0 is linear in
    /// time over the step (Taylor, Pister and Goudreau, International Journal for Numerical Methods in Engineering 2,
    /// 1970).
    #[inline(always)]
    #[must_use]
    pub fn next<N: Number>(&self, memory: Symmetric<N>, change: Symmetric<N>) -> Symmetric<N> {
        let decay = N::of(self.decay);
        plus(memory.map(|entry| entry * decay), N::of(self.gain), change)
    }
}

/// The stress: the long-term part of S0 plus h of all terms.
#[inline(always)]
#[must_use]
pub fn stress<N: Number>(
    terms: &[Term],
    instantaneous: Symmetric<N>,
    memories: &[Symmetric<N>],
) -> Symmetric<N> {
    let stays = N::of(1.0 - relaxing(terms));
    let mut stress = instantaneous.map(|entry| entry * stays);
    for &memory in memories {
        stress = plus(stress, N::of(1.0), memory);
    }
    stress
}

/// The derivative of the stress by S0 at the end of a step.
#[must_use]
pub fn tangent_factor(terms: &[Term], dt: f64) -> f64 {
    let gains: f64 = terms.iter().map(|term| term.over(dt).gain).sum();
    1.0 - relaxing(terms) + gains
}

/// The second Piola-Kirchhoff stress `F^-1 P` of a first one; J must not be 0.
#[inline(always)]
#[must_use]
pub fn second_piola<N: Number>(deformation: &Deformation<N>, first: Tensor<N>) -> Symmetric<N> {
    let over = deformation.volume_ratio.recip();
    let second = deformation.cofactor.transposed_times(first).scaled(over);
    let [[xx, xy, zx], [_, yy, yz], [.., zz]] = second.0;
    [xx, yy, zz, xy, yz, zx]
}

/// The first Piola-Kirchhoff stress `F S` of a second one.
#[inline(always)]
#[must_use]
pub fn first_piola<N: Number>(deformation: &Deformation<N>, second: Symmetric<N>) -> Tensor<N> {
    let [xx, yy, zz, xy, yz, zx] = second;
    deformation.gradient * Tensor([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
}

/// The deviatoric part `P - (P : F)/(3 J) c` of a first Piola-Kirchhoff stress, whose Cauchy stress has no pressure: that of the invariants without change of volume, for
/// laws that have such a part. It relaxes alone if only the deviatoric part is viscous.
#[inline(always)]
#[must_use]
pub fn deviatoric<N: Number>(deformation: &Deformation<N>, stress: Tensor<N>) -> Tensor<N> {
    let work = stress.contracted(deformation.gradient);
    let share = N::of(-1.0 / 3.0) * work / deformation.volume_ratio;
    stress.plus(share, deformation.cofactor)
}

#[inline(always)]
fn plus<N: Number>(a: Symmetric<N>, factor: N, b: Symmetric<N>) -> Symmetric<N> {
    let entry = |i: usize| b[i].mul_add(factor, a[i]);
    [entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::law::HyperelasticLaw;
    use crate::hyperelastic::{MooneyRivlin, NeoHookeanIso, Parameters, sample_deformations};

    #[test]
    fn second_stresses_go_back_to_first_ones() {
        let law = NeoHookeanIso::new(&Parameters::new(3500.0, 0.45)).unwrap();
        for [h, _] in sample_deformations(law).take(50) {
            let at = law.at(h);
            let stress = law.stress_with(&at, law.own_bulk(&at));
            let again = first_piola(&at, second_piola(&at, stress));
            assert!((again - stress).largest() < 1e-12 * stress.largest());
        }
    }

    #[test]
    fn the_deviatoric_stress_of_split_laws_is_that_without_their_volumetric_energy() {
        let parameters = Parameters::new(3500.0, 0.45).with("c1_over_c2", &[4.0]);
        let law = MooneyRivlin::new(&parameters).unwrap();
        let (lambda, mu) = law.lame();
        for [h, _] in sample_deformations(law).take(50) {
            let at = law.at(h);
            let stress = law.stress_with(&at, law.own_bulk(&at));
            let pressure = (lambda + 2.0 / 3.0 * mu) * at.volume_change;
            let expected = stress.plus(-pressure, at.cofactor);
            let size = stress.largest() + pressure.abs() * at.cofactor.largest();
            let found = deviatoric(&at, stress);
            assert!((found - expected).largest() < 1e-13 * size);
        }
    }

    #[test]
    fn terms_outside_their_ranges_are_refused_by_name() {
        let said = |pairs: &[(f64, f64)]| {
            let terms: Vec<Term> = pairs
                .iter()
                .map(|&(share, time)| Term { share, time })
                .collect();
            check(&terms).unwrap_err().to_string()
        };
        assert!(said(&[(0.0, 1.0)]).starts_with("share = 0"));
        assert!(said(&[(0.1, -1.0)]).starts_with("time = -1"));
        assert!(said(&[(0.5, 1.0), (0.5, 2.0)]).starts_with("sum of shares = 1"));
        assert_eq!(check(&[]), Ok(()));
    }

    #[test]
    fn a_step_of_no_time_is_a_jump() {
        let term = Term {
            share: 0.3,
            time: 0.05,
        };
        let (memory, change) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.5; 6]);
        assert_eq!(
            term.over(0.0).next(memory, change),
            term.jump(memory, change)
        );
    }
}
