//! `propagator` in two-step form, fitted to the loads: the error is as estimated, and no mode grows.

use std::sync::Arc;

use crate::common::cube::{altered, cube};
use crate::common::exponential::exponentials;
use crate::common::{build, plain, relative_error};
use proptest::prelude::*;
use sinew_core::spectrum::critical_step;
use sinew_core::{
    BlockMatrix, Damping, Integrator, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    OptionValue, Options, Pattern, Ramp, SetupError, State, StepError, System,
};
use sinew_integrators::Stepper;
use sinew_testkit::body::bodies_up_to;

fn text(text: &str) -> OptionValue {
    OptionValue::Text(text.into())
}

fn options(tolerance: f64) -> Options {
    plain()
        .with("kind", text("two-step"))
        .with("fit", text("load"))
        .with_number("tolerance", tolerance)
}

fn fitted(tolerance: f64) -> Box<dyn Integrator> {
    build("propagator", &options(tolerance))
}

fn fact(integrator: &dyn Integrator, name: &str) -> f64 {
    let facts = integrator.facts();
    facts.iter().find(|fact| fact.name == name).unwrap().value
}

fn mass_damping(mass: f64) -> Damping {
    Damping {
        mass,
        ..Damping::default()
    }
}

/// Masses of 1 kg, each on a spring of its own with this square of a frequency (1/s^2) and under this force (N).
fn modes(squares: &[f64], forces: &[f64], alpha: f64) -> LinearModel {
    let cells = squares.len();
    let pattern = Pattern::from_elements(cells, (0..cells as u32).map(|cell| [cell])).unwrap();
    let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
    for (cell, square) in squares.iter().enumerate() {
        stiffness
            .add_block(cell as u32, cell as u32, &[*square])
            .unwrap();
    }
    let load = Load {
        ramp: Ramp::Step,
        entries: (0..).zip(forces.iter().copied()).collect(),
    };
    let damping = mass_damping(alpha);
    let operators = LinearOperators::new(vec![1.0; cells], stiffness, damping, vec![load]);
    LinearModel::new(operators.unwrap())
}

/// Largest amplitude of any mode about its equilibrium in `steps` steps, over that of the exact motion, from a velocity
/// alone and from a displacement alone.
fn largest_amplitude(system: &LinearModel, dt: f64, tolerance: f64, steps: usize) -> f64 {
    try_largest_amplitude(system, dt, tolerance, steps).unwrap()
}

fn try_largest_amplitude(
    system: &LinearModel,
    dt: f64,
    tolerance: f64,
    steps: usize,
) -> Result<f64, StepError> {
    let operators = system.operators();
    let n = operators.dofs();
    let mut force = vec![0.0; n];
    operators.external_force(0.0, &mut force);
    let square = |cell: usize| operators.stiffness().block(cell, cell).unwrap()[0];
    let rest: Vec<f64> = (0..n).map(|cell| force[cell] / square(cell)).collect();
    let still = State::new(
        rest.clone(),
        (0..n).map(|cell| square(cell).sqrt()).collect(),
    );
    let off = rest.iter().map(|rest| rest + 1.0).collect();
    let mut integrator = fitted(tolerance);
    let mut largest = 0.0_f64;
    for mut state in [still, State::new(off, vec![0.0; n])] {
        for _ in 0..steps {
            integrator.step(system, &mut state, dt)?;
            for (u, rest) in state.u.iter().zip(&rest) {
                largest = largest.max((u - rest).abs());
            }
        }
    }
    Ok(largest)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// For any tolerance and any fitted modes, undamped, damped or creeping: no amplitude of a mode is larger than
    /// twice that of the exact motion, even 2000 steps later. Bodies without such a fit are refused: one body in
    /// thousands, in which motion dies out within a step or the tolerance is tight.
    #[test]
    fn no_mode_of_a_random_spectrum_grows(
        squares in prop::collection::vec(1e-4..1.0, 1..40),
        loaded in 0..40_usize,
        dt in 0.5..20.0,
        alpha in prop_oneof![Just(0.0), 1e-3..3.0],
        tolerance in prop_oneof![Just(0.5), Just(0.1), Just(1e-2), Just(1e-4)],
    ) {
        let mut squares = squares;
        squares.push(1.0);
        let mut forces = vec![0.0; squares.len()];
        forces[loaded % squares.len()] = 1.0;
        forces[0] += 0.2;
        let system = modes(&squares, &forces, alpha);
        match try_largest_amplitude(&system, dt, tolerance, 2000) {
            Ok(found) => prop_assert!(found <= 2.0 + 1e-6, "{found}"),
            Err(StepError::Setup(SetupError::Unresolved { reason, .. })) => {
                let hard = alpha * dt > 10.0 || tolerance < 1e-3;
                prop_assert!(hard, "{reason}");
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    /// The displacements of bodies at random, under loads that jump, damped or creeping: with a fine fit they are
    /// exact, which shows that first step, recurrence and jumps are consistent.
    #[test]
    fn random_bodies_move_as_their_matrix_exponential_says(
        body in bodies_up_to(1),
        share in 0.1..5.0,
        ratio in prop_oneof![Just(0.0), 1e-3..2.0],
    ) {
        let body = body.without_dashpots().on_the_ground();
        let model = body.model();
        let limit = critical_step(model.operators());
        let dt = share * limit;
        let pulse = Ramp::Pulse { from: 3.0 * dt, to: 8.0 * dt };
        let loads = [Ramp::Step, pulse].map(|ramp| {
            let entries = (0..model.dofs() as u32).map(|dof| (dof, f64::from(dof).sin()));
            Load { ramp, entries: entries.collect() }
        });
        let system = altered(&model, mass_damping(2.0 * ratio / limit), loads.to_vec());
        let start = State::at_rest(model.dofs());
        let (mut state, mut integrator) = (start.clone(), fitted(1.1e-6));
        let expected = exponentials(&system, &start, dt, 36);
        let expected: Vec<Vec<f64>> = expected.into_iter().map(|state| state.u).collect();
        let mut found = Vec::new();
        for _ in 0..expected.len() {
            let stepped = integrator.step(&system, &mut state, dt);
            // One body in thousands has no fit that is fine enough, and is refused.
            prop_assume!(!matches!(stepped, Err(StepError::Setup(SetupError::Unresolved { .. }))));
            stepped.unwrap();
            found.push(state.u.clone());
        }
        let error = relative_error(&found, &expected);
        // The estimate is for eight periods; in the first steps of a slow motion the displacement is still small.
        prop_assert!(error <= 1e-3, "{error:e}");
    }
}

/// Modes over the whole spectrum, of which only the slowest is loaded, followed for a hundred thousand steps.
#[test]
fn nothing_grows_in_a_hundred_thousand_steps() {
    let squares: Vec<f64> = (1..=25).map(|j| (f64::from(j) / 25.0).powi(2)).collect();
    let mut forces = vec![0.0; 25];
    forces[2] = 1.0;
    for (dt, tolerance) in [(10.0, 1e-2), (6.3, 0.3)] {
        let found = largest_amplitude(&modes(&squares, &forces, 0.0), dt, tolerance, 100_000);
        assert!(found <= 2.0, "dt = {dt}: {found}");
    }
}

/// All modes of a heavily damped body creep; the fastest is not loaded. A loose fit once let it overshoot to 2.24 times its
/// displacement.
#[test]
fn a_mode_that_creeps_does_not_overshoot() {
    let mut squares = vec![1e-4; 24];
    (squares[0], squares[23]) = (0.408_503_871, 0.059_154_028);
    squares.push(1.0);
    let mut forces = vec![0.0; 25];
    (forces[0], forces[23]) = (0.2, 1.0);
    let system = modes(&squares, &forces, 2.440_756_973);
    let found = largest_amplitude(&system, 15.530_391_334, 0.5, 2000);
    assert!(found <= 2.0, "{found}");
}

/// Modes at each of 3000 eigenvalues, the polynomial's double roots among them.
#[test]
fn no_mode_grows_wherever_it_lies() {
    let squares: Vec<f64> = (1..=3000).map(|j| f64::from(j) / 3000.0).collect();
    let mut forces = vec![0.0; 3000];
    forces[40] = 1.0;
    forces[200] = -1.0;
    for dt in [3.0, 9.9, 17.1] {
        for tolerance in [0.5, 0.05, 1e-3] {
            let system = modes(&squares, &forces, 0.0);
            let found = largest_amplitude(&system, dt, tolerance, 400);
            assert!(found <= 2.0, "dt = {dt}, {tolerance:e}: {found}");
        }
    }
}

/// The estimate is near the error against the closed form `(1 - cos(w t)) f/w^2` of 400 modes, over eight
/// periods of their mean frequency.
#[test]
fn the_estimate_is_the_error_of_the_closed_form() {
    let squares: Vec<f64> = (1..=400).map(|j| (f64::from(j) / 400.0).powi(2)).collect();
    let forces: Vec<f64> = squares.iter().map(|square| square.powf(0.8)).collect();
    let system = modes(&squares, &forces, 0.0);
    let dt = 9.0;
    let shares: Vec<f64> = squares
        .iter()
        .zip(&forces)
        .map(|(l, f)| (f / l).powi(2))
        .collect();
    let moment: f64 = shares
        .iter()
        .zip(&squares)
        .map(|(share, l)| share * l)
        .sum();
    let mean = moment / shares.iter().sum::<f64>();
    let horizon = 8.0 * std::f64::consts::TAU / mean.sqrt();
    for tolerance in [0.3, 0.1, 1e-2, 1e-3] {
        let mut integrator = fitted(tolerance);
        let mut state = State::at_rest(system.dofs());
        let (mut found, mut exact) = (Vec::new(), Vec::new());
        while state.t() < horizon {
            integrator.step(&system, &mut state, dt).unwrap();
            found.push(state.u.clone());
            let modes = squares.iter().zip(&forces);
            let u = modes.map(|(l, f)| f / l * (1.0 - (l.sqrt() * state.t()).cos()));
            exact.push(u.collect::<Vec<f64>>());
        }
        let error = relative_error(&found, &exact);
        let estimate = fact(&*integrator, "estimated_error");
        assert!(estimate <= tolerance);
        let ratio = error / estimate;
        assert!(
            (0.7..1.4).contains(&ratio),
            "{tolerance}: {error} {estimate}"
        );
    }
}

/// A body without supports moves by F t^2/(2 M).
#[test]
fn a_free_body_falls() {
    let model = cube(2);
    let mass = model.operators().mass().to_vec();
    let free = free_chain(&mass);
    let dt = 3.0 * critical_step(free.operators());
    let mut state = State::at_rest(free.dofs());
    let mut integrator = fitted(1e-2);
    for _ in 0..50 {
        integrator.step(&free, &mut state, dt).unwrap();
    }
    let total: f64 = mass.iter().sum();
    let moved: f64 = state.u.iter().zip(&mass).map(|(u, m)| u * m).sum::<f64>() / total;
    let expected = 1.5 * state.t().powi(2) / (2.0 * total);
    assert!((moved / expected - 1.0).abs() < 1e-2, "{moved} {expected}");
}

/// A chain of these masses (kg) with springs of 10 N/m, under 1.5 N at one end.
fn free_chain(mass: &[f64]) -> LinearModel {
    let n = mass.len() as u32;
    let pattern = Pattern::from_elements(n as usize, (1..n).map(|i| [i - 1, i])).unwrap();
    let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
    for i in 1..n {
        stiffness
            .add_element(&[i - 1, i], &[10.0, -10.0, -10.0, 10.0])
            .unwrap();
    }
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(0, 1.5)],
    };
    let operators = LinearOperators::new(mass.to_vec(), stiffness, Damping::default(), vec![load]);
    LinearModel::new(operators.unwrap())
}

fn program(options: &Options, system: &dyn System, dt: f64) -> sinew_cnn::Program {
    let mut integrator = sinew_integrators::build("propagator", options).unwrap();
    integrator.prepare(system, dt).unwrap();
    Stepper::program(&*integrator).unwrap()
}

#[test]
fn a_uniform_fit_is_the_default() {
    let model = cube(2);
    let two_step = plain().with("kind", text("two-step"));
    let named = two_step.clone().with("fit", text("uniform"));
    assert_eq!(
        program(&two_step, &model, 0.02),
        program(&named, &model, 0.02)
    );
}

/// Loads that excite other modes get another polynomial, also with the same integrator.
#[test]
fn other_loads_have_another_fit() {
    let squares: Vec<f64> = (1..=60).map(|j| f64::from(j) / 60.0).collect();
    let of = |loaded: usize| {
        let mut forces = vec![0.0; 60];
        forces[loaded] = 1.0;
        modes(&squares, &forces, 0.0)
    };
    let first = of(5);
    let loads = of(40).operators().loads().to_vec();
    let second = LinearModel::new(first.operators().with_loads(loads).unwrap());
    let mut integrator = sinew_integrators::build("propagator", &options(0.01)).unwrap();
    integrator.prepare(&first, 9.0).unwrap();
    let before = integrator.program().unwrap();
    integrator.prepare(&second, 9.0).unwrap();
    let after = integrator.program().unwrap();
    assert_ne!(before, after);
    assert_eq!(after, program(&options(0.01), &second, 9.0));
}

#[test]
fn what_it_cannot_do_is_refused_with_what_can() {
    let refusal = |options: &Options| {
        let error = sinew_integrators::build("propagator", options).err();
        error.unwrap().to_string()
    };
    assert_eq!(
        refusal(&plain().with("fit", text("load"))),
        "`propagator`: fit = \"load\": expected nothing without kind = \"two-step\""
    );
    assert_eq!(
        refusal(&options(1e-8)),
        "`propagator`: tolerance = 0.00000001: expected a number above 1e-6 and below 1 for fit = \"load\""
    );
    let model = cube(2);
    let at_set_up = |damping: Damping, loads: Vec<Load>, options: &Options| {
        let system = altered(&model, damping, loads);
        let error = build("propagator", options).prepare(&system, 0.1).err();
        error.unwrap().to_string()
    };
    let load = |ramp| Load {
        ramp,
        entries: vec![(2, 1.0)],
    };
    let stiffness = Damping {
        stiffness: 1e-3,
        ..Damping::default()
    };
    assert_eq!(
        at_set_up(stiffness, vec![load(Ramp::Step)], &options(0.01)),
        "`propagator` needs mass damping at most for kind = \"two-step\"; \"chebyshev\" takes \
         proportional damping, \"krylov\" any, which this system does not offer"
    );
    assert_eq!(
        at_set_up(mass_damping(0.0), vec![], &options(0.01)),
        "`propagator` needs loads to fit to for fit = \"load\"; fit = \"uniform\" takes any motion, \
         which this system does not offer"
    );
    let low = options(1e-3).with_number("degree", 2.0);
    let found = at_set_up(mass_damping(0.0), vec![load(Ramp::Step)], &low);
    assert!(
        found.starts_with(
            "`propagator`: with degree 2 the estimated error of a run in steps of 0.1 s is "
        ),
        "{found}"
    );
}
