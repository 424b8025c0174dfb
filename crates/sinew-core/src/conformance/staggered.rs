//! Laws on states that a staggered method left.

use super::boxed::Boxed;
use super::problems::{Dampers, FORCE, Problem, advance, gentle_step, problems};
use crate::{Acceleration, Inputs, LoadTime, State, System, Trial, VelocityTime};

/// The state after some steps of `dt` (s) of a leapfrog, its velocity half a step behind.
fn leapfrog(problem: &Problem, dt: f64, kept: Acceleration) -> State {
    let (system, mut state): (&dyn System, _) = (&problem.system, problem.start.clone());
    let mut a = vec![0.0; state.u.len()];
    for step in 0..4 {
        let trial = Trial::of(&state, LoadTime::at(state.t()));
        if let Err(error) = system.net_force(&trial, &mut a) {
            unreachable!("a linear system refuses nothing: {error}");
        }
        let since = if step == 0 { 0.5 * dt } else { dt };
        for (dof, mass) in system.mass().iter().enumerate() {
            a[dof] /= mass;
            state.v[dof] += since * a[dof];
            state.u[dof] += dt * state.v[dof];
        }
        state.end_step(dt, VelocityTime::MiddleOfStep, kept);
    }
    if kept == Acceleration::Kick {
        state.a = a;
    }
    state
}

/// A state whose velocity a leapfrog left half a step behind is taken over through
/// [`State::synchronise`], to the last bit: whether it keeps the acceleration of its last kick or
/// not, after steps of the same length and of another. Only a method that is staggered itself
/// continues differently, and only with the same step.
pub fn a_staggered_state_is_taken_over_at_one_time(make: &dyn Fn() -> Boxed) {
    for problem in problems(Dampers::MASS, FORCE) {
        let system = &problem.system;
        let dt = gentle_step(&*make(), system);
        for kept in [Acceleration::None, Acceleration::Kick] {
            for before in [dt, 0.7 * dt] {
                let mut state = leapfrog(&problem, before, kept);
                let mut expected = state.clone();
                let mut work = vec![0.0; state.u.len()];
                let moved = expected.synchronise(system, Inputs::none(), &mut work);
                assert_eq!(moved, Ok(true));
                advance(&mut *make(), system, &mut state, 5, dt);
                advance(&mut *make(), system, &mut expected, 5, dt);
                if before == dt && expected.velocity != VelocityTime::Same {
                    continue;
                }
                let what = format!("{}, {kept:?}, {before} s before {dt} s", problem.name);
                assert_eq!(state.u, expected.u, "{what}");
                assert_eq!(state.v, expected.v, "{what}");
                assert_eq!(state.velocity, expected.velocity, "{what}");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::problems::exact;
    use super::*;

    #[test]
    fn the_leapfrog_follows_the_exact_motion_to_second_order() {
        let [chain, _] = problems(Dampers::MASS, FORCE);
        let error = |dt: f64, kept| {
            let mut state = leapfrog(&chain, dt, kept);
            let mut work = vec![0.0; 2];
            let moved = state.synchronise(&chain.system, Inputs::none(), &mut work);
            assert_eq!(moved, Ok(true));
            let at = |t: f64| exact(2.0, &chain.start, t);
            let (now, h) = (state.t(), 1e-6);
            let speed = (at(now + h)[0] - at(now - h)[0]) / (2.0 * h);
            [(state.u[0] - at(now)[0]).abs(), (state.v[0] - speed).abs()]
        };
        for kept in [Acceleration::None, Acceleration::Kick] {
            let [u, v] = error(1e-3, kept);
            assert!(u < 1e-6 && v < 3e-3, "{kept:?}: {u} {v}");
        }
    }
}
