//! Methods that cannot be set up for a scene, reported at the keys at fault.

use sinew_core::{Options, SetupError, System};

use crate::decode::Place;
use crate::error::{Fault, SceneError};
use crate::scene::{RunSettings, Scene};

/// The error of a scene whose integrator was refused for a system and a step (s).
pub(super) fn refused(
    scene: &Scene,
    refused: SetupError,
    system: &dyn System,
    dt: f64,
) -> SceneError {
    let settings = scene.settings();
    // The matrix of a step is not factorised once more to find a key.
    let refuses = |options: &Options| match refused {
        SetupError::Factorization { .. } => None,
        _ => refusal(settings, options, system, dt),
    };
    at_key(
        &scene.places().run,
        &settings.options,
        refuses,
        refused.clone(),
    )
}

/// The error of an integrator of these settings that refuses a system, with other options.
pub(super) fn refusal(
    settings: &RunSettings,
    options: &Options,
    system: &dyn System,
    dt: f64,
) -> Option<SetupError> {
    let mut method = sinew_integrators::build(&settings.integrator, options).ok()?;
    method.prepare(system, dt).err()
}

/// The error, at the first option whose removal avoids an error of this kind; at the integrator if there is no such
/// option.
pub(super) fn at_key(
    run: &Place,
    options: &Options,
    refusal: impl Fn(&Options) -> Option<SetupError>,
    refused: SetupError,
) -> SceneError {
    let is_refused = |options: &Options| {
        refusal(options)
            .is_some_and(|other| std::mem::discriminant(&other) == std::mem::discriminant(&refused))
    };
    let is_at_fault = |key: &&str| {
        let mut others = options.clone();
        others.remove(key);
        !is_refused(&others)
    };
    let mut keys = options.iter().map(|(key, _)| key);
    let key = match is_refused(options) {
        true => keys.find(is_at_fault),
        false => None,
    };
    run.value_fault(key.unwrap_or("integrator"), Fault::SetUp(refused))
}
