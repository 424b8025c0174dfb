//! What a search may choose from.

use sinew_core::{Accuracy, StableStep};

use crate::case::Case;
use crate::measure::Method;

/// A method with what its search needs to know of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The method.
    pub method: Method,
    /// The largest step (s) at which it is stable; infinite where it always is or cannot say, 0
    /// where it never is.
    pub stable_step: f64,
    /// The highest order it declares; none where it is exact at any step.
    pub order: Option<u8>,
    /// An integrator whose set-up is a part of this one's.
    pub contains_setup_of: Option<&'static str>,
}

impl Candidate {
    /// A method on a case.
    ///
    /// # Errors
    /// A reason in words when its options do not fit or the system lacks what it needs.
    pub fn of(case: &Case, method: Method) -> Result<Self, String> {
        let integrator = sinew_integrators::build(&method.integrator, &method.options)
            .map_err(|error| error.to_string())?;
        let stable_step = integrator
            .stable_step(case.simulation().system())
            .map_err(|error| error.to_string())?;
        let order = match integrator.properties().accuracy {
            Accuracy::Exact => None,
            accuracy => accuracy.order(false).max(accuracy.order(true)),
        };
        Ok(Self {
            stable_step: match stable_step {
                StableStep::UpTo(limit) => limit,
                StableStep::Any | StableStep::Unknown => f64::INFINITY,
            },
            order,
            // Modes are found with a factor of K; Newmark's set-up is one of the same pattern.
            contains_setup_of: (method.integrator == "modal").then_some("newmark"),
            method,
        })
    }
}
