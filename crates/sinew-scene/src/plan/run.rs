//! Section about the run: its steps and their stability.

use sinew_core::{ElementStiffness, StableStep};

use super::section::PlanSection;
use crate::number::{count, short};
use crate::scene::{RunSettings, TimeStep};
use crate::simulation::Simulation;

/// The section about the run.
pub(super) fn section(simulation: &Simulation) -> PlanSection {
    let RunSettings {
        duration,
        samples,
        integrator: id,
        dt: asked,
        options,
        memory: _,
        free_flight: _,
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
    if let Ok(stable_step) = simulation.stable_step() {
        lines.push(match stable_step {
            StableStep::Any => format!("`{id}` is stable at any step"),
            StableStep::UpTo(limit) if limit > 0.0 && simulation.system().as_linear().is_none() => {
                let rest = format!("`{id}` is stable up to {} s at rest; ", short(limit));
                let mend = if simulation.follows_stiffness() {
                    "steps are cut into parts of nine tenths of the stable step as the stiffness changes"
                } else {
                    "that shrinks as tissue is squeezed or stretched, which dt = \"auto\" follows and this dt does not"
                };
                rest + mend
            }
            StableStep::UpTo(limit) if limit > 0.0 => {
                format!("`{id}` is stable up to dt = {} s", short(limit))
            }
            StableStep::UpTo(_) => format!("`{id}` is stable at no step"),
            StableStep::Unknown => format!("`{id}` cannot tell up to which step it is stable"),
        });
        if matches!(stable_step, StableStep::UpTo(limit) if limit > 0.0) {
            lines.extend(stiffest_element(simulation));
        }
    }
    // The remarks of a method with patches name the elements in them. Methods that are no programs
    // make no such remarks, and their set-up is costly.
    let entries = sinew_integrators::entries();
    let mut own = entries.iter().filter(|entry| entry.id == id);
    let tells = own.any(|entry| entry.substeps || entry.programs);
    if tells && let Ok(mut integrator) = simulation.integrator() {
        match integrator.prepare(simulation.system(), *dt) {
            Ok(_) => {
                lines.extend(integrator.computed_by());
                lines.extend(integrator.remarks());
            }
            Err(refused) => lines.push(format!("it is refused: {refused}")),
        }
    }
    PlanSection::new("run", lines)
}

/// Share of the median element's step below which the step of an element stands out.
const STANDS_OUT: f64 = 0.5;

/// Largest number of elements for the median; of more elements, every nth is used.
const SAMPLE: usize = 5_000;

/// A sentence about the element that sets the step, if one does.
fn stiffest_element(simulation: &Simulation) -> Option<String> {
    let linear = simulation.system().as_linear()?;
    let elements = linear.elements()?;
    let mass = linear.operators().mass();
    let mut stiffness = ElementStiffness::default();
    let mut omega_squared = |element: usize| {
        elements.stiffness(element, &mut stiffness);
        stiffness.omega_squared(mass)
    };
    // Steps (s) that single elements would allow.
    let step = |omega_squared: f64| 2.0 / omega_squared.max(0.0).sqrt();
    let stride = elements.count().div_ceil(SAMPLE).max(1);
    let sample = (0..elements.count()).step_by(stride);
    let mut sample: Vec<f64> = sample.map(|element| step(omega_squared(element))).collect();
    sample.sort_by(f64::total_cmp);
    let median = *sample.get(sample.len() / 2)?;
    let limit = STANDS_OUT * median;
    let inverse_mass: Vec<f64> = mass.iter().map(|mass| 1.0 / mass).collect();
    let (mut shortest, mut worst, mut below) = (f64::INFINITY, 0, 0_usize);
    for element in 0..elements.count() {
        elements.stiffness(element, &mut stiffness);
        if step(stiffness.omega_squared_bound(&inverse_mass)) >= limit {
            continue;
        }
        let own = step(stiffness.omega_squared(mass));
        below += usize::from(own < limit);
        if own < shortest {
            (shortest, worst) = (own, element);
        }
    }
    if below == 0 {
        return Some("no element sets the step alone: all allow about the same".to_owned());
    }
    Some(format!(
        "{} sets the step: alone it would allow {} s, the median element {} s; {} below half of \
         that, for which `central-difference` has patches = \"auto\"",
        elements.name(worst),
        short(shortest),
        short(median),
        if below == 1 {
            "no other is".to_owned()
        } else {
            format!("{below} are")
        },
    ))
}
