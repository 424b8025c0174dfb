//! Plans and advice, found in a thread of their own so that Ctrl-C works.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use serde_json::Value;
use sinew::cli::{PlanError, memory_of, plan_json};
use sinew_measure::advice::{Question, check_budget, check_pilot_seconds, check_tolerance};
use sinew_scene::Scene;

use crate::errors::{of_scene, value_error};
use crate::guard::guarded;

/// Time between two checks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// The question about a scene: error, cost and time (s) of pilots; `None` without error and cost.
pub(crate) fn question(
    tolerance: Option<f64>,
    budget: Option<f64>,
    seconds: f64,
) -> PyResult<Option<Question>> {
    let named = |name: &str, error: &dyn std::fmt::Display| value_error(format!("{name}: {error}"));
    if let Some(tolerance) = tolerance {
        check_tolerance(tolerance).map_err(|error| named("tolerance", &error))?;
    }
    if let Some(budget) = budget {
        check_budget(budget).map_err(|error| named("budget", &error))?;
    }
    check_pilot_seconds(seconds).map_err(|error| named("seconds", &error))?;
    let is_asked = tolerance.is_some() || budget.is_some();
    Ok(is_asked.then_some(Question {
        tolerance,
        budget,
        pilot_seconds: seconds,
        cost: sinew_measure::Cost::CpuTime,
    }))
}

/// The plan as one object. After a signal the thread is left to finish in the background.
pub(crate) fn planned(py: Python<'_>, scene: Scene, question: Option<Question>) -> PyResult<Value> {
    let (to, from) = channel();
    let work = move || {
        let planned =
            guarded(|| memory_of(&scene).within(|| plan_json(scene, question).map_err(of_plan)));
        // Nobody listens after a signal.
        let _ = to.send(planned);
    };
    let begun = thread::Builder::new().name("sinew plan".into()).spawn(work);
    begun.map_err(|error| PyMemoryError::new_err(error.to_string()))?;
    let mut from = from;
    loop {
        let heard;
        (heard, from) = py.detach(move || (from.recv_timeout(LOOK), from));
        match heard {
            Ok(planned) => return planned,
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => return Err(crate::guard::unusable()),
        }
    }
}

fn of_plan(error: PlanError) -> PyErr {
    match error {
        PlanError::Scene(error) => of_scene(&error),
        PlanError::Memory(text) => PyMemoryError::new_err(text),
        other => value_error(other.to_string().replace("--pilot-seconds", "seconds")),
    }
}
