//! Integrators that may have a program.

use sinew_cnn::Program;
use sinew_core::Integrator;

use crate::numerical_dissipation::NumericalDissipation;

/// An integrator that may have a program.
pub trait Stepper: Integrator {
    /// The program of a step as set-up made it; `None` before set-up and where no program of sweeps
    /// expresses the method.
    fn program(&self) -> Option<Program> {
        None
    }

    /// The energy that it takes by itself from a linear system, where there is a closed form.
    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        None
    }

    /// What computes its steps, and what that costs in error, one sentence each; empty before set-up and
    /// for steps that no machine takes.
    fn computed_by(&self) -> Vec<String> {
        Vec::new()
    }

    /// Reason why there is no program, where set-up made none.
    fn without_program(&self) -> &'static str {
        "its steps are not sweeps with coefficients that are known beforehand"
    }
}
