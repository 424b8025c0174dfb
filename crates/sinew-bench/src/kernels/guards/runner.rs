//! Machines whose laps are compared.

use std::sync::Arc;
use std::time::Instant;

use sinew_cnn::{Machine, Program};
use sinew_core::{Batch, Inputs, State, StepError};
use sinew_fem::Model;
use sinew_measure::thread_cpu_time;

/// A machine on a model, with a motion of its own.
pub(super) struct Runner<'a> {
    machine: Box<dyn Machine>,
    model: &'a Model,
    dt: f64,
    pub(super) state: State,
}

impl<'a> Runner<'a> {
    pub(super) fn new(
        mut machine: Box<dyn Machine>,
        (model, program, dt): (&'a Model, &Arc<Program>, f64),
        state: &State,
    ) -> Self {
        machine.load(Arc::clone(program), model);
        Self {
            machine,
            model,
            dt,
            state: state.clone(),
        }
    }

    /// Takes steps; their wall time and CPU time of this thread (s).
    pub(super) fn take(&mut self, steps: usize) -> Result<(f64, f64), StepError> {
        let mut batch = Batch::new(self.model, Inputs::none(), self.dt, steps);
        let (wall, cpu) = (Instant::now(), thread_cpu_time());
        self.machine.run(&mut batch, &mut self.state)?;
        let cpu = (thread_cpu_time() - cpu).as_secs_f64();
        Ok((wall.elapsed().as_secs_f64(), cpu))
    }
}
