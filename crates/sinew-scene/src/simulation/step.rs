//! The step of a scene that leaves it to the integrator.

use sinew_core::{StableStep, System};
use sinew_integrators::explicit::Substeps;

use crate::error::Fault;
use crate::scene::{RunSettings, TimeStep};

/// The step (s) that a scene asks for.
pub(super) fn seconds(settings: &RunSettings, system: &dyn System) -> Result<f64, Fault> {
    let TimeStep::Given(dt) = settings.dt else {
        return automatic(settings, system);
    };
    Ok(dt)
}

fn automatic(settings: &RunSettings, system: &dyn System) -> Result<f64, Fault> {
    let id = &settings.integrator;
    let refused = |reason: String| Err(Fault::NoStableStep { reason });
    let integrator = sinew_integrators::build(id, &settings.options)?;
    match integrator.stable_step(system) {
        Ok(StableStep::UpTo(limit)) if limit > 0.0 && limit.is_finite() => {
            let between = settings.duration / settings.samples as f64;
            Ok(Substeps::longest_part(between, limit))
        }
        Ok(StableStep::UpTo(limit)) if limit > 0.0 => {
            refused(format!("nothing in this scene limits the step of `{id}`"))
        }
        Ok(StableStep::UpTo(_)) => refused(format!("`{id}` is stable at no step on this scene")),
        Ok(StableStep::Any) => refused(format!("`{id}` is stable at any step")),
        Ok(StableStep::Unknown) => {
            refused(format!("`{id}` cannot tell up to which step it is stable"))
        }
        Err(error) => refused(error.to_string()),
    }
}
