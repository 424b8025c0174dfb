//! Newton's method on bodies of soft tissue that are deformed by a third of their size.

use crate::common::tissue::{body, held};
use crate::common::{build, plain};
use sinew_core::{LoadTime, Ramp, State, StepError, StepReport, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Law, LoadKind, LoadSpec, Model, Problem};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const EDGE: f64 = 0.1;

fn neo_hookean() -> Problem {
    let mut problem = body(Law::hyperelastic(
        "neo-hookean",
        Parameters::new(3500.0, 0.45),
    ));
    problem.fixed = vec![held("bottom", [true; 3])];
    problem
}

fn cube() -> TetMesh {
    structured::cube(6, EDGE, Split::Mirrored).unwrap()
}

/// The cube under 12 N on its top, which compress it by more than a quarter.
fn push(mesh: &TetMesh) -> Model {
    let mut problem = neo_hookean();
    problem.damping.mass = 10.0;
    problem.loads = vec![
        LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, -1200.0]))
            .with_ramp(Ramp::Sin2 { rise: 0.2 }),
    ];
    Model::build(mesh, &problem).unwrap()
}

/// The cube let go from a stretch to one and a half of its height.
fn release(mesh: &TetMesh) -> (Model, State) {
    let model = Model::build(mesh, &neo_hookean()).unwrap();
    let mut state = State::at_rest(model.dofs());
    let nodal: Vec<[f64; 3]> = mesh
        .points
        .iter()
        .map(|[x, y, z]| {
            let shrunk = (1.5_f64.powf(-0.5) - 1.0) * z / EDGE;
            [
                shrunk * (x - EDGE / 2.0),
                shrunk * (y - EDGE / 2.0),
                0.5 * z,
            ]
        })
        .collect();
    model.to_dofs(&nodal, &mut state.u).unwrap();
    (model, state)
}

/// The accuracy of this motion is tested in the verification; this test counts iterations.
#[test]
fn a_push_by_a_quarter_takes_two_iterations_a_step() {
    let model = push(&cube());
    for id in ["newmark", "generalized-alpha", "implicit-euler"] {
        let always = plain().with_text("factor", "always");
        let (mut integrator, mut state) = (build(id, &always), State::at_rest(model.dofs()));
        let mut work = StepReport::default();
        for _ in 0..50 {
            work += integrator.step(&model, &mut state, 0.01).unwrap();
        }
        assert!(
            (95..=100).contains(&work.newton_iterations),
            "`{id}`: {work:?}"
        );
        assert_eq!(
            (work.solves, work.factorizations),
            (work.newton_iterations, work.newton_iterations)
        );
        assert_eq!(
            (work.backtracks, work.projected_solves),
            (0, 0),
            "`{id}`: {work:?}"
        );
        assert!(!integrator.remarks().join("; ").contains("grew"), "`{id}`");
    }
}

#[test]
fn a_release_takes_few_projections_and_long_newmark_steps_tell_that_their_energy_grows() {
    let mesh = cube();
    for (id, dt, iterations) in [("newmark", 0.005, 4.06), ("implicit-euler", 0.01, 2.48)] {
        let (model, mut state) = release(&mesh);
        let (mut integrator, mut work) = (build(id, &plain()), StepReport::default());
        let steps = (0.5_f64 / dt).round() as u32;
        for _ in 0..steps {
            work += integrator.step(&model, &mut state, dt).unwrap();
        }
        let a_step = work.newton_iterations as f64 / f64::from(steps);
        assert!((a_step / iterations - 1.0).abs() < 0.1, "`{id}`: {a_step}");
        assert!(work.projected_solves <= 2, "`{id}`: {work:?}");
        assert!(!integrator.remarks().join("; ").contains("grew"), "`{id}`");
    }
    let (model, mut state) = release(&mesh);
    let mut integrator = build("newmark", &plain());
    // However this ends, the energy has grown by then.
    let ended = (0..50).find_map(|_| integrator.step(&model, &mut state, 0.01).err());
    assert!(
        matches!(ended, None | Some(StepError::NotConverged { .. })),
        "{ended:?}"
    );
    let remarks = integrator.remarks().join("; ");
    assert!(
        remarks.contains("the energy grew by itself") && remarks.contains("account for 7.308e-1 J"),
        "{remarks}"
    );
}

/// A cantilever of 10:1 whose end a dead load moves by a third of its length, compared at each quarter of the load with
/// another code.
#[test]
fn a_cantilever_bends_far() {
    let mesh = structured::block([2, 2, 20], [0.1, 0.1, 1.0], Split::Mirrored).unwrap();
    let mut problem = body(Law::hyperelastic(
        "neo-hookean",
        Parameters::new(3500.0, 0.3),
    ));
    problem.fixed = vec![held("bottom", [true; 3])];
    let force = 0.5 * 1.3 * 3.0 * 3500.0 * 0.1_f64.powi(4) / 12.0;
    problem.loads = vec![LoadSpec::new(
        "top",
        LoadKind::Traction([force / 0.01, 0.0, 0.0]),
    )];
    let model = Model::build(&mesh, &problem).unwrap();
    let mut load = vec![0.0; model.dofs()];
    let system: &dyn System = &model;
    system.external_force(LoadTime::at(1.0), &[], &mut load);
    let u = static_solution(&model, &load).unwrap();
    let mut nodal = vec![[0.0; 3]; mesh.points.len()];
    model.to_nodes(&u, &mut nodal).unwrap();
    let end = mesh
        .points
        .iter()
        .position(|p| (p[0] - 0.05).abs() + (p[1] - 0.05).abs() + (p[2] - 1.0).abs() < 1e-9);
    let [z, _, x] = nodal[end.unwrap()];
    assert!((z / 0.34746 - 1.0).abs() < 2e-3, "{x} {z}");
}
