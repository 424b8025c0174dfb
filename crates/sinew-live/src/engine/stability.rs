//! Facts about the stability of steps.

use sinew_core::{EnergyBehaviour, Options, StableStep, System};
use sinew_integrators::Stepper;
use sinew_integrators::explicit::Substeps;

use crate::protocol::{Stability, StepFacts};

/// Stability of the steps of an integrator on a scene, as far as known; `options` are those that it was built
/// with.
pub(super) fn facts(
    integrator: &dyn Stepper,
    options: &Options,
    system: &dyn System,
    found: StableStep,
) -> StepFacts {
    let is_linear = system.as_linear().is_some();
    let cuts = options.get(Substeps::KEY).and_then(|value| value.word());
    let energy = integrator.properties().energy;
    let (stability, stable_step) = match found {
        StableStep::UpTo(step) if is_linear => (Stability::UpTo, Some(step)),
        StableStep::UpTo(step) => (Stability::AtRestUpTo, Some(step)),
        StableStep::Any if is_linear || energy == EnergyBehaviour::NeverRises => {
            (Stability::Any, None)
        }
        // Parts are found by the current stiffness.
        StableStep::Any if cuts.is_some() => (Stability::Cut, None),
        StableStep::Any => (Stability::AtRest, None),
        StableStep::Unknown => (Stability::Unknown, None),
    };
    StepFacts {
        stability,
        stable_step,
    }
}
