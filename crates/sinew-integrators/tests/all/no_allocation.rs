//! Tests that after set-up neither a step nor the display of its frame allocates memory.

use std::hint::black_box;

use crate::common::cube::{altered, cube, mass_damping, scene, springs};
use crate::common::nonlinear::{Chain, model as chain_of};
use crate::common::tissue::{body, held, linear};
use crate::common::{build, inner, plain};
use sinew_core::CountingAllocator;
use sinew_core::{
    Between, Fact, Inputs, Layers, LinearSystem, Load, LoadTime, OptionValue, Options, Ramp, State,
    System, worst_beyond,
};
#[cfg(feature = "implicit")]
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, LoadKind, LoadSpec, Model, Moving, NodalForces, On};
#[cfg(feature = "implicit")]
use sinew_fem::{Element, Law, Rayleigh};
use sinew_integrators::explicit::{GuardOption, Guarded};
use sinew_mesh::structured::{self, Split};

fn allocations_of_steps(system: &dyn System, id: &str, options: &Options, dt: f64) -> u64 {
    let mut integrator = build(id, options);
    let mut state = State::at_rest(system.dofs());
    crate::common::advance(&mut *integrator, system, &mut state, 2, dt);
    CountingAllocator::count(|| {
        crate::common::advance(&mut *integrator, system, &mut state, 20, dt);
    })
}

#[test]
fn the_counter_counts() {
    assert_eq!(
        CountingAllocator::count(|| drop(black_box(vec![0_u8; 100]))),
        1
    );
    assert_eq!(CountingAllocator::count(|| drop(black_box(Box::new(1)))), 1);
    assert_eq!(CountingAllocator::count(|| ()), 0);
}

#[test]
fn no_integrator_allocates_after_its_second_step() {
    let model = cube(4);
    for entry in sinew_integrators::entries() {
        let mut variants = vec![plain()];
        if entry.substeps {
            variants.push(plain().with_number("substeps", 3.0));
            variants.push(plain().with("substeps", OptionValue::Text("auto".into())));
        }
        if entry.guard != GuardOption::None {
            // So low that it is reached.
            let low = plain().with_number("saturation", 1e-6);
            let auto = plain().with("saturation", OptionValue::Text("auto".into()));
            for guarded in [low, auto] {
                if entry.substeps {
                    variants.push(guarded.clone().with_number("substeps", 3.0));
                }
                variants.push(guarded);
            }
        }
        if entry.id == "propagator" {
            for kind in ["two-step", "krylov"] {
                variants.push(plain().with("kind", OptionValue::Text(kind.into())));
            }
        }
        if entry.id == "cnn-energy" {
            variants.push(plain().with("kind", OptionValue::Text("ie".into())));
        }
        if entry.options.iter().any(|option| option.key == "inner") {
            // Stabilised at the step below, which it would leave as it is by itself.
            let full = plain().with_number("s", 1.0);
            variants.push(full.clone());
            for kind in ["jacobi", "chebyshev", "gauss-seidel"] {
                variants.push(full.clone().with("inner", inner(kind, Some(3.0))));
            }
        }
        for options in variants {
            let count = allocations_of_steps(&model, entry.id, &options, 1e-3);
            assert_eq!(count, 0, "`{}` with {options:?}", entry.id);
        }
    }
}

/// Bodies that may move as rigid bodies need sums over their cells.
#[test]
fn neither_do_networks_on_a_body_that_nothing_holds() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    let model = Model::build(&mesh, &body(linear(5000.0, 0.3))).unwrap();
    let with = |kind: &str| plain().with("inner", inner(kind, Some(3.0)));
    let inners = [
        plain(),
        with("jacobi"),
        with("chebyshev"),
        with("gauss-seidel"),
    ];
    let inners = inners.map(|options| ("cnn-stabilised", options));
    let ie = plain().with("kind", OptionValue::Text("ie".into()));
    let energies = [("cnn-energy", plain()), ("cnn-energy", ie)];
    for (id, options) in inners.into_iter().chain(energies) {
        let count = allocations_of_steps(&model, id, &options, 0.05);
        assert_eq!(count, 0, "`{id}` with {options:?}");
    }
}

#[test]
fn neither_does_a_guard_that_cuts_and_clamps() {
    // Forward Euler without damping grows at any step until it is clamped.
    let (model, dt) = (scene(2, 0.2, springs(0.0), mass_damping(0.0)), 0.02);
    let model = &model;
    let auto = plain().with("saturation", OptionValue::Text("auto".into()));
    let mut integrator = build("forward-euler", &auto);
    let mut state = State::at_rest(model.dofs());
    crate::common::advance(&mut *integrator, model, &mut state, 400, dt);
    let cut = |fact: &Fact| fact.name == Guarded::SUBSTEPS && fact.value > 1.0;
    assert!(integrator.facts().iter().any(cut));
    let mut saturated = 0;
    let count = CountingAllocator::count(|| {
        for _ in 0..20 {
            let work = integrator.step(model, &mut state, dt);
            saturated += work.map_or(0, |work| work.saturated);
        }
    });
    assert_eq!(count, 0);
    assert!(saturated > 0);
}

/// A load that changes needs additional sweeps, and damping of another kind additional products.
#[test]
fn neither_do_loads_that_change_nor_other_damping() {
    let model = cube(4);
    let loads = model.operators().loads().iter().map(|load| Load {
        ramp: Ramp::Sin2 { rise: 0.1 },
        ..load.clone()
    });
    let damping = sinew_core::Damping {
        mass: 3.0,
        stiffness: 1e-3,
        extra: None,
    };
    let system = altered(&model, damping, loads.collect());
    for id in sinew_integrators::ids() {
        let count = allocations_of_steps(&system, id, &plain(), 1e-3);
        assert_eq!(count, 0, "`{id}`");
    }
}

/// Newton's method factorises in each iteration, by the workspace of set-up.
#[cfg(feature = "implicit")]
#[test]
fn neither_does_newtons_method_with_a_factor() {
    let links = Chain {
        stiffness: 10.0,
        cubic: 4000.0,
        longest: f64::INFINITY,
    };
    let model = chain_of(links, &[0.1; 40], Layers::One, vec![1.0; 40]);
    let always = plain().with_text("factor", "always");
    for id in ["newmark", "generalized-alpha", "implicit-euler"] {
        let count = allocations_of_steps(&model, id, &always, 0.01);
        assert_eq!(count, 0, "`{id}`");
    }
}

#[cfg(feature = "implicit")]
#[test]
fn neither_does_newtons_method_without_a_factor() {
    let mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap();
    for element in [
        Element::P1,
        Element::FbarEdge {
            edge_share: 0.9,
            patch: None,
        },
    ] {
        let law = Law::hyperelastic("neo-hookean", Parameters::new(3500.0, 0.45));
        let mut problem = body(law);
        problem.regions[0].element = element;
        problem.fixed = vec![held("bottom", [true; 3])];
        problem.damping = Rayleigh::new(1.0, 1e-3);
        problem.loads = vec![LoadSpec::new("top", LoadKind::FollowingPressure(300.0))];
        let model = Model::build(&mesh, &problem).unwrap();
        for id in ["newmark", "generalized-alpha", "implicit-euler"] {
            for factor in ["auto", "never"] {
                let options = plain().with_text("factor", factor);
                let count = allocations_of_steps(&model, id, &options, 0.01);
                assert_eq!(count, 0, "`{id}`, {factor}, {element}");
            }
        }
    }
}

#[cfg(feature = "implicit")]
#[test]
fn neither_do_patches() {
    use crate::common::sliver::{MASS_DAMPING, auto, model, with_sliver};
    let system = model(&with_sliver(1000.0), MASS_DAMPING);
    let count = allocations_of_steps(&system, "central-difference", &auto(), 0.004);
    assert_eq!(count, 0);
}

/// Displacements, strain, stress and reactions, once the rows of fixed nodes are summed up.
#[test]
fn neither_do_the_fields_of_a_frame() {
    let mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap();
    let mut problem = body(linear(3500.0, 0.3));
    problem.fixed = vec![held("bottom", [true; 3]), held("top", [true, false, false])];
    problem.gravity = Some([0.0, 0.0, -9.81]);
    let model = Model::build(&mesh, &problem).unwrap();
    let (mut u, v) = (vec![1e-3; model.dofs()], vec![0.0; model.dofs()]);
    let mut nodal = vec![[0.0; 3]; mesh.points.len()];
    let mut tensors = vec![[0.0; 6]; mesh.tets.len()];
    let mut frame = || {
        model.positions(0.0, &u, &mut nodal).unwrap();
        model.to_nodes(&u, &mut nodal).unwrap();
        model.to_dofs(&nodal, &mut u).unwrap();
        model.strain(0.0, &u, &mut tensors).unwrap();
        model.stress(0.0, &u, &mut tensors).unwrap();
        model.reactions(0.1, &u, &v, &mut nodal).unwrap();
        model.reaction_of_nodes(0.1, &u, &v, &[0]).unwrap();
    };
    assert!(
        CountingAllocator::count(&mut frame) > 0,
        "the rows of held nodes"
    );
    assert_eq!(CountingAllocator::count(&mut frame), 0);
}

/// In a sweep over a modulus the models share their pattern, and with it its analysis: only another pattern needs a new
/// analysis.
#[cfg(feature = "implicit")]
#[test]
fn a_factor_for_another_modulus_allocates_as_little_as_one_for_another_step() {
    let mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
    let tissue = |youngs_modulus: f64| {
        let mut problem = body(linear(youngs_modulus, 0.3));
        problem.fixed = vec![held("bottom", [true; 3])];
        problem
    };
    let first = Model::build(&mesh, &tissue(3500.0)).unwrap();
    let swept = first.with_problem(&tissue(7000.0)).unwrap();
    let built_apart = Model::build(&mesh, &tissue(7000.0)).unwrap();
    for id in ["implicit-euler", "newmark", "generalized-alpha"] {
        let set_up = |second: &Model, dt: f64| {
            let mut integrator = build(id, &plain());
            integrator.prepare(&first, 1e-3).unwrap();
            let mut factorizations = 0;
            let count = CountingAllocator::count(|| {
                factorizations = integrator.prepare(second, dt).unwrap().factorizations;
            });
            assert_eq!(factorizations, 1, "`{id}`");
            count
        };
        let without_analysis = set_up(&first, 2e-3);
        assert_eq!(set_up(&swept, 1e-3), without_analysis, "`{id}`");
        assert!(set_up(&built_apart, 1e-3) > without_analysis, "`{id}`");
    }
}

/// A hand pulls at some nodes, a clamp moves and a cuff presses, all known only at the time they happen; the body is
/// drawn, coloured and weighed.
#[test]
fn a_frame_of_a_simulator_allocates_nothing() {
    const FRAME: f64 = 0.016;
    let mesh = structured::cube(3, 0.1, Split::Kuhn).unwrap();
    let mut inputs = Inputs::new();
    let clamp = inputs.add_channel(Between::Line);
    let cuff = inputs.add_channel(Between::Hold);
    let mut problem = body(linear(3500.0, 0.3));
    problem.fixed = vec![held("bottom", [true; 3])];
    problem.damping.stiffness = 1e-4;
    problem.moves = vec![
        Moving::new("top", [Course::new([0.0, 0.0, -0.01], Ramp::Input(clamp))])
            .along([false, false, true]),
    ];
    problem.loads =
        vec![LoadSpec::new("sides", LoadKind::Pressure(50.0)).with_ramp(Ramp::Input(cuff))];
    let model = Model::build(&mesh, &problem).unwrap();
    let options = Options::new().with_text("substeps", "auto");
    let mut method = build("central-difference", &options);
    let mut state = State::at_rest(model.dofs());

    let (mut given, mut hand) = (Vec::new(), NodalForces::default());
    let mut positions = vec![[0.0; 3]; mesh.points.len()];
    let mut stress = vec![[0.0; 6]; mesh.tets.len()];
    let mut velocity = vec![0.0; model.dofs()];
    let floor = On::from("bottom").nodes(&mesh).unwrap();
    let mut frame = |number: usize| {
        let (start, end) = (state.t(), (number + 1) as f64 * FRAME);
        given.clear();
        // Now more of them, now fewer.
        for node in 30..33 + number as u32 % 5 {
            given.push((node, [0.01, 0.0, -0.02 * f64::from(node % 3)]));
        }
        model.forces_into(&given, &mut hand).unwrap();
        inputs.set_forces(start, &hand.entries).unwrap();
        inputs.set(clamp, end, (3.0 * end).sin()).unwrap();
        inputs.set(cuff, end, (5.0 * end).cos()).unwrap();
        inputs.forget_before(start - 2.0 * FRAME);
        method
            .step_under(&model, &inputs, &mut state, FRAME)
            .unwrap();
        assert_eq!(worst_beyond(&state.u, 0.1), None);
        let now = LoadTime::at(state.t()).under(&inputs);
        model.positions(now, &state.u, &mut positions).unwrap();
        model.stress(now, &state.u, &mut stress).unwrap();
        state.velocity_at_t(&model, &inputs, &mut velocity).unwrap();
        let floor = model.reaction_of_nodes(now, &state.u, &velocity, &floor);
        assert!(floor.unwrap()[2] != 0.0);
        model.node_displacement(now, &state.u, 40).unwrap();
    };
    let warming = CountingAllocator::count(|| (0..60).for_each(&mut frame));
    assert!(warming > 0, "set-up, and room for what is given");
    assert_eq!(
        CountingAllocator::count(|| (60..300).for_each(&mut frame)),
        0
    );
}
