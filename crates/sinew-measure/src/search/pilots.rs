//! The runs from which a search learns.

use std::time::Duration;

use serde::{Deserialize, Serialize};
use sinew_core::{LinearSystem, LoadOverStep, OptionError, Ramp, Run};
use sinew_scene::{SceneModel, Simulation};

use crate::case::Case;
use crate::cost::Cost;
use crate::cpu_time::thread_cpu_time;
use crate::measure::{MeasureError, measure};
use crate::method_choice::MethodChoice;
use crate::row::Row;
use crate::timing::Effort;

/// A measured run, with its method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pilot {
    /// The method.
    pub method: MethodChoice,
    /// The measured row.
    pub row: Row,
}

/// Reasons why a pilot was not run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PilotError {
    /// The integrator is unknown, or its options do not fit.
    #[error(transparent)]
    Options(#[from] OptionError),
    /// The loads do not fit the step.
    #[error(transparent)]
    Loads(#[from] UnfitLoads),
    /// The loads fit no step that is worth a pilot.
    #[error("{0}, nor of a longer one that meets the instants of the error")]
    LoadsAtAnyStep(#[source] UnfitLoads),
    /// The run failed.
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

/// A load of the scene changes at a time when the method needs it constant.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a load changes at t = {instant} s of the scene, and is not {} of {dt} s", .needed.describe())]
pub struct UnfitLoads {
    /// The first instant (s) at which a load changes so.
    pub instant: f64,
    /// The behaviour of loads over each step that the method needs.
    pub needed: LoadOverStep,
    /// The step (s).
    pub dt: f64,
}

/// Measures runs.
pub trait Pilots {
    /// Measures a method in steps of `dt` (s).
    ///
    /// # Errors
    /// [`PilotError`] when it cannot run with this step.
    fn measure(
        &mut self,
        method: &MethodChoice,
        dt: f64,
        effort: Effort,
    ) -> Result<Row, PilotError>;

    /// The smallest number of parts of an interval (s) for which a method accepts the loads; its multiples are accepted
    /// as well.
    ///
    /// # Errors
    /// [`PilotError`] when the method accepts them at no step that is worth a pilot.
    fn parts_for_loads(&self, _method: &MethodChoice, _interval: f64) -> Result<u32, PilotError> {
        Ok(1)
    }

    /// CPU time (s) left for more.
    fn left(&self) -> f64 {
        f64::INFINITY
    }

    /// Minimum CPU time (s) of a step of a method of some order.
    fn least_step_cpu_s(&self) -> f64 {
        0.0
    }
}

/// Largest number of parts of an interval that are tried to meet the instants at which loads change.
const MOST_PARTS: u32 = 100;

/// Pilots on a case, until some CPU time of this thread. A run is refused if loads anywhere in the scene would end it
/// with an error.
#[derive(Debug)]
pub struct CasePilots<'a> {
    case: &'a mut Case,
    until: Option<Duration>,
    cost: Cost,
}

impl<'a> CasePilots<'a> {
    /// Unlimited pilots on a case.
    pub fn new(case: &'a mut Case) -> Self {
        Self {
            case,
            until: None,
            cost: Cost::default(),
        }
    }

    /// Limits the pilots to those begun before [`thread_cpu_time`] reaches `until`.
    #[must_use]
    pub fn until(self, until: Duration) -> Self {
        Self {
            until: Some(until),
            ..self
        }
    }

    /// Sets the measure of the cost of runs.
    #[must_use]
    pub fn charging(self, cost: Cost) -> Self {
        Self { cost, ..self }
    }
}

impl Pilots for CasePilots<'_> {
    fn measure(
        &mut self,
        method: &MethodChoice,
        dt: f64,
        effort: Effort,
    ) -> Result<Row, PilotError> {
        check_loads(self.case.simulation(), needed_of_loads(method)?, dt)?;
        Ok(self.cost.charged(measure(self.case, method, dt, effort)?))
    }

    fn parts_for_loads(&self, method: &MethodChoice, interval: f64) -> Result<u32, PilotError> {
        let needed = needed_of_loads(method)?;
        let mut parts = 1;
        loop {
            let dt = interval / f64::from(parts);
            match check_loads(self.case.simulation(), needed, dt) {
                Ok(()) => return Ok(parts),
                Err(unfit) if parts == MOST_PARTS => return Err(PilotError::LoadsAtAnyStep(unfit)),
                Err(_) => parts += 1,
            }
        }
    }

    fn left(&self) -> f64 {
        self.until.map_or(f64::INFINITY, |until| {
            until.saturating_sub(thread_cpu_time()).as_secs_f64()
        })
    }

    /// A sweep of the reference also sums its series: half of its time is no more than a plain sweep.
    fn least_step_cpu_s(&self) -> f64 {
        let sweeps = self.case.samples().sweeps.max(1);
        let sweep = 0.5 * self.case.reference_cpu_s() / sweeps as f64;
        self.cost.of_least_step(sweep)
    }
}

/// The behaviour of loads over each step that a method needs.
fn needed_of_loads(method: &MethodChoice) -> Result<LoadOverStep, OptionError> {
    Ok(method.build()?.properties().changing_loads.needed())
}

/// Refuses steps of `dt` (s) over which the loads of a scene do not meet a method's needs.
fn check_loads(simulation: &Simulation, needed: LoadOverStep, dt: f64) -> Result<(), UnfitLoads> {
    let end = Run::covering(simulation.settings().duration, dt).steps as f64 * dt;
    let broken = |ramp: &Ramp| needed.first_broken(ramp, 0.0, dt, end);
    match ramps(simulation).filter_map(broken).reduce(f64::min) {
        None => Ok(()),
        Some(instant) => Err(UnfitLoads {
            instant,
            needed,
            dt,
        }),
    }
}

/// The loads of a scene over time.
pub(crate) fn ramps(simulation: &Simulation) -> impl Iterator<Item = &Ramp> {
    let (loads, moves) = match simulation.model() {
        SceneModel::Oscillator(model) => (model.operators().loads(), &[][..]),
        SceneModel::Body(body) => (
            body.model.operators().loads(),
            body.problem.moves.as_slice(),
        ),
    };
    let courses = moves.iter().flat_map(|moving| &moving.courses);
    let loads = loads.iter().map(|load| &load.ramp);
    loads.chain(courses.map(|course| &course.ramp))
}
