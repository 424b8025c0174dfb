//! The runs a search learns from.

use std::time::Duration;

use crate::case::Case;
use crate::cpu_time::thread_cpu_time;
use crate::measure::{Effort, Method, measure};
use crate::row::Row;

/// A run that was measured, with the method that made it.
#[derive(Clone, Debug, PartialEq)]
pub struct Pilot {
    /// The method.
    pub method: Method,
    /// What was measured.
    pub row: Row,
}

/// Measures runs.
pub trait Pilots {
    /// Measures a method in steps of `dt` (s).
    ///
    /// # Errors
    /// A reason in words when it cannot run so.
    fn measure(&mut self, method: &Method, dt: f64, effort: Effort) -> Result<Row, String>;

    /// CPU time (s) left for more.
    fn left(&self) -> f64 {
        f64::INFINITY
    }

    /// CPU time (s) below which no step of a method of some order stays.
    fn least_step_cpu_s(&self) -> f64 {
        0.0
    }
}

/// Pilots on a case, until some CPU time of this thread.
#[derive(Debug)]
pub struct CasePilots<'a> {
    case: &'a mut Case,
    until: Option<Duration>,
}

impl<'a> CasePilots<'a> {
    /// As many as are asked for.
    pub fn new(case: &'a mut Case) -> Self {
        Self { case, until: None }
    }

    /// Until this thread has used `until` of CPU time, by [`thread_cpu_time`].
    #[must_use]
    pub fn until(self, until: Duration) -> Self {
        Self {
            until: Some(until),
            ..self
        }
    }
}

impl Pilots for CasePilots<'_> {
    fn measure(&mut self, method: &Method, dt: f64, effort: Effort) -> Result<Row, String> {
        measure(self.case, method, dt, effort)
    }

    fn left(&self) -> f64 {
        self.until.map_or(f64::INFINITY, |until| {
            until.saturating_sub(thread_cpu_time()).as_secs_f64()
        })
    }

    /// A sweep of the reference also sums its series: half of it is no more than a sweep.
    fn least_step_cpu_s(&self) -> f64 {
        0.5 * self.case.reference_cpu_s() / self.case.samples().sweeps.max(1) as f64
    }
}
