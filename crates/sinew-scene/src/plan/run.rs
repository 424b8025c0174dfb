//! The run: steps, and whether they are short enough.

use sinew_core::{StableStep, element_omegas_squared};

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
            if let StableStep::UpTo(limit) = stable_step
                && limit > 0.0
            {
                lines.extend(stiffest_element(simulation));
            }
            if stable_step == StableStep::Unknown {
                plan.warnings.push(format!(
                    "nothing is known about the step up to which `{id}` is stable here: its motion may grow at \
                     dt = {dt} s; `central-difference` knows its step"
                ));
            }
            plan.stable_step = stable_step;
        }
        Err(error) => plan.warnings.push(error),
    }
    // A method that makes patches names the elements they hold. Methods without a largest stable
    // step have nothing of the kind to say, and a set-up that is dear.
    let entries = sinew_integrators::entries();
    let has_limit = entries.iter().any(|entry| entry.id == id && entry.substeps);
    if has_limit
        && let Ok(mut integrator) = simulation.integrator()
        && integrator.prepare(simulation.system(), *dt).is_ok()
    {
        lines.extend(integrator.remarks());
    }
    plan.warnings.extend(simulation.refused_load());
    plan.warnings.extend(simulation.unresolved_load());
    if dt > duration {
        plan.warnings.push(format!(
            "dt = {dt} s is longer than the duration, {duration} s"
        ));
    }
    plan.add("run", lines);
}

/// Elements whose own step is shorter than half the usual stand out.
const STANDS_OUT: f64 = 0.5;

/// Which element sets the step, if one does.
fn stiffest_element(simulation: &Simulation) -> Option<String> {
    let linear = simulation.system().as_linear()?;
    let elements = linear.elements()?;
    let omegas = element_omegas_squared(elements, linear.operators().mass());
    // Steps (s) that single elements would allow.
    let step = |omega_squared: f64| 2.0 / omega_squared.max(0.0).sqrt();
    let mut steps: Vec<(f64, usize)> = omegas.iter().map(|w2| step(*w2)).zip(0..).collect();
    steps.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (&(shortest, worst), &(usual, _)) = (steps.first()?, steps.get(steps.len() / 2)?);
    if shortest >= STANDS_OUT * usual {
        return Some("no element sets the step alone: all allow about the same".to_owned());
    }
    let below = steps.partition_point(|(step, _)| *step < STANDS_OUT * usual);
    Some(format!(
        "{} sets the step: alone it would allow {} s, the usual element {} s; {} below half of \
         that, for which `central-difference` has patches = \"auto\"",
        elements.name(worst),
        short(shortest),
        short(usual),
        if below == 1 {
            "no other is".to_owned()
        } else {
            format!("{below} are")
        },
    ))
}
