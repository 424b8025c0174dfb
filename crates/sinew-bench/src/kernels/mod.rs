//! Steps of programs on every machine, compared with plain loops and with memory bandwidth.

use sinew_verify::LabError;
mod baseline;
mod bodies;
mod elements;
mod guards;
mod laps;
mod memory;
mod page;
mod pairs;
mod plain_tets;
mod pulled;
mod roofs;
mod row;
mod table;
mod variant;

use std::path::PathBuf;

use serde::Serialize;

pub use elements::{ElementMark, ElementRow};
pub use guards::{Guard, Limit};
pub use pairs::PairRow;
pub use pulled::PulledRow;
pub use roofs::{OperationRate, ReadRate, Roofs};
pub use row::KernelRow;

use sinew_verify::Machine;
use sinew_verify::Progress;

/// A bench of kernels: machines, precisions and threads on bodies of several sizes.
#[derive(Clone, Debug)]
pub struct KernelBench {
    /// Folder of the repository's meshes.
    pub meshes: PathBuf,
    /// A mesh of some ten thousand tetrahedra from a mesh generator, with surfaces "bottom" and "top", if any.
    pub generated: Option<PathBuf>,
    /// One small body and few laps, to check that everything runs.
    pub quick: bool,
}

/// Measurements of a bench of kernels.
#[derive(Clone, Debug, Serialize)]
pub struct KernelResults {
    /// Revision of the code.
    pub revision: String,
    /// The computer.
    pub machine: Machine,
    /// Peak rates of one thread of it.
    pub roofs: Roofs,
    /// Ratios that detect kernels which have become slow.
    pub guards: Vec<Guard>,
    /// One row for each body, machine, precision and number of threads.
    pub rows: Vec<KernelRow>,
    /// Forces of hyperelastic elements: one row for each body, law, element, precision and instruction set.
    pub elements: Vec<ElementRow>,
    /// Steps of a pulled cube, compared with a plain scalar loop, and automatic steps.
    pub pulled: Vec<PulledRow>,
    /// Runs of scenes in pairs.
    pub pairs: Vec<PairRow>,
    /// Marks for some of these ratios.
    pub marks: Vec<ElementMark>,
}

impl KernelBench {
    /// Measures everything.
    ///
    /// # Errors
    /// [`LabError`] when a body cannot be read or built.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        mut progress: impl FnMut(Progress),
    ) -> Result<KernelResults, LabError> {
        let mut rows = Vec::new();
        let bodies = bodies::bodies(&self.meshes, self.generated.as_deref(), self.quick)?;
        let of = bodies.len() + 5;
        for (done, body) in bodies.into_iter().enumerate() {
            let what = body.name.clone();
            progress(Progress::Run { done, of, what });
            rows.extend(laps::rows(&body, self.quick)?);
        }
        let mut next = |done, what: &str| {
            let what = what.to_owned();
            progress(Progress::Run { done, of, what });
        };
        next(of - 5, "forces of hyperelastic elements");
        let elements = elements::rows(self.quick)?;
        next(of - 4, "what the computer can do");
        let roofs = Roofs::measure(self.quick);
        next(of - 3, "steps of a pulled cube");
        let pulled = pulled::rows(self.quick, &roofs)?;
        let mut marks = elements::marks(&elements);
        marks.extend(pulled::marks(&pulled));
        next(of - 2, "runs in pairs");
        let pairs = pairs::rows(self.quick)?;
        marks.extend(pairs::marks(&pairs));
        next(of - 1, "guards");
        let guards = guards::guards(self.quick)?;
        Ok(KernelResults {
            revision,
            machine,
            roofs,
            guards,
            rows,
            marks,
            elements,
            pulled,
            pairs,
        })
    }
}
