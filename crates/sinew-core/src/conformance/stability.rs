//! Laws on energy and growth.

use super::boxed::Boxed;
use super::problems::{Dampers, Problem, advance, gentle_step, problems};
use crate::{
    Energy, EnergyBehaviour, Inputs, LinearSystem, SetupError, StableStep, State, StepError, System,
};

fn total_energy(system: &dyn System, state: &State) -> f64 {
    let mut velocity = vec![0.0; state.u.len()];
    if let Err(error) = state.velocity_at_t(system, Inputs::none(), &mut velocity) {
        unreachable!("a linear system refuses nothing: {error}");
    }
    system
        .energy(&state.u, &velocity)
        .map_or(f64::NAN, Energy::total)
}

/// The energy of an undamped, unloaded system is conserved, bounded, falls or grows as declared.
pub fn energy_behaves_as_declared(make: &dyn Fn() -> Boxed) {
    for Problem {
        name,
        system,
        start,
    } in problems(Dampers::NONE, 0.0)
    {
        let (mut integrator, mut state) = (make(), start);
        let dt = gentle_step(&*integrator, &system);
        let start = total_energy(&system, &state);
        let energies: Vec<f64> = (0..2000)
            .map(|_| {
                advance(&mut *integrator, &system, &mut state, 1, dt);
                total_energy(&system, &state) / start
            })
            .collect();
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let (early, late) = (mean(&energies[..500]), mean(&energies[1500..]));
        let (low, high) = energies
            .iter()
            .fold((f64::MAX, f64::MIN), |(low, high), &e| {
                (low.min(e), high.max(e))
            });
        let summary =
            format!("{name}: energy over start {low:.3e}..{high:.3e}, early {early}, late {late}");
        match make().properties().energy {
            EnergyBehaviour::Conserved => {
                assert!(low > 1.0 - 1e-10 && high < 1.0 + 1e-10, "{summary}");
            }
            EnergyBehaviour::Bounded => {
                assert!(low > 0.5 && high < 2.0, "{summary}");
                assert!((late / early - 1.0).abs() < 0.01, "{summary}");
            }
            EnergyBehaviour::Falls => {
                assert!(late < 0.999 * early, "{summary}");
                assert!(high < 1.0 + 1e-3, "{summary}");
            }
            EnergyBehaviour::NeverRises => {
                let rises = |pair: &[f64]| pair[1] > pair[0] + 1e-14;
                let at = energies.windows(2).position(rises);
                assert!(at.is_none() && high <= 1.0 + 1e-12, "{summary}, {at:?}");
            }
            EnergyBehaviour::Grows => assert!(late > 1.5 * early, "{summary}"),
        }
    }
}

/// Just below the declared stable step motion stays bounded, just above it grows; where the
/// method declares itself stable at any step, it stays bounded at three and at a thousand times
/// 2/omega_max. Only a method that declares so may refuse the latter, by
/// [`SetupError::Unresolved`] and its own name.
pub fn stable_step_is_as_declared(make: &dyn Fn() -> Boxed) {
    for damping in [Dampers::NONE, Dampers::MASS] {
        for problem in problems(damping, 0.0) {
            hold_to_stable_step(make, &problem, damping);
        }
    }
}

fn hold_to_stable_step(make: &dyn Fn() -> Boxed, problem: &Problem, damping: Dampers) {
    let system = &problem.system;
    let what = format!("{}, {damping:?}", problem.name);
    let critical = crate::spectrum::critical_step(system.operators());
    // The largest displacement within so many steps; beyond 1e3 m nothing more is learned.
    let growth = |dt: f64, steps: usize| -> Result<f64, SetupError> {
        let (mut integrator, mut state) = (make(), problem.start.clone());
        integrator.prepare(system, dt)?;
        let mut size = 0.0;
        for _ in 0..steps {
            match integrator.step(system, &mut state, dt) {
                Ok(_) => {}
                Err(StepError::Setup(error)) => return Err(error),
                Err(error) => unreachable!("{what}: `{}` refused: {error}", integrator.id()),
            }
            let finite = state.u.iter().all(|u| u.is_finite());
            size = state.u.iter().fold(size, |size: f64, u| size.max(u.abs()));
            if !finite || size > 1e3 {
                return Ok(f64::INFINITY);
            }
        }
        Ok(size)
    };
    let taken = |dt: f64, steps: usize| match growth(dt, steps) {
        Ok(size) => size,
        Err(error) => unreachable!("{what}: a step of {dt} s is declared and refused: {error}"),
    };
    match make().stable_step(system) {
        Ok(StableStep::UpTo(limit)) => {
            if limit > 0.0 {
                let below = taken(0.99 * limit, 4000);
                assert!(below < 1.0, "{what}: {below} at .99 of {limit}");
            }
            let step = if limit > 0.0 {
                1.02 * limit
            } else {
                0.05 * critical
            };
            let above = taken(step, 1_000_000);
            assert!(
                above.is_infinite(),
                "{what}: only {above} at {step} above {limit}"
            );
        }
        Ok(StableStep::Any) => {
            let size = taken(3.0 * critical, 4000);
            assert!(size < 10.0, "{what}: {size} at 3 times critical");
            match growth(1e3 * critical, 400) {
                Ok(size) => assert!(size < 10.0, "{what}: {size} at 1000 times critical"),
                Err(error) => {
                    let declared = make().properties().refuses_long_steps;
                    assert!(declared, "{what}: not declared to be refused: {error}");
                    let is_named = error.to_string().contains(make().id());
                    let is_of_kind = matches!(error, SetupError::Unresolved { .. });
                    assert!(is_named && is_of_kind, "{what}: {error}");
                }
            }
        }
        Ok(StableStep::Unknown) => {}
        Err(error) => unreachable!("{what}: a linear system has a spectrum: {error}"),
    }
}
