//! Large deformations: every method, law and element on scenes with tissue that is pressed, twisted and released.
//!
//! Errors in time are relative to a reference of the same body, extrapolated to step 0; errors of the mesh, relative to
//! finer meshes, are listed separately.

mod cases;
mod equal_error;
mod marks;
mod methods;
mod picture;

use std::path::PathBuf;

pub use self::picture::picture;

use crate::BenchError;
use crate::planned::Plan;
use crate::results::BenchResults;
use sinew_verify::{Machine, Progress};

/// The bench of large deformations.
#[derive(Clone, Debug, PartialEq)]
pub struct NonlinearBench {
    /// The folder of scenes; most of these are in its folder `nonlinear`.
    pub scenes: PathBuf,
    /// Takes few scenes, methods and steps.
    pub quick: bool,
}

impl NonlinearBench {
    /// Measures every case on one thread. A run that is refused or diverges is a row like any other; a method that
    /// cannot run on a body is listed with its reason.
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
        self.plan().run(results, progress, |results, begins| {
            marks::all(&results.rows, self.quick, begins)
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
            subject: "Large deformation: methods, laws and elements, with their errors",
            scenes: self.scenes.clone(),
            quick: self.quick,
            cases: cases::all(self.quick),
        }
    }
}
