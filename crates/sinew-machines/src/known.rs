//! The kinds of machines that [`Settings`] and scenes know by their ids: ours, and those that a program adds.

use std::sync::{PoisonError, RwLock};

use sinew_cnn::Machine;
use sinew_core::System;

use crate::kinds::OURS;
use crate::{PrecisionName, Settings, Unfit};

/// A kind of machine: its name, what it runs, and how it is built.
#[derive(Clone, Copy, Debug)]
pub struct KnownMachine {
    /// The name users type.
    pub id: &'static str,
    /// Its use, in half a sentence.
    pub meaning: &'static str,
    /// The precisions that it computes in.
    pub precisions: &'static [PrecisionName],
    /// Checks that it runs a system as the settings ask.
    pub check: fn(&Settings, &dyn System) -> Result<(), Unfit>,
    /// Builds a machine for a system. The program is loaded afterwards.
    pub build: fn(&Settings, &dyn System) -> Box<dyn Machine>,
}

/// A kind of machine by its id, one of [`known_machines`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind(&'static str);

impl Kind {
    /// The fastest that takes the system.
    pub const AUTO: Self = Self("auto");
    /// Plain loops, the meaning of a program.
    pub const REFERENCE: Self = Self("reference");
    /// Kernels for any matrix.
    pub const GENERAL: Self = Self("general");
    /// Kernels for rows that repeat on a lattice.
    pub const REPEATED: Self = Self("repeated");

    /// The kind with an id; `None` if there is none.
    #[must_use]
    pub fn of(id: &str) -> Option<Self> {
        let known = known_machines().into_iter().find(|known| known.id == id)?;
        Some(Self(known.id))
    }

    /// The name users type.
    #[must_use]
    pub const fn id(self) -> &'static str {
        self.0
    }

    /// The kind's description.
    #[must_use]
    pub fn known(self) -> &'static KnownMachine {
        let known = known_machines()
            .into_iter()
            .find(|known| known.id == self.0);
        // A kind is made of the id of a known one, and none is taken away.
        known.unwrap_or(&OURS[0])
    }
}

impl Default for Kind {
    fn default() -> Self {
        Self::AUTO
    }
}

/// The kinds that the program has added.
static ADDED: RwLock<Vec<&'static KnownMachine>> = RwLock::new(Vec::new());

/// Adds a kind of machine, so that scenes and [`Settings`] know it by its id, for as long as the program runs.
///
/// # Errors
/// [`RegisterError`] for an id that is taken.
pub fn register(machine: KnownMachine) -> Result<Kind, RegisterError> {
    let id = machine.id;
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    if OURS
        .iter()
        .chain(added.iter().copied())
        .any(|known| known.id == id)
    {
        return Err(RegisterError { id });
    }
    added.push(Box::leak(Box::new(machine)));
    Ok(Kind(id))
}

/// All kinds that are known: those of this crate, then those added, in their order.
#[must_use]
pub fn known_machines() -> Vec<&'static KnownMachine> {
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    OURS.iter().chain(added.iter().copied()).collect()
}

/// An id that another kind of machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("machine {id:?}: another kind has this id; take another")]
pub struct RegisterError {
    /// The id.
    pub id: &'static str,
}
