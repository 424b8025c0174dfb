//! `propagator` in two-step form: exact displacements, stability at any tolerance, half the sweeps.

use std::sync::Arc;

use crate::common::cube::{altered, cube, paper_cube, reference, run};
use crate::common::exponential::exponentials;
use crate::common::{advance, build, largest, plain, relative_error, velocity_after};
use proptest::prelude::*;
use sinew_core::spectrum::critical_step;
use sinew_core::{
    BlockMatrix, Damping, Integrator, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    OptionValue, Options, Pattern, Ramp, State, System,
};
use sinew_testkit::body::bodies_up_to;

fn kind(tolerance: f64) -> Options {
    plain()
        .with("kind", OptionValue::Text("two-step".into()))
        .with_number("tolerance", tolerance)
}

fn two_step(tolerance: f64) -> Box<dyn Integrator> {
    build("propagator", &kind(tolerance))
}

fn mass_damping(mass: f64) -> Damping {
    Damping {
        mass,
        ..Damping::default()
    }
}

/// A step and two pulses that begin and end on steps, one of them over a single step.
fn jumping_loads(dofs: usize, dt: f64, force: f64) -> Vec<Load> {
    let at = |step: u32| f64::from(step) * dt;
    let pulse = |from, to| Ramp::Pulse {
        from: at(from),
        to: at(to),
    };
    (0_u32..)
        .zip([Ramp::Step, pulse(3, 8), pulse(5, 6)])
        .map(|(number, ramp)| Load {
            ramp,
            entries: (0..dofs as u32)
                .map(|dof| (dof, force * f64::from(3 * dof + number).sin()))
                .collect(),
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Displacements under loads that jump, from none to twice the damping at which the fastest mode
    /// creeps, free bodies among them.
    #[test]
    fn random_networks_move_as_their_matrix_exponential_says(
        body in bodies_up_to(1),
        share in 0.1..20.0,
        ratio in prop_oneof![Just(0.0), 1e-3..2.0],
        free in any::<bool>(),
    ) {
        let body = if free { body.free() } else { body }.without_dashpots();
        let model = body.model();
        let limit = critical_step(model.operators());
        let start = body.state(&model, 1e-3, 1e-3 / limit);
        let dt = share * limit;
        let force = 1e-3 * model.mass()[0] * (2.0 / limit).powi(2);
        let loads = jumping_loads(model.dofs(), dt, force);
        let system = altered(&model, mass_damping(2.0 * ratio / limit), loads);
        let mut state = start.clone();
        let mut integrator = two_step(1e-13);
        let (mut worst, mut size) = (0.0_f64, largest(&start.u));
        for expected in exponentials(&system, &start, dt, 10) {
            integrator.step(&system, &mut state, dt).unwrap();
            let difference = state.u.iter().zip(&expected.u).map(|(a, b)| (a - b).abs());
            worst = worst.max(difference.fold(0.0, f64::max));
            size = size.max(largest(&expected.u));
        }
        prop_assert!(worst <= 1e-9 * size, "{worst:e} of {size:e}");
    }

    /// With any loose tolerance, and thus few sweeps, no mode grows: 1500 steps later the motion is as large as at the
    /// beginning, or smaller.
    #[test]
    fn no_tolerance_and_no_step_makes_it_unstable(
        body in bodies_up_to(1),
        share in 0.2..40.0,
        ratio in prop_oneof![Just(0.0), 1e-4..1.0],
        tolerance in prop_oneof![Just(0.9), Just(0.1), Just(1e-2), Just(1e-4)],
    ) {
        // Held: a free body may fly.
        let body = body.on_the_ground().conservative();
        let model = body.model();
        let limit = critical_step(model.operators());
        let system = altered(&model, mass_damping(2.0 * ratio / limit), vec![]);
        let mut state = body.state(&model, 1e-3, 1e-3 / limit);
        let mut integrator = two_step(tolerance);
        let size = |state: &State| {
            let mut force = vec![0.0; state.u.len()];
            system.operators().stiffness().multiply(&state.u, &mut force);
            state.u.iter().zip(&force).map(|(u, f)| u * f).sum::<f64>()
        };
        let energy = system.energy(&state.u, &state.v).unwrap().total();
        for step in 0..1500 {
            integrator.step(&system, &mut state, share * limit).unwrap();
            // A mode of the recurrence whose polynomial is near a multiple of pi swings wider than
            // the motion that set it going, but never for ever wider.
            prop_assert!(size(&state) <= 1e4 * energy, "step {step}: {:e} of {energy:e}", size(&state));
        }
    }
}

/// The reproduction scene in steps of 20 ms, for which the one-step form takes 1050 sweeps a second.
#[test]
fn half_the_sweeps_of_the_one_step_form() {
    let measure = |options: &Options| {
        let (instants, _, report) = run(paper_cube(), &mut *build("propagator", options), 1);
        (relative_error(&instants, reference()), report.work.sweeps)
    };
    let chebyshev = |tolerance| measure(&plain().with_number("tolerance", tolerance));
    for (tolerance, error, share) in [(1e-3, 2e-5, 0.65), (1e-8, 1e-6, 0.78)] {
        let (one, two) = (chebyshev(tolerance), measure(&kind(tolerance)));
        println!("{tolerance:e}: one-step {one:?}, two-step {two:?}");
        assert!(two.0 <= error, "{tolerance:e}: {two:?}");
        assert!(two.1 as f64 <= share * one.1 as f64, "{one:?} {two:?}");
    }
}

#[test]
fn a_checkpoint_continues_to_the_same_bits() {
    let model = cube(3);
    let mut through = State::at_rest(model.dofs());
    advance(&mut *two_step(1e-6), &model, &mut through, 20, 0.02);
    let mut halves = State::at_rest(model.dofs());
    advance(&mut *two_step(1e-6), &model, &mut halves, 10, 0.02);
    let mut halves = halves.clone();
    advance(&mut *two_step(1e-6), &model, &mut halves, 10, 0.02);
    assert_eq!(through, halves);
}

/// Another method continues from the velocity at the displacement's time, which is accurate to second order in the
/// step.
#[test]
fn another_method_can_go_on() {
    let model = cube(3);
    let exact = velocity_after(&mut *build("propagator", &plain()), &model, 3, 0.02);
    let error = |parts: usize| {
        let found = velocity_after(
            &mut *two_step(1e-10),
            &model,
            3 * parts,
            0.02 / parts as f64,
        );
        relative_error(&[found], std::slice::from_ref(&exact))
    };
    let (coarse, fine) = (error(10), error(20));
    let after_one_step = relative_error(
        &[velocity_after(&mut *two_step(1e-10), &model, 1, 1e-4)],
        &[velocity_after(
            &mut *build("propagator", &plain()),
            &model,
            1,
            1e-4,
        )],
    );
    assert!(after_one_step < 0.01, "{after_one_step:e}");
    assert!(
        fine < 0.01 && (coarse / fine).log2() > 1.8,
        "{coarse:e} {fine:e}"
    );
}

fn refusal(system: &LinearModel, dt: f64, steps: usize) -> String {
    let mut integrator = two_step(1e-6);
    let mut state = State::at_rest(system.dofs());
    for _ in 0..steps {
        if let Err(error) = integrator.step(system, &mut state, dt) {
            return error.to_string();
        }
    }
    "nothing refused".into()
}

#[test]
fn what_it_cannot_do_is_refused_with_what_can() {
    let model = cube(3);
    let with = |ramp, stiffness| {
        let damping = Damping {
            stiffness,
            ..mass_damping(10.0)
        };
        let entries = vec![(2, 1.0)];
        altered(&model, damping, vec![Load { ramp, entries }])
    };
    assert_eq!(
        refusal(&with(Ramp::Step, 1e-3), 0.02, 1),
        "`propagator` needs mass damping at most for kind = \"two-step\"; \"chebyshev\" takes \
         proportional damping, \"krylov\" any, which this system does not offer"
    );
    let advice = "and is not constant over each step of 0.02 s; choose a dt that meets the \
                  instants at which loads jump, or kind = \"chebyshev\"";
    assert_eq!(
        refusal(&with(Ramp::Sin2 { rise: 0.1 }, 0.0), 0.02, 1),
        format!("`propagator` at t = 0 s: a load changes at t = 0 s, {advice}")
    );
    let pulse = Ramp::Pulse {
        from: 0.02,
        to: 0.05,
    };
    assert_eq!(
        refusal(&with(pulse, 0.0), 0.02, 5),
        format!("`propagator` at t = 0.04 s: a load changes at t = 0.05 s, {advice}")
    );
}

/// Masses of 1 kg, each on a spring of its own: these squares of frequencies (1/s^2).
fn modes(squares: &[f64]) -> LinearModel {
    let cells = squares.len();
    let pattern = Pattern::from_elements(cells, (0..cells as u32).map(|cell| [cell])).unwrap();
    let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
    for (cell, square) in squares.iter().enumerate() {
        stiffness
            .add_block(cell as u32, cell as u32, &[*square])
            .unwrap();
    }
    let operators =
        LinearOperators::new(vec![1.0; cells], stiffness, Damping::default(), Vec::new());
    LinearModel::new(operators.unwrap())
}

/// The largest amplitude of any mode within `steps` steps, over that of the exact motion.
fn largest_amplitude(squares: &[f64], dt: f64, tolerance: f64, steps: usize) -> f64 {
    let system = modes(squares);
    let mut integrator = two_step(tolerance);
    let v = squares.iter().map(|square| square.sqrt()).collect();
    let mut state = State::new(vec![1.0; squares.len()], v);
    let mut largest = 0.0_f64;
    for _ in 0..steps {
        integrator.step(&system, &mut state, dt).unwrap();
        largest = state.u.iter().fold(largest, |max, u| max.max(u.abs()));
    }
    largest / std::f64::consts::SQRT_2
}

/// Peaks of the polynomial that are nearly as high as the highest, and zeros that are not zeros of the sine: a mode at
/// one of them is stable and keeps its amplitude.
#[test]
fn no_mode_grows_wherever_it_lies() {
    // Each was wrong by 1e17 and more after 1000 steps where one peak alone was looked at.
    for (square, dt, tolerance) in [
        (0.15532565040100568, 23.90325271059216, 0.01),
        (0.06185995824751358, 37.9115929941618, 0.1),
        (0.33089104127128793, 70.99916597164304, 1e-3),
    ] {
        let found = largest_amplitude(&[square, 1.0], dt, tolerance, 1000);
        assert!(
            found < 1.0 + 2.0 * f64::sqrt(tolerance),
            "{square}: {found}"
        );
    }
    let squares: Vec<f64> = (1..=600).map(|j| (f64::from(j) / 600.0).powi(2)).collect();
    for dt in [3.0, 6.3, 9.0458555217769, 17.1, 40.0, 63.27] {
        for tolerance in [0.9, 0.1, 1e-2, 1e-3, 1e-4, 1e-6] {
            let found = largest_amplitude(&squares, dt, tolerance, 600);
            let allowed = 1.0 + 2.0 * f64::sqrt(tolerance);
            assert!(found < allowed, "dt = {dt}, {tolerance:e}: {found}");
        }
    }
}
