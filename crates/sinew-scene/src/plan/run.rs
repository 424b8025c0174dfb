//! The run: steps, and whether they are short enough.

use sinew_core::StableStep;

use super::Plan;
use super::number::{count, short};
use crate::scene::{RunSettings, TimeStep};
use crate::simulation::Simulation;

pub(super) fn describe(simulation: &Simulation, plan: &mut Plan) {
    let RunSettings {
        duration,
        samples,
        integrator: id,
        dt: asked,
        options,
    } = simulation.settings();
    let dt = &simulation.dt();
    let options: Vec<String> = options
        .iter()
        .map(|(key, value)| format!(", {key} = {value}"))
        .collect();
    let mut lines = vec![
        match asked {
            TimeStep::Given(_) => format!("`{id}`, dt = {dt} s{}", options.concat()),
            TimeStep::Auto => format!(
                "`{id}`, dt = \"auto\": {} s{}",
                short(*dt),
                options.concat()
            ),
        },
        format!(
            "{} for {duration} s, error taken at {} instants",
            count(simulation.run().steps, "step"),
            samples + 1
        ),
    ];
    let stable_step = match simulation.integrator() {
        Ok(integrator) => integrator
            .stable_step(simulation.system())
            .map_err(|e| e.to_string()),
        Err(error) => Err(error.to_string()),
    };
    match stable_step {
        Ok(stable_step) => {
            lines.push(match stable_step {
                StableStep::Any => format!("`{id}` is stable at any step"),
                StableStep::UpTo(limit) if limit > 0.0 => {
                    format!("`{id}` is stable up to dt = {} s", short(limit))
                }
                StableStep::UpTo(_) => format!("`{id}` is stable at no step"),
                StableStep::Unknown => format!("`{id}` cannot tell up to which step it is stable"),
            });
            if stable_step.allows(*dt) == Some(false) {
                plan.warnings.push(match stable_step {
                    StableStep::UpTo(limit) if limit > 0.0 => format!(
                        "dt = {dt} s is {} times the stable step of `{id}`, {} s",
                        short(dt / limit),
                        short(limit)
                    ),
                    _ => format!("`{id}` is unstable on this scene at any dt"),
                });
            }
            plan.stable_step = stable_step;
        }
        Err(error) => plan.warnings.push(error),
    }
    if dt > duration {
        plan.warnings.push(format!(
            "dt = {dt} s is longer than the duration, {duration} s"
        ));
    }
    plan.add("run", lines);
}
