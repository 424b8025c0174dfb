//! The option `saturation` as a guard.

use std::sync::Mutex;

use crate::common::cube::{cube, mass_damping, paper_cube, problem, scene, springs};
use crate::common::tissue::{body, held, linear};
use crate::common::{advance, build, diverged, largest, plain, relative_error, saturation, watch};
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Acceleration, Equations, EvaluationError, Integrator, Layers, LinearModel, LinearOperators,
    LinearSystem, Load, OptionValue, Options, Ramp, Revision, Run, StableStep, State, System,
};
use sinew_fem::{LoadKind, LoadSpec, Model, Problem};
use sinew_integrators::explicit::{GuardOption, Guarded};
use sinew_mesh::structured::{self, Split};

fn word(value: &str) -> Options {
    plain().with("saturation", OptionValue::Text(value.into()))
}

fn auto() -> Options {
    word("auto")
}

/// Methods that take a guard.
fn guarded_ids() -> Vec<&'static str> {
    let entries = sinew_integrators::entries().into_iter();
    let guarded = entries.filter(|entry| entry.guard != GuardOption::None);
    guarded.map(|entry| entry.id).collect()
}

/// A fact by name.
fn fact(integrator: &dyn Integrator, name: &str) -> f64 {
    let facts = integrator.facts();
    let fact = facts.iter().find(|fact| fact.name == name);
    fact.unwrap_or_else(|| panic!("no {name} in {facts:?}"))
        .value
}

fn largest_limit(system: &dyn System, start: &State) -> f64 {
    let mut integrator = build("central-difference", &auto());
    integrator.step(system, &mut start.clone(), 1e-9).unwrap();
    fact(&*integrator, Guarded::LARGEST_LIMIT)
}

fn bits(state: &State) -> Vec<u64> {
    let times = [state.t()];
    let all = [&times, &state.u[..], &state.v, &state.a].concat();
    all.iter().map(|value| value.to_bits()).collect()
}

fn oscillator(damping: f64) -> LinearModel {
    LinearModel::new(LinearOperators::oscillator(0.1, 100.0, damping).unwrap())
}

fn loaded_oscillator(force: f64, ramp: Ramp) -> LinearModel {
    let load = Load {
        ramp,
        entries: vec![(0, force)],
    };
    let operators = LinearOperators::oscillator(0.1, 100.0, 0.0).unwrap();
    LinearModel::new(operators.with_loads(vec![load]).unwrap())
}

#[test]
fn every_explicit_method_and_every_network_takes_one() {
    let expected = [
        "forward-euler",
        "symplectic-euler",
        "central-difference",
        "rk4",
        "modified-leapfrog",
        "cnn",
        "cnn-symplectic",
        "cnn-stabilised",
    ];
    assert_eq!(guarded_ids(), expected);
}

#[test]
fn bad_values_are_refused_by_each_method() {
    let bad = [
        OptionValue::Number(0.0),
        OptionValue::Number(-4.0),
        OptionValue::Number(f64::NAN),
        OptionValue::Number(f64::INFINITY),
        OptionValue::Text("of".into()),
    ];
    for id in guarded_ids() {
        for value in &bad {
            let options = plain().with("saturation", value.clone());
            let refusal = sinew_integrators::build(id, &options).err().unwrap();
            assert_eq!(
                refusal.to_string(),
                format!(
                    "`{id}`: saturation = {value}: expected a number above 0 [m/s], \"auto\" or \"off\""
                )
            );
        }
    }
}

// The limits.

/// Ten times the speed of the lightest cell with the whole energy of a suddenly applied load, `F'K^-1 F/2`.
#[cfg(feature = "implicit")]
#[test]
fn on_the_papers_cube_the_limit_is_that_of_the_loads_work() {
    let model = paper_cube();
    let mut force = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(sinew_core::LoadTime::at(1.0), &mut force);
    let at_rest = sinew_integrators::static_solution(model, &force).unwrap();
    let work: f64 = force.iter().zip(&at_rest).map(|(f, u)| f * u).sum();
    let lightest = model.mass().iter().copied().fold(f64::INFINITY, f64::min);
    let limit = 10.0 * (work / lightest).sqrt();
    let found = largest_limit(model, &State::at_rest(model.dofs()));
    assert!((found / limit - 1.0).abs() < 1e-6, "{found} {limit}");
}

/// Ten times the speed for the largest possible energy.
#[test]
fn the_oscillators_limit_is_that_of_its_energy() {
    let ten = 10.0;
    let pushed = State::new(vec![0.0], vec![-5.0]);
    assert_limit(&oscillator(1.0), &pushed, ten * 5.0);
    let drawn = State::new(vec![0.1], vec![0.0]);
    assert_limit(&oscillator(1.0), &drawn, ten * 0.1 * 1000.0_f64.sqrt());
    // A constant force from rest: at its largest, v = F/sqrt(k m). Taken away again in the worst
    // moment, twice that; but a short push gives no more than its impulse.
    let rest = State::at_rest(1);
    let fastest = 2.0 / f64::sqrt(100.0 * 0.1);
    assert_limit(&loaded_oscillator(2.0, Ramp::Step), &rest, ten * fastest);
    let rise = Ramp::Sin2 { rise: 0.2 };
    assert_limit(&loaded_oscillator(2.0, rise), &rest, ten * fastest);
    let pulse = |to| Ramp::Pulse { from: 0.0, to };
    let long = loaded_oscillator(2.0, pulse(1.0));
    assert_limit(&long, &rest, ten * 2.0 * fastest);
    let short = loaded_oscillator(2.0, pulse(1e-3));
    // In steps of a nanosecond it may be longer by two of them.
    assert_limit(&short, &rest, ten * 2.0 / 0.1 * (1e-3 + 2e-9));
    // The motions of the start and of the load add up.
    let loaded = loaded_oscillator(2.0, Ramp::Step);
    assert_limit(&loaded, &pushed, ten * (fastest + 5.0));
}

#[track_caller]
fn assert_limit(system: &dyn System, start: &State, expected: f64) {
    let found = largest_limit(system, start);
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
}

/// A force that reverses at each zero of the velocity does the most work a force can.
#[test]
fn a_load_in_resonance_stays_within_the_limit_and_comes_near_it() {
    let half_period = std::f64::consts::PI / 1000.0_f64.sqrt();
    let turn = |n: usize| n as f64 * half_period;
    let count = 20;
    let times = (0..count).flat_map(|n| [turn(n) + 1e-6, turn(n + 1)]);
    let sign = |n: usize| if n.is_multiple_of(2) { 1.0 } else { -1.0 };
    let values = (0..count).flat_map(|n| [sign(n); 2]);
    let ramp = Ramp::Table {
        times: times.collect(),
        values: values.collect(),
    };
    let system = loaded_oscillator(2.0, ramp);
    let limit = largest_limit(&system, &State::at_rest(1)) / 10.0;
    let (mut rk4, mut state, mut fastest) = (build("rk4", &plain()), State::at_rest(1), 0.0);
    let dt = half_period / 200.0;
    for _ in 0..count * 200 {
        rk4.step(&system, &mut state, dt).unwrap();
        fastest = state.v[0].abs().max(fastest);
    }
    assert!(fastest < limit, "{fastest} {limit}");
    assert!(fastest > 0.97 * limit, "{fastest} {limit}");
}

#[test]
fn what_the_start_brings_is_its_energy() {
    let model = cube(4);
    let mut moving = State::at_rest(model.dofs());
    moving.v.chunks_exact_mut(3).for_each(|v| v[1] = 2.0);
    let waves = (0..).map(|dof| 1e-3 * f64::sin(0.7 * f64::from(dof)));
    let deformed = waves.take(model.dofs()).collect();
    let deformed = State::new(deformed, vec![0.0; model.dofs()]);
    for mut state in [moving, deformed] {
        let energy = model.energy(&state.u, &state.v).unwrap().total();
        build("rk4", &auto())
            .step(&model, &mut state, 1e-9)
            .unwrap();
        let start = state.start.unwrap();
        assert_eq!(start.energy, energy);
        assert_eq!(start.system, model.revision());
    }
}

/// Another system is another motion; the same system is the same motion with any integrator.
#[test]
fn the_start_is_that_of_the_system_at_hand() {
    let (first, second) = (cube(3), cube(3));
    let mut state = State::at_rest(first.dofs());
    let mut integrator = build("central-difference", &auto());
    advance(&mut *integrator, &first, &mut state, 5, 1e-3);
    assert_eq!(state.start.unwrap().energy, 0.0);
    assert_eq!(state.start.unwrap().system, first.revision());
    advance(&mut *integrator, &second, &mut state, 1, 1e-3);
    let start = state.start.unwrap();
    assert_eq!(start.system, second.revision());
    assert!(start.energy > 0.0);
}

#[test]
fn a_body_that_its_loads_carry_away_needs_a_number() {
    let mut problem = Problem {
        loads: vec![top_load(Ramp::Step)],
        ..body(springs(0.0))
    };
    let mesh = structured::cube(3, 0.2, Split::Kuhn).unwrap();
    let model = Model::build(&mesh, &problem).unwrap();
    let refusal = build("rk4", &auto()).prepare(&model, 1e-3).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "`rk4` needs a body with enough supports for saturation = \"auto\" (give a number instead), which this system does not offer"
    );
    assert!(build("rk4", &saturation(4.0)).prepare(&model, 1e-3).is_ok());
    // A push ends.
    problem.loads = vec![top_load(Ramp::Pulse { from: 0.0, to: 0.1 })];
    let model = Model::build(&mesh, &problem).unwrap();
    assert!(build("rk4", &auto()).prepare(&model, 1e-3).is_ok());
}

fn top_load(ramp: Ramp) -> LoadSpec {
    LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, -500.0])).with_ramp(ramp)
}

/// A number that is not reached changes nothing, at any step and with any other option.
#[test]
fn a_number_that_is_not_reached_changes_nothing() {
    let model = cube(3);
    let waves = |size: f64, rate: f64| {
        let wave = |dof| size * f64::sin(rate * f64::from(dof));
        (0..model.dofs() as u32).map(wave).collect()
    };
    for id in guarded_ids() {
        for dt in [1e-4, 5e-2] {
            let mut one = State::new(waves(1e-3, 0.7), waves(0.1, 1.3));
            let mut other = one.clone();
            let (mut guarded, mut off) = (build(id, &saturation(1e300)), build(id, &word("off")));
            for _ in 0..30 {
                let work = guarded.step(&model, &mut one, dt).unwrap();
                assert_eq!(work, off.step(&model, &mut other, dt).unwrap());
                assert!(bits(&one) == bits(&other), "`{id}` at {dt}");
            }
        }
    }
}

// Bounded whatever the step.

/// The paper's cube under another pressure (Pa).
fn paper_cube_under(pressure: f64) -> Model {
    let mesh = structured::cube(10, 0.2, Split::Kuhn).unwrap();
    let traction = [0.0, 0.0, -pressure];
    Model::build(&mesh, &problem(springs(0.0), mass_damping(80.0), traction)).unwrap()
}

/// Result of a run of one second.
#[derive(Debug)]
struct Second {
    /// The largest displacement (m); infinite if it passed a hundred times the size of the body.
    size: f64,
    /// Share of saturated (dof, step) pairs.
    saturated: f64,
    /// Substeps of each step.
    parts: f64,
}

fn one_second(model: &Model, id: &str, options: &Options, dt: f64) -> Second {
    let run = Run::covering(1.0, dt).with_divergence_limit(20.0);
    let mut integrator = build(id, options);
    let mut size: f64 = 0.0;
    let start = State::at_rest(model.dofs());
    let (_, report) = watch(model, &mut *integrator, start, &run, |state| {
        size = size.max(largest(&state.u));
    });
    let facts = integrator.facts();
    let parts = facts.iter().find(|fact| fact.name == Guarded::SUBSTEPS);
    Second {
        size: if diverged(&report) {
            f64::INFINITY
        } else {
            size
        },
        saturated: report.work.saturated as f64 / (report.steps * model.dofs()) as f64,
        parts: parts.map_or(1.0, |fact| fact.value),
    }
}

/// Steps beyond the limit of every explicit method.
fn long_steps(model: &Model) -> [f64; 2] {
    [0.02, 5.0 * Spectrum::of(model.operators()).critical_step()]
}

/// The largest displacement of the exact motion under this pressure, section 4.2 (m).
fn exact_size(pressure: f64) -> f64 {
    0.01695 * pressure / 500.0
}

#[test]
fn at_any_step_every_method_stays_bounded_with_the_guard_and_none_without() {
    for pressure in [500.0, 5.0] {
        let model = paper_cube_under(pressure);
        for dt in long_steps(&model) {
            for id in guarded_ids()
                .into_iter()
                .filter(|id| *id != "cnn-stabilised")
            {
                let free = one_second(&model, id, &word("off"), dt);
                assert_eq!(free.size, f64::INFINITY, "`{id}` at {dt}");
                let guarded = one_second(&model, id, &auto(), dt);
                assert!(guarded.parts > 1.0, "`{id}` at {dt}: {guarded:?}");
                // Stable parts make a stable motion.
                assert_eq!(guarded.saturated, 0.0, "`{id}` at {dt}");
                let share = guarded.size / exact_size(pressure);
                assert!((share - 1.0).abs() < 0.01, "`{id}` at {dt}: {share}");
            }
        }
    }
}

/// With a number, no step is divided: beyond their stable step these two reverse the restoring force, and cells run
/// away at the limit.
#[test]
fn a_number_clamps_and_cuts_nothing() {
    let model = paper_cube_under(5.0);
    for dt in long_steps(&model) {
        for id in ["rk4", "modified-leapfrog"] {
            let limit = 0.0126;
            let clamped = one_second(&model, id, &saturation(limit), dt);
            assert_eq!(clamped.parts, 1.0, "`{id}` at {dt}");
            let size = clamped.size;
            assert!(size > 0.9 * limit * 1.0, "`{id}` at {dt}: {size}");
        }
    }
}

fn parts(model: &Model, id: &str, dt: f64, start: &State) -> f64 {
    let mut integrator = build(id, &auto());
    integrator.step(model, &mut start.clone(), dt).unwrap();
    fact(&*integrator, Guarded::SUBSTEPS)
}

/// Methods with a stable step on the paper's cube.
const STABLE_UP_TO: [&str; 7] = [
    "forward-euler",
    "symplectic-euler",
    "central-difference",
    "rk4",
    "modified-leapfrog",
    "cnn",
    "cnn-symplectic",
];

#[test]
fn a_step_that_no_number_of_parts_makes_stable_is_refused() {
    let model = paper_cube_under(1.0);
    for id in STABLE_UP_TO {
        let refused = build(id, &auto()).prepare(&model, 1e12);
        let message = refused.unwrap_err().to_string();
        let expected =
            "times the stable step, too many for saturation = \"auto\"; take a shorter dt";
        assert!(message.contains(expected), "`{id}`: {message}");
    }
}

#[test]
fn a_step_is_cut_beyond_the_stable_one_into_the_fewest_parts_of_nine_tenths_of_it() {
    let models = [0.01, 1.0, 100.0, 500.0].map(paper_cube_under);
    let rest = State::at_rest(models[0].dofs());
    for (id, model) in STABLE_UP_TO
        .iter()
        .flat_map(|id| models.iter().map(move |model| (id, model)))
    {
        let limit = match build(id, &plain()).stable_step(model).unwrap() {
            StableStep::UpTo(limit) => limit,
            other => panic!("`{id}`: {other:?}"),
        };
        for (share, expected) in [
            (0.5, 1.0),
            (1.0, 1.0),
            (1.01, 2.0),
            (1.79, 2.0),
            (1.81, 3.0),
            (3.15, 4.0),
            (9.5, 11.0),
        ] {
            let found = parts(model, id, share * limit, &rest);
            assert_eq!(found, expected, "`{id}` at {share}");
        }
    }
    assert_eq!(parts(&models[3], "cnn-stabilised", 0.02, &rest), 1.0);
}

#[test]
fn a_cut_step_is_so_many_substeps_to_the_bit() {
    let dt = 3.15 * Spectrum::of(paper_cube().operators()).critical_step();
    for pressure in [1.0, 100.0, 500.0] {
        let model = paper_cube_under(pressure);
        let (mut guarded, mut free) = (
            build("central-difference", &auto()),
            build("central-difference", &plain().with_number("substeps", 4.0)),
        );
        let rest = State::at_rest(model.dofs());
        let (mut one, mut other) = (rest.clone(), rest);
        for step in 0..40 {
            let work = guarded.step(&model, &mut one, dt).unwrap();
            let expected = free.step(&model, &mut other, dt).unwrap();
            assert_eq!(work, expected, "{pressure} Pa, step {step}");
            assert!(bits(&one) == bits(&other), "{pressure} Pa, step {step}");
        }
    }
}

/// Forward Euler and the paper's network without damping: substeps in which no cell moves by more than a fifth of its
/// size, and clamped motion in addition.
#[test]
fn where_no_step_is_stable_parts_are_chosen_by_size_and_the_motion_stays_bounded() {
    let model = scene(4, 0.2, springs(0.0), mass_damping(0.0));
    let rest = State::at_rest(model.dofs());
    for id in ["forward-euler", "cnn"] {
        let mut integrator = build(id, &auto());
        integrator.step(&model, &mut rest.clone(), 0.02).unwrap();
        // All cells are of one size, 50 mm.
        let passed = 0.02 * fact(&*integrator, Guarded::LARGEST_LIMIT) / (0.2 * 0.05);
        let found = fact(&*integrator, Guarded::SUBSTEPS);
        assert_eq!(found, passed.ceil(), "`{id}`");
        let said = integrator.remarks().join("; ");
        assert!(said.contains("knows no stable step"), "`{id}`: {said}");

        let free = one_second(&model, id, &word("off"), 0.02);
        assert_eq!(free.size, f64::INFINITY, "`{id}`");
        let second = one_second(&model, id, &auto(), 0.02);
        let share = second.size / exact_size(500.0);
        assert!(share < 10.0, "`{id}`: {share} of the exact size");
    }
}

/// Cells of a thousandth of the width weigh a millionth: a fifth of their size would need millions of substeps.
#[test]
fn parts_by_size_are_a_thousand_at_most() {
    let mut mesh = structured::block([1, 1, 20], [0.02, 0.02, 0.2], Split::Kuhn).unwrap();
    for [x, y, z] in &mut mesh.points {
        let width = 1000.0_f64.powf(-*z / 0.2);
        (*x, *y) = (*x * width, *y * width);
    }
    let mut problem = problem(springs(0.0), mass_damping(0.0), [0.0, 0.0, -5.0]);
    problem.fixed[0].on = "bottom".into();
    problem.gravity = Some([0.0, 0.0, -9.81]);
    let model = Model::build(&mesh, &problem).unwrap();
    let rest = State::at_rest(model.dofs());
    assert_eq!(parts(&model, "forward-euler", 0.02, &rest), 1000.0);
}

/// Cells that start at 2 m/s raise the limits, and with them the number of substeps.
#[test]
fn a_fast_start_cuts_steps_too_and_so_does_a_fresh_integrator_later() {
    let model = scene(3, 0.2, springs(0.0), mass_damping(0.0));
    let rest = State::at_rest(model.dofs());
    let mut state = rest.clone();
    state.v.chunks_exact_mut(3).for_each(|v| v[0] = 2.0);
    let still = parts(&model, "forward-euler", 0.02, &rest);
    let moving = parts(&model, "forward-euler", 0.02, &state);
    assert!(moving > 1.1 * still, "{moving} {still}");
    for _ in 0..3 {
        let mut integrator = build("forward-euler", &auto());
        let work = integrator.step(&model, &mut state, 0.02).unwrap();
        assert_eq!(work.sweeps as f64, moving);
    }
}

#[test]
fn parts_and_guard_go_together() {
    let model = paper_cube();
    let both = auto().with("substeps", OptionValue::Text("auto".into()));
    let only = plain().with("substeps", OptionValue::Text("auto".into()));
    for id in ["forward-euler", "central-difference", "rk4", "cnn"] {
        let off = only
            .clone()
            .with("saturation", OptionValue::Text("off".into()));
        let only = if id == "cnn" { &off } else { &only };
        let start = State::at_rest(model.dofs());
        let (mut one, mut other) = (start.clone(), start);
        let (mut guarded, mut free) = (build(id, &both), build(id, only));
        for _ in 0..20 {
            let work = guarded.step(model, &mut one, 0.02).unwrap();
            assert_eq!(work, free.step(model, &mut other, 0.02).unwrap());
            assert!(bits(&one) == bits(&other), "`{id}`");
        }
    }
}

// What a clamped step leaves behind.

#[test]
fn a_clamped_cell_keeps_its_direction_at_the_limit() {
    let model = cube(3);
    let q = 0.05;
    for id in guarded_ids()
        .into_iter()
        .filter(|id| !id.starts_with("cnn"))
    {
        let mut guarded = build(id, &saturation(q));
        let mut free = build(id, &plain());
        let mut state = State::at_rest(model.dofs());
        let dt = 1e-3;
        let mut saturated = 0;
        for _ in 0..40 {
            let (before, mut unclamped) = (state.clone(), state.clone());
            free.step(&model, &mut unclamped, dt).unwrap();
            let work = guarded.step(&model, &mut state, dt).unwrap();
            let mut cells = 0;
            for cell in 0..model.dofs() / 3 {
                let of = |x: &[f64]| -> [f64; 3] { std::array::from_fn(|i| x[3 * cell + i]) };
                let length = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
                let apart = |a: &[f64], b: &[f64]| -> [f64; 3] {
                    std::array::from_fn(|i| a[3 * cell + i] - b[3 * cell + i])
                };
                let (v, v_free) = (of(&state.v), of(&unclamped.v));
                let (d, d_free) = (apart(&state.u, &before.u), apart(&unclamped.u, &before.u));
                let mut touched = false;
                for (vector, free, limit) in [(v, v_free, q), (d, d_free, q * dt)] {
                    if length(free) > limit * (1.0 + 1e-9) {
                        touched = true;
                        assert!((length(vector) / limit - 1.0).abs() < 1e-8);
                        let along: f64 = vector.iter().zip(&free).map(|(a, b)| a * b).sum();
                        assert!((along / (limit * length(free)) - 1.0).abs() < 1e-8);
                    } else {
                        assert_eq!(vector, free);
                    }
                }
                cells += u64::from(touched);
            }
            assert_eq!(work.saturated, 3 * cells, "`{id}`");
            saturated += work.saturated;
        }
        assert!(saturated > 100, "`{id}`: {saturated}");
    }
}

/// The kept acceleration leads from the velocity before to the clamped one.
#[test]
fn a_kept_acceleration_is_that_of_the_clamped_motion() {
    let model = cube(4);
    let dt = 0.02;
    let options = saturation(0.05).with_number("s", 1.0);
    let mut integrator = build("cnn-stabilised", &options);
    let mut state = State::at_rest(model.dofs());
    for step in 0..10 {
        let before = state.clone();
        let work = integrator.step(&model, &mut state, dt).unwrap();
        assert!(step == 0 || work.saturated > 0);
        assert_eq!(state.acceleration, Acceleration::Kick);
        let time = if step == 0 { dt / 2.0 } else { dt };
        for ((a, v), v_before) in state.a.iter().zip(&state.v).zip(&before.v) {
            assert!((v_before + time * a - v).abs() < 1e-14, "step {step}");
        }
    }
}

/// A run that a fresh integrator continues from a clone, with and without saturation, with and without substeps.
#[test]
fn a_clone_continues_to_the_bit_while_cells_saturate() {
    let model = paper_cube_under(5.0);
    let moving = || {
        let wave = |dof| 0.02 * f64::sin(0.7 * f64::from(dof));
        let v = (0..model.dofs() as u32).map(wave).collect();
        State::new(vec![0.0; model.dofs()], v)
    };
    for id in guarded_ids() {
        for options in [auto(), saturation(0.01)] {
            for start in [State::at_rest(model.dofs()), moving()] {
                let (mut integrator, mut state) = (build(id, &options), start);
                let dt = 0.02;
                advance(&mut *integrator, &model, &mut state, 11, dt);
                let mut clone = state.clone();
                let mut fresh = build(id, &options);
                for _ in 0..13 {
                    let work = integrator.step(&model, &mut state, dt).unwrap();
                    assert_eq!(
                        work.saturated,
                        fresh.step(&model, &mut clone, dt).unwrap().saturated
                    );
                }
                assert_eq!(state, clone, "`{id}` {options:?}");
            }
        }
    }
}

/// A system that keeps the states of which it was notified.
struct Told {
    inner: LinearModel,
    states: Mutex<Vec<State>>,
}

impl System for Told {
    fn dofs(&self) -> usize {
        self.inner.dofs()
    }
    fn mass(&self) -> &[f64] {
        self.inner.mass()
    }
    fn revision(&self) -> Revision {
        self.inner.revision()
    }
    fn layers(&self) -> Layers {
        self.inner.layers()
    }
    fn equations(&self) -> Equations<'_> {
        self.inner.equations()
    }
    fn accept(
        &self,
        state: &mut State,
        _inputs: &sinew_core::Inputs,
        _dt: f64,
    ) -> Result<(), EvaluationError> {
        self.states.lock().unwrap().push(state.clone());
        Ok(())
    }
}

#[test]
fn the_system_is_told_of_each_step_once_as_it_was_clamped() {
    for id in guarded_ids() {
        let system = Told {
            inner: oscillator(1.0),
            states: Mutex::default(),
        };
        let mut integrator = sinew_integrators::build(id, &saturation(1.0)).unwrap();
        let mut state = State::new(vec![0.0], vec![-5.0]);
        let mut seen = Vec::new();
        for _ in 0..4 {
            integrator.step(&system, &mut state, 1e-3).unwrap();
            seen.push(state.clone());
        }
        assert_eq!(*system.states.lock().unwrap(), seen, "`{id}`");
        let own = ["cnn", "cnn-symplectic"].contains(&id);
        assert!(own || seen[0].v == [-1.0], "`{id}`");
    }
}

// Directions.

/// Rotation by an angle about an axis (unit).
fn rotation(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let [x, y, z] = axis;
    let (s, c) = angle.sin_cos();
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let same = f64::from(u8::from(i == j));
            c * same + s * cross[i][j] + (1.0 - c) * axis[i] * axis[j]
        })
    })
}

fn turned(r: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    r.map(|row| row.iter().zip(x).map(|(r, x)| r * x).sum())
}

/// A cube under oblique traction, and the same rotated.
fn cube_and_turned(r: &[[f64; 3]; 3]) -> (Model, Model) {
    let mesh = structured::cube(5, 0.2, Split::Kuhn).unwrap();
    let mut other = mesh.clone();
    for point in &mut other.points {
        *point = turned(r, *point);
    }
    let model = |mesh, traction| {
        Model::build(mesh, &problem(springs(0.0), mass_damping(80.0), traction)).unwrap()
    };
    let traction = [300.0, 100.0, -500.0];
    (model(&mesh, traction), model(&other, turned(r, traction)))
}

/// Relative difference between the motion of a turned copy of the cube and the turned motion, and the share of
/// saturated pairs.
fn difference_when_turned(id: &str, options: &Options, dt: f64, r: &[[f64; 3]; 3]) -> (f64, f64) {
    let (model, other) = cube_and_turned(r);
    let motion = |model: &Model| {
        let (mut integrator, mut state) = (build(id, options), State::at_rest(model.dofs()));
        let mut saturated = 0;
        let mut motion = Vec::new();
        for _ in 0..60 {
            saturated += integrator.step(model, &mut state, dt).unwrap().saturated;
            motion.push(state.u.clone());
        }
        (motion, saturated as f64 / (60 * model.dofs()) as f64)
    };
    let ((mut expected, share), (found, _)) = (motion(&model), motion(&other));
    for u in expected.iter_mut().flat_map(|u| u.as_chunks_mut::<3>().0) {
        *u = turned(r, *u);
    }
    (relative_error(&found, &expected), share)
}

#[test]
fn a_guarded_motion_turns_with_the_scene_and_the_papers_clamp_does_not() {
    let quarter = rotation([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2);
    let oblique = rotation([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 0.7);
    let q = saturation(0.05);
    for r in [&quarter, &oblique] {
        for id in guarded_ids()
            .into_iter()
            .filter(|id| !["cnn", "cnn-symplectic"].contains(id))
        {
            let (difference, share) = difference_when_turned(id, &q, 1e-3, r);
            assert!(difference < 1e-10, "`{id}`: {difference:e}");
            assert!(share > 0.1, "`{id}`: {share}");
        }
    }
    for id in ["cnn", "cnn-symplectic"] {
        let (difference, share) = difference_when_turned(id, &q, 1e-3, &oblique);
        assert!(share > 0.1, "`{id}`: {share}");
        assert!(difference > 1e-2, "`{id}`: {difference:e}");
    }
}

/// A tapered bar hanging from its thick end, and the same rotated by 37 degrees.
#[test]
fn the_limits_of_a_turned_bar_under_gravity_are_the_same() {
    let mut mesh = structured::block([2, 2, 8], [0.04, 0.05, 0.3], Split::Kuhn).unwrap();
    for [x, y, z] in &mut mesh.points {
        (*x, *y) = (*x * (1.0 - 3.0 * *z), *y * (1.0 - 3.0 * *z));
    }
    let limit = |r: &[[f64; 3]; 3]| {
        let mut mesh = mesh.clone();
        mesh.points
            .iter_mut()
            .for_each(|point| *point = turned(r, *point));
        let bar = Problem {
            fixed: vec![held("bottom", [true; 3])],
            gravity: Some(turned(r, [0.0, 0.0, 9.81])),
            ..body(linear(3500.0, 0.3))
        };
        let model = Model::build(&mesh, &bar).unwrap();
        largest_limit(&model, &State::at_rest(model.dofs()))
    };
    let upright = limit(&rotation([0.0, 0.0, 1.0], 0.0));
    for axis in [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
    ] {
        let same = limit(&rotation(axis, f64::to_radians(37.0)));
        assert!((same / upright - 1.0).abs() < 1e-9, "{upright} {same}");
    }
}

#[test]
fn the_limits_of_a_turned_scene_are_the_same() {
    let oblique = rotation([2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 0.7);
    let (model, other) = cube_and_turned(&oblique);
    let wave = |dof| 1e-2 * f64::sin(0.7 * f64::from(dof));
    let field: Vec<f64> = (0..model.dofs() as u32).map(wave).collect();
    let vectors = field.as_chunks::<3>().0.iter();
    let turned_field: Vec<f64> = vectors.flat_map(|v| turned(&oblique, *v)).collect();
    let rest = || vec![0.0; model.dofs()];
    for (start, turned_start) in [
        (State::new(rest(), rest()), State::new(rest(), rest())),
        (
            State::new(field.clone(), rest()),
            State::new(turned_field.clone(), rest()),
        ),
        (
            State::new(rest(), field.clone()),
            State::new(rest(), turned_field.clone()),
        ),
    ] {
        let (limit, same) = (
            largest_limit(&model, &start),
            largest_limit(&other, &turned_start),
        );
        assert!((same / limit - 1.0).abs() < 1e-9, "{limit} {same}");
    }
}
