//! The pass marks of the hard cases, one file for each.

pub(crate) mod centre_of_mass;
pub(crate) mod energy_and_work;
pub(crate) mod energy_form;
pub(crate) mod equilibrium;
pub(crate) mod long_run;
pub(crate) mod mirror;
pub(crate) mod released_bar;
pub(crate) mod rotation;
pub(crate) mod slivers;
pub(crate) mod units;
pub(crate) mod within_work;

use sinew_core::{Integrator, State, System};
use sinew_measure::MethodChoice;

use crate::report::milliseconds;
use sinew_verify::LabError;

/// Description of a method at a step.
pub(crate) fn at(method: &str, dt: f64) -> String {
    format!("{method}, {} ms", milliseconds(dt))
}

/// A method, built and set up.
pub(crate) fn set_up(
    method: &MethodChoice,
    system: &dyn System,
    dt: f64,
) -> Result<Box<dyn Integrator>, LabError> {
    let mut integrator = method.build()?;
    integrator.prepare(system, dt)?;
    Ok(integrator)
}

/// The displacements after each of `steps` steps.
pub(crate) fn trajectory(
    system: &dyn System,
    start: &State,
    method: &MethodChoice,
    dt: f64,
    steps: usize,
) -> Result<Vec<Vec<f64>>, LabError> {
    let mut integrator = set_up(method, system, dt)?;
    let mut state = start.clone();
    let step = |_| {
        integrator.step(system, &mut state, dt)?;
        Ok(state.u.clone())
    };
    (0..steps).map(step).collect()
}

/// Largest difference of two trajectories over the largest displacement of the second; NaN counts
/// as infinite.
pub(crate) fn largest_difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let larger = |max: f64, x: f64| {
        if x.is_nan() {
            f64::INFINITY
        } else {
            max.max(x.abs())
        }
    };
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let difference = pairs.map(|(a, b)| a - b).fold(0.0, larger);
    difference / b.iter().flatten().copied().fold(0.0, larger)
}
