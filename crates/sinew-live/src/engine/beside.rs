//! The methods of panes.

use sinew_scene::SceneError;
use sinew_world::CommandError;

use super::pane::{GUARD, Pane};
use crate::pane_choice::PaneChoice;
use crate::scene_values::SceneValues;

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
    match take_other(pane, first) {
        Some(id) => Ok(Some(format!("{refused}; `{id}` runs beside it"))),
        None => Err(refused),
    }
}

/// Gives a pane the first method but this one that can run in its scene and step.
pub(super) fn take_other(pane: &mut Pane, but: &str) -> Option<&'static str> {
    let ids = sinew_integrators::ids();
    let rest = ids.iter().filter(|id| !PREFERRED.contains(id));
    let mut all = PREFERRED.iter().filter(|id| ids.contains(id)).chain(rest);
    let found =
        all.find(|id| **id != but && pane.use_integrator(id).is_ok() && pane.has_stable_step());
    found.copied()
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

/// The same scene with the explicit method in automatic steps, which takes tools, and without the options of its own
/// method.
pub(super) fn with_explicit_steps(scene: &SceneValues) -> Result<SceneValues, SceneError> {
    let own = scene.scene.settings().options.iter();
    let removed = own
        .filter(|(key, _)| *key != GUARD)
        .map(|(key, _)| (format!("run.{key}"), None));
    let set = [("run.integrator", "central-difference"), ("run.dt", "auto")];
    let set = set.map(|(key, value)| (key.to_owned(), Some(value.to_owned())));
    scene.with(set.into_iter().chain(removed).collect())
}
