//! Tolerance and iteration limit of Newton's method.

use sinew_core::{OptionError, OptionValue, Options};

use super::factor_use::FactorUse;
use crate::{OptionDefault, OptionHelp, OptionKind};

/// Largest iteration limit that can be requested.
const MOST: u32 = 1000;

/// Tolerance, iteration limit and solver of Newton's method on nonlinear systems; linear ones take one solution with a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// The acceleration of the residual force, over the largest of the accelerations that balance each other: elastic
    /// forces over masses, or inertia. All are root mean squares weighted by mass.
    pub tolerance: f64,
    /// Iterations of a step after which it counts as not converged.
    pub most_iterations: u32,
    /// Solver of the linear equations of an iteration.
    pub factor: FactorUse,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            most_iterations: 50,
            factor: FactorUse::Auto,
        }
    }
}

/// Help of the tolerance.
pub(in crate::implicit) const TOLERANCE: OptionHelp = OptionHelp {
    key: "newton_tolerance",
    help: "for nonlinear laws: what may stay unbalanced in a step, as a share of the forces, both divided by the masses",
    expected: "a number above 0 and below 1",
    kind: OptionKind::PART,
    default: OptionDefault::Value("1e-6"),
    example: "newton_tolerance = 1e-8",
    shown_default: None,
};

/// Help of the iteration limit.
pub(in crate::implicit) const ITERATIONS: OptionHelp = OptionHelp {
    key: "newton_iterations",
    help: "for nonlinear laws: iterations after which a step counts as not converged",
    expected: "a whole number from 1 to 1000",
    kind: OptionKind::Count(MOST),
    default: OptionDefault::Value("50"),
    example: "newton_iterations = 100",
    shown_default: None,
};

impl NewtonSettings {
    /// Reads the options of an integrator.
    ///
    /// # Errors
    /// [`OptionError`] for a value that does not fit.
    pub(in crate::implicit) fn from_options(
        options: &Options,
        integrator: &str,
    ) -> Result<Self, OptionError> {
        let default = Self::default();
        let most = ITERATIONS.read(options, integrator, |value| OptionValue::count(value, MOST))?;
        Ok(Self {
            tolerance: TOLERANCE
                .number(options, integrator)?
                .unwrap_or(default.tolerance),
            most_iterations: most.unwrap_or(default.most_iterations),
            factor: FactorUse::from_options(options, integrator)?,
        })
    }
}
