//! Tools on tissue: pressing, dragging and lifting, by every method that supports it, with the errors of motion and
//! of force.

mod cases;
mod marks;

use std::path::PathBuf;

use crate::BenchError;
use crate::planned::Plan;
use crate::results::BenchResults;
use sinew_verify::{Machine, Progress};

/// The bench of scenes with tools.
#[derive(Clone, Debug, PartialEq)]
pub struct HandsBench {
    /// The folder of scenes; these are in its folder `hands`.
    pub scenes: PathBuf,
    /// Takes the longest steps only, and no finer meshes.
    pub quick: bool,
}

impl HandsBench {
    /// Measures every case on one thread. A method without support for tools is listed with its reason.
    ///
    /// # Errors
    /// [`BenchError`] if no scene can be read.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        progress: impl FnMut(Progress) + Send,
    ) -> Result<BenchResults, BenchError> {
        let results = BenchResults::new(revision, machine);
        self.plan().run(results, progress, |results, _| {
            marks::all(&results.cases, &results.rows, self.quick)
        })
    }

    /// The files that the bench reads: no output may be one of them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        self.plan().input_files()
    }

    /// The names of the files that [`write_all`](crate::report::write_all) writes for the results.
    #[must_use]
    pub fn output_files(&self) -> Vec<String> {
        self.plan().output_files()
    }

    fn plan(&self) -> Plan {
        Plan {
            subject: "Tools: what presses, draws and lifts, with errors of motion and of force",
            scenes: self.scenes.clone(),
            quick: self.quick,
            cases: cases::all(self.quick),
        }
    }
}
