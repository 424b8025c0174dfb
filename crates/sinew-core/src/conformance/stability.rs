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

/// The motion stays bounded just below the declared stable step; just above it the motion grows, however slowly. A
/// method that declares itself stable at any step stays bounded at three and at a thousand times 2/omega_max. Only such
/// a method may refuse the latter, by [`SetupError::Unresolved`] and its own name.
pub fn stable_step_is_as_declared(make: &dyn Fn() -> Boxed) {
    for damping in [Dampers::NONE, Dampers::MASS] {
        for problem in problems(damping, 0.0) {
            hold_to_stable_step(make, &problem, damping);
        }
    }
}

/// Steps after which growth is judged.
const BLOCK: usize = 1000;
/// Growth of the mean square of the displacement that no bounded motion reaches.
const GROWN: f64 = 2.0;
/// Displacement, over the largest of the exact motion, at which the result is certain.
const FAR: f64 = 1e3;

/// A motion in steps of one length.
#[derive(Debug, Default)]
struct Followed {
    /// The largest displacement, over that of the exact motion.
    largest: f64,
    /// Sum of the squared displacements of each block of steps.
    blocks: Vec<f64>,
}

impl Followed {
    /// Mean square of the displacement in the last quarter over that in the first one; infinite for a motion that went far.
    fn growth(&self) -> f64 {
        if self.largest > FAR {
            return f64::INFINITY;
        }
        let quarter = self.blocks.len() / 4;
        let first: f64 = self.blocks.iter().take(quarter).sum();
        let last: f64 = self.blocks.iter().rev().take(quarter).sum();
        if first > 0.0 { last / first } else { 0.0 }
    }

    /// True if the growth of the motion is established already, so that it need not be followed any longer.
    fn has_grown(&self) -> bool {
        let count = self.blocks.len();
        self.largest > FAR || (count >= 16 && count.is_power_of_two() && self.growth() > GROWN)
    }
}

fn hold_to_stable_step(make: &dyn Fn() -> Boxed, problem: &Problem, damping: Dampers) {
    let system = &problem.system;
    let what = format!("{}, {damping:?}", problem.name);
    let critical = crate::spectrum::critical_step(system.operators());
    let largest = |u: &[f64]| u.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let exact = problem.motion(0.02, 60);
    let size = exact
        .iter()
        .fold(largest(&problem.start.u), |most, u| most.max(largest(u)));
    let follow = |dt: f64, steps: usize| -> Result<Followed, SetupError> {
        let (mut integrator, mut state) = (make(), problem.start.clone());
        integrator.prepare(system, dt)?;
        let mut followed = Followed::default();
        while followed.blocks.len() * BLOCK < steps && !followed.has_grown() {
            let mut squares = 0.0;
            for _ in 0..BLOCK.min(steps) {
                match integrator.step(system, &mut state, dt) {
                    Ok(_) => {}
                    Err(StepError::Setup(error)) => return Err(error),
                    Err(error) => unreachable!("{what}: `{}` refused: {error}", integrator.id()),
                }
                let reached = largest(&state.u) / size;
                if !state.u.iter().all(|u| u.is_finite()) || reached > FAR {
                    followed.largest = f64::INFINITY;
                    return Ok(followed);
                }
                followed.largest = followed.largest.max(reached);
                squares += state.u.iter().map(|u| u * u).sum::<f64>();
            }
            followed.blocks.push(squares);
        }
        Ok(followed)
    };
    let taken = |dt: f64, steps: usize| match follow(dt, steps) {
        Ok(followed) => followed,
        Err(error) => unreachable!("{what}: a step of {dt} s is declared and refused: {error}"),
    };
    let is_bounded = |followed: &Followed, most: f64, at: &str| {
        let (largest, growth) = (followed.largest, followed.growth());
        assert!(
            largest < most && growth < GROWN,
            "{what}: {largest:.3e} times as far as the exact motion, and grown by {growth:.3} at {at}"
        );
    };
    match make().stable_step(system) {
        Ok(StableStep::UpTo(limit)) => {
            if limit > 0.0 {
                let below = taken(0.99 * limit, 4 * BLOCK);
                is_bounded(&below, 20.0, &format!(".99 of {limit} s"));
            }
            let step = if limit > 0.0 {
                1.02 * limit
            } else {
                0.05 * critical
            };
            let above = taken(step, 256 * BLOCK).growth();
            assert!(
                above > GROWN,
                "{what}: grown by {above:.3} only at {step} s, above {limit} s"
            );
        }
        Ok(StableStep::Any) => {
            let long = taken(3.0 * critical, 4 * BLOCK);
            is_bounded(&long, 200.0, "3 times critical");
            match follow(1e3 * critical, 400) {
                // In so few steps, a hundredth of a turn each, growth cannot be distinguished from the motion.
                Ok(Followed { largest, .. }) => assert!(
                    largest < 200.0,
                    "{what}: {largest:.3e} times as far as the exact motion at 1000 times critical"
                ),
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
