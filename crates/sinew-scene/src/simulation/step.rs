//! The step of a scene, and the largest stable one of its integrator.

use sinew_core::{LoadTime, Options, StableStep, State, System, Trial};
use sinew_integrators::Stepper;
use sinew_integrators::explicit::{Substepped, Substeps};

use crate::error::{NoStableStep, StableStepError};
use crate::number::short;
use crate::scene::{RunSettings, TimeStep};

/// The largest stable step of the scene's integrator.
pub(super) fn stable(
    settings: &RunSettings,
    system: &dyn System,
) -> Result<StableStep, StableStepError> {
    let integrator = sinew_integrators::build(&settings.integrator, &settings.options)?;
    Ok(integrator.stable_step(system)?)
}

/// True if the current stiffness determines the substeps: dt = "auto" on a system that is not linear.
pub(super) fn follows_stiffness(settings: &RunSettings, system: &dyn System) -> bool {
    settings.dt == TimeStep::Auto && system.as_linear().is_none()
}

/// The options of an integrator by its id, with substeps that follow the current stiffness, or without.
pub(super) fn options((id, options): (&str, &Options), follows_stiffness: bool) -> Options {
    let cuts = sinew_integrators::entry(id).is_some_and(|entry| entry.substeps);
    if cuts && follows_stiffness && options.get(Substeps::KEY).is_none() {
        return options.clone().with_text(Substeps::KEY, "auto");
    }
    options.clone()
}

/// The step (s) that a scene requests; `stable` is called only if the scene leaves it to the integrator.
pub(super) fn seconds(
    settings: &RunSettings,
    system: &dyn System,
    stable: impl FnOnce() -> Result<StableStep, StableStepError>,
) -> Result<f64, NoStableStep> {
    if let TimeStep::Given(dt) = settings.dt {
        return Ok(dt);
    }
    let integrator = settings.integrator.clone();
    match stable()? {
        StableStep::UpTo(limit) if limit > 0.0 && limit.is_finite() => {
            let between = settings.duration / settings.samples as f64;
            let parts = if follows_stiffness(settings, system) {
                Substepped::PARTS_AT_REST
            } else {
                1.0
            };
            Ok(Substeps::longest_part(between, parts * limit))
        }
        StableStep::UpTo(limit) if limit > 0.0 => Err(NoStableStep::Unlimited { integrator }),
        StableStep::UpTo(_) => Err(NoStableStep::Never { integrator }),
        StableStep::Any => Err(NoStableStep::Any { integrator }),
        StableStep::Unknown => Err(unknown(system, integrator)),
    }
}

/// The reason why no stable step is known.
fn unknown(system: &dyn System, integrator: String) -> NoStableStep {
    let rest = vec![0.0; system.dofs()];
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &rest,
        v: &rest,
        internal: &[],
    };
    match system.as_elastic().map(|law| law.fastest_wave(&trial)) {
        Some(Err(refusal)) => NoStableStep::Refused(refusal),
        Some(Ok(Some(wave))) if !wave.is_finite() => NoStableStep::NotFinite,
        _ => NoStableStep::Unknown { integrator },
    }
}

/// A message if a step (s) is longer than the stable one of the deformed body.
pub(super) fn outrun(
    system: &dyn System,
    dt: f64,
    integrator: &dyn Stepper,
    state: &State,
) -> Option<String> {
    if system.as_linear().is_some() {
        return None;
    }
    match integrator.stable_step_about(system, Some(state)) {
        Ok(StableStep::UpTo(limit)) if dt > limit => Some(format!(
            "dt = {dt} s is {} times the stable step of `{}` about the body as it is at t = {} s, {} s: its fastest motions are wrong; \
             dt = \"auto\" follows the stiffness",
            short(dt / limit),
            integrator.id(),
            state.t(),
            short(limit)
        )),
        _ => None,
    }
}
