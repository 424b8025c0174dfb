//! A motion that is kept and continued.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::bytes::{self, BytesError, Kind};
use sinew_core::{Options, SavedInputs, SavedState};
use sinew_scene::{Cutter, SavedCuts};

use super::{Method, Sheet, World};
use crate::error::RestoreError;
use crate::log::Entry;

const KIND: Kind = Kind {
    name: b"sinew world v1\r\n",
    words: "saved world",
};

/// All that the motion of a world continues from: a value that other processes read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// `None` if nothing can cut.
    cuts: Option<SavedCuts>,
    state: SavedState,
    /// `None` of a world that follows its scene.
    commanded: Option<Commanded>,
}

/// The effects of commands to a world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Commanded {
    inputs: SavedInputs,
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
    log: Vec<Entry>,
    log_steps: usize,
}

/// Position (m) and rotation vector (rad) that a tool goes to.
type Target = Option<([f64; 3], [f64; 3])>;

impl Saved {
    /// It as bytes, the same on every machine.
    ///
    /// # Errors
    /// [`BytesError`]; none for what [`World::save`] gives.
    pub fn to_bytes(&self) -> Result<Vec<u8>, BytesError> {
        bytes::write(KIND, self)
    }

    /// Reads what [`Saved::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`BytesError`] for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BytesError> {
        bytes::read(KIND, bytes)
    }
}

impl World {
    /// Keeps all that the motion continues from.
    #[must_use]
    pub fn save(&self) -> Saved {
        let commanded = (!self.follows).then(|| Commanded {
            inputs: SavedInputs::of(&self.inputs),
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
            log: self.log.entries().to_vec(),
            log_steps: self.log.steps(),
        });
        Saved {
            cuts: self.cutter.as_ref().map(Cutter::save),
            state: SavedState::of(&self.state, self.body.system()),
            commanded,
        }
    }

    /// Continues from what [`World::save`] kept of this world, or of another one of the same scene that was built in the
    /// same way. The log is that of the motion that is continued.
    ///
    /// # Errors
    /// [`RestoreError`] for what another scene left; the world stays as it was.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        if saved.commanded.is_some() == self.follows {
            return Err(RestoreError::OtherWorld);
        }
        let before = self.cutter.as_ref().map(Cutter::save);
        let restored = self.take_saved(saved);
        // All else is replaced once nothing can be refused.
        if restored.is_err()
            && let (Some(cutter), Some(before)) = (&mut self.cutter, &before)
        {
            cutter.restore(before, self.scene.body())?;
        }
        restored
    }

    fn take_saved(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        let cut = match (&mut self.cutter, &saved.cuts) {
            (Some(cutter), Some(cuts)) => cutter.restore(cuts, self.scene.body())?,
            (None, None) => None,
            _ => return Err(RestoreError::OtherScene),
        };
        let undriven = cut.map_or_else(|| Arc::clone(self.scene.body()), Arc::new);
        let drives_loads = (saved.commanded.as_ref()).is_some_and(|kept| kept.drives_loads);
        let is_same = Arc::ptr_eq(&undriven, &self.undriven);
        // Methods need not be set up again for the body that they know.
        let body = match drives_loads {
            _ if is_same && drives_loads == self.drives_loads() => Arc::clone(&self.body),
            true => self.driven(&undriven)?,
            false => Arc::clone(&undriven),
        };
        let state = saved.state.restore(body.system())?;
        if let Some(commanded) = &saved.commanded {
            self.restore_commanded(commanded)?;
        }
        (self.body, self.undriven) = (body, undriven);
        self.topology_epoch += u64::from(!is_same);
        self.method.stable_step.take();
        self.state = state;
        self.reached = self.state.t();
        (self.change, self.failure) = (None, None);
        Ok(())
    }

    fn restore_commanded(&mut self, commanded: &Commanded) -> Result<(), RestoreError> {
        let inputs = commanded.inputs.restore()?;
        let known = [
            self.tools.len(),
            self.loads.len(),
            self.inputs.channel_count(),
        ];
        if known
            != [
                commanded.tools.len(),
                commanded.factors.len(),
                inputs.channel_count(),
            ]
        {
            return Err(RestoreError::OtherScene);
        }
        let (id, options) = &commanded.method;
        if self.method.asked != commanded.method {
            self.method = Method::new(&self.scene, id, options, commanded.dt)?;
        }
        self.method.dt = commanded.dt;
        self.inputs = inputs;
        for (hand, (target, is_steered)) in self.tools.iter_mut().zip(&commanded.tools) {
            (hand.target, hand.is_steered) = (*target, *is_steered);
        }
        for (load, factor) in self.loads.iter_mut().zip(&commanded.factors) {
            load.next = *factor;
        }
        self.sheets.clone_from(&commanded.sheets);
        self.blade = commanded.blade;
        self.steps = commanded.steps;
        self.log.restore(&commanded.log, commanded.log_steps);
        Ok(())
    }
}
