//! Supervision of steps for Python: Ctrl-C ends them in an orderly way.

use std::time::{Duration, Instant};

use pyo3::prelude::*;
use sinew_core::{Moment, RecordError, Verdict};
use sinew_record::{Companion, Pace};
use sinew_world::Recorder;

/// Checks for signals several times a second.
pub(crate) struct Watch {
    pace: Pace,
    /// The exception that ended the steps.
    pub(crate) raised: Option<PyErr>,
}

impl Watch {
    pub(crate) fn new() -> Self {
        Self {
            pace: Pace::new(0),
            raised: None,
        }
    }

    fn look(&mut self) -> Verdict {
        let looked = Python::attach(|py| -> PyResult<()> {
            py.check_signals()?;
            Ok(())
        });
        match looked {
            Ok(()) => Verdict::Continue,
            Err(error) => {
                self.raised = Some(error);
                Verdict::Stop
            }
        }
    }
}

impl sinew_core::Recorder for Watch {
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(self.pace.next().max(step))
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self.pace.look(moment.step);
        Ok(self.look())
    }
}

impl Recorder for Watch {}

/// Watches a run and reports its progress to a function of Python.
pub(crate) struct Onlooker {
    /// Called with the time (s) of the state and the duration (s); `False` ends the run.
    progress: Option<Py<PyAny>>,
    duration: f64,
    /// The exception that ended the run.
    pub(crate) raised: Option<PyErr>,
    pub(crate) is_ended: bool,
    /// Time of the last call.
    told: Instant,
}

/// Time between two calls of a function of Python.
const TELL: Duration = Duration::from_millis(40);

impl Onlooker {
    pub(crate) fn new(progress: Option<Py<PyAny>>, duration: f64) -> Self {
        Self {
            progress,
            duration,
            raised: None,
            is_ended: false,
            told: Instant::now(),
        }
    }
}

impl Companion for Onlooker {
    fn is_interrupted(&self) -> bool {
        self.is_ended
    }

    fn progress(&mut self, _: usize, t: f64) {
        if self.told.elapsed() < TELL && t < self.duration {
            return;
        }
        self.told = Instant::now();
        let told = Python::attach(|py| {
            py.check_signals()?;
            let Some(progress) = &self.progress else {
                return Ok(false);
            };
            let said = progress.call1(py, (t, self.duration))?;
            Ok(said.extract::<bool>(py).is_ok_and(|goes_on| !goes_on))
        });
        match told {
            Ok(ends) => self.is_ended |= ends,
            Err(error) => {
                self.is_ended = true;
                self.raised.get_or_insert(error);
            }
        }
    }
}
