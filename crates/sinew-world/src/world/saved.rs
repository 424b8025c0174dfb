//! A motion that is kept and continued.

use std::sync::Arc;

use sinew_core::{Inputs, Options, State};
use sinew_scene::Cutter;

use super::{Method, Sheet, World};
use crate::error::RestoreError;
use crate::log::Log;

/// All that the motion of a world continues from.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// The cuts; empty if nothing can cut.
    pub cuts: Vec<u8>,
    /// The state, see [`State::to_bytes`].
    pub state: Vec<u8>,
    /// Tools, loads, method and log as commands left them; `None` of a world that follows its scene.
    pub commanded: Option<Commanded>,
}

/// What commands to a world left.
#[derive(Clone, Debug, PartialEq)]
pub struct Commanded {
    inputs: Vec<u8>,
    /// Target of each tool, and whether it was steered.
    tools: Vec<(Target, bool)>,
    /// Factor of each load that the next step begins with.
    factors: Vec<Option<f64>>,
    drives_loads: bool,
    method: (String, Options),
    dt: f64,
    sheets: Vec<Sheet>,
    blade: Option<[[f64; 3]; 2]>,
    steps: usize,
    log: Log,
}

/// Position (m) and rotation vector (rad) that a tool goes to.
type Target = Option<([f64; 3], [f64; 3])>;

impl World {
    /// Keeps all that the motion continues from.
    #[must_use]
    pub fn save(&self) -> Saved {
        let commanded = (!self.follows).then(|| Commanded {
            inputs: self.inputs.to_bytes(),
            tools: (self.tools.iter())
                .map(|hand| (hand.target, hand.is_steered))
                .collect(),
            factors: self.loads.iter().map(|load| load.next).collect(),
            drives_loads: self.drives_loads(),
            method: self.method.asked.clone(),
            dt: self.method.dt,
            sheets: self.sheets.clone(),
            blade: self.blade,
            steps: self.steps,
            log: self.log.clone(),
        });
        Saved {
            cuts: self.cutter.as_ref().map_or_else(Vec::new, Cutter::to_bytes),
            state: self.state.to_bytes(self.body.system()),
            commanded,
        }
    }

    /// Continues from what [`World::save`] kept of this world, or of another one of the same scene that was built in the same
    /// way. The log is that of the motion that is continued.
    ///
    /// # Errors
    /// [`RestoreError`] for what another scene left. The world is of no use then.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        if saved.commanded.is_some() == self.follows {
            return Err(RestoreError::OtherWorld);
        }
        self.undriven = Arc::clone(self.scene.body());
        self.topology_epoch += 1;
        if let Some(cutter) = &mut self.cutter
            && let Some(cut) = cutter.restore(&saved.cuts, self.scene.body())?
        {
            self.undriven = Arc::new(cut);
        }
        self.body = Arc::clone(&self.undriven);
        let state = State::from_bytes(&saved.state, self.body.system())?;
        if let Some(commanded) = &saved.commanded {
            self.restore_commanded(commanded)?;
        }
        self.method.stable_step.take();
        self.state = state;
        self.reached = self.state.t();
        (self.change, self.failure) = (None, None);
        Ok(())
    }

    fn restore_commanded(&mut self, commanded: &Commanded) -> Result<(), RestoreError> {
        self.inputs = Inputs::from_bytes(&commanded.inputs)?;
        if commanded.drives_loads {
            self.body = self.driven()?;
        }
        let (id, options) = &commanded.method;
        self.method = Method::new(&self.scene, id, options, commanded.dt)?;
        for (hand, (target, is_steered)) in self.tools.iter_mut().zip(&commanded.tools) {
            (hand.target, hand.is_steered) = (*target, *is_steered);
        }
        for (load, factor) in self.loads.iter_mut().zip(&commanded.factors) {
            load.next = *factor;
        }
        self.sheets.clone_from(&commanded.sheets);
        self.blade = commanded.blade;
        self.steps = commanded.steps;
        self.log = commanded.log.clone();
        Ok(())
    }
}
