//! Machines, which run programs.

mod cells;
mod combine;
mod host;
mod reference;

use std::sync::Arc;

use sinew_core::{Batch, CostClock, State, StepError, System};

pub use host::{FollowedLoad, StepTime};
pub use reference::ReferenceMachine;

use crate::Program;

/// Runs programs on the cells of a system.
///
/// It may use another precision, numbering or memory internally; the [`State`] stays f64, node-major. Every machine
/// gives the results of [`ReferenceMachine`], to its own rounding, and the same bits for every division of a run into
/// batches. The module `conformance` (feature `conformance`) checks that.
pub trait Machine: Send + std::fmt::Debug {
    /// Its name, as plans and results show it.
    fn name(&self) -> &'static str;

    /// Its name with the precision and the instructions that it uses, as tables of results show it.
    fn kernel(&self) -> String {
        self.name().to_owned()
    }

    /// Description for plans: kernels, number format, threads.
    fn in_words(&self) -> String {
        "plain loops in f64".to_owned()
    }

    /// The clock that measures the cost of its steps: the calling thread's unless it works elsewhere.
    fn cost_clock(&self) -> CostClock {
        CostClock::default()
    }

    /// Loads a program for a system, and allocates its buffers: afterwards a batch allocates nothing.
    fn load(&mut self, program: Arc<Program>, system: &dyn System);

    /// Takes the steps of a batch, each in as many substeps as the program repeats. The velocity of `state` is that
    /// at the displacement's time, or in the middle of the last substep if the program leaves it there.
    ///
    /// # Errors
    /// [`StepError::Refused`] when the system refuses a trial state, [`StepError::NotPrepared`] if no program was loaded.
    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError>;
}
