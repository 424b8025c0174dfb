//! Bodies whose forces are sums over hyperelastic elements.

use crate::common::bodies;

use bodies::{bump, difference, leapfrog, run};
use sinew_cnn::{Machine, ReferenceMachine};
use sinew_core::CountingAllocator;
use sinew_core::{Batch, ElementPrecision, Equations, Inputs, State, StepError, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::{
    Course, Direction, Element, FibreFamily, Fixed, Law, Model, Moving, Problem, Region,
};
use sinew_machines::{FastMachine, Layout};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{TetData, TetMesh};

const EDGES: Element = Element::FbarEdge {
    edge_share: 0.9,
    patch: None,
};

fn law(id: &'static str) -> Law {
    Law::hyperelastic(id, Parameters::new(3500.0, 0.45))
}

fn problem(law: Law, element: Element) -> Problem {
    Problem::of([Region::new(law, 1060.0).with_element(element)]).with_fixed(Fixed::at("bottom"))
}

/// Bodies of every element and some laws, with fixed components, a moving support, mass damping, and a linear region
/// above a hyperelastic one.
fn models(mesh: &TetMesh) -> Vec<(String, Model)> {
    let mut problems = Vec::new();
    for (id, element) in [
        ("neo-hookean", Element::P1),
        ("corotational", Element::P1),
        ("stable-neo-hookean", Element::Fbar { patch: None }),
        ("neo-hookean", Element::Fbar { patch: Some(300) }),
        ("stable-neo-hookean", EDGES),
    ] {
        problems.push((format!("{id}, {element}"), problem(law(id), element)));
    }
    let mut held = problem(law("neo-hookean"), EDGES);
    held.damping.mass = 20.0;
    held.fixed
        .push(Fixed::at("top").along([false, true, false]));
    problems.push(("held and damped".into(), held));
    let mut moved = problem(law("neo-hookean"), EDGES);
    moved.moves.push(
        Moving::new(
            "top",
            Course::along(&[0.0, 0.1], &[[0.0; 3], [0.01, 0.0, 0.0]]),
        )
        .along([true, false, false]),
    );
    problems.push(("moved".into(), moved));
    let mut uneven = problem(law("neo-hookean"), EDGES);
    let region = &mut uneven.regions[0];
    region.law.set_youngs_modulus(1.0);
    region.tissue.fibres = vec![FibreFamily::new(
        Fibres::new(Stiffening::Quadratic { eta: 2000.0 }).unwrap(),
        Direction::Data("along".to_owned()),
    )];
    region.from_mesh.youngs_modulus = Some("E".to_owned());
    problems.push(("with moduli and fibres by data".into(), uneven));
    let mesh = with_data(mesh);
    let models = problems.into_iter();
    models
        .map(|(name, problem)| (name, Model::build(&mesh, &problem).unwrap()))
        .collect()
}

/// The same mesh with moduli and directions that differ from one tetrahedron to the next.
fn with_data(mesh: &TetMesh) -> TetMesh {
    let mut mesh = mesh.clone();
    let waves = (0..mesh.tets.len()).map(|tet| (1.3 * tet as f64).sin());
    let of = |name: &str, components: usize, values: Vec<f64>| TetData {
        name: name.to_owned(),
        step: 0,
        components,
        values,
    };
    let moduli = waves.clone().map(|x| 3500.0 * (1.5 + x));
    let along = waves.flat_map(|x| [x, 1.0, 2.0 * x * x]);
    let data = [
        of("E", 1, moduli.collect()),
        of("along", 3, along.collect()),
    ];
    mesh.data.extend(data);
    mesh
}

fn machine<T: ElementPrecision>(model: &Model, threads: usize) -> FastMachine<T> {
    let Equations::Forces(law) = model.equations() else {
        panic!("a force law");
    };
    let layout = Layout::<T>::beside_elements(law.element_forces().unwrap());
    FastMachine::new(layout).with_threads(threads)
}

/// A bump with displacements of some per cent of the body's size.
fn start(model: &Model) -> State {
    let mut start = bump(model);
    for (value, pinned) in start.u.iter_mut().zip(model.pinned()) {
        *value *= if *pinned { 0.0 } else { 2.0 };
    }
    start
}

#[test]
fn kernels_move_bodies_as_plain_loops_do() {
    let mesh = cube(4, 0.1, Split::Kuhn).unwrap();
    for (name, model) in models(&mesh) {
        let (program, dt) = leapfrog(&model, 0.5);
        let start = start(&model);
        let mut reference = ReferenceMachine::default();
        let expected = run(&mut reference, (&model, &start), (&program, dt), 100);
        let moved = difference(&expected, &start);
        assert!(moved > 0.05, "{name}: {moved}");
        let found = run(
            &mut machine::<f64>(&model, 1),
            (&model, &start),
            (&program, dt),
            100,
        );
        let off = difference(&expected, &found);
        assert!(off < 1e-12, "{name}: {off:.1e}");
        let found = run(
            &mut machine::<f32>(&model, 1),
            (&model, &start),
            (&program, dt),
            100,
        );
        let off = difference(&expected, &found);
        println!("{name}: {off:.1e}");
        assert!(off < 1e-4 && off > 1e-8, "{name}: {off:.1e}");
    }
}

/// Bodies with enough elements for three threads.
#[test]
fn threads_change_no_bit() {
    let mesh = cube(14, 0.1, Split::Kuhn).unwrap();
    for (name, model) in models(&mesh) {
        let (program, dt) = leapfrog(&model, 0.5);
        let start = start(&model);
        let by = |threads| {
            run(
                &mut machine::<f64>(&model, threads),
                (&model, &start),
                (&program, dt),
                40,
            )
        };
        let alone = by(1);
        for threads in [2, 3, 16] {
            assert!(by(threads) == alone, "{name}: {threads} threads");
        }
        let by = |threads| {
            run(
                &mut machine::<f32>(&model, threads),
                (&model, &start),
                (&program, dt),
                40,
            )
        };
        assert!(by(1) == by(3), "{name}: f32");
    }
}

#[test]
fn steps_allocate_nothing() {
    let mesh = cube(4, 0.1, Split::Kuhn).unwrap();
    for (name, model) in models(&mesh) {
        let (program, dt) = leapfrog(&model, 0.5);
        let mut state = start(&model);
        let mut single = machine::<f32>(&model, 1);
        let mut double = machine::<f64>(&model, 1);
        let machines: [&mut dyn Machine; 2] = [&mut single, &mut double];
        for machine in machines {
            machine.load(program.clone(), &model);
            let mut batch = Batch::new(&model, Inputs::none(), dt, 20);
            let count = CountingAllocator::count(|| {
                machine.run(&mut batch, &mut state).unwrap();
            });
            assert_eq!(count, 0, "{name}");
        }
    }
}

/// The first batch may start threads; later short batches find them ready.
#[test]
fn short_batches_with_threads_allocate_nothing() {
    let mesh = cube(14, 0.1, Split::Kuhn).unwrap();
    let model = Model::build(&mesh, &problem(law("neo-hookean"), Element::P1)).unwrap();
    let (program, dt) = leapfrog(&model, 0.5);
    let mut state = start(&model);
    let mut machine = machine::<f64>(&model, 2);
    machine.load(program, &model);
    let mut steps = |steps, state: &mut State| {
        let mut batch = Batch::new(&model, Inputs::none(), dt, steps);
        CountingAllocator::count(|| machine.run(&mut batch, state).unwrap())
    };
    steps(100, &mut state);
    for _ in 0..20 {
        assert_eq!(steps(4, &mut state), 0);
    }
}

/// Steps of another length keep the data that the elements need, whatever the machine ran in between, and change no
/// bit.
#[test]
fn a_machine_loaded_for_other_steps_gives_the_bits_of_a_new_one() {
    let mesh = cube(4, 0.1, Split::Kuhn).unwrap();
    for (name, model) in models(&mesh) {
        let (program, dt) = leapfrog(&model, 0.5);
        let (shorter, short) = leapfrog(&model, 0.3);
        let start = start(&model);
        let expected = run(
            &mut machine::<f64>(&model, 2),
            (&model, &start),
            (&program, dt),
            20,
        );
        let mut machine = machine::<f64>(&model, 2);
        for _ in 0..2 {
            run(&mut machine, (&model, &start), (&shorter, short), 5);
            let found = run(&mut machine, (&model, &start), (&program, dt), 20);
            assert!(found == expected, "{name}");
        }
        // Elements of another body are another's.
        let mesh = cube(3, 0.1, Split::Kuhn).unwrap();
        let other = Model::build(&mesh, &problem(law("neo-hookean"), EDGES)).unwrap();
        let (small, step) = leapfrog(&other, 0.5);
        run(
            &mut machine,
            (&other, &self::start(&other)),
            (&small, step),
            5,
        );
        let found = run(&mut machine, (&model, &start), (&program, dt), 20);
        assert!(found == expected, "{name}: after another body");
    }
}

/// The error text, the time and the motion until then are the same for every number of threads.
#[test]
fn a_motion_that_the_law_refuses_ends_there() {
    let mesh = cube(9, 0.1, Split::Kuhn).unwrap();
    let model = Model::build(&mesh, &problem(law("neo-hookean"), EDGES)).unwrap();
    let (program, dt) = leapfrog(&model, 0.5);
    let mut start = start(&model);
    for (v, u) in start.v.iter_mut().zip(&start.u) {
        *v = -2e3 * u;
    }
    let by = |machine: &mut dyn Machine| {
        machine.load(program.clone(), &model);
        let mut state = start.clone();
        let mut batch = Batch::new(&model, Inputs::none(), dt, 1000);
        let error = machine.run(&mut batch, &mut state).unwrap_err();
        assert!(matches!(error, StepError::Refused { .. }), "{error}");
        (error.to_string(), batch.taken(), state)
    };
    let (reason, taken, state) = by(&mut ReferenceMachine::default());
    assert!(taken > 1, "{taken}");
    for threads in [1, 2, 5] {
        let (found, found_taken, found_state) = by(&mut machine::<f64>(&model, threads));
        assert_eq!((&found, found_taken), (&reason, taken), "{threads} threads");
        assert!(difference(&state, &found_state) < 1e-9, "{threads} threads");
    }
}
