//! A scene moves alike whatever its unit of length.

use sinew_core::OptionValue;
use sinew_measure::{Case, Method};

use super::{at, largest_difference, trajectory};
use crate::hard::mark::{Asked, Mark};
use crate::hard::pairs::in_units;
use crate::report::three;

/// Millimetres and micrometres a metre.
const UNITS: [f64; 2] = [1e3, 1e6];

/// Most steps that are compared.
const MOST_STEPS: usize = 200;

/// The largest difference between the motion of a scene in metres and in other units, over the
/// largest displacement: of every scene by its own method at its own step.
pub(crate) fn check<'a>(
    asked: Asked,
    cases: impl IntoIterator<Item = &'a Case>,
) -> Result<Mark, String> {
    let mut worst = (0.0, String::new());
    let mut ids = Vec::new();
    for case in cases {
        let simulation = case.simulation();
        let settings = simulation.settings();
        let method = Method {
            integrator: settings.integrator.clone(),
            options: settings.options.clone(),
        };
        let dt = simulation.dt();
        let steps = case.run(dt).steps.min(MOST_STEPS);
        let (system, start) = (simulation.system(), simulation.initial_state());
        let metres = trajectory(system, start, &method, dt, steps)?;
        for per_metre in UNITS {
            let twin = in_units(simulation, per_metre)?;
            let method = scaled(&method, per_metre);
            let mut path = trajectory(&*twin.system, &twin.start, &method, dt, steps)?;
            path.iter_mut().flatten().for_each(|u| *u /= per_metre);
            let difference = largest_difference(&path, &metres);
            if !(difference <= worst.0) {
                worst = (
                    difference,
                    format!("{}: {}", case.id(), at(&method.label(), dt)),
                );
            }
        }
        ids.push(case.id());
    }
    let note = format!(
        "largest of {} scenes in mm and um: {}",
        ids.len(),
        ids.join(", ")
    );
    Ok(asked.measured(worst.0, three, worst.1).noting(note))
}

/// A saturation voltage is a velocity.
fn scaled(method: &Method, per_metre: f64) -> Method {
    const SATURATION: &str = "saturation";
    let mut method = method.clone();
    if let Some(OptionValue::Number(voltage)) = method.options.get(SATURATION) {
        let voltage = voltage * per_metre;
        method
            .options
            .insert(SATURATION, OptionValue::Number(voltage));
    }
    method
}
