//! `propagator`: undamped motions do not grow, for any tolerance, step and number of steps.

use crate::common::cube::altered;
use crate::common::exponential::exponentials;
use crate::common::tissue::{body, held, linear};
use crate::common::{build, largest, plain};
use proptest::prelude::*;
use sinew_core::spectrum::critical_step;
use sinew_core::{
    Damping, Integrator, LinearModel, LinearSystem, Load, LoadTime, OptionValue, Options, Ramp,
    State, System,
};
use sinew_fem::{Fixed, Model, Problem};
use sinew_mesh::structured::{self, Split};
use sinew_testkit::body::bodies_up_to;

/// The kinds whose steps are contractions.
const KINDS: [&str; 2] = ["chebyshev", "krylov"];

fn options(kind: &str, tolerance: f64) -> Options {
    plain()
        .with("kind", OptionValue::Text(kind.into()))
        .with_number("tolerance", tolerance)
}

/// A cube of edge 0.1 m of nearly incompressible tissue on the ground, without damping or loads, its
/// top raised by 1 mm.
fn raised_cube(cells: usize) -> (Model, State) {
    let fixed = vec![held("bottom", [true; 3])];
    cube_of_tissue(cells, fixed)
}

fn cube_of_tissue(cells: usize, fixed: Vec<Fixed>) -> (Model, State) {
    let mesh = structured::cube(cells, 0.1, Split::Kuhn).unwrap();
    let problem = Problem {
        fixed,
        ..body(linear(3500.0, 0.45))
    };
    let model = Model::build(&mesh, &problem).unwrap();
    let mut start = State::at_rest(model.dofs());
    for (node, point) in (0_u32..).zip(&mesh.points) {
        if point[2] > 0.1 - 1e-9
            && let Some(cell) = model.cell_of_node(node)
        {
            start.u[3 * cell as usize + 2] = 1e-3;
        }
    }
    (model, start)
}

fn energy(system: &dyn System, state: &State) -> f64 {
    system.energy(&state.u, &state.v).unwrap().total()
}

/// The largest energy after a step over the energy at the start, less 1.
fn growth(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    start: &State,
    dt: f64,
    steps: usize,
) -> f64 {
    let mut state = start.clone();
    let first = energy(system, start);
    let step = |_| {
        integrator.step(system, &mut state, dt).unwrap();
        energy(system, &state) / first - 1.0
    };
    (0..steps).map(step).fold(f64::NEG_INFINITY, f64::max)
}

fn fact(integrator: &dyn Integrator, name: &str) -> f64 {
    let facts = integrator.facts();
    facts.iter().find(|fact| fact.name == name).unwrap().value
}

/// A state with components in every mode.
fn scattered(system: &LinearModel) -> State {
    let limit = critical_step(system.operators());
    let value = |dof: usize, phase: f64| (dof as f64 * 1.7 + phase).sin();
    let dofs = 0..system.dofs();
    State::new(
        dofs.clone().map(|dof| 1e-3 * value(dof, 0.3)).collect(),
        dofs.map(|dof| 1e-3 / limit * value(dof, 2.1)).collect(),
    )
}

#[test]
fn a_raised_cube_gains_no_energy_at_any_tolerance() {
    for (cells, kind, dt, steps) in [
        (2, "chebyshev", 0.02, 20_000),
        (2, "chebyshev", 0.2, 2000),
        (4, "chebyshev", 0.02, 1000),
        (4, "chebyshev", 0.2, 200),
        (2, "krylov", 0.02, 2000),
        (2, "krylov", 0.2, 100),
        (4, "krylov", 0.02, 200),
    ] {
        let (model, start) = raised_cube(cells);
        for tolerance in [1e-2, 1e-3, 1e-6, 1e-10] {
            let mut integrator = build("propagator", &options(kind, tolerance));
            let growth = growth(&mut *integrator, &model, &start, dt, steps);
            let what = format!("{kind} {tolerance:e}, {cells} cells, {dt} s");
            assert!(growth <= 1e-12, "{what}: {growth:e}");
        }
    }
}

/// The two-step form's velocity is a mean over a step, so that only the displacements can be compared: modes beat, but
/// no amplitude keeps growing.
#[test]
fn the_two_step_form_swings_no_wider_at_the_end_than_at_the_beginning() {
    let (model, start) = raised_cube(2);
    let at_rest = |state: &State| State::new(state.u.clone(), vec![0.0; state.u.len()]);
    let first = energy(&model, &start);
    for dt in [0.02, 0.2] {
        for tolerance in [1e-2, 1e-3, 1e-10] {
            let mut integrator = build("propagator", &options("two-step", tolerance));
            let mut state = start.clone();
            let mut widest = |steps: usize| {
                (0..steps).fold(0.0, |widest: f64, _| {
                    integrator.step(&model, &mut state, dt).unwrap();
                    widest.max(energy(&model, &at_rest(&state)) / first)
                })
            };
            // Each mode keeps its amplitude but for the root of the tolerance, from rest at its widest.
            let allowed = (1.0 + tolerance.sqrt()).powi(2);
            for steps in [5000, 10_000, 5000] {
                let found = widest(steps);
                assert!(
                    found <= allowed,
                    "{dt} s, {tolerance:e}: {found} of {allowed}"
                );
            }
        }
    }
}

#[test]
fn a_step_is_off_by_no_more_than_its_tolerance_says() {
    let (model, _) = raised_cube(2);
    let system = altered(&model, Damping::default(), vec![]);
    let start = scattered(&system);
    let less = |a: &State, b: &State| {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        State::new(minus(&a.u, &b.u), minus(&a.v, &b.v))
    };
    let length = |state: &State| energy(&system, state).sqrt();
    let displaced = |state: &State| length(&State::new(state.u.clone(), vec![0.0; state.u.len()]));
    for dt in [0.02, 0.2] {
        let exact = exponentials(&system, &start, dt, 2);
        for tolerance in [0.5, 1e-2, 1e-3, 1e-6, 1e-10] {
            let what = format!("{dt} s, {tolerance:e}");
            let mut state = start.clone();
            let mut integrator = build("propagator", &options("chebyshev", tolerance));
            integrator.step(&system, &mut state, dt).unwrap();
            let error = length(&less(&state, &exact[0])) / length(&start);
            let said = fact(&*integrator, "step_error");
            assert!(
                error <= said && said <= tolerance,
                "{what}: {error:e} {said:e}"
            );
            assert!(error >= 0.02 * said, "{what}: {error:e} {said:e}");

            // From two displacements of which the second is off by as much as a first step may be.
            let mut state = start.clone();
            let mut integrator = build("propagator", &options("two-step", tolerance));
            integrator.step(&system, &mut state, dt).unwrap();
            integrator.step(&system, &mut state, dt).unwrap();
            let error = displaced(&less(&state, &exact[1]));
            let sine = fact(&*integrator, "sine_error");
            assert!(sine <= 2.0 * tolerance, "{what}: {sine:e}");
            let bound = 8.0 * sine * displaced(&exact[0]) + 2.0 * tolerance * length(&start);
            assert!(error <= bound, "{what}: {error:e} {bound:e}");
        }
    }
}

/// Permanent loads with damping: the body comes to rest in equilibrium with the springs, for any tolerance.
#[test]
fn equilibria_are_exact_at_any_tolerance() {
    let (model, _) = raised_cube(2);
    let critical = critical_step(model.operators());
    let damping = Damping {
        mass: 20.0,
        stiffness: 0.02 * critical,
        extra: None,
    };
    let entries: Vec<(u32, f64)> = (0..model.dofs() as u32)
        .map(|dof| (dof, 1e-3 * f64::from(dof).sin()))
        .collect();
    let load = Load {
        ramp: Ramp::Step,
        entries,
    };
    let system = altered(&model, damping, vec![load]);
    for kind in KINDS {
        for tolerance in [0.1, 1e-2, 1e-6] {
            let mut integrator = build("propagator", &options(kind, tolerance));
            let mut state = scattered(&system);
            for _ in 0..500 {
                integrator.step(&system, &mut state, 0.02).unwrap();
            }
            let mut force = vec![0.0; state.u.len()];
            system
                .operators()
                .net_force(state.t(), &state.u, &state.v, &mut force);
            let what = format!("{kind} {tolerance:e}: {:e}", largest(&force));
            assert!(largest(&force) <= 1e-12 * 1e-3, "{what}");
        }
    }
}

/// The body moves on at its speed; its error relative to the exact distance is less than the tolerance, and it never
/// gains energy.
#[test]
fn a_body_that_is_not_held_drifts_on_and_gains_no_energy() {
    let (model, mut start) = cube_of_tissue(2, vec![]);
    let speed = [0.01, -0.02, 0.005];
    for (dof, v) in start.v.iter_mut().enumerate() {
        *v = speed[dof % 3];
    }
    let mass = model.mass();
    let centre = |x: &[f64], axis: usize| {
        let own = mass.iter().zip(x).skip(axis).step_by(3);
        let (moment, sum) = own.fold((0.0, 0.0), |(moment, sum), (mass, x)| {
            (moment + mass * x, sum + mass)
        });
        moment / sum
    };
    let (dt, steps) = (0.02, 2000);
    for kind in KINDS {
        for tolerance in [1e-2, 1e-6, 1e-10] {
            let mut integrator = build("propagator", &options(kind, tolerance));
            let mut state = start.clone();
            let first = energy(&model, &start);
            for step in 0..steps {
                integrator.step(&model, &mut state, dt).unwrap();
                let gain = energy(&model, &state) / first - 1.0;
                assert!(gain <= 1e-11, "{kind} {tolerance:e} step {step}: {gain:e}");
            }
            for (axis, speed) in speed.into_iter().enumerate() {
                let what = format!("{kind} {tolerance:e} axis {axis}");
                let kept = centre(&state.v, axis) / speed;
                let way = (centre(&state.u, axis) - centre(&start.u, axis))
                    / (speed * dt * f64::from(steps));
                if kind == "chebyshev" {
                    // K u of a body that is 1 m away is rounded to as much.
                    assert!((kept - 1.0).abs() <= 1e-8, "{what}: {kept}");
                    assert!(
                        way <= 1.0 + 1e-8 && 1.0 - way <= tolerance + 1e-8,
                        "{what}: {way}"
                    );
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Energy less the work of constant loads never rises, with and without damping.
    #[test]
    fn no_step_brings_energy_in(
        body in bodies_up_to(1),
        share in 0.2..40.0,
        ratios in prop_oneof![Just([0.0; 2]), [0.0..1.0, 0.0..0.1]],
        tolerance in prop_oneof![Just(0.9), Just(0.1), Just(1e-2), Just(1e-4), Just(1e-8)],
        loaded in any::<bool>(),
    ) {
        let body = body.on_the_ground().conservative();
        let model = body.model();
        let limit = critical_step(model.operators());
        let start = body.state(&model, 1e-3, 1e-3 / limit);
        let force = 1e-3 * model.mass()[0] * (2.0 / limit).powi(2);
        let load = Load {
            ramp: Ramp::Step,
            entries: (0..model.dofs() as u32)
                .map(|dof| (dof, force * f64::from(dof).sin()))
                .collect(),
        };
        let damping = Damping {
            mass: ratios[0] / limit,
            stiffness: ratios[1] * limit,
            extra: None,
        };
        let loads = if loaded { vec![load] } else { vec![] };
        let system = altered(&model, damping, loads);
        let mut force = vec![0.0; model.dofs()];
        system.operators().external_force(LoadTime::at(0.0), &mut force);
        let work = |state: &State| -> f64 { force.iter().zip(&state.u).map(|(f, u)| f * u).sum() };
        for kind in KINDS {
            let mut integrator = build("propagator", &options(kind, tolerance));
            let mut state = start.clone();
            // To rounding of K u, whose rows hold stiff and soft springs side by side.
            let size = |state: &State| {
                let omega = 2.0 / limit;
                let of_mass = |x: &[f64]| -> f64 {
                    let terms = model.mass().iter().zip(x);
                    terms.map(|(mass, x)| 0.5 * mass * x * x).sum()
                };
                omega * omega * of_mass(&state.u) + of_mass(&state.v) + work(state).abs()
            };
            let mut largest = size(&state);
            let mut before = energy(&system, &state) - work(&state);
            for step in 0..60 {
                integrator.step(&system, &mut state, share * limit).unwrap();
                let after = energy(&system, &state) - work(&state);
                largest = largest.max(size(&state));
                let gain = (after - before) / largest;
                prop_assert!(gain <= 1e-13, "{kind} step {step}: {gain:e}");
                before = after;
            }
        }
    }
}
