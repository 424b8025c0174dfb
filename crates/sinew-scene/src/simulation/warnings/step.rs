//! Steps that are unstable, or do not fit the duration.

use sinew_core::StableStep;
use sinew_integrators::explicit::GuardOption;

use super::{Warning, WarningKind};
use crate::number::{count, short};
use crate::simulation::Simulation;

/// Warnings of an unstable step, with the effect of a clamp; empty if the step is stable.
pub(super) fn unstable(simulation: &Simulation) -> Vec<Warning> {
    let (dt, id) = (simulation.dt(), &simulation.settings().integrator);
    let kind = WarningKind::UnstableStep;
    let stable_step = match simulation.stable_step() {
        Ok(stable_step) => stable_step,
        Err(error) => return vec![Warning::new(kind, error.to_string(), "")],
    };
    if simulation.follows_stiffness() {
        return Vec::new();
    }
    match (stable_step, stable_step.allows(dt)) {
        (_, Some(true)) => Vec::new(),
        (StableStep::UpTo(limit), _) if limit > 0.0 => {
            let what = format!(
                "dt = {dt} s is {} times the stable step of `{id}`, {} s",
                short(dt / limit),
                short(limit)
            );
            let numbers = [("dt_s", dt), ("stable_step_s", limit)];
            let beyond = Warning::new(kind, what, "").with(&numbers);
            std::iter::once(beyond).chain(clamped(simulation)).collect()
        }
        (_, Some(false)) => {
            let what = format!("`{id}` is unstable on this scene at any dt");
            let never = Warning::new(kind, what, "");
            std::iter::once(never).chain(clamped(simulation)).collect()
        }
        (_, None) => {
            let what = format!(
                "nothing is known about the step up to which `{id}` is stable here: its motion may grow at \
                 dt = {dt} s"
            );
            vec![Warning::new(
                kind,
                what,
                "`central-difference` knows its step",
            )]
        }
    }
}

/// A warning that only the clamp of a network bounds a step that is too long; `None` for other methods, and if the
/// scene lets the clamp divide its steps.
fn clamped(simulation: &Simulation) -> Option<Warning> {
    let settings = simulation.settings();
    let entry = sinew_integrators::entry(&settings.integrator)?;
    let own_clamp = entry.guard == GuardOption::OwnOrAuto;
    let given = settings.options.get(GuardOption::KEY)?;
    if !own_clamp || given.word().is_some() {
        return None;
    }
    let what = format!(
        "only its clamp keeps `{}` bounded at this step, and that makes no motion right: on the paper's cube, in \
         steps of 16 times the stable one, its error is 2520 %",
        settings.integrator
    );
    let mend = "`cnn-stabilised` takes such a step; saturation = \"auto\" cuts it into stable ones";
    Some(Warning::new(WarningKind::ClampedNetwork, what, mend))
}

/// A warning about steps that are longer than the duration or do not end with it.
pub(super) fn beside_duration(simulation: &Simulation) -> Option<Warning> {
    let (dt, duration) = (simulation.dt(), simulation.settings().duration);
    let steps = simulation.run().steps.max(1);
    let shortened = duration / steps as f64;
    let end = steps as f64 * dt;
    if dt > duration {
        let what = format!("dt = {dt} s is longer than the duration, {duration} s");
        let numbers = [("dt_s", dt), ("duration_s", duration)];
        let mend = "`sinew run` takes one step that ends with it";
        return Some(Warning::new(WarningKind::LongStep, what, mend).with(&numbers));
    }
    if (end - duration).abs() <= 1e-9 * duration {
        return None;
    }
    let what = format!(
        "dt = {dt} s does not divide the duration, {duration} s: {} end at t = {} s",
        count(steps, "step"),
        short(end)
    );
    let mend = format!("`sinew run` shortens them all to {shortened} s");
    let numbers = [
        ("dt_s", dt),
        ("duration_s", duration),
        ("end_s", end),
        ("shortened_dt_s", shortened),
    ];
    Some(Warning::new(WarningKind::UnevenSteps, what, mend).with(&numbers))
}
