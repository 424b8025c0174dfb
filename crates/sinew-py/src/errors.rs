//! Exceptions.

use std::fmt::Display;

use pyo3::create_exception;
use pyo3::exceptions::{PyKeyError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use sinew_record::RecordRunError;
use sinew_world::{
    AdvanceError, AdvanceToError, CommandError, ReportError, WorldError, WorldStepError,
};

create_exception!(
    sinew_sim,
    SceneError,
    PyValueError,
    "A scene, or a file that it reads, cannot be used. Its text is that of the command. \
     Attributes: file (str), line and column (int from 1, or None), hint (str or None)."
);
create_exception!(
    sinew_sim,
    Diverged,
    PyRuntimeError,
    "The motion diverged. Attributes: t (s), place (str: the node that went farthest)."
);
create_exception!(
    sinew_sim,
    Refused,
    PyRuntimeError,
    "A step cannot be taken: a law refuses a state, or a method finds no solution. \
     Attributes: t (s), place (str: the element or node and the reason)."
);
create_exception!(
    sinew_sim,
    InternalError,
    PyRuntimeError,
    "A fault of sinew_sim itself; please report it."
);

/// The exception of a scene that cannot be used.
pub(crate) fn of_scene(error: &sinew_scene::SceneError) -> PyErr {
    Python::attach(|py| {
        let raised = SceneError::new_err(error.to_string());
        let value = raised.value(py);
        let set = || {
            // A scene of values names the key, and has no file.
            let has_file = !error.is_of_values();
            let file = has_file.then(|| error.path().display().to_string());
            value.setattr("file", file)?;
            value.setattr("line", error.line().filter(|_| has_file))?;
            value.setattr("column", error.column().filter(|_| has_file))?;
            value.setattr("hint", error.help())
        };
        set().err().unwrap_or(raised)
    })
}

/// The exception of a scene whose error has no line.
pub(crate) fn scene_error(error: &impl Display) -> PyErr {
    Python::attach(|py| {
        let raised = SceneError::new_err(error.to_string());
        let value = raised.value(py);
        let set = || {
            for name in ["file", "line", "column", "hint"] {
                value.setattr(name, py.None())?;
            }
            Ok(())
        };
        set().err().unwrap_or(raised)
    })
}

pub(crate) fn of_world(error: WorldError) -> PyErr {
    match error {
        WorldError::Scene(error) => of_scene(&error),
        other => scene_error(&other),
    }
}

/// The exception of a step that failed at a time (s).
pub(crate) fn of_step(error: &WorldStepError, t: f64) -> PyErr {
    let place = match error {
        WorldStepError::Diverged { place, .. } => place.clone(),
        other => other.to_string(),
    };
    let raised = match error {
        WorldStepError::Diverged { .. } => Diverged::new_err(error.to_string()),
        _ => Refused::new_err(error.to_string()),
    };
    Python::attach(|py| {
        let value = raised.value(py);
        let set = || {
            value.setattr("t", t)?;
            value.setattr("place", place)
        };
        set().err().unwrap_or(raised)
    })
}

pub(crate) fn of_advance(error: AdvanceError, t: f64) -> PyErr {
    match error {
        AdvanceError::Step(error) => of_step(&error, t),
        AdvanceError::Record(error) => PyRuntimeError::new_err(error.to_string()),
    }
}

pub(crate) fn of_advance_to(error: AdvanceToError, t: f64) -> PyErr {
    match error {
        AdvanceToError::Advance(error) => of_advance(error, t),
        AdvanceToError::Shorten(error) => of_command(error),
        error @ AdvanceToError::Time { .. } => PyValueError::new_err(error.to_string()),
    }
}

/// The exception for a refused command; the session continues as before.
pub(crate) fn of_command(error: CommandError) -> PyErr {
    match error {
        CommandError::NoTool { .. } | CommandError::NoLoad { .. } => {
            PyKeyError::new_err(error.to_string())
        }
        CommandError::Failed => {
            PyRuntimeError::new_err("the last step failed: call `reset` or `restore` to continue")
        }
        other => PyValueError::new_err(other.to_string()),
    }
}

pub(crate) fn of_report(error: ReportError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

pub(crate) fn of_run(error: RecordRunError) -> PyErr {
    match error {
        RecordRunError::Scene(error) => of_scene(&error),
        other => PyOSError::new_err(
            other
                .to_string()
                .replace("`sinew run --again`", "again=True"),
        ),
    }
}

/// An exception for an invalid value.
pub(crate) fn value_error(text: impl Into<String>) -> PyErr {
    PyValueError::new_err(text.into())
}
