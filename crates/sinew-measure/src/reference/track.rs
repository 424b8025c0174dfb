//! A reference at the instants a comparison needs.

use sinew_core::vectors::largest;
use sinew_core::{State, System};

use super::peak::peak_between;

/// A reference solution at some instants, with the data of the whole run that verdicts need.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Instants (s).
    pub times: Vec<f64>,
    /// Displacement (m) at each instant.
    pub displacements: Vec<Vec<f64>>,
    /// The impulses (N s) until each instant of the objects in contact with the body, x, y, z of each; empty without
    /// contact.
    pub impulses: Vec<Vec<f64>>,
    /// Largest |component| (m) over the run.
    pub max_u: f64,
    /// Half the range (m) of the worst degree of freedom over the last fifth of the run.
    pub late_amplitude: f64,
    /// The reference's own estimate of its relative L2 error; see [`ReferenceMethod`].
    pub error: f64,
    /// Products with the matrices it took, the check included.
    pub sweeps: u64,
    /// The method by which it was solved.
    pub method: ReferenceMethod,
}

impl Track {
    /// Smallest relative error of a run that the reference can measure: for smaller errors it gives only this bound. 0
    /// for a reference that is exact to rounding.
    #[must_use]
    pub fn least_error(&self) -> f64 {
        match self.method {
            ReferenceMethod::Taylor => 0.0,
            ReferenceMethod::Faber | ReferenceMethod::Extrapolated { .. } => {
                TOLD_APART * self.error
            }
        }
    }
}

/// The method by which a reference was solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReferenceMethod {
    /// The Taylor series of the motion in time, to rounding; its error is the difference from the same series with
    /// steps of two thirds of the length.
    Taylor,
    /// Faber series of the exponential function in long steps; its error is the difference from the Taylor
    /// series over a fifth of the time, as if the rest were like it.
    Faber,
    /// A method in halved steps, extrapolated to steps of zero length; its error is the difference from another method,
    /// extrapolated too.
    Extrapolated {
        /// Id of the method.
        method: &'static str,
        /// Relative difference from the solution in the shortest steps.
        by_rule: f64,
    },
}

/// Reasons why there is no reference.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The system is not linear.
    #[error("a reference solution needs the matrices of a linear system")]
    NotLinear,
    /// A method's solutions do not converge for any of the tried steps.
    #[error("no reference solution: `{method}` does not converge in any of the steps tried")]
    NotConverged {
        /// Id of the method.
        method: &'static str,
    },
    /// Its own check failed.
    #[error(
        "the reference solution differs from its check by {error:.1e}, more than {allowed:.0e}; the scene moves too fast for its duration"
    )]
    Inaccurate {
        /// Relative L2 difference.
        error: f64,
        /// Largest difference allowed.
        allowed: f64,
    },
}

/// Smallest error of a run over the reference's own: even a tenth of it is then ten times larger.
pub(crate) const TOLD_APART: f64 = 100.0;

/// Running observations of a motion.
#[derive(Clone)]
pub(super) struct Sight<'a> {
    times: &'a [f64],
    pub(super) displacements: Vec<Vec<f64>>,
    pub(super) impulses: Vec<Vec<f64>>,
    before: State,
    max_u: f64,
    late: LateRange,
    late_from: f64,
}

impl<'a> Sight<'a> {
    pub(super) fn new(start: &State, times: &'a [f64]) -> Self {
        Self {
            times,
            displacements: Vec::with_capacity(times.len()),
            impulses: Vec::new(),
            before: start.clone(),
            max_u: largest(&start.u),
            late: LateRange::new(start.u.len()),
            late_from: 0.8 * times.last().copied().unwrap_or(0.0),
        }
    }

    /// Records the extremes of the motion since the last call.
    pub(super) fn pass(&mut self, state: &State) {
        let most = self.max_u.max(largest(&state.u));
        self.max_u = peak_between(&self.before, state, most);
        self.before.clone_from(state);
        if state.t() > self.late_from {
            self.late.include(&state.u);
        }
    }

    /// Stores the displacement at the next of the instants.
    pub(super) fn keep(&mut self, state: &State) {
        self.displacements.push(state.u.clone());
    }

    /// Stores the displacement and, with contact, the impulses until the next of the instants.
    pub(super) fn keep_of(&mut self, system: &dyn System, state: &State) {
        self.keep(state);
        if let Some(contact) = system.contact() {
            self.impulses.push(contact.impulses(state).into_flattened());
        }
    }

    pub(super) fn track(self, method: ReferenceMethod, error: f64, sweeps: u64) -> Track {
        Track {
            times: self.times.to_vec(),
            displacements: self.displacements,
            impulses: self.impulses,
            max_u: self.max_u,
            late_amplitude: self.late.amplitude(),
            error,
            sweeps,
            method,
        }
    }
}

/// Range of each degree of freedom over some states.
#[derive(Clone, Debug)]
pub(crate) struct LateRange {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl LateRange {
    pub(crate) fn new(dofs: usize) -> Self {
        Self {
            low: vec![f64::INFINITY; dofs],
            high: vec![f64::NEG_INFINITY; dofs],
        }
    }

    pub(crate) fn include(&mut self, u: &[f64]) {
        for ((low, high), u) in self.low.iter_mut().zip(&mut self.high).zip(u) {
            *low = low.min(*u);
            *high = high.max(*u);
        }
    }

    /// Half the range (m) of the worst degree of freedom; 0 before any state.
    pub(crate) fn amplitude(&self) -> f64 {
        let ranges = self
            .low
            .iter()
            .zip(&self.high)
            .map(|(low, high)| high - low);
        ranges.fold(0.0, f64::max) / 2.0
    }
}
