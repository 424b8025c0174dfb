//! The machines on hyperelastic bodies, with the programs of all methods.

use std::num::NonZero;

use crate::common::methods::methods;
use crate::common::tissue::{body, held, linear};
use sinew_cnn::conformance::Body;
use sinew_cnn::{Machine, ReferenceMachine};
use sinew_core::{ForceLaw, Ramp, State, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::{
    Course, Element, FibreFamily, Law, LoadKind, LoadSpec, Model, Moving, Problem, Region,
};
use sinew_machines::{Chosen, PrecisionName, Settings, Threads};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{Group, GroupMembers, TetMesh};
use sinew_sparse::simd::InstructionSet;

const EDGES: Element = Element::FbarEdge {
    edge_share: 0.9,
    patch: None,
};

fn law(id: &'static str) -> Law {
    Law::hyperelastic(id, Parameters::new(3500.0, 0.45))
}

fn region(law: Law, element: Element, group: Option<&str>) -> Region {
    Region {
        group: group.map(Into::into),
        element,
        ..body(law).regions.remove(0)
    }
}

/// A cube with a lower and an upper part, fixed at the bottom and loaded by pressure on the top.
fn problem(regions: Vec<Region>) -> Problem {
    Problem::of(regions)
        .with_fixed(held("bottom", [true; 3]))
        .with_load(
            LoadSpec::new("top", LoadKind::Pressure(100.0)).with_ramp(Ramp::Sin2 { rise: 0.05 }),
        )
}

fn problems() -> Vec<(&'static str, Problem)> {
    let one = |id, element| problem(vec![region(law(id), element, None)]);
    let mut damped = one("neo-hookean", EDGES);
    damped.damping.mass = 15.0;
    damped.fixed.push(held("top", [false, true, false]));
    let mut moved = one("stable-neo-hookean", Element::Fbar { patch: Some(12) });
    moved.loads.clear();
    moved.moves.push(
        Moving::new(
            "top",
            Course::along(&[0.0, 0.1], &[[0.0; 3], [0.01, 0.0, 0.0]]),
        )
        .along([true, false, false]),
    );
    let mixed = problem(vec![
        region(law("neo-hookean"), EDGES, Some("low")),
        region(linear(3500.0, 0.45), Element::P1, Some("high")),
    ]);
    let mut pressed = one("neo-hookean", Element::P1);
    pressed.loads[0].kind = LoadKind::FollowingPressure(300.0);
    pressed.fixed.push(held("top", [false, true, false]));
    let mut fibrous = one("neo-hookean", EDGES);
    fibrous.regions[0].tissue.fibres = vec![FibreFamily::new(
        Fibres::new(Stiffening::Quadratic { eta: 2000.0 }).unwrap(),
        [0.0, 1.0, 2.0],
    )];
    let two_laws = problem(vec![
        region(law("mooney-rivlin"), Element::P1, Some("high")),
        region(law("neo-hookean-log"), EDGES, Some("low")),
    ]);
    vec![
        ("plain tetrahedra", one("neo-hookean", Element::P1)),
        ("rotations", one("corotational", Element::P1)),
        ("edges, held and damped", damped),
        ("patches below a moved support", moved),
        ("edges below a linear region", mixed),
        ("pressure that follows", pressed),
        ("fibres", fibrous),
        ("two laws", two_laws),
    ]
}

fn mesh() -> TetMesh {
    let mut mesh = cube(3, 0.1, Split::Kuhn).unwrap();
    let tets = mesh.tets.len() as u32;
    for (name, range) in [("low", 0..tets / 3), ("high", tets / 3..tets)] {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag: 7,
            members: GroupMembers::Tets(range.collect()),
        });
    }
    mesh
}

fn bodies() -> Vec<Body> {
    let mesh = mesh();
    let made = problems().into_iter().map(|(name, mut problem)| {
        for region in &mut problem.regions {
            if let Law::Hyperelastic {
                id: "mooney-rivlin",
                parameters,
            } = &mut region.law
            {
                parameters.set("c1_over_c2", &[4.0]);
            }
        }
        let model = Model::build(&mesh, &problem).unwrap();
        let mut start = State::at_rest(model.dofs());
        let places = model.cell_positions().unwrap();
        for (dof, (u, v)) in start.u.iter_mut().zip(&mut start.v).enumerate() {
            let [x, y, z] = places[dof / 3];
            if !model.pinned()[dof] {
                *u = 1e-3 * (30.0 * x + dof as f64).sin() * (10.0 * z).sin();
                *v = 0.01 * (25.0 * y).cos() * (10.0 * z).sin();
            }
        }
        Body {
            name: name.into(),
            // Deformed bodies are stiffer than at rest.
            omega: 3.0 * model.spectrum(None).unwrap().omega_max,
            refuses: !["rotations", "patches below a moved support"].contains(&name),
            system: Box::new(model),
            start,
        }
    });
    made.collect()
}

fn chosen(settings: Settings) -> Box<dyn Machine> {
    Box::new(Chosen::new(settings))
}

fn with(set: InstructionSet) -> Box<dyn Machine> {
    chosen(Settings {
        instructions: Some(set),
        ..Settings::default()
    })
}

const ROUNDING: f64 = 1e-11;

sinew_cnn::machine_conformance_on_bodies!(
    reference,
    methods(),
    bodies(),
    || Box::new(ReferenceMachine::default()),
    0.0
);
sinew_cnn::machine_conformance_on_bodies!(
    portable,
    methods(),
    bodies(),
    || with(InstructionSet::Portable),
    ROUNDING
);
sinew_cnn::machine_conformance_on_bodies!(
    best,
    methods(),
    bodies(),
    || with(InstructionSet::best()),
    ROUNDING
);
sinew_cnn::machine_conformance_on_bodies!(
    threads,
    methods(),
    bodies(),
    || chosen(Settings {
        threads: Threads::UpTo(NonZero::new(3).unwrap()),
        ..Settings::default()
    }),
    ROUNDING
);
sinew_cnn::machine_conformance_on_bodies!(
    single_precision,
    methods(),
    bodies(),
    || chosen(Settings {
        precision: PrecisionName::F32,
        ..Settings::default()
    }),
    2e-5
);

/// The loops over elements run, and are reported.
#[test]
fn bodies_are_run_by_loops_over_elements() {
    for body in bodies() {
        let mut machine = with(InstructionSet::best());
        let program = methods()
            .iter()
            .find_map(|method| (method.program)(&*body.system, 1e-4))
            .unwrap();
        machine.load(program.into(), &*body.system);
        assert_eq!(machine.name(), "elements", "{}", body.name);
        let words = machine.in_words();
        assert!(words.contains("elements in f64 by"), "{words}");
    }
}
