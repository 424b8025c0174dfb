//! Steps of programs on every machine, beside plain loops and beside what the memory can do.

mod baseline;
mod bodies;
mod laps;
mod memory;
mod table;

use std::path::PathBuf;

use serde::Serialize;
use sinew_machines::{Kind, PrecisionName};

pub use bodies::KernelBenchError;
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

/// Steps of a program on one machine.
#[derive(Clone, Debug, Serialize)]
pub struct KernelRow {
    /// The body.
    pub mesh: String,
    /// Its nodes, held ones too.
    pub nodes: usize,
    /// Its tetrahedra.
    pub tets: usize,
    /// The machine: "template" in the name where rows are stored once.
    pub kernel: String,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Instructions.
    pub instructions: &'static str,
    /// Threads that it may use.
    pub threads: usize,
    /// Time of a step of plain loops over its own, median of alternating laps: CPU time, or wall time where
    /// there are several threads.
    pub ratio_to_b1: f64,
    /// Lowest and highest ratio.
    pub ratios: [f64; 2],
    /// Time of a step (s), of this computer only.
    pub step_s: f64,
    /// Largest difference of a displacement from the plain machine's after the steps of a lap, relative to
    /// the largest displacement.
    pub difference: f64,
    /// Bytes that a step moves: matrices or templates, and vectors.
    pub bytes_per_step: f64,
    /// Those bytes in the time of a step over what one thread reads of as many, measured in the same run.
    pub share_of_bandwidth: f64,
    /// Templates, where rows are stored once.
    pub templates: Option<usize>,
    /// Allocations of the calling thread in a step; `None` where nothing counts them.
    pub allocations_per_step: Option<f64>,
}

/// Machine, precision and threads of a row.
#[derive(Clone, Copy, Debug)]
struct Variant {
    kind: Kind,
    precision: PrecisionName,
    threads: usize,
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
        let bodies = bodies::bodies(self)?;
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

/// All machines, precisions and numbers of threads.
fn variants() -> Vec<Variant> {
    let most = sinew_machines::Threads::All.most();
    let mut variants = Vec::new();
    for kind in [Kind::General, Kind::Repeated] {
        for precision in [PrecisionName::F64, PrecisionName::F32] {
            let several = (most > 1).then_some(most);
            for threads in [Some(1), several].into_iter().flatten() {
                variants.push(Variant {
                    kind,
                    precision,
                    threads,
                });
            }
        }
    }
    variants
}
