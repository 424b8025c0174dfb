//! A motion that is saved and continued.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::bytes::{self, BytesError, Kind};
use sinew_core::{Clock, Options, SavedInputs, SavedState};
use sinew_scene::{Cutter, SavedCuts};

use super::commands::{FARTHEST, STRONGEST};
use super::{Method, Sheet, World};
use crate::error::{RestoreError, WorldStepError};
use crate::log::Entry;

const KIND: Kind = Kind {
    name: b"sinew world v4\r\n",
    words: "saved world",
};

/// All data that the motion of a world needs to continue, as a value that other processes can read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// SHA-256 of the scene with the files that it reads, in hexadecimal digits.
    scene: String,
    /// Time (s) after the last complete step.
    reached: f64,
    failure: Option<SavedFailure>,
    /// The cuts; `None` if nothing can cut.
    cuts: Option<SavedCuts>,
    state: SavedState,
    /// The effects of commands; `None` for a world that follows its scene.
    commanded: Option<Commanded>,
}

impl Saved {
    /// Number of bytes of its fields over the body.
    pub(super) fn bytes(&self) -> usize {
        self.state.bytes()
    }
}

/// The effects of commands to a world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Commanded {
    inputs: SavedInputs,
    /// Target of each tool, a flag that is true if it was steered, and the state of its jaws at the beginning of the
    /// next step.
    tools: Vec<(Target, bool, Option<bool>)>,
    /// Forces (N) on degrees of freedom at the beginning of the next step.
    forces: Option<Vec<(u32, f64)>>,
    /// Factor of each load at the beginning of the next step.
    factors: Vec<Option<f64>>,
    drives_loads: bool,
    method: (String, Options),
    dt: f64,
    sheets: Vec<Sheet>,
    blade: Option<[[f64; 3]; 2]>,
    steps: usize,
    log: Vec<Entry>,
}

/// A failure from which only a reset continues.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum SavedFailure {
    Diverged { t: f64, place: String },
    InWords(String),
}

/// Position (m) and rotation vector (rad) to which a tool moves.
type Target = Option<([f64; 3], [f64; 3])>;

impl Saved {
    /// Converts it to bytes, the same on every machine.
    ///
    /// # Errors
    /// [`BytesError`]; never for a result of [`World::save`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, BytesError> {
        bytes::write(KIND, self)
    }

    /// Reads bytes written by [`Saved::to_bytes`].
    ///
    /// # Errors
    /// [`BytesError`] for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BytesError> {
        bytes::read(KIND, bytes)
    }
}

impl SavedFailure {
    fn of(failure: &WorldStepError) -> Self {
        match failure {
            WorldStepError::Diverged { t, place } => Self::Diverged {
                t: *t,
                place: place.clone(),
            },
            other => Self::InWords(other.to_string()),
        }
    }

    fn restored(&self) -> WorldStepError {
        match self {
            Self::Diverged { t, place } => WorldStepError::Diverged {
                t: *t,
                place: place.clone(),
            },
            Self::InWords(words) => WorldStepError::Earlier(words.clone()),
        }
    }
}

impl Commanded {
    /// The first part that no sequence of commands can produce.
    fn impossible_part(&self) -> Option<&'static str> {
        let within = |values: &[f64], most: f64| values.iter().all(|value| value.abs() <= most);
        let is_place = |ends: &[[f64; 3]]| within(ends.as_flattened(), FARTHEST);
        let targets = self.tools.iter().filter_map(|(target, ..)| *target);
        let factors: Vec<f64> = self.factors.iter().copied().flatten().collect();
        let in_order = |pair: &[Entry]| pair[0].step <= pair[1].step;
        let last = self.log.last().map_or(0, |entry| entry.step);
        let is_possible = [
            ("step", self.dt.is_finite() && self.dt > 0.0),
            ("number of steps", self.steps as u64 <= Clock::MOST_STEPS),
            (
                "log",
                last <= self.steps && self.log.windows(2).all(in_order),
            ),
            (
                "pose of a tool",
                targets
                    .into_iter()
                    .all(|(position, turn)| is_place(&[position, turn])),
            ),
            ("factor of a load", within(&factors, STRONGEST)),
            (
                "blade",
                (self.sheets.iter().flatten().chain(&self.blade)).all(|ends| is_place(ends)),
            ),
        ];
        let broken = is_possible
            .into_iter()
            .find(|(_, is_possible)| !is_possible);
        broken.map(|(part, _)| part)
    }
}

impl World {
    /// Saves all data that the motion needs to continue.
    #[must_use]
    pub fn save(&self) -> Saved {
        self.saved_with(self.log.entries().to_vec())
    }

    /// Its motion, with these commands of its log.
    pub(super) fn saved_with(&self, log: Vec<Entry>) -> Saved {
        let commanded = (!self.follows).then(|| Commanded {
            inputs: SavedInputs::of(&self.inputs),
            tools: (self.tools.iter())
                .map(|hand| (hand.target, hand.is_steered, hand.next_jaws))
                .collect(),
            forces: (self.forces.is_new).then(|| self.forces.next.entries.clone()),
            factors: self.loads.iter().map(|load| load.next).collect(),
            drives_loads: self.drives_loads(),
            method: self.method.asked.clone(),
            dt: self.method.dt,
            sheets: self.sheets.clone(),
            blade: self.blade,
            steps: self.steps,
            log,
        });
        Saved {
            scene: self.identity.sha256.clone(),
            reached: self.reached,
            failure: self.failure.as_ref().map(SavedFailure::of),
            cuts: self.cutter.as_ref().map(Cutter::save),
            state: SavedState::of(&self.state, self.body.system()),
            commanded,
        }
    }

    /// Continues from a result of [`World::save`], of this world or of another one built in the same way from the
    /// same scene: scenes are the same if their texts and the files that they read are. The log becomes that of the
    /// saved motion; if that had failed, the world needs a reset here too.
    ///
    /// # Errors
    /// [`RestoreError`] for data of another scene, and for values that are not possible; the world is then unchanged.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        self.restore_without_log(saved)?;
        if let Some(commanded) = &saved.commanded {
            self.log.restore(&commanded.log, commanded.steps);
        }
        Ok(())
    }

    /// Same as [`World::restore`], but the log stays as it is.
    pub(super) fn restore_without_log(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        if saved.scene != self.identity.sha256 {
            return Err(RestoreError::OtherScene);
        }
        if saved.commanded.is_some() == self.follows {
            return Err(RestoreError::OtherWorld);
        }
        let impossible = match &saved.commanded {
            _ if !saved.reached.is_finite() => Some("time"),
            Some(commanded) => commanded.impossible_part(),
            None => None,
        };
        if let Some(part) = impossible {
            return Err(RestoreError::Impossible { part });
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
            _ => return Err(RestoreError::Impossible { part: "cuts" }),
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
        self.reached = saved.reached;
        self.change = None;
        self.failure = saved.failure.as_ref().map(SavedFailure::restored);
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
            return Err(RestoreError::Impossible {
                part: "number of tools and loads",
            });
        }
        let (id, options) = &commanded.method;
        if self.method.asked != commanded.method {
            self.method = Method::new(&self.scene, id, options, commanded.dt)?;
        }
        self.method.dt = commanded.dt;
        self.inputs = inputs;
        for (hand, kept) in self.tools.iter_mut().zip(&commanded.tools) {
            (hand.target, hand.is_steered, hand.next_jaws) = *kept;
        }
        self.forces.is_new = commanded.forces.is_some();
        self.forces.next.entries = commanded.forces.clone().unwrap_or_default();
        for (load, factor) in self.loads.iter_mut().zip(&commanded.factors) {
            load.next = *factor;
        }
        self.sheets.clone_from(&commanded.sheets);
        self.blade = commanded.blade;
        self.steps = commanded.steps;
        Ok(())
    }
}
