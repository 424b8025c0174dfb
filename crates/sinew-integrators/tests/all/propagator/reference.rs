//! `propagator` against closed forms and dense matrix exponentials, and the inputs that it refuses.

use std::sync::Arc;

use crate::common::cube::{altered, cube, scene, springs};
use crate::common::exponential::exponentials;
use crate::common::{build, largest, plain};
use proptest::prelude::*;
use sinew_core::closed_form::DampedOscillator;
use sinew_core::spectrum::critical_step;
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, LinearSystem, Load, OptionValue,
    Options, Pattern, Ramp, State, System,
};
use sinew_fem::Rayleigh;
use sinew_testkit::body::{Body, bodies_up_to};

/// The largest difference of displacements over the largest displacement, the first included, or of
/// velocities.
fn distance(start: &State, found: &[State], expected: &[State]) -> f64 {
    let part = |of: fn(&State) -> &[f64]| {
        let all = |states: &[State]| -> Vec<f64> {
            states.iter().flat_map(|state| of(state).to_vec()).collect()
        };
        let (found, expected) = (all(found), all(expected));
        let difference: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
        largest(&difference) / largest(&expected).max(largest(of(start)))
    };
    part(|state| &state.u).max(part(|state| &state.v))
}

fn tight() -> Options {
    plain().with_number("tolerance", 1e-13)
}

fn propagate(system: &dyn System, start: &State, dt: f64, steps: usize) -> Vec<State> {
    let mut integrator = build("propagator", &tight());
    let mut state = start.clone();
    let step = |_| {
        integrator.step(system, &mut state, dt).unwrap();
        state.clone()
    };
    (0..steps).map(step).collect()
}

/// The body without dashpots, as matrices without loads.
fn proportional(body: Body, damping: Damping) -> (LinearModel, State) {
    let body = body.without_dashpots();
    let model = body.model();
    let start = body.state(&model, 1e-3, 1e-3 / critical_step(model.operators()));
    (altered(&model, damping, vec![]), start)
}

/// Loads of every kind whose kinks fall on multiples of `dt`.
fn every_ramp(dofs: usize, dt: f64, force: f64) -> Vec<Load> {
    let at = |step: u32| f64::from(step) * dt;
    let ramps = [
        Ramp::Step,
        Ramp::Sin2 { rise: at(5) },
        Ramp::Pulse {
            from: at(3),
            to: at(8),
        },
        Ramp::Table {
            times: vec![at(2), at(4), at(7)],
            values: vec![0.5, 2.0, -1.0],
        },
    ];
    (0_u32..)
        .zip(ramps)
        .map(|(number, ramp)| Load {
            ramp,
            entries: (0..dofs as u32)
                .map(|dof| {
                    (
                        dof,
                        force * (f64::from(dof) * 0.7 + f64::from(number)).sin(),
                    )
                })
                .collect(),
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Motion under every ramp and every proportional damping, free bodies among them.
    #[test]
    fn random_networks_move_as_their_matrix_exponential_says(
        body in bodies_up_to(1),
        share in 0.1..20.0,
        ratios in [0.0..2.0, 0.0..2.0],
        free in any::<bool>(),
    ) {
        let body = if free { body.free() } else { body };
        let (unloaded, start) = proportional(body, Damping::default());
        let limit = critical_step(unloaded.operators());
        let damping = Damping {
            mass: 2.0 * ratios[0] / limit,
            stiffness: 0.1 * ratios[1] * limit,
            extra: None,
        };
        let dt = share * limit;
        let operators = unloaded.operators();
        // As large as what carries the first displacement.
        let force = 1e-3 * operators.mass()[0] * (2.0 / limit).powi(2);
        let stiffness = operators.stiffness().as_ref().clone();
        let loads = every_ramp(operators.dofs(), dt, force);
        let mass = operators.mass().to_vec();
        let system = LinearModel::new(LinearOperators::new(mass, stiffness, damping, loads).unwrap());
        let found = propagate(&system, &start, dt, 10);
        let distance = distance(&start, &found, &exponentials(&system, &start, dt, 10));
        prop_assert!(distance <= 1e-10, "{distance:e}");
    }
}

#[test]
fn the_oscillator_moves_as_its_closed_form_says() {
    let (mass, spring, force) = (0.1, 100.0, 2.0);
    for damping in [0.0, 1.0, 2.0 * f64::sqrt(10.0), 20.0] {
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(0, force)],
        };
        let operators = LinearOperators::oscillator(mass, spring, damping).unwrap();
        let system = LinearModel::new(operators.with_loads(vec![load]).unwrap());
        let exact = DampedOscillator {
            omega: f64::sqrt(spring / mass),
            damping: damping / mass,
            load: force / mass,
            displacement: 0.03,
            velocity: -5.0,
        };
        for dt in [1e-3, 0.05, 0.7] {
            let start = State::new(vec![0.03], vec![-5.0]);
            let found = propagate(&system, &start, dt, 20);
            let expected: Vec<State> = (1..=20)
                .map(|step| exact.at(f64::from(step) * dt))
                .map(|(u, v)| State::new(vec![u], vec![v]))
                .collect();
            let distance = distance(&start, &found, &expected);
            assert!(distance <= 1e-11, "{damping} at {dt}: {distance:e}");
        }
    }
}

/// Sums of times are a little less or more than the instants that they represent: .1 added eight times is less than .8.
/// A jump there still belongs to the step that begins.
#[test]
fn loads_jump_at_steps_whatever_their_sum_rounds_to() {
    let operators = LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap();
    for dt in [0.1, 0.02, 1.0 / 30.0] {
        for (from, to) in [(1, 3), (2, 8), (3, 10), (6, 15)] {
            let load = Load {
                ramp: Ramp::Pulse {
                    from: f64::from(from) * dt,
                    to: f64::from(to) * dt,
                },
                entries: vec![(0, 2.0)],
            };
            let system = LinearModel::new(operators.clone().with_loads(vec![load]).unwrap());
            let start = State::at_rest(1);
            let found = propagate(&system, &start, dt, 20);
            let distance = distance(&start, &found, &exponentials(&system, &start, dt, 20));
            assert!(distance <= 1e-10, "{from}..{to} of {dt}: {distance:e}");
        }
    }
}

/// A free body drifts, turns and vibrates: its stiffness is singular.
#[test]
fn a_free_body_under_no_load_keeps_its_momentum() {
    let pattern = Arc::new(Pattern::from_elements(3, [[0, 1], [1, 2]]).unwrap());
    let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    for pair in [[0, 1], [1, 2]] {
        stiffness
            .add_element(&pair, &[50.0, -50.0, -50.0, 50.0])
            .unwrap();
    }
    let mass = vec![0.1, 0.3, 0.2];
    let operators =
        LinearOperators::new(mass.clone(), stiffness, Damping::default(), vec![]).unwrap();
    let start = State::new(vec![0.01, 0.0, 0.02], vec![1.0, -0.5, 2.0]);
    let found = propagate(&LinearModel::new(operators), &start, 0.3, 100);
    let sum = |x: &[f64]| -> f64 { mass.iter().zip(x).map(|(mass, x)| mass * x).sum() };
    let (first, momentum) = (sum(&start.u), sum(&start.v));
    for (step, state) in (1..).zip(&found) {
        let centre = first + momentum * 0.3 * f64::from(step);
        assert!((sum(&state.v) / momentum - 1.0).abs() <= 1e-11, "{step}");
        assert!((sum(&state.u) / centre - 1.0).abs() <= 1e-11, "{step}");
    }
}

fn fact(system: &dyn System, options: &Options, dt: f64, name: &str) -> f64 {
    let mut integrator = build("propagator", options);
    integrator.prepare(system, dt).unwrap();
    let facts = integrator.facts();
    facts.iter().find(|fact| fact.name == name).unwrap().value
}

#[test]
fn the_degree_is_the_smallest_that_meets_the_tolerance() {
    let model = altered(&cube(3), Damping::default(), vec![]);
    for dt in [1e-3, 0.02, 0.2] {
        let mut before = 0.0;
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let options = plain().with_number("tolerance", tolerance);
            let degree = fact(&model, &options, dt, "degree");
            let rounding = 4e-15 * (2.0 * dt / critical_step(model.operators())).powi(2);
            assert!(fact(&model, &options, dt, "step_error") <= tolerance + rounding);
            assert!(degree >= before);
            before = degree;
            if degree > 1.0 {
                let fewer = options.with_number("degree", degree - 1.0);
                assert!(build("propagator", &fewer).prepare(&model, dt).is_err());
            }
        }
    }
    // About omega_max dt/2 + 5.
    let dt = 0.2;
    let half = dt / critical_step(model.operators());
    let degree = fact(
        &model,
        &plain().with_number("tolerance", 1e-4),
        dt,
        "degree",
    );
    assert!((degree - half - 5.0).abs() <= 3.0, "{degree} {half}");
}

#[test]
fn work_is_two_sweeps_a_degree_and_one_for_each_load_that_changes() {
    let model = cube(3);
    let entries = vec![(2, 1.0)];
    let load = |ramp| Load {
        ramp,
        entries: entries.clone(),
    };
    let sin2 = load(Ramp::Sin2 { rise: 0.06 });
    let pulse = load(Ramp::Pulse {
        from: 0.02,
        to: 0.08,
    });
    for (loads, changing) in [
        (vec![], [0, 0, 0, 0]),
        (vec![pulse.clone()], [0, 0, 0, 0]),
        (vec![sin2.clone()], [1, 1, 1, 0]),
        (vec![sin2.clone(), pulse, sin2], [2, 2, 2, 0]),
    ] {
        let damping = Damping {
            mass: 10.0,
            stiffness: 1e-3,
            extra: None,
        };
        let system = altered(&model, damping, loads);
        let degree = fact(&system, &plain(), 0.02, "degree") as u64;
        let mut integrator = build("propagator", &plain());
        let mut state = State::at_rest(system.dofs());
        for changing in changing {
            let work = integrator.step(&system, &mut state, 0.02).unwrap();
            assert_eq!(work.sweeps, 1 + (2 + changing) * degree);
            assert_eq!((work.force_evaluations, work.solves), (1, 0));
        }
    }
}

fn refusal(options: &Options) -> String {
    sinew_integrators::build("propagator", options)
        .err()
        .unwrap()
        .to_string()
}

#[test]
fn options_that_make_no_sense_are_refused() {
    for degree in [0.0, -3.0, 2.5, 501.0, f64::NAN] {
        assert_eq!(
            refusal(&plain().with_number("degree", degree)),
            format!("`propagator`: degree = {degree}: expected a whole number from 1 to 500")
        );
    }
    for tolerance in [0.0, -1e-6, 1.0, f64::NAN] {
        assert_eq!(
            refusal(&plain().with_number("tolerance", tolerance)),
            format!("`propagator`: tolerance = {tolerance}: expected a number above 0 and below 1")
        );
    }
    assert_eq!(
        refusal(&plain().with("kind", OptionValue::Text("taylor".into()))),
        "`propagator`: kind = \"taylor\": expected \"chebyshev\", \"two-step\" or \"krylov\""
    );
}

#[test]
fn a_degree_that_is_too_small_is_refused_with_one_that_is_not() {
    let model = altered(&cube(3), Damping::default(), vec![]);
    let refusal = |options: Options, dt| {
        build("propagator", &options)
            .prepare(&model, dt)
            .unwrap_err()
            .to_string()
    };
    let message = refusal(plain().with_number("degree", 2.0), 0.1);
    let start = "`propagator`: degree 2 leaves out ";
    assert!(message.starts_with(start), "{message}");
    let advised = message
        .strip_suffix(" or leave it out")
        .and_then(|message| message.rsplit(' ').next())
        .unwrap()
        .parse()
        .unwrap();
    let options = plain().with_number("degree", advised);
    assert!(build("propagator", &options).prepare(&model, 0.1).is_ok());
    assert_eq!(
        refusal(plain(), 30.0),
        "`propagator`: a step of 30 s needs a degree above 500; take a shorter step"
    );
}

#[test]
fn a_kink_within_a_step_is_refused_with_its_instant() {
    let model = cube(3);
    for (ramp, kink) in [
        (Ramp::Sin2 { rise: 0.05 }, "0.05"),
        (
            Ramp::Pulse {
                from: 0.02,
                to: 0.045,
            },
            "0.045",
        ),
        (
            Ramp::Table {
                times: vec![0.0, 0.04, 0.041],
                values: vec![0.0, 1.0, 2.0],
            },
            "0.041",
        ),
    ] {
        let load = Load {
            ramp,
            entries: vec![(2, 1.0)],
        };
        let system = altered(&model, Damping::default(), vec![load]);
        let mut integrator = build("propagator", &plain());
        let mut state = State::at_rest(system.dofs());
        for _ in 0..2 {
            integrator.step(&system, &mut state, 0.02).unwrap();
        }
        let refusal = integrator.step(&system, &mut state, 0.02).unwrap_err();
        assert_eq!(
            refusal.to_string(),
            format!(
                "`propagator` at t = 0.04 s: a load changes at t = {kink} s, and is not smooth over each step of 0.02 s; choose a dt that meets that instant"
            )
        );
    }
}

#[test]
fn dashpots_are_refused_with_what_to_take_instead() {
    let model = scene(3, 0.2, springs(0.5), Rayleigh::default());
    assert_eq!(
        build("propagator", &plain())
            .prepare(&model, 0.02)
            .unwrap_err()
            .to_string(),
        "`propagator` needs proportional damping (D = alpha M + beta K, no dashpots); kind = \"krylov\" takes any, which this system does not offer"
    );
}

/// Dampings far beyond critical, in proportion to mass or stiffness.
#[test]
fn strong_damping_is_followed_too() {
    let unloaded = cube(2);
    let limit = critical_step(unloaded.operators());
    for (mass, stiffness) in [(40.0 / limit, 0.0), (0.0, 5.0 * limit), (0.0, 0.5 * limit)] {
        let damping = Damping {
            mass,
            stiffness,
            extra: None,
        };
        for share in [0.3, 3.0] {
            let dt = share * limit;
            let system = altered(&unloaded, damping.clone(), every_ramp(9, dt, 1.0));
            let mut start = State::at_rest(9);
            start.v = (0..9).map(|dof| f64::sin(f64::from(dof))).collect();
            let found = propagate(&system, &start, dt, 10);
            let distance = distance(&start, &found, &exponentials(&system, &start, dt, 10));
            assert!(
                distance <= 1e-10,
                "{mass} {stiffness} {share}: {distance:e}"
            );
        }
    }
}
