//! Steps of programs on every machine, beside plain loops and beside what the memory can do.

mod baseline;
mod bodies;
mod laps;
mod memory;
mod row;
mod table;
mod variant;

use std::path::PathBuf;

use serde::Serialize;

pub use bodies::KernelBenchError;
pub use row::KernelRow;
pub use sinew_cnn::conformance::CountingAllocator;

use crate::bench::Progress;
use crate::results::Machine;

/// A bench of kernels: machines, precisions and threads on bodies of several sizes.
#[derive(Clone, Debug)]
pub struct KernelBench {
    /// Folder of the repository's meshes.
    pub meshes: PathBuf,
    /// One small body and few laps, to see that everything runs.
    pub quick: bool,
}

/// What a bench of kernels measured.
#[derive(Clone, Debug, Serialize)]
pub struct KernelResults {
    /// Revision of the code.
    pub revision: String,
    /// The computer.
    pub machine: Machine,
    /// One row for each body, machine, precision and number of threads.
    pub rows: Vec<KernelRow>,
}

impl KernelBench {
    /// Measures everything.
    ///
    /// # Errors
    /// [`KernelBenchError`] when a body cannot be read or built.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress),
    ) -> Result<KernelResults, KernelBenchError> {
        let mut rows = Vec::new();
        let bodies = bodies::bodies(&self.meshes, self.quick)?;
        let of = bodies.len();
        for (done, body) in bodies.into_iter().enumerate() {
            let what = body.name.clone();
            progress(Progress::Run { done, of, what });
            rows.extend(laps::rows(&body, self.quick)?);
        }
        Ok(KernelResults {
            revision,
            machine,
            rows,
        })
    }
}
