//! Registry of the kinds of machines that [`Settings`] and scenes know by their ids: those of this crate, and those
//! that a program adds.

use std::sync::{PoisonError, RwLock};

use sinew_core::System;

use crate::kinds::OURS;
use crate::known::KnownMachine;
use crate::settings::{Kind, Settings};
use crate::unfit::Unfit;

impl Kind {
    /// The kind with an id; `None` if there is none.
    #[must_use]
    pub fn of(id: &str) -> Option<Self> {
        let known = known_machines().into_iter().find(|known| known.id == id)?;
        Some(Self(known.id))
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

impl Settings {
    /// Checks that a machine with these settings can run a system.
    ///
    /// # Errors
    /// [`Unfit`] if it cannot.
    pub fn check(&self, system: &dyn System) -> Result<(), Unfit> {
        let known = self.kind.known();
        (known.check)(self, system)?;
        if known.precisions.contains(&self.precision) {
            return Ok(());
        }
        Err(Unfit::Precision {
            machine: known.id,
            precision: self.precision.id(),
        })
    }
}

/// The kinds that the program has added.
static ADDED: RwLock<Vec<&'static KnownMachine>> = RwLock::new(Vec::new());

/// Adds a kind of machine, so that scenes and [`Settings`] know it by its id, for as long as the program runs.
///
/// # Errors
/// [`RegisterError`] for an id that is in use.
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
