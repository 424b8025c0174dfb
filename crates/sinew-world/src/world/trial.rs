//! Trials of the next step.

use sinew_core::State;

use super::{Method, World, try_step};
use crate::command::CommandError;

/// Trials of the next step of a world, with other forces on nodes. They use a method of their own: the world, its log
/// and the bits of its motion stay as they are.
pub struct Trial {
    method: Method,
    state: State,
}

impl World {
    /// Sets up trials with the present method and step.
    ///
    /// # Errors
    /// [`CommandError`] if the method cannot be set up.
    pub fn trial(&self) -> Result<Trial, CommandError> {
        let (id, options) = &self.method.asked;
        Ok(Trial {
            method: Method::new(&self.scene, id, options, self.method.dt)?,
            state: self.state.clone(),
        })
    }
}

impl Trial {
    /// The state after the next step of a world with these forces (N) on nodes, and no others.
    ///
    /// # Errors
    /// [`CommandError`] if the forces, or the step, are refused.
    pub fn next(
        &mut self,
        world: &World,
        forces: &[(u32, [f64; 3])],
    ) -> Result<&State, CommandError> {
        let body = world.body.model().body().ok_or(CommandError::NoNodes)?;
        let forces = body.model.forces(forces)?;
        let mut inputs = world.inputs.clone();
        inputs.set_forces(world.state.t(), &forces.entries)?;
        let (state, method) = (&mut self.state, &mut self.method);
        try_step(world.body.system(), &inputs, &world.state, state, method)?;
        Ok(state)
    }
}
