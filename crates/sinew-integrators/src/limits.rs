//! Tools for the largest stable steps of explicit methods.
//!
//! With proportional damping every mode is q'' + d q' + w^2 q = 0 with d = alpha + beta w^2, and the fastest mode
//! decides. A separate damping matrix enters through its largest eigenvalue; the limits are then lower bounds.

use sinew_core::StableStep;
use sinew_core::spectrum::Spectrum;

/// The root h of `4 - 2 d h - w^2 h^2`, d being the damping that enters with the old velocity.
pub(crate) fn lagged(w: f64, d: f64) -> f64 {
    // The rationalised form holds for w = 0 too.
    4.0 / (d + (d * d + 4.0 * w * w).sqrt())
}

/// Largest radius of a disc whose left half lies in the stability regions of all one-step methods used here.
const HALF_DISC: f64 = 2.6;

/// The limit of a one-step method with the stability polynomial `1 + c_1 z + c_2 z^2 + ..`: the step at
/// which the ray of some mode leaves the region `|polynomial| <= 1`. The region must contain the left half of the
/// disc of radius 2.6.
pub(crate) fn within_region_of(polynomial: &[f64], spectrum: &Spectrum) -> StableStep {
    if !spectrum.proportional {
        // A mode x has lambda^2 + d_x lambda + w_x^2 = 0 with Rayleigh quotients d_x and w_x^2, so
        // that |lambda|^2 <= d |lambda| + w^2.
        let d = spectrum.mass_damping + spectrum.damping_max;
        let radius = d / 2.0 + ((d / 2.0).powi(2) + spectrum.omega_max.powi(2)).sqrt();
        return StableStep::UpTo(HALF_DISC / radius);
    }
    let modes = 400;
    let limits = (0..=modes).map(|mode| {
        let w = spectrum.omega_max * f64::from(mode) / f64::from(modes);
        let d = spectrum.mass_damping + spectrum.stiffness_damping * w * w;
        ray_limit(polynomial, w, d)
    });
    StableStep::UpTo(limits.fold(f64::INFINITY, f64::min))
}

/// The step at which a mode's faster root leaves the region.
fn ray_limit(polynomial: &[f64], w: f64, d: f64) -> f64 {
    let half = d / 2.0;
    let beyond = half * half - w * w;
    let (re, im) = if beyond > 0.0 {
        (-half - beyond.sqrt(), 0.0)
    } else {
        (-half, (-beyond).sqrt())
    };
    let size = re.hypot(im);
    if size == 0.0 {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (2.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if amplification(polynomial, re / size * middle, im / size * middle) <= 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low / size
}

/// `|polynomial|` at x + i y, by Horner's rule.
fn amplification(polynomial: &[f64], x: f64, y: f64) -> f64 {
    let (mut p, mut q) = (0.0, 0.0);
    for coefficient in polynomial.iter().rev() {
        (p, q) = (coefficient + x * p - y * q, x * q + y * p);
    }
    f64::hypot(p, q)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use sinew_core::{
        BlockMatrix, Damping, Layers, LinearModel, LinearOperators, LinearSystem, Pattern,
    };

    use super::*;
    use crate::Explicit;
    use crate::explicit::{CentralDifference, ForwardEuler, SymplecticEuler};

    const RK4: [f64; 5] = [1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0];

    fn paper_oscillator() -> LinearModel {
        LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap())
    }

    #[test]
    fn limits_of_the_papers_oscillator() {
        let spectrum = Spectrum::of(paper_oscillator().operators());
        let limit = |of: &dyn Fn(&Spectrum) -> StableStep| match of(&spectrum) {
            StableStep::UpTo(limit) => limit,
            other => panic!("{other:?}"),
        };
        assert!((limit(&|s| ForwardEuler.stable_step(s)) - 0.01).abs() < 1e-9);
        assert!((limit(&|s| SymplecticEuler.stable_step(s)) - 0.0540).abs() < 5e-5);
        assert!((limit(&|s| CentralDifference.stable_step(s)) - 0.0632).abs() < 5e-5);
    }

    /// Two masses between walls with a dashpot between them: forward Euler is stable up to some step or none, depending
    /// on the mode on which the dashpot does not act.
    #[test]
    fn forward_euler_does_not_guess_what_dashpots_do() {
        let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]]).unwrap());
        let matrix = |entries: [f64; 4]| {
            let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
            matrix.add_element(&[0, 1], &entries).unwrap();
            matrix
        };
        let limit = |mass_damping: f64| {
            let damping = Damping {
                mass: mass_damping,
                stiffness: 0.0,
                extra: Some(Arc::new(matrix([1.0, -1.0, -1.0, 1.0]))),
            };
            let stiffness = matrix([200.0, -100.0, -100.0, 200.0]);
            let operators = LinearOperators::new(vec![1.0; 2], stiffness, damping, vec![]);
            ForwardEuler.stable_step(&Spectrum::of(&operators.unwrap()))
        };
        assert_eq!(limit(0.0), StableStep::Unknown);
        assert!(matches!(limit(1.0), StableStep::UpTo(limit) if limit > 0.0));
    }

    #[test]
    fn rk4_holds_the_half_disc_used_without_modes() {
        for step in 0..=90 {
            let angle = std::f64::consts::FRAC_PI_2 * (1.0 + f64::from(step) / 90.0);
            let (x, y) = (2.6 * angle.cos(), 2.6 * angle.sin());
            assert!(amplification(&RK4, x, y) <= 1.0, "at {step} degrees");
        }
    }

    #[test]
    fn rk4_leaves_its_region_where_the_textbooks_say() {
        assert!((ray_limit(&RK4, 1.0, 0.0) - 8.0_f64.sqrt()).abs() < 1e-9);
        assert!((ray_limit(&RK4, 0.0, 1.0) - 2.785_293_563).abs() < 1e-8);
    }
}
