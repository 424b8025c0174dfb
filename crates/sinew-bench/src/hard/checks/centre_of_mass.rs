//! A pulse moves the centre of mass of a free body by Newton's law.

use sinew_core::{Ramp, System};
use sinew_measure::{Case, MethodChoice};

use super::{at, trajectory};
use crate::hard::mark::Asked;
use crate::hard::methods::{block, chebyshev, cut};
use crate::report::{milliseconds, percent};
use crate::results::Mark;
use sinew_verify::LabError;

/// The axis along which the body is free.
const Z: usize = 2;

/// The largest distance of the centre of mass from its exact position, over its largest displacement: for the best
/// method and step.
pub(crate) fn check(asked: Asked, case: &Case, steps: &[f64]) -> Result<Mark, LabError> {
    let mut found = Vec::new();
    let methods = [
        block(),
        chebyshev(4),
        chebyshev(8),
        MethodChoice::new("newmark"),
        cut("central-difference"),
    ];
    for method in &methods {
        for &dt in steps {
            found.push((method.label(), dt, deviation(case, method, dt)?));
        }
    }
    let best = found
        .iter()
        .min_by(|a, b| a.2.total_cmp(&b.2))
        .ok_or_else(|| LabError::new("no method or no step was given"))?;
    let shown = |figure: f64| format!("{} %", percent(figure));
    let others = found.iter().filter(|other| *other != best);
    let others: Vec<String> = others
        .map(|(label, dt, figure)| {
            format!("{label} {} at {} ms", shown(*figure), milliseconds(*dt))
        })
        .collect();
    Ok(asked
        .measured(best.2, shown, at(&best.0, best.1))
        .noting(others.join(", ")))
}

fn deviation(case: &Case, method: &MethodChoice, dt: f64) -> Result<f64, LabError> {
    let simulation = case.simulation();
    let system = simulation.system();
    let path = trajectory(
        system,
        simulation.initial_state(),
        method,
        dt,
        case.run(dt).steps,
    )?;
    let exact = (1..=path.len()).map(|step| place(system, step as f64 * dt));
    let exact: Vec<f64> = exact.collect::<Result<_, _>>()?;
    let largest = exact.iter().fold(0.0, |max: f64, x| max.max(x.abs()));
    let distances = path
        .iter()
        .zip(&exact)
        .map(|(u, exact)| (centre(system, u) - exact).abs());
    let larger = |max: f64, x: f64| {
        if x.is_nan() {
            f64::INFINITY
        } else {
            max.max(x)
        }
    };
    Ok(distances.fold(0.0, larger) / largest)
}

/// Displacement (m) of the centre of mass along z.
fn centre(system: &dyn System, u: &[f64]) -> f64 {
    let (mut moment, mut mass) = (0.0, 0.0);
    for (u, m) in u.iter().zip(system.mass()).skip(Z).step_by(3) {
        moment += m * u;
        mass += m;
    }
    moment / mass
}

/// The position (m) of a mass m at time t under a pulse F, from rest: `F/m` times the integral of the
/// pulse, taken twice.
fn place(system: &dyn System, t: f64) -> Result<f64, LabError> {
    let linear = system
        .as_linear()
        .ok_or_else(|| LabError::new("needs the matrices of a linear system"))?;
    let [load] = linear.operators().loads() else {
        return Err(LabError::new("needs one load, a pulse"));
    };
    let Ramp::Pulse { from, to } = load.ramp else {
        return Err(LabError::new("needs one load, a pulse"));
    };
    let along_z = load
        .entries
        .iter()
        .filter(|(dof, _)| *dof as usize % 3 == Z);
    let force: f64 = along_z.map(|(_, force)| force).sum();
    let mass: f64 = system.mass().iter().skip(Z).step_by(3).sum();
    let while_on = |t: f64| 0.5 * t.max(0.0).powi(2);
    Ok(force / mass * (while_on(t - from) - while_on(t - to)))
}
