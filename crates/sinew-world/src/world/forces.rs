//! Forces on nodes that commands give.

use std::collections::HashMap;

use sinew_core::{ForceInputError, Inputs, Ramp};
use sinew_scene::SceneBody;

use super::World;
use crate::command::CommandError;

impl World {
    /// Stores forces (N) on nodes of the present body, which act from the next step on.
    pub(super) fn take_forces(&mut self, forces: &[(u32, [f64; 3])]) -> Result<(), CommandError> {
        let body = self.body.model().body().ok_or(CommandError::NoNodes)?;
        body.model.forces_into(forces, &mut self.forces.next)?;
        self.forces.is_new = true;
        Ok(())
    }

    /// Applies new forces to a step that begins at `t` (s).
    pub(super) fn give_forces(&mut self, t: f64) -> Result<(), ForceInputError> {
        if std::mem::take(&mut self.forces.is_new) {
            self.inputs.set_forces(t, &self.forces.next.entries)?;
            // Methods look back by a step.
            let last = self.state.clock.last_step().unwrap_or(0.0);
            self.inputs.forget_before(t - 2.0 * last);
        }
        Ok(())
    }
}

/// Transfers the recorded forces to the same nodes of a body after a cut. Forces on removed nodes are dropped, and of
/// several copies the first keeps the force.
pub(super) fn carry(
    inputs: &mut Inputs,
    before: &SceneBody,
    after: &SceneBody,
) -> Result<(), ForceInputError> {
    if inputs.forces().len() == 0 {
        return Ok(());
    }
    let (Some(before), Some(after)) = (before.model().body(), after.model().body()) else {
        return Ok(());
    };
    let nodes = 0..after.mesh.points.len() as u32;
    let places: HashMap<u32, u32> = nodes
        .map(|node| (after.number_in_body(node), node))
        .collect();
    let dof = |(dof, force): &(u32, f64)| {
        let (cell, axis) = (dof / 3, dof % 3);
        let node = before.model.nodes().get(cell as usize)?;
        let node = places.get(&before.number_in_body(*node))?;
        Some((3 * after.model.cell_of_node(*node)? + axis, *force))
    };
    let carried: Vec<_> = (inputs.forces())
        .map(|load| {
            let entries: Vec<(u32, f64)> = load.entries.iter().filter_map(dof).collect();
            (load.ramp.clone(), entries)
        })
        .collect();
    for (number, (ramp, entries)) in carried.iter().enumerate() {
        let Ramp::Pulse { from, to } = *ramp else {
            continue;
        };
        if number == 0 {
            inputs.set_forces(from, &[])?;
        }
        inputs.set_forces(from, entries)?;
        if to.is_finite() {
            inputs.set_forces(to, &[])?;
        }
    }
    Ok(())
}
