//! Newton's method in implicit steps and in equilibria, against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::nonlinear::{Chain, Potential, Scalar, Sling, damped, model};
use crate::common::{build, plain};
use sinew_core::{
    Damping, EvaluationError, ForceModel, Integrator, Layers, Run, SimulateError, State, StepError,
    StepReport, System, simulate,
};
use sinew_integrators::{NewtonError, StaticError, static_solution};

const METHODS: [&str; 3] = ["newmark", "generalized-alpha", "implicit-euler"];

/// A system of one degree of freedom.
fn one<F: Fn(f64) -> [f64; 3] + Send + Sync>(
    mass: f64,
    load: f64,
    potential: F,
) -> ForceModel<crate::common::nonlinear::Law<Scalar<F>>> {
    model(Scalar(potential), &[mass], Layers::One, vec![load])
}

/// A pendulum by its angle, with a frequency of 1 rad/s in small swings.
fn pendulum() -> impl System {
    one(1.0, 0.0, |angle: f64| {
        [1.0 - angle.cos(), angle.sin(), angle.cos()]
    })
}

fn run(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    dt: f64,
    steps: usize,
) -> StepReport {
    let mut work = StepReport::default();
    for _ in 0..steps {
        work += integrator.step(system, state, dt).unwrap();
    }
    work
}

/// K of the amplitude, by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6): a quarter of the period.
fn quarter_period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, (amplitude / 2.0).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

#[test]
fn a_pendulum_that_swings_far_passes_its_lowest_point_and_returns_as_in_closed_form() {
    let amplitude = 170.0 * PI / 180.0;
    let quarter = quarter_period(amplitude);
    let (lowest, fastest) = (0.0, -2.0 * (amplitude / 2.0).sin());
    for (id, order) in [
        ("newmark", 2),
        ("generalized-alpha", 2),
        ("implicit-euler", 1),
    ] {
        let errors = [400, 800].map(|steps: i32| {
            let (mut integrator, mut state) =
                (build(id, &plain()), State::new(vec![amplitude], vec![0.0]));
            let dt = quarter / f64::from(steps);
            run(
                &mut *integrator,
                &pendulum(),
                &mut state,
                dt,
                steps as usize,
            );
            let at_lowest = (state.u[0] - lowest).hypot(state.v[0] - fastest);
            run(
                &mut *integrator,
                &pendulum(),
                &mut state,
                dt,
                steps as usize,
            );
            at_lowest + (state.u[0] + amplitude).hypot(state.v[0])
        });
        let observed = (errors[0] / errors[1]).log2();
        assert!(
            (observed - f64::from(order)).abs() < 0.15,
            "`{id}`: {errors:?}"
        );
        assert!(
            errors[1] < if order == 2 { 1e-3 } else { 0.2 },
            "`{id}`: {errors:?}"
        );
    }
}

#[test]
fn above_the_horizontal_the_tangent_is_projected_only_where_the_step_needs_it() {
    // M + dt^2/4 K is 1 + dt^2/4 cos(angle): below 0 near the top for dt above 2 only.
    for (dt, expected) in [(0.1, false), (2.5, true)] {
        let (mut integrator, mut state) =
            (build("newmark", &plain()), State::new(vec![3.0], vec![0.0]));
        let work = run(&mut *integrator, &pendulum(), &mut state, dt, 40);
        assert_eq!(work.projected_solves > 0, expected, "dt = {dt}: {work:?}");
        let remarks = integrator.remarks().join("; ");
        assert_eq!(remarks.contains("projected tangent"), expected, "{remarks}");
    }
}

#[test]
fn a_law_that_is_linear_takes_one_iteration_and_small_steps_take_two() {
    let spring = one(2.0, 0.0, |u: f64| [50.0 * u * u, 100.0 * u, 100.0]);
    for id in METHODS {
        let (mut integrator, mut state) = (build(id, &plain()), State::new(vec![0.1], vec![1.0]));
        let work = run(&mut *integrator, &spring, &mut state, 0.02, 50);
        assert_eq!(
            (work.newton_iterations, work.solves, work.factorizations),
            (50, 50, 50),
            "`{id}`"
        );
        assert_eq!((work.backtracks, work.projected_solves), (0, 0), "`{id}`");
        // Three trials, or four with the force before the step, the tangent and the watch for energy; the first step may make an acceleration.
        assert!(work.sweeps <= 6 * 50 + 1, "`{id}`: {work:?}");

        let mut state = State::new(vec![2.0], vec![0.0]);
        let work = run(&mut *integrator, &pendulum(), &mut state, 0.05, 200);
        let a_step = work.newton_iterations as f64 / 200.0;
        assert!((1.0..=2.0).contains(&a_step), "`{id}`: {a_step}");
        let facts = integrator.facts();
        assert_eq!(
            (facts[0].name, facts[0].value),
            ("newton_iterations_a_step", a_step)
        );
        assert!(facts[1].value <= 3.0, "{facts:?}");
    }
}

/// Stretch at which a link carries a force: the real root of `c s^3 + k s = f` (Cardano).
fn stretch(k: f64, c: f64, f: f64) -> f64 {
    let (p, q) = (k / (3.0 * c), f / (2.0 * c));
    let root = (q * q + p.powi(3)).sqrt();
    (q + root).cbrt() + (q - root).cbrt()
}

#[test]
fn a_chain_of_hardening_links_hangs_as_in_closed_form() {
    let (k, c, masses) = (10.0, 4000.0, [0.1; 40]);
    let chain = || Chain {
        stiffness: k,
        cubic: c,
        longest: f64::INFINITY,
    };
    // Each link carries the weights below it.
    let weights = |g: f64| vec![0.1 * g; 40];
    for g in [1e-3, 9.81, 981.0] {
        let system = model(chain(), &masses, Layers::One, weights(g));
        let u = static_solution(&system, &weights(g)).unwrap();
        let mut expected = 0.0;
        for (i, u) in u.iter().enumerate() {
            expected += stretch(k, c, 0.1 * g * (40 - i) as f64);
            assert!((u / expected - 1.0).abs() < 1e-9, "{g}: {u} {expected}");
        }
    }
}

/// The truss of von Mises: two bars of stiffness 1 N/m each from (-1, 0) and (1, 0) m to an apex at height H, which is pushed
/// down by u.
const HEIGHT: f64 = 0.5;

/// Energy, force and stiffness of the truss.
fn truss(u: f64) -> [f64; 3] {
    let (h, rest) = (HEIGHT - u, HEIGHT.hypot(1.0));
    let length = h.hypot(1.0);
    let shorter = rest - length;
    [
        shorter * shorter,
        2.0 * shorter * h / length,
        2.0 * (1.0 - rest / length.powi(3)),
    ]
}

/// Displacement and load at which the apex snaps through: the stiffness is 0 at length^3 = rest.
fn limit_point() -> (f64, f64) {
    let height = (HEIGHT.hypot(1.0).powf(2.0 / 3.0) - 1.0).sqrt();
    let u = HEIGHT - height;
    (u, truss(u)[1])
}

#[test]
fn a_truss_carries_its_load_up_to_the_limit_point_and_snaps_through_above() {
    let (give_way, most) = limit_point();
    assert!(truss(give_way)[2].abs() < 1e-12);
    let system = one(1.0, 0.0, truss);
    for share in [0.1, 0.5, 0.9, 0.999] {
        let u = static_solution(&system, &[share * most]).unwrap()[0];
        assert!(
            (truss(u)[1] - share * most).abs() < 1e-8 * most && u < give_way,
            "{share}: {u}"
        );
    }
    for share in [1.001, 1.5, 20.0] {
        let u = static_solution(&system, &[share * most]).unwrap()[0];
        let [_, force, stiffness] = truss(u);
        assert!(
            (force - share * most).abs() < 1e-6 * share * most,
            "{share}: {u}"
        );
        assert!(u > 2.0 * HEIGHT && stiffness > 0.0, "{share}: {u}");
    }
}

#[test]
fn a_truss_snaps_through_in_time_with_the_speed_of_its_energy() {
    let (_, most) = limit_point();
    let load = 1.2 * most;
    let system = one(0.01, load, truss);
    let (mut integrator, mut state) = (build("newmark", &plain()), State::at_rest(1));
    let mut farthest: f64 = 0.0;
    for _ in 0..4000 {
        integrator.step(&system, &mut state, 1e-3).unwrap();
        // From rest, M v^2/2 + W - F u stays 0.
        let total = 0.005 * state.v[0].powi(2) + truss(state.u[0])[0] - load * state.u[0];
        assert!(total.abs() < 1e-4 * load, "t = {}: {total}", state.t());
        farthest = farthest.max(state.u[0]);
    }
    assert!(farthest > 2.0 * HEIGHT);
    // Steps far too long for the motion still solve their equations.
    for id in METHODS {
        let (mut integrator, mut state) = (build(id, &plain()), State::at_rest(1));
        let work = run(&mut *integrator, &system, &mut state, 2.0, 50);
        assert!(work.projected_solves > 0, "`{id}`: {work:?}");
    }
}

#[test]
fn stiffness_damping_by_the_current_tangent_takes_few_iterations_more() {
    let damping = Damping {
        stiffness: 0.02,
        ..Damping::default()
    };
    let chain = Chain {
        stiffness: 50.0,
        cubic: 5000.0,
        longest: f64::INFINITY,
    };
    let system = damped(
        chain,
        &[0.5; 5],
        Layers::One,
        vec![0.0, 0.0, 0.0, 0.0, 10.0],
        damping,
    );
    let rest = static_solution(&system, &[0.0, 0.0, 0.0, 0.0, 10.0]).unwrap();
    for id in METHODS {
        let (mut integrator, mut state) = (build(id, &plain()), State::at_rest(5));
        let work = run(&mut *integrator, &system, &mut state, 0.05, 1000);
        assert!(work.newton_iterations <= 4000, "`{id}`: {work:?}");
        for (u, rest) in state.u.iter().zip(&rest) {
            assert!((u / rest - 1.0).abs() < 1e-4, "`{id}`: {u} {rest}");
        }
    }
}

/// A mass that a stiff spring keeps on a circle.
fn sling() -> (ForceModel<crate::common::nonlinear::Law<Sling>>, State) {
    let sling = Sling {
        stiffness: 1e4,
        length: 1.0,
    };
    let system = model(sling, &[1.0], Layers::Three, vec![0.0; 3]);
    (system, State::new(vec![0.0; 3], vec![0.0, 2.0, 0.0]))
}

#[test]
fn growth_of_the_energy_is_told_with_its_numbers_and_only_where_it_grows() {
    let energy = |system: &ForceModel<crate::common::nonlinear::Law<Sling>>, state: &State| {
        let kinetic: f64 = state.v.iter().map(|v| 0.5 * v * v).sum();
        kinetic
            + system
                .law()
                .potential
                .energy(&state.u, &mut [0.0; 3])
                .unwrap()
    };
    let said = |id: &str, dt: f64| {
        let (system, mut state) = sling();
        let mut integrator = build(id, &plain());
        let mut most: f64 = 0.0;
        for _ in 0..400 {
            integrator.step(&system, &mut state, dt).unwrap();
            most = most.max(energy(&system, &state));
        }
        (most / 2.0, integrator.remarks().join("; "))
    };
    let (grown, remarks) = said("newmark", 0.16);
    assert!(grown > 100.0, "{grown}: {remarks}");
    let numbers = "start, loads and supports account for 2.000e0 J";
    assert!(
        remarks.contains("grew by itself") && remarks.contains(numbers),
        "{remarks}"
    );
    for (id, dt) in [
        ("newmark", 0.01),
        ("newmark", 0.12),
        ("implicit-euler", 0.16),
        ("generalized-alpha", 0.12),
        ("generalized-alpha", 0.16),
    ] {
        let (grown, remarks) = said(id, dt);
        assert!(
            grown < 1.02 && !remarks.contains("grew"),
            "`{id}` {dt}: {grown}: {remarks}"
        );
    }
}

#[test]
fn a_step_that_is_not_solved_ends_the_run_by_name_and_keeps_what_was() {
    let chain = Chain {
        stiffness: 1.0,
        cubic: 1e6,
        longest: f64::INFINITY,
    };
    let system = model(chain, &[0.1; 3], Layers::One, vec![0.0; 3]);
    for id in METHODS {
        let options = plain().with_number("newton_iterations", 1.0);
        let options = options.with_number("newton_tolerance", 1e-10);
        let mut integrator = build(id, &options);
        let mut state = State::new(vec![0.0; 3], vec![0.0, 0.0, 50.0]);
        let started = state.clone();
        let run = Run {
            dt: 0.01,
            steps: 10,
            divergence_limit: f64::INFINITY,
        };
        let error = simulate(&system, &mut *integrator, &mut state, &run, &mut ()).unwrap_err();
        let message = error.to_string();
        let SimulateError::Step(StepError::NotConverged {
            integrator,
            t,
            iterations,
            residual,
            ..
        }) = error
        else {
            panic!("{message}");
        };
        assert_eq!((integrator, t, iterations), (id, 0.0, 1));
        assert!(
            residual > 1e-10 && message.contains("take a shorter step"),
            "{message}"
        );
        assert_eq!((&state.u, &state.v), (&started.u, &started.v));
    }
}

#[test]
fn trials_that_a_law_refuses_are_taken_shorter() {
    // The first trial, `u + dt v`, is beyond what the link bears; the solution is not.
    let chain = Chain {
        stiffness: 10.0,
        cubic: 1e7,
        longest: 0.05,
    };
    let system = model(chain, &[0.01], Layers::One, vec![0.0]);
    let (mut integrator, mut state) = (
        build("implicit-euler", &plain()),
        State::new(vec![0.0], vec![2.0]),
    );
    let work = integrator.step(&system, &mut state, 0.05).unwrap();
    assert!(work.backtracks > 0, "{work:?}");
    let (u, v) = (state.u[0], state.v[0]);
    let force = 10.0 * u + 1e7 * u.powi(3);
    assert!((u - 0.05 * v).abs() < 1e-15 && (0.01 * (v - 2.0) / 0.05 + force).abs() < 1e-5 * force);
}

#[test]
fn a_load_that_no_equilibrium_carries_is_refused_with_the_share_that_is() {
    let weak = Chain {
        stiffness: 10.0,
        cubic: 0.0,
        longest: 0.3,
    };
    let system = model(weak, &[1.0], Layers::One, vec![0.0]);
    let error = static_solution(&system, &[10.0]).unwrap_err();
    let message = error.to_string();
    let StaticError::Unreached {
        share,
        source: NewtonError::Refused(EvaluationError { element: 0, .. }),
    } = error
    else {
        panic!("{message}");
    };
    assert!((share - 0.3).abs() < 2e-3, "{message}");
    assert!(message.contains("more than 0.3 m"), "{message}");

    let free = one(1.0, 0.0, |_| [0.0; 3]);
    // Nothing holds it: its tangent is 0, as that of a held component.
    assert!(static_solution(&free, &[1.0]).is_err());
    assert_eq!(static_solution(&free, &[0.0]).unwrap(), [0.0]);
    assert!(matches!(
        static_solution(&free, &[1.0, 2.0]),
        Err(StaticError::Size { load: 2, system: 1 })
    ));
}
