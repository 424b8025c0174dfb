//! The methods of panes.

use sinew_world::CommandError;

use super::pane::Pane;
use crate::pane_choice::PaneChoice;

/// Methods that are tried first: with any step, then with a stable one.
const PREFERRED: [&str; 4] = [
    "newmark",
    "implicit-euler",
    "central-difference",
    "symplectic-euler",
];

/// Gives a second pane the wished method or, where that is the method of the first pane or cannot run here, the first
/// other one that can, in the scene's step. Returns a sentence if it is not the wished one.
///
/// # Errors
/// A sentence if no other method can run here.
pub(super) fn choose_beside(
    pane: &mut Pane,
    wished: &PaneChoice,
    first: &str,
) -> Result<Option<String>, String> {
    let refused = match wished.integrator.as_deref() {
        Some(id) if id == first => format!("`{id}` runs in the first pane"),
        _ => match choose(pane, wished) {
            Ok(()) => return Ok(None),
            Err(refused) => refused.to_string(),
        },
    };
    let ids = sinew_integrators::ids();
    let rest = ids.iter().filter(|id| !PREFERRED.contains(id));
    let all = PREFERRED.iter().filter(|id| ids.contains(id)).chain(rest);
    for id in all.filter(|id| **id != first) {
        if pane.use_integrator(id).is_ok() && pane.has_stable_step() {
            return Ok(Some(format!("{refused}; `{id}` runs beside it")));
        }
    }
    Err(refused)
}

/// Gives a pane its integrator and step.
pub(super) fn choose(pane: &mut Pane, choice: &PaneChoice) -> Result<(), CommandError> {
    if let Some(dt) = choice.dt {
        pane.use_step(dt)?;
    }
    match &choice.integrator {
        Some(name) => pane.use_integrator(name),
        None => Ok(()),
    }
}
