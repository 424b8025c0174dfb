//! Machines whose laps are compared.

use std::sync::Arc;

use sinew_cnn::{Machine, Program};
use sinew_core::{Batch, Inputs, State};
use sinew_fem::Model;

use crate::timed::{Spent, TimedRunError, time_batch};

/// A machine on a model, with its own motion.
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

    /// Takes steps and returns their time.
    pub(super) fn take(&mut self, steps: usize) -> Result<Spent, TimedRunError> {
        let mut batch = Batch::new(self.model, Inputs::none(), self.dt, steps);
        time_batch(&mut *self.machine, &mut batch, steps, &mut self.state)
    }
}
