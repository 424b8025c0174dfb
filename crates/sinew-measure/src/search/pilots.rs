//! The runs a search learns from.

use std::time::Duration;

use sinew_core::{LinearSystem, LoadOverStep, Ramp, Run};
use sinew_scene::Simulation;

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

    /// The fewest parts of an interval (s), whose multiples serve as well, at which a method takes
    /// the loads.
    ///
    /// # Errors
    /// A reason in words when it takes them at no step that is worth a pilot.
    fn parts_for_loads(&self, _method: &Method, _interval: f64) -> Result<u32, String> {
        Ok(1)
    }

    /// CPU time (s) left for more.
    fn left(&self) -> f64 {
        f64::INFINITY
    }

    /// CPU time (s) below which no step of a method of some order stays.
    fn least_step_cpu_s(&self) -> f64 {
        0.0
    }
}

/// Most parts of an interval that are tried to meet the instants at which loads change.
const MOST_PARTS: u32 = 100;

/// Pilots on a case, until some CPU time of this thread. A run that the loads of the whole scene
/// would end with an error is refused, wherever in the scene that is.
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
        check_loads(self.case.simulation(), needed_of_loads(method)?, dt)?;
        measure(self.case, method, dt, effort)
    }

    fn parts_for_loads(&self, method: &Method, interval: f64) -> Result<u32, String> {
        let needed = needed_of_loads(method)?;
        let mut refused = String::new();
        for parts in 1..=MOST_PARTS {
            let dt = interval / f64::from(parts);
            match check_loads(self.case.simulation(), needed, dt) {
                Ok(()) => return Ok(parts),
                Err(reason) => refused = reason,
            }
        }
        Err(format!(
            "{refused}, nor of a longer one that meets the instants of the error"
        ))
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

/// What a method needs loads to be over each step.
fn needed_of_loads(method: &Method) -> Result<LoadOverStep, String> {
    let integrator = sinew_integrators::build(&method.integrator, &method.options)
        .map_err(|error| error.to_string())?;
    Ok(integrator.properties().changing_loads.needed())
}

/// Refuses steps of `dt` (s) over which the loads of a scene are not what a method needs.
fn check_loads(simulation: &Simulation, needed: LoadOverStep, dt: f64) -> Result<(), String> {
    let end = Run::covering(simulation.settings().duration, dt).steps as f64 * dt;
    let broken = |ramp: &Ramp| needed.first_broken(ramp, 0.0, dt, end);
    match ramps(simulation).filter_map(broken).reduce(f64::min) {
        None => Ok(()),
        Some(instant) => Err(format!(
            "a load changes at t = {instant} s of the scene, and is not {} of {dt} s",
            needed.describe()
        )),
    }
}

/// The loads of a scene over time.
pub(crate) fn ramps(simulation: &Simulation) -> impl Iterator<Item = &Ramp> {
    let operators = simulation.system().as_linear().map(LinearSystem::operators);
    let loads = operators.map_or(&[][..], |operators| operators.loads());
    loads.iter().map(|load| &load.ramp)
}
