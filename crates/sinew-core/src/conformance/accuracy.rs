//! Laws on the error of a method.

use super::boxed::Boxed;
use super::problems::{
    Dampers, FORCE, MASS, Problem, SPRING, advance, chain, exact, gentle_step, is_never_stable,
    moving, problems,
};
use crate::{Accuracy, Inputs, LinearSystem, SetupError};

/// Time over which errors are observed (s).
const DURATION: f64 = 0.5;

/// Halving the step divides the error by 2^order, to a tenth of an order, with mass damping and
/// without; an exact method is exact, under a constant load, to 1e-9 at any step.
pub fn observed_order_is_declared_order(make: &dyn Fn() -> Boxed) {
    for damping in [Dampers::MASS, Dampers::NONE] {
        for problem in problems(damping, FORCE) {
            if is_never_stable(&*make(), &problem.system) {
                continue; // no order to observe
            }
            let accuracy = make().properties().accuracy;
            observe(make, &problem, accuracy, damping);
        }
    }
}

/// The law of [`observed_order_is_declared_order`] under beta K and under a dashpot. A kind of damping
/// for which no order is declared is refused at set-up.
pub fn observed_order_under_other_damping_is_declared_order(make: &dyn Fn() -> Boxed) {
    let declared = make().properties().other_damping;
    for (damping, accuracy) in [
        (Dampers::STIFFNESS, declared.stiffness),
        (Dampers::DASHPOT, declared.dashpots),
    ] {
        for problem in problems(damping, FORCE) {
            if let Some(accuracy) = accuracy {
                observe(make, &problem, accuracy, damping);
                continue;
            }
            let refusal = make().prepare(&problem.system, 0.01);
            assert!(
                matches!(refusal, Err(SetupError::Lacks { .. })),
                "{damping:?}: declared to be refused, not {refusal:?}"
            );
        }
    }
}

fn observe(make: &dyn Fn() -> Boxed, problem: &Problem, accuracy: Accuracy, damping: Dampers) {
    let order = accuracy.order(damping != Dampers::NONE);
    let what = format!("{}, {damping:?}", problem.name);
    let dt = match order {
        Some(_) => gentle_step(&*make(), &problem.system),
        None => 0.07,
    };
    let coarse = (DURATION / dt).ceil() as usize;
    let instants = problem.motion(DURATION / coarse as f64, coarse);
    let error = |refinement: usize| {
        let dt = DURATION / (coarse * refinement) as f64;
        let (mut integrator, mut state) = (make(), problem.start.clone());
        let (mut sum, mut size) = (0.0, 0.0);
        for expected in &instants {
            advance(
                &mut *integrator,
                &problem.system,
                &mut state,
                refinement,
                dt,
            );
            for (u, expected) in state.u.iter().zip(expected) {
                sum += (u - expected).powi(2);
                size += expected * expected;
            }
        }
        f64::sqrt(sum / size)
    };
    let Some(order) = order else {
        let error = error(1);
        assert!(error <= 1e-9, "{what}: declared exact, error {error:.1e}");
        return;
    };
    let errors: Vec<f64> = [16, 32].into_iter().map(error).collect();
    let observed = (errors[0] / errors[1]).log2();
    assert!(
        (observed - f64::from(order)).abs() <= 0.1,
        "{what}: declared order {order}, observed {observed:.3} (errors {errors:?})"
    );
}

/// The velocity at the time of the displacement is that of the exact motion, to the method's
/// accuracy, and a synchronised state can be taken over by any method.
pub fn velocity_can_be_had_at_the_time_of_the_displacement(make: &dyn Fn() -> Boxed) {
    let damping = 2.0;
    let system = chain(damping, FORCE, [MASS; 2]);
    let start = moving();
    let (mut integrator, mut state) = (make(), start.clone());
    let dt = 1e-5;
    advance(&mut *integrator, &system, &mut state, 1000, dt);
    let mut velocity = vec![0.0; 2];
    assert!(
        state
            .velocity_at_t(&system, Inputs::none(), &mut velocity)
            .is_ok()
    );
    let (before, after) = (
        exact(damping, &start, state.t() - 1e-6),
        exact(damping, &start, state.t() + 1e-6),
    );
    for dof in 0..2 {
        let expected = (after[dof] - before[dof]) / 2e-6;
        assert!(
            (velocity[dof] - expected).abs() < 1e-3,
            "{} instead of {expected}",
            velocity[dof]
        );
    }
}

/// Damped motion under a constant load ends in K u = F.
pub fn static_solution_is_the_equilibrium(make: &dyn Fn() -> Boxed) {
    let damping = Dampers {
        mass: 20.0,
        ..Dampers::NONE
    };
    for Problem {
        name,
        system,
        start,
    } in problems(damping, FORCE)
    {
        let (mut integrator, mut state) = (make(), start);
        let dt = gentle_step(&*integrator, &system);
        let steps = (4.0 / dt).ceil() as usize;
        advance(&mut *integrator, &system, &mut state, steps, dt);
        let operators = system.operators();
        let (mut load, mut left) = (vec![0.0; state.u.len()], vec![0.0; state.u.len()]);
        operators.external_force(state.t(), &mut load);
        left.copy_from_slice(&load);
        operators.stiffness().subtract_product(&state.u, &mut left);
        let size = |force: &[f64]| force.iter().fold(0.0, |max: f64, f| max.max(f.abs()));
        let share = size(&left) / size(&load);
        assert!(
            share < 1e-8,
            "{name}: {share:.1e} of the load is left over at the end"
        );
        if name == "chain" {
            let equilibrium = [FORCE * 2.0 / (3.0 * SPRING), FORCE / (3.0 * SPRING)];
            for (u, expected) in state.u.iter().zip(equilibrium) {
                assert!((u / expected - 1.0).abs() < 1e-8, "{u} for {expected}");
            }
        }
    }
}
