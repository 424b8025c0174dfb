//! Largest stable steps of the explicit methods.
//!
//! With proportional damping every mode is q'' + d q' + w^2 q = 0 with d = alpha + beta w^2, and
//! the fastest mode decides. A damping matrix of its own enters through its largest eigenvalue;
//! the limits are then lower bounds.

use sinew_core::spectrum::Spectrum;
use sinew_core::{SetupError, StableStep, System};

/// `2 zeta/w = beta + alpha/w^2` where the fastest mode swings, `2/|lambda|` where it creeps; slow
/// modes under mass damping creep with roots up to alpha.
pub(crate) fn forward_euler(
    integrator: &'static str,
    system: &dyn System,
) -> Result<StableStep, SetupError> {
    let spectrum = Spectrum::of_system(system, integrator)?;
    let (w2, alpha) = (spectrum.omega_max.powi(2), spectrum.mass_damping);
    let d = alpha + spectrum.damping_max;
    let swinging = spectrum.stiffness_damping + alpha / w2;
    let fastest = match (d / 2.0).powi(2) - w2 {
        _ if !spectrum.proportional => swinging.min(2.0 / d),
        creeping if creeping >= 0.0 => 2.0 / (d / 2.0 + creeping.sqrt()),
        _ => swinging,
    };
    let limit = fastest.min(2.0 / alpha);
    // Dashpots alone may or may not damp every mode; their largest eigenvalue does not tell.
    if limit == 0.0 && !spectrum.proportional {
        return Ok(StableStep::Unknown);
    }
    Ok(StableStep::UpTo(limit))
}

/// The root h of `4 - 2 d h - w^2 h^2`, d being the damping that enters with the old velocity.
pub(crate) fn lagged(w: f64, d: f64) -> f64 {
    // The rationalised form holds for w = 0 too.
    4.0 / (d + (d * d + 4.0 * w * w).sqrt())
}

pub(crate) fn symplectic_euler(
    integrator: &'static str,
    system: &dyn System,
) -> Result<StableStep, SetupError> {
    let spectrum = Spectrum::of_system(system, integrator)?;
    let d = spectrum.mass_damping + spectrum.damping_max;
    Ok(StableStep::UpTo(lagged(spectrum.omega_max, d)))
}

/// `2/w` with mass damping, which enters at the middle of the step.
pub(crate) fn central_difference(
    integrator: &'static str,
    system: &dyn System,
) -> Result<StableStep, SetupError> {
    let spectrum = Spectrum::of_system(system, integrator)?;
    Ok(StableStep::UpTo(lagged(
        spectrum.omega_max,
        spectrum.damping_max,
    )))
}

/// `sqrt 12/w` undamped: `dt^2 w^2 (1 - dt^2 w^2/12)` reaches its largest value, 3, at `dt^2 w^2 = 6`
/// and returns to 0 at 12. Lagging damping d takes from the room below 4 that is left at 6, and
/// beyond that from the step.
pub(crate) fn modified_leapfrog(
    integrator: &'static str,
    system: &dyn System,
) -> Result<StableStep, SetupError> {
    let spectrum = Spectrum::of_system(system, integrator)?;
    let (w, d) = (spectrum.omega_max, spectrum.damping_max);
    let limit = 12.0_f64.sqrt() / w;
    // Stable while 2 d h + max over modes of w^2 h^2 (1 - w^2 h^2/12) < 4: the product is at most 3,
    // and at most w^2 h^2.
    let with_damping = (1.0 / (2.0 * d)).max(lagged(w, d));
    Ok(StableStep::UpTo(limit.min(with_damping)))
}

/// `2 sqrt 2/w` on the imaginary axis, 2.785../|lambda| on the real one; between them the edge of
/// the region `|1 + z + z^2/2 + z^3/6 + z^4/24| <= 1` is found along the ray of each mode.
pub(crate) fn rk4(integrator: &'static str, system: &dyn System) -> Result<StableStep, SetupError> {
    let spectrum = Spectrum::of_system(system, integrator)?;
    if !spectrum.proportional {
        // A mode x has lambda^2 + d_x lambda + w_x^2 = 0 with Rayleigh quotients d_x and w_x^2, so
        // that |lambda|^2 <= d |lambda| + w^2; the region holds the left half of the disc of
        // radius 2.6.
        let d = spectrum.mass_damping + spectrum.damping_max;
        let radius = d / 2.0 + ((d / 2.0).powi(2) + spectrum.omega_max.powi(2)).sqrt();
        return Ok(StableStep::UpTo(2.6 / radius));
    }
    let modes = 400;
    let limit = (0..=modes)
        .map(|mode| {
            let w = spectrum.omega_max * f64::from(mode) / f64::from(modes);
            let d = spectrum.mass_damping + spectrum.stiffness_damping * w * w;
            ray_limit(w, d)
        })
        .fold(f64::INFINITY, f64::min);
    Ok(StableStep::UpTo(limit))
}

/// The step at which a mode's faster root leaves the region of RK4.
fn ray_limit(w: f64, d: f64) -> f64 {
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
        if rk4_amplification(re / size * middle, im / size * middle) <= 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low / size
}

/// `|1 + z (1 + z/2 (1 + z/3 (1 + z/4)))|` at z = x + i y.
fn rk4_amplification(x: f64, y: f64) -> f64 {
    let (mut p, mut q) = (1.0, 0.0);
    for k in [4.0, 3.0, 2.0, 1.0] {
        (p, q) = (1.0 + (x * p - y * q) / k, (x * q + y * p) / k);
    }
    f64::hypot(p, q)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use sinew_core::{BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Pattern};

    use super::*;

    fn paper_oscillator() -> LinearModel {
        LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap())
    }

    #[test]
    fn limits_of_the_papers_oscillator() {
        let limit = |of: fn(&'static str, &dyn System) -> Result<StableStep, SetupError>| match of(
            "test",
            &paper_oscillator(),
        )
        .unwrap()
        {
            StableStep::UpTo(limit) => limit,
            other => panic!("{other:?}"),
        };
        assert!((limit(forward_euler) - 0.01).abs() < 1e-9);
        assert!((limit(symplectic_euler) - 0.0540).abs() < 5e-5);
        assert!((limit(central_difference) - 0.0632).abs() < 5e-5);
    }

    /// Two masses between walls with a dashpot between them: forward Euler is stable up to some step
    /// or none, depending on the mode that the dashpot leaves alone.
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
            forward_euler("test", &LinearModel::new(operators.unwrap())).unwrap()
        };
        assert_eq!(limit(0.0), StableStep::Unknown);
        assert!(matches!(limit(1.0), StableStep::UpTo(limit) if limit > 0.0));
    }

    #[test]
    fn rk4_holds_the_half_disc_used_without_modes() {
        for step in 0..=90 {
            let angle = std::f64::consts::FRAC_PI_2 * (1.0 + f64::from(step) / 90.0);
            let (x, y) = (2.6 * angle.cos(), 2.6 * angle.sin());
            assert!(rk4_amplification(x, y) <= 1.0, "at {step} degrees");
        }
    }

    #[test]
    fn rk4_leaves_its_region_where_the_textbooks_say() {
        assert!((ray_limit(1.0, 0.0) - 8.0_f64.sqrt()).abs() < 1e-9);
        assert!((ray_limit(0.0, 1.0) - 2.785_293_563).abs() < 1e-8);
    }
}
