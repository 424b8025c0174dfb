//! A method that a search may choose.

use serde::{Deserialize, Serialize};
use sinew_core::{Accuracy, StableStep};
use sinew_scene::Simulation;

use crate::method_choice::{MethodChoice, MethodError};

/// A method with the properties that its search needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The method.
    pub method: MethodChoice,
    /// The largest step (s) at which it is stable; infinite if it is always stable or cannot compute the step, 0 if it
    /// is never stable.
    pub stable_step: f64,
    /// True if the method can compute that step.
    pub stable_step_is_known: bool,
    /// The highest order it declares; none if the method is exact at any step.
    pub order: Option<u8>,
    /// True if its set-up factorises a matrix, which on a large mesh costs more than many runs.
    pub factorises: bool,
}

impl Candidate {
    /// A method on a scene.
    ///
    /// # Errors
    /// [`MethodError`] when its options do not fit or the system lacks a needed property.
    pub fn of(simulation: &Simulation, method: MethodChoice) -> Result<Self, MethodError> {
        let integrator = method.build()?;
        let stable_step = integrator.stable_step(simulation.system())?;
        let order = match integrator.properties().accuracy {
            Accuracy::Exact => None,
            accuracy => accuracy.order(false).max(accuracy.order(true)),
        };
        Ok(Self {
            stable_step_is_known: stable_step != StableStep::Unknown,
            stable_step: match stable_step {
                StableStep::UpTo(limit) => limit,
                StableStep::Any | StableStep::Unknown => f64::INFINITY,
            },
            order,
            factorises: sinew_integrators::entry(&method.integrator)
                .is_some_and(|entry| entry.factorises),
            method,
        })
    }

    /// True if a step (s) is no longer than the longest stable one.
    pub(crate) fn allows(&self, dt: f64) -> bool {
        // As much more as steps of a search may be.
        dt <= self.stable_step * (1.0 + 1e-9)
    }
}
