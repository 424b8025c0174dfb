//! Integrators that may have a program.

use sinew_cnn::Program;
use sinew_core::spectrum::Spectrum;
use sinew_core::{Integrator, StableStep};

use crate::numerical_dissipation::NumericalDissipation;

/// An integrator that may have a program.
pub trait Stepper: Integrator {
    /// The program of a step as set-up made it; `None` before set-up and if no program of sweeps
    /// expresses the method.
    fn program(&self) -> Option<Program> {
        None
    }

    /// The energy that it dissipates numerically from a linear system, if a closed form exists.
    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        None
    }

    /// The largest step at which it is stable if these are the fastest motions.
    fn stable_step_of(&self, _spectrum: &Spectrum) -> StableStep {
        StableStep::Unknown
    }

    /// Divides each automatic substep into `_times` substeps from now on; returns false if steps are as long as its
    /// caller asks for, or are divided into a given number of substeps. A comparison of a run with one of shorter steps
    /// needs this function, because halving a step that is divided in two gives the same substeps.
    fn refine(&mut self, _times: u32) -> bool {
        false
    }

    /// Machine that computes its steps, and the resulting error, one sentence each; empty before set-up and for steps
    /// that do not run on a machine.
    fn computed_by(&self) -> Vec<String> {
        Vec::new()
    }

    /// Reason why there is no program, if set-up made none.
    fn without_program(&self) -> &'static str {
        "its steps are not sweeps with coefficients that are known beforehand"
    }
}
