//! Modal superposition against closed forms, published figures and other methods.

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use crate::common::cube::cube;
use crate::common::{advance, build, largest, plain, relative_error};
use sinew_core::closed_form::DampedOscillator;
use sinew_core::{
    BlockMatrix, Damping, Integrator, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    LoadTime, OptionValue, Options, Pattern, Ramp, State, System,
};
use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Model, Problem, Rayleigh, Region, SpringRule};
use sinew_integrators::implicit::Modal;
use sinew_integrators::{Frame, Method};
use sinew_mesh::structured::{self, Split};

const MASS: f64 = 0.02; // kg
const SPRING: f64 = 300.0; // N/m

/// wall - mass - mass - ... - wall.
fn chain(masses: u32, damping: Damping, loads: Vec<Load>) -> LinearModel {
    let pairs = (1..masses).map(|right| [right - 1, right]);
    let pattern = Arc::new(Pattern::from_elements(masses as usize, pairs).unwrap());
    let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    for cell in 0..masses {
        stiffness.add_block(cell, cell, &[2.0 * SPRING]).unwrap();
        if cell > 0 {
            stiffness.add_block(cell - 1, cell, &[-SPRING]).unwrap();
            stiffness.add_block(cell, cell - 1, &[-SPRING]).unwrap();
        }
    }
    let mass = vec![MASS; masses as usize];
    LinearModel::new(LinearOperators::new(mass, stiffness, damping, loads).unwrap())
}

/// Angular frequency of mode j = 1, 2, ..: 2 sqrt(k/m) sin(j pi/(2 (n + 1))).
fn chain_frequency(masses: u32, mode: u32) -> f64 {
    let angle = f64::from(mode) * PI / (2.0 * f64::from(masses + 1));
    2.0 * (SPRING / MASS).sqrt() * angle.sin()
}

fn uniform(masses: u32, ramp: Ramp) -> Load {
    let entries = (0..masses).map(|dof| (dof, 0.01)).collect();
    Load { ramp, entries }
}

fn modes(count: f64) -> Options {
    plain().with_number("modes", count)
}

fn tolerance(tolerance: f64) -> Options {
    plain().with_number("tolerance", tolerance)
}

fn prepared(system: &dyn System, options: &Options) -> Frame<Modal> {
    let mut modal = Frame::new(Modal::from_options(options).unwrap());
    modal.prepare(system, 0.01).unwrap();
    modal
}

/// `||K phi - omega^2 M phi|| / ||K phi||` of the worst mode.
fn worst_residual(system: &dyn LinearSystem, modal: &Frame<Modal>) -> f64 {
    let operators = system.operators();
    let mut worst = 0.0_f64;
    for (mode, omega) in modal.frequencies().iter().enumerate() {
        let shape = modal.shape(mode).unwrap();
        let mut force = vec![0.0; shape.len()];
        operators.stiffness().multiply(shape, &mut force);
        let size = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        let inertia = shape.iter().zip(operators.mass());
        let off = force.iter().zip(inertia);
        let off = off.map(|(force, (phi, mass))| (force - omega * omega * mass * phi).powi(2));
        worst = worst.max(off.sum::<f64>().sqrt() / size);
    }
    worst
}

/// Displacements at `instants` instants.
fn motion(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    start: State,
    dt: f64,
    instants: usize,
    steps: usize,
) -> Vec<Vec<f64>> {
    let mut state = start;
    (0..instants)
        .map(|_| {
            advance(integrator, system, &mut state, steps, dt);
            state.u.clone()
        })
        .collect()
}

fn linear(poissons_ratio: f64) -> Law {
    Law::linear(3500.0, poissons_ratio)
}

fn springs(rule: SpringRule) -> Law {
    Law::Springs {
        youngs_modulus: 3500.0,
        rule,
        calibrate: false,
        damping_ratio: 0.0,
    }
}

/// A cube of edge 0.1 m.
fn body(
    cells: usize,
    law: Law,
    fixed: &[(&str, [bool; 3])],
    kind: LoadKind,
    damping: Rayleigh,
) -> Model {
    let mesh = structured::cube(cells, 0.1, Split::Kuhn).unwrap();
    let held = |(group, axes): &(&str, [bool; 3])| Fixed::at(*group).along(*axes);
    let problem = Problem {
        regions: vec![Region::new(law, 1060.0)],
        damping,
        fixed: fixed.iter().map(held).collect(),
        loads: vec![LoadSpec::new("top", kind)],
        gravity: None,
        moves: Vec::new(),
    };
    Model::build(&mesh, &problem).unwrap()
}

const ALL: [bool; 3] = [true; 3];

/// The cube on which other systems were measured: no damping, 0.042135 N on the free top nodes.
fn peers_cube() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| {
        let force = LoadKind::Force([0.0, 0.0, -0.042_135]);
        body(
            10,
            linear(0.45),
            &[("sides", ALL)],
            force,
            Rayleigh::default(),
        )
    })
}

/// Its error over 100 instants of the first second, against the exact motion by polynomials in K.
fn peers_error(options: &Options) -> (f64, Frame<Modal>) {
    static REFERENCE: OnceLock<Vec<Vec<f64>>> = OnceLock::new();
    let model = peers_cube();
    let rest = || State::at_rest(model.dofs());
    let reference = REFERENCE.get_or_init(|| {
        motion(
            model,
            &mut *build("propagator", &plain()),
            rest(),
            0.01,
            100,
            1,
        )
    });
    let mut modal = prepared(model, options);
    let found = motion(model, &mut modal, rest(), 0.01, 100, 1);
    (relative_error(&found, reference), modal)
}

#[test]
fn frequencies_of_a_chain() {
    // Both ways of finding modes: all at once and by Lanczos.
    for masses in [100, 600] {
        let system = chain(masses, Damping::default(), vec![]);
        let modal = prepared(&system, &modes(20.0));
        assert_eq!(modal.frequencies().len(), 20);
        for (mode, omega) in (1..).zip(modal.frequencies()) {
            let exact = chain_frequency(masses, mode);
            assert!((omega / exact - 1.0).abs() < 1e-10, "{mode}: {omega}");
        }
        let residual = worst_residual(&system, &modal);
        assert!(residual < 1e-6, "{residual:e}");
    }
}

#[test]
fn what_the_loads_do_not_excite_is_not_taken() {
    // A uniform load leaves every second mode at rest.
    let system = chain(600, Damping::default(), vec![uniform(600, Ramp::Step)]);
    let options = modes(8.0).with_number("basis", 80.0);
    let modal = prepared(&system, &options);
    for (mode, omega) in (0..).zip(modal.frequencies()) {
        let exact = chain_frequency(600, 2 * mode + 1);
        assert!((omega / exact - 1.0).abs() < 1e-9, "{mode}: {omega}");
    }
}

/// Only the initial state excites modes: the slowest ones are taken.
#[test]
fn a_chain_without_loads_swings_freely() {
    let system = chain(600, Damping::default(), vec![]);
    let mut modal = prepared(&system, &plain());
    let shape = modal.shape(2).unwrap().to_vec();
    let mut state = State::new(shape.clone(), vec![0.0; 600]);
    advance(&mut modal, &system, &mut state, 9, 0.5);
    let cos = (chain_frequency(600, 3) * 4.5).cos();
    let exact = shape.iter().map(|phi| phi * cos).collect();
    let error = relative_error(&[state.u], &[exact]);
    assert!(error < 1e-8, "{error:e}");
}

/// Lowest angular frequencies (rad/s) of the cube fixed at its sides.
#[test]
fn frequencies_of_the_cube() {
    for (law, expected) in [
        (springs(SpringRule::Lloyd), 39.0),
        (springs(SpringRule::VanGelder), 33.4),
        (linear(0.25), 47.7),
        (linear(0.45), 45.7),
        (linear(0.49), 45.9),
    ] {
        let traction = LoadKind::Traction([0.0, 0.0, -100.0]);
        let model = body(
            10,
            law.clone(),
            &[("sides", ALL)],
            traction,
            Rayleigh::default(),
        );
        let modal = prepared(&model, &modes(10.0).with_number("basis", 60.0));
        let lowest = modal.frequencies()[0];
        assert!((lowest - expected).abs() <= 0.05, "{law:?}: {lowest}");
    }
    let options = modes(5.0).with_number("basis", 60.0);
    let lowest = prepared(peers_cube(), &options).frequencies()[0];
    assert!((lowest / (2.0 * PI) - 7.27).abs() <= 0.005, "{lowest}");
}

/// An error of 4.4 % with a hundred of all modes that the load excites. Groups of fast modes do better.
#[test]
fn a_hundred_modes_of_the_peers_cube() {
    let (error, modal) = peers_error(&modes(100.0).with_number("basis", 800.0));
    assert_eq!(modal.frequencies().len(), 100);
    assert!((100.0 * error - 4.4).abs() <= 0.03 * 4.4, "{error}");
    let (bundled, modal) = peers_error(&modes(100.0));
    assert_eq!(modal.frequencies().len(), 100);
    assert!(bundled < 0.031, "{bundled}");
}

#[test]
fn a_tolerance_is_met_on_the_peers_cube() {
    for allowed in [0.05, 0.02] {
        let (error, modal) = peers_error(&tolerance(allowed));
        let estimate = modal.estimated_error().unwrap();
        assert!(estimate <= allowed, "{estimate}");
        assert!(error <= allowed, "{error} > {allowed}");
        assert!(error > 0.2 * allowed, "{error} is far below {allowed}");
        let modes = modal.frequencies().len();
        assert!(modes < 450, "{modes} modes for {allowed}");
    }
}

#[test]
fn a_tolerance_is_met_on_springs_too() {
    let traction = LoadKind::Traction([20.0, 0.0, -100.0]);
    let model = body(
        8,
        springs(SpringRule::Lloyd),
        &[("bottom", ALL)],
        traction,
        Rayleigh::default(),
    );
    let rest = || State::at_rest(model.dofs());
    let reference = motion(
        &model,
        &mut *build("propagator", &plain()),
        rest(),
        0.02,
        50,
        1,
    );
    for allowed in [0.03, 0.01] {
        let mut modal = prepared(&model, &tolerance(allowed));
        let found = motion(&model, &mut modal, rest(), 0.02, 50, 1);
        let error = relative_error(&found, &reference);
        assert!(error <= allowed, "{error} > {allowed}");
    }
}

#[test]
fn all_modes_are_exact() {
    let model = cube(4);
    let rest = || State::at_rest(model.dofs());
    let reference = motion(
        &model,
        &mut *build("propagator", &plain()),
        rest(),
        0.02,
        50,
        1,
    );
    let mut modal = prepared(&model, &plain());
    let held = model.pinned().iter().filter(|held| **held).count();
    assert_eq!(modal.frequencies().len(), model.dofs() - held);
    let error = relative_error(&motion(&model, &mut modal, rest(), 0.02, 50, 1), &reference);
    assert!(error < 1e-8, "{error:e}");
}

/// Damping of both kinds, from slight to beyond critical for the fast modes.
#[test]
fn a_damped_chain_moves_as_its_modes_do() {
    for (alpha, beta) in [(0.0, 0.0), (3.0, 0.0), (0.0, 0.02), (1.0, 0.5)] {
        let damping = Damping {
            mass: alpha,
            stiffness: beta,
            extra: None,
        };
        let n = 400;
        let system = chain(n, damping, vec![uniform(n, Ramp::Step)]);
        let mut modal = prepared(&system, &tolerance(1e-5));
        let mut state = State::at_rest(n as usize);
        for _ in 0..7 {
            modal.step(&system, &mut state, 0.3).unwrap();
        }
        let norm = (2.0 / f64::from(n + 1)).sqrt();
        let mut exact = vec![0.0; n as usize];
        for mode in 1..=n {
            let shape = |i: u32| norm * (f64::from(mode * (i + 1)) * PI / f64::from(n + 1)).sin();
            let omega = chain_frequency(n, mode);
            let damping = alpha + beta * omega * omega;
            let load = (0..n).map(shape).sum::<f64>() * 0.01 / MASS;
            let oscillator = DampedOscillator {
                omega,
                damping,
                load,
                displacement: 0.0,
                velocity: 0.0,
            };
            // Beyond this the closed form overflows; the mode is at rest.
            let q = if damping * 2.1 > 600.0 {
                load / (omega * omega) * (1.0 - (-omega * omega / damping * 2.1).exp())
            } else {
                oscillator.at(2.1).0
            };
            for (i, value) in exact.iter_mut().enumerate() {
                *value += q * shape(i as u32);
            }
        }
        let error = relative_error(&[state.u], &[exact]);
        assert!(error < 2e-5, "{alpha} {beta}: {error:e}");
    }
}

#[test]
fn ramps_are_followed_at_any_step() {
    let ramps = [
        Ramp::Sin2 { rise: 0.073 },
        Ramp::Table {
            times: vec![0.0, 0.011, 0.05, 0.09],
            values: vec![0.0, 2.0, -1.0, 0.5],
        },
    ];
    for ramp in ramps {
        let loads = vec![
            uniform(5, ramp.clone()),
            Load {
                ramp: Ramp::Step,
                entries: vec![(2, -0.02)],
            },
        ];
        let damping = Damping {
            mass: 2.0,
            ..Damping::default()
        };
        let system = chain(5, damping, loads);
        let rest = || State::at_rest(5);
        let fine = motion(&system, &mut *build("rk4", &plain()), rest(), 1e-5, 3, 5000);
        let found = motion(
            &system,
            &mut prepared(&system, &plain()),
            rest(),
            0.05,
            3,
            1,
        );
        let error = relative_error(&found, &fine);
        assert!(error < 1e-8, "{ramp:?}: {error:e}");
    }
}

#[test]
fn a_pulse_within_a_step_is_two_steps() {
    let pulse = Load {
        ramp: Ramp::Pulse {
            from: 0.03,
            to: 0.08,
        },
        entries: vec![(0, 1.0)],
    };
    let system = chain(1, Damping::default(), vec![pulse]);
    let mut state = State::at_rest(1);
    let mut modal = prepared(&system, &plain());
    modal.step(&system, &mut state, 0.2).unwrap();
    let since = |t: f64| {
        DampedOscillator {
            omega: (2.0 * SPRING / MASS).sqrt(),
            damping: 0.0,
            load: 1.0 / MASS,
            displacement: 0.0,
            velocity: 0.0,
        }
        .at(0.2 - t)
    };
    let (on, off) = (since(0.03), since(0.08));
    assert!((state.u[0] - (on.0 - off.0)).abs() < 1e-14);
    assert!((state.v[0] - (on.1 - off.1)).abs() < 1e-12);
}

/// A body without supports: six motions without stiffness, and Newton's law for the whole.
#[test]
fn a_floating_body_flies() {
    let traction = LoadKind::Traction([3.0, 0.0, -10.0]);
    let model = body(5, linear(0.3), &[], traction, Rayleigh::default());
    let mut modal = prepared(&model, &tolerance(0.01));
    let frequencies = modal.frequencies();
    assert!(frequencies[..6].iter().all(|omega| *omega == 0.0));
    assert!(frequencies[6] > 10.0, "{}", frequencies[6]);
    // It is thrown, too.
    let start = State::new(
        vec![0.0; model.dofs()],
        (0..model.dofs())
            .map(|dof| 0.3 * (dof % 3) as f64)
            .collect(),
    );
    let mut state = start.clone();
    advance(&mut modal, &model, &mut state, 10, 0.03);
    let mut force = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(0.0), &mut force);
    for axis in 0..3 {
        let sum = |values: &mut dyn Iterator<Item = f64>| values.skip(axis).step_by(3).sum::<f64>();
        let mass = sum(&mut model.mass().iter().copied());
        let moved = sum(&mut state.u.iter().zip(model.mass()).map(|(u, m)| u * m)) / mass;
        let push = sum(&mut force.iter().copied()) / mass;
        let expected = 0.3 * axis as f64 * 0.3 + 0.5 * push * 0.3 * 0.3;
        assert!((moved - expected).abs() < 1e-8, "{moved} {expected}");
    }
    let reference = motion(
        &model,
        &mut *build("propagator", &plain()),
        start,
        0.03,
        1,
        10,
    );
    let error = relative_error(&[state.u], &reference);
    assert!(error < 0.01, "{error}");
}

/// Fixed components are no motions without stiffness.
#[test]
fn held_components_are_no_modes() {
    let supports = [
        ("bottom", [false, false, true]),
        ("sides", [true, true, false]),
    ];
    let traction = LoadKind::Traction([5.0, 0.0, -10.0]);
    let model = body(6, linear(0.3), &supports, traction, Rayleigh::default());
    let held = model.pinned().iter().filter(|held| **held).count();
    assert!(held > 50 && model.dofs() - held > 300);
    let modal = prepared(&model, &tolerance(0.01));
    assert!(modal.frequencies()[0] > 10.0);
    let rest = || State::at_rest(model.dofs());
    let mut propagator = build("propagator", &plain());
    let reference = motion(&model, &mut *propagator, rest(), 0.02, 50, 1);
    for allowed in [0.01, 0.003, 0.001] {
        let mut modal = prepared(&model, &tolerance(allowed));
        let found = motion(&model, &mut modal, rest(), 0.02, 50, 1);
        let error = relative_error(&found, &reference);
        assert!(error <= allowed, "{error} > {allowed}");
        for u in &found {
            let mut components = u.iter().zip(model.pinned());
            assert!(components.all(|(u, held)| !held || *u == 0.0));
        }
    }
    // The slowest modes, whatever is loaded.
    let unloaded = model.operators().clone().with_loads(vec![]).unwrap();
    let unloaded = LinearModel::new(unloaded);
    let modal = prepared(&unloaded, &modes(12.0));
    assert!(modal.frequencies()[0] > 10.0);
    let residual = worst_residual(&unloaded, &modal);
    assert!(residual < 1e-6, "{residual:e}");
}

#[test]
fn set_up_and_steps_are_counted() {
    let mut modal = Frame::new(Modal::with_modes(20));
    let model = peers_cube();
    let work = modal.prepare(model, 0.01).unwrap();
    assert_eq!(work.factorizations, 1);
    // A test of the factor, the static response and forty vectors.
    assert_eq!(work.solves, 42);
    assert_eq!(modal.prepare(model, 0.01).unwrap().solves, 0);
    assert_eq!(
        modal.prepare(model, 0.02).unwrap().solves,
        0,
        "another step"
    );
    let step = modal.step(model, &mut State::at_rest(model.dofs()), 0.02);
    let step = step.unwrap();
    let sweep = 18 * model.operators().stiffness().pattern().blocks();
    assert_eq!(step.sweeps, (8 * model.dofs() * 20).div_ceil(sweep) as u64);
    assert_eq!((step.solves, step.factorizations), (0, 0));
}

#[test]
fn a_run_goes_on_from_any_of_its_states() {
    // What has been lifted from the modes lies in them: no solve checks it.
    let model = peers_cube();
    let mut modal = prepared(model, &modes(20.0));
    let mut state = State::at_rest(model.dofs());
    for _ in 0..5 {
        let step = modal.step(model, &mut state, 0.01).unwrap();
        assert_eq!(step.solves, 0);
    }
    let (mut clone, mut fresh) = (state.clone(), Frame::new(Modal::with_modes(20)));
    modal.step(model, &mut state, 0.01).unwrap();
    fresh.step(model, &mut clone, 0.01).unwrap();
    assert!(state == clone);
    assert!(largest(&state.u) > 0.0);
}

#[test]
fn refusals_say_what_to_do() {
    let springs_with_dashpots = Law::Springs {
        youngs_modulus: 3500.0,
        rule: SpringRule::Lloyd,
        calibrate: false,
        damping_ratio: 0.1,
    };
    let force = LoadKind::Force([0.0, 0.0, -1.0]);
    let dashpots = body(
        2,
        springs_with_dashpots,
        &[("bottom", ALL)],
        force,
        Rayleigh::default(),
    );
    assert_eq!(
        Frame::new(Modal::default())
            .prepare(&dashpots, 0.01)
            .unwrap_err()
            .to_string(),
        "`modal` needs proportional damping (D = alpha M + beta K, no dashpots), which this system \
         does not offer"
    );

    // A blow on the end of a long chain is a front that excites everything.
    let blow = Load {
        ramp: Ramp::Step,
        entries: vec![(0, 1.0)],
    };
    let front = chain(900, Damping::default(), vec![blow]);
    let message = Frame::new(Modal::default())
        .prepare(&front, 0.01)
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("`modal`: the tolerance needs more than 450 modes of 900"),
        "{message}"
    );
    assert!(
        message.ends_with("or use `central-difference`"),
        "{message}"
    );

    let smooth = chain(600, Damping::default(), vec![uniform(600, Ramp::Step)]);
    let mut plucked = State::at_rest(600);
    plucked.u[17] = 1e-3;
    let refusal = Frame::new(Modal::default()).step(&smooth, &mut plucked, 0.01);
    let message = refusal.unwrap_err().to_string();
    assert!(message.starts_with("`modal` at t = 0 s: "), "{message}");
    assert!(
        message.contains("% of the state lies outside the "),
        "{message}"
    );

    let refused = |options: &Options| Modal::from_options(options).unwrap_err().to_string();
    for (options, expected) in [
        (
            tolerance(0.0),
            "`modal`: tolerance = 0: expected a number above 0 and below 1",
        ),
        (
            modes(0.0),
            "`modal`: modes = 0: expected a whole number above 0",
        ),
        (
            modes(5.0).with_number("tolerance", 0.1),
            "`modal`: tolerance = 0.1: expected nothing beside `modes`",
        ),
        (
            plain().with_number("basis", 50.0),
            "`modal`: basis = 50: expected nothing without `modes`",
        ),
        (
            modes(5.0).with_number("basis", 4.0),
            "`modal`: basis = 4: expected a whole number not below `modes`",
        ),
        (
            plain().with("modes", OptionValue::Text("all".into())),
            "`modal`: modes = \"all\": expected a whole number above 0",
        ),
    ] {
        assert_eq!(refused(&options), expected);
    }
}
