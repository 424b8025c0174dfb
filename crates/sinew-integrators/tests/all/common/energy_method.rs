//! The energy guarantee of `cnn-energy`.

use sinew_core::vectors::{dot, norm, weighted_dot};
use sinew_core::{Integrator, LoadTime, OptionValue, Options, State, System, Trial};

use super::build;

fn options(kind: &str, sweeps: u32) -> Options {
    let kind = OptionValue::Text(kind.into());
    let options = Options::new().with("kind", kind);
    options.with_number("sweeps", f64::from(sweeps))
}

pub(crate) fn energy_method(kind: &str, sweeps: u32) -> Box<dyn Integrator> {
    build("cnn-energy", &options(kind, sweeps))
}

/// Kinetic and elastic energy of a state (J), and the size of its rounded terms.
fn energy(system: &dyn System, state: &State) -> [f64; 2] {
    let trial = Trial::of(state, LoadTime::at(state.t()));
    let mut force = vec![0.0; state.u.len()];
    let law = system.as_elastic().unwrap();
    let elastic = law.elastic_force(&trial, &mut force).unwrap().energy;
    let total = elastic + 0.5 * weighted_dot(system.mass(), &state.v, &state.v);
    [total, total.abs() + norm(&force) * norm(&state.u)]
}

/// Work of the loads in a step (J), their mean over the step times the displacement; and the size of the terms whose
/// difference it is.
fn work(system: &dyn System, kind: &str, before: &State, after: &State, dt: f64) -> [f64; 2] {
    let moved: Vec<f64> = after.u.iter().zip(&before.u).map(|(b, a)| b - a).collect();
    let of = |when: LoadTime<'_>| {
        let mut force = vec![0.0; moved.len()];
        system.external_force(when, &before.u, &mut force);
        let size = norm(&force) * (norm(&after.u) + norm(&before.u));
        [dot(&force, &moved), size]
    };
    match kind {
        "ie" => of(LoadTime::end_of(before.t(), dt)),
        _ => {
            let [start, end] = LoadTime::at_both_ends(before.t(), dt, 0.5).map(of);
            [0, 1].map(|at| 0.5 * (start[at] + end[at]))
        }
    }
}

/// Takes steps and compares the energy with that at the start plus the work of the loads since; returns the step at
/// which it rose above.
pub(crate) fn never_rises(
    system: &dyn System,
    (kind, sweeps): (&str, u32),
    start: State,
    dt: f64,
    steps: usize,
) -> Result<(), String> {
    let mut integrator = energy_method(kind, sweeps);
    let mut state = start;
    let [first, mut size] = energy(system, &state);
    let (mut brought, mut before_step) = (0.0, first);
    for step in 0..steps {
        let before = state.clone();
        integrator.step(system, &mut state, dt).unwrap();
        let [found, of_energy] = energy(system, &state);
        let [work, of_loads] = work(system, kind, &before, &state, dt);
        brought += work;
        size = size.max(of_energy).max(brought.abs()).max(of_loads);
        let rise = found - before_step - work;
        let excess = found - first - brought;
        // Not so where it is not a number.
        let kept = rise <= 1e-13 * size && excess <= 1e-12 * size;
        if !kept {
            return Err(format!(
                "step {step}: by {rise:e}, {excess:e} in all, of {size:e}"
            ));
        }
        before_step = found;
    }
    Ok(())
}
