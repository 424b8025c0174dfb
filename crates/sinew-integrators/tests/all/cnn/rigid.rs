//! Newton's laws for whole bodies beyond the stable step: with cellular networks bodies fall, fly and turn as rigid
//! bodies do.

use crate::common::energy_method::energy_method;
use crate::common::tissue::{body, held, linear};
use crate::common::{advance, build, inner, largest, plain};
use nalgebra::{DMatrix, DVector};
use sinew_cnn::{Blend, GammaRule, Inner, Stabiliser};
use sinew_core::spectrum::critical_step;
use sinew_core::{Integrator, LinearSystem, State, System};
use sinew_fem::hyperelastic::{Hyperelastic, Parameters};
use sinew_fem::{Fixed, Law, Model, Problem};
use sinew_mesh::structured::{Split, block};
use sinew_mesh::{Group, GroupMembers, TetMesh};
use sinew_testkit::dense::{dense, dense_damping};

/// Steps, as multiples of the stable one.
const STEPS: [f64; 4] = [1.1, 2.3, 4.5, 9.0];

const GRAVITY: [f64; 3] = [0.4, -1.3, -9.81];

fn problem(fixed: Vec<Fixed>) -> Problem {
    Problem {
        fixed,
        ..body(linear(5000.0, 0.3))
    }
}

fn brick() -> TetMesh {
    block([3, 2, 2], [0.09, 0.05, 0.06], Split::Kuhn).unwrap()
}

/// All ways of solving with the stabilising matrix.
fn networks() -> [(&'static str, Box<dyn Integrator>); 5] {
    let with = |kind: &'static str, sweeps: Option<f64>| {
        let options = plain().with("inner", inner(kind, sweeps));
        (kind, build("cnn-stabilised", &options))
    };
    [
        with("block", None),
        with("jacobi", Some(1.0)),
        with("jacobi", Some(3.0)),
        with("chebyshev", Some(4.0)),
        with("gauss-seidel", Some(2.0)),
    ]
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, of: &str) {
    let size = largest(expected);
    let off: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
    let off = largest(&off);
    assert!(off <= tolerance * size, "{of}: {off:e} of {size:e}");
}

/// The velocity of every cell of a body that rotates about a moving point.
fn rigid(model: &Model, velocity: [f64; 3], [a, b, c]: [f64; 3], about: [f64; 3]) -> Vec<f64> {
    let places = model.cell_positions().unwrap();
    let of = |place: [f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - about[axis]);
        let [p, q, r] = velocity;
        [p + b * z - c * y, q + c * x - a * z, r + a * y - b * x]
    };
    places.into_iter().flat_map(of).collect()
}

#[test]
fn a_body_that_nothing_holds_falls_as_a_point_at_any_step() {
    let mut falling = problem(Vec::new());
    falling.gravity = Some(GRAVITY);
    let model = Model::build(&brick(), &falling).unwrap();
    let limit = critical_step(model.operators());
    for share in STEPS {
        for (kind, mut integrator) in networks() {
            let (dt, steps) = (share * limit, 40);
            let mut state = State::at_rest(model.dofs());
            advance(&mut *integrator, &model, &mut state, steps, dt);
            let t = dt * steps as f64;
            let fallen = GRAVITY.map(|g| 0.5 * g * t * t);
            let expected: Vec<f64> = fallen.into_iter().cycle().take(model.dofs()).collect();
            assert_near(&state.u, &expected, 1e-10, &format!("{kind}, {share}"));
        }
    }
}

#[test]
fn a_body_without_forces_moves_and_turns_on_at_any_step() {
    let model = Model::build(&brick(), &problem(Vec::new())).unwrap();
    let limit = critical_step(model.operators());
    let v = rigid(
        &model,
        [0.1, -0.2, 0.3],
        [2.0, 1.0, -3.0],
        [0.02, 0.0, 0.01],
    );
    for share in STEPS {
        for (kind, mut integrator) in networks() {
            let (dt, steps) = (share * limit, 40);
            let mut state = State::new(vec![0.0; model.dofs()], v.clone());
            advance(&mut *integrator, &model, &mut state, steps, dt);
            // A linear law turns along tangents.
            let expected: Vec<f64> = v.iter().map(|v| v * dt * steps as f64).collect();
            assert_near(&state.u, &expected, 1e-10, &format!("{kind}, {share}"));
            assert_near(&state.v, &v, 1e-10, kind);
        }
    }
}

/// A supported block and, beside it, a loose one.
#[test]
fn a_part_that_a_cut_left_loose_falls_as_a_point() {
    let mut mesh = brick();
    let other = brick();
    let (nodes, first_tag) = (
        mesh.points.len() as u32,
        mesh.node_tags.iter().max().unwrap() + 1,
    );
    for (tag, [x, y, z]) in (first_tag..).zip(&other.points) {
        mesh.points.push([x + 1.0, *y, *z]);
        mesh.node_tags.push(tag);
    }
    for tet in &other.tets {
        mesh.tets.push(tet.map(|node| node + nodes));
        mesh.tet_tags.push(mesh.tet_tags.iter().max().unwrap() + 1);
    }
    let mut falling = problem(vec![held("bottom", [true; 3])]);
    falling.gravity = Some(GRAVITY);
    let model = Model::build(&mesh, &falling).unwrap();
    let (dt, steps) = (4.5 * critical_step(model.operators()), 40);
    let parts = model.free_parts();
    assert_eq!(parts.len(), 1);
    assert_eq!(parts[0].twists.len(), 6);
    for (kind, mut integrator) in networks() {
        let mut state = State::at_rest(model.dofs());
        advance(&mut *integrator, &model, &mut state, steps, dt);
        let t = dt * steps as f64;
        for cell in &parts[0].cells {
            let found = &state.u[3 * *cell as usize..][..3];
            let fallen = GRAVITY.map(|g| 0.5 * g * t * t);
            assert_near(found, &fallen, 1e-10, kind);
        }
    }
}

/// A mesh with a group of the nodes at these places.
fn with_nodes(mut mesh: TetMesh, name: &str, is_in: impl Fn([f64; 3]) -> bool) -> TetMesh {
    let nodes = (0..).zip(&mesh.points);
    let nodes: Vec<u32> = nodes
        .filter(|(_, place)| is_in(**place))
        .map(|(node, _)| node)
        .collect();
    assert!(!nodes.is_empty());
    mesh.groups.push(Group {
        name: name.to_owned(),
        dim: 0,
        tag: 1,
        members: GroupMembers::Nodes(nodes),
    });
    mesh
}

/// A body on a hinge, and one on a table that fixes heights only.
#[test]
fn supports_leave_a_body_its_free_motions() {
    let mesh = brick();
    let hinged = with_nodes(mesh.clone(), "edge", |[x, _, z]| x == 0.0 && z == 0.0);
    let hinge = Model::build(&hinged, &problem(vec![held("edge", [true; 3])])).unwrap();
    let table = Model::build(&mesh, &problem(vec![held("bottom", [false, false, true])])).unwrap();
    let cases = [
        (
            &hinge,
            1,
            rigid(&hinge, [0.0; 3], [0.0, 4.0, 0.0], [0.0; 3]),
        ),
        (
            &table,
            3,
            rigid(&table, [0.2, 0.1, 0.0], [0.0, 0.0, 5.0], [0.03, 0.0, 0.0]),
        ),
    ];
    for (model, free, v) in cases {
        let parts = model.free_parts();
        assert_eq!(parts[0].twists.len(), free);
        let (dt, steps) = (4.5 * critical_step(model.operators()), 40);
        for (kind, mut integrator) in networks() {
            let mut state = State::new(vec![0.0; model.dofs()], v.clone());
            advance(&mut *integrator, model, &mut state, steps, dt);
            let expected: Vec<f64> = v.iter().map(|v| v * dt * steps as f64).collect();
            assert_near(&state.u, &expected, 1e-9, kind);
        }
    }
    let clamped = Model::build(&mesh, &problem(vec![held("bottom", [true; 3])])).unwrap();
    assert!(clamped.free_parts().is_empty());
}

fn matrix(rows: Vec<Vec<f64>>) -> DMatrix<f64> {
    let n = rows.len();
    DMatrix::from_row_iterator(n, n, rows.into_iter().flatten())
}

/// P itself, by its inverse.
fn stabilising(stabiliser: &Stabiliser, n: usize) -> DMatrix<f64> {
    let mut inverse = DMatrix::zeros(n, n);
    let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
    for j in 0..n {
        unit.fill(0.0);
        unit[j] = 1.0;
        stabiliser.solve(&unit, &mut column);
        inverse.set_column(j, &DVector::from_row_slice(&column));
    }
    let p = inverse.try_inverse().unwrap();
    (&p + p.transpose()) * 0.5
}

const INNERS: [Inner; 5] = [
    Inner::Block,
    Inner::Jacobi { sweeps: 3 },
    Inner::Chebyshev { sweeps: 1 },
    Inner::Chebyshev { sweeps: 4 },
    Inner::GaussSeidel { sweeps: 2 },
];

/// The proof of stability, and Newton's first law: P is larger than its bound, and equals M' on rigid motions.
#[test]
fn the_stabilising_matrix_bounds_what_it_must_and_is_the_mass_on_rigid_motions() {
    let mut damped = problem(Vec::new());
    (damped.damping.mass, damped.damping.stiffness) = (3.0, 2e-3);
    let mesh = block([2, 1, 1], [0.06, 0.03, 0.03], Split::Kuhn).unwrap();
    let model = Model::build(&mesh, &damped).unwrap();
    let operators = model.operators();
    let n = operators.dofs();
    let motion = rigid(
        &model,
        [0.1, -0.2, 0.3],
        [2.0, 1.0, -3.0],
        [0.02, 0.0, 0.01],
    );
    let motion = DVector::from_vec(motion);
    let (stiffness, damping) = (
        matrix(dense(operators.stiffness())),
        matrix(dense_damping(operators)),
    );
    let mass = DMatrix::from_diagonal(&DVector::from_row_slice(operators.mass()));
    let root = mass.map(|mass| if mass > 0.0 { 1.0 / mass.sqrt() } else { 0.0 });
    for share in [1.5, 9.0, 100.0] {
        let dt = share * critical_step(operators);
        for kind in INNERS {
            let plain = Stabiliser::new(operators, dt, GammaRule::Power, Blend::Auto, kind);
            let braked = stabilising(&plain, n);
            let stabiliser = plain.sparing(model.free_parts());
            assert!(stabiliser.spares());
            let p = stabilising(&stabiliser, n);
            let inertia = &mass * (1.0 + 3.0 * dt / 2.0);
            let off = (&p * &motion - &inertia * &motion).amax() / (&inertia * &motion).amax();
            assert!(off < 1e-8, "{kind:?}, {share}: {off:e}");
            let needed = &damping * (dt / 2.0) + &stiffness * (dt * dt / 4.0);
            let room = &root * (&p - needed) * &root;
            let least = room.symmetric_eigenvalues().min();
            assert!(least > 0.0, "{kind:?}, {share}: {least:e}");
            let certificate = stabiliser.certificate();
            assert!(certificate < 1.0, "{kind:?}, {share}: {certificate}");
            if kind.is_single() {
                // Nothing is added beyond the blocks.
                let less = &root * (braked - &p) * &root;
                let scale = (&root * &p * &root).amax();
                assert!(less.symmetric_eigenvalues().min() > -1e-9 * scale);
            }
        }
    }
}

#[test]
fn the_slowest_motion_is_slowed_by_the_factor_that_is_told() {
    let mesh = block([6, 1, 1], [0.12, 0.02, 0.02], Split::Mirrored).unwrap();
    let mesh = with_nodes(mesh, "left", |[x, _, _]| x == 0.0);
    let clamped = problem(vec![held("left", [true; 3])]);
    for fixed in [clamped, problem(Vec::new())] {
        let rigid_motions = if fixed.fixed.is_empty() { 6 } else { 0 };
        let model = Model::build(&mesh, &fixed).unwrap();
        let operators = model.operators();
        let n = operators.dofs();
        let stiffness = matrix(dense(operators.stiffness()));
        let lowest = |inertia: &DMatrix<f64>| {
            let factor = inertia.clone().cholesky().unwrap().inverse();
            let lower = factor.cholesky().unwrap().l();
            let eigenvalues = (lower.transpose() * &stiffness * lower).symmetric_eigenvalues();
            let mut values: Vec<f64> = eigenvalues.iter().copied().collect();
            values.sort_by(f64::total_cmp);
            values[rigid_motions].sqrt()
        };
        let mass = DMatrix::from_diagonal(&DVector::from_row_slice(operators.mass()));
        let omega = lowest(&mass);
        for (share, kind) in [(1.5, INNERS[0]), (3.2, INNERS[0]), (9.0, INNERS[3])] {
            let dt = share * critical_step(operators);
            let plain = Stabiliser::new(operators, dt, GammaRule::Power, Blend::Auto, kind);
            let stabiliser = plain.sparing(model.free_parts());
            let told = stabiliser.slowing().unwrap();
            let found = 2.0 / dt * (0.5 * dt * lowest(&stabilising(&stabiliser, n))).asin();
            let factor = omega / found;
            assert!((told.period * omega / std::f64::consts::TAU - 1.0).abs() < 0.05);
            assert!(factor > 1.01, "{share}: {factor}");
            assert!(
                (told.factor / factor - 1.0).abs() < 0.05,
                "{share}: {told:?} {factor}"
            );
        }
    }
}

fn tissue(mesh: &TetMesh, gravity: Option<[f64; 3]>, law: usize) -> Model {
    let law = Law::hyperelastic(Hyperelastic::IDS[law], Parameters::new(5000.0, 0.3));
    let falling = Problem {
        gravity,
        ..body(law)
    };
    Model::build(mesh, &falling).unwrap()
}

/// The stable step of the same block with a linear law.
fn limit() -> f64 {
    critical_step(
        Model::build(&brick(), &problem(Vec::new()))
            .unwrap()
            .operators(),
    )
}

#[test]
fn soft_bodies_fall_as_points_by_energy_sweeps_at_any_step() {
    for share in STEPS {
        let (dt, steps) = (share * limit(), 30);
        let linear = {
            let mut falling = problem(Vec::new());
            falling.gravity = Some(GRAVITY);
            Model::build(&brick(), &falling).unwrap()
        };
        for model in [
            linear,
            tissue(&brick(), Some(GRAVITY), 0),
            tissue(&brick(), Some(GRAVITY), 1),
        ] {
            for (kind, sweeps) in [("trap", 4), ("trap", 1), ("ie", 4), ("ie", 1)] {
                let mut state = State::at_rest(model.dofs());
                advance(
                    &mut *energy_method(kind, sweeps),
                    &model,
                    &mut state,
                    steps,
                    dt,
                );
                let n = steps as f64;
                // Implicit Euler's steps sum to n (n + 1)/2.
                let times = if kind == "trap" { n * n } else { n * (n + 1.0) };
                let fallen = GRAVITY.map(|g| 0.5 * g * dt * dt * times);
                let expected: Vec<f64> = fallen.into_iter().cycle().take(model.dofs()).collect();
                assert_near(
                    &state.u,
                    &expected,
                    1e-8,
                    &format!("{kind} {sweeps}, {share}"),
                );
            }
        }
    }
}

/// Angular momentum about the origin (kg m^2/s).
fn spin(model: &Model, state: &State) -> [f64; 3] {
    let places = model.cell_positions().unwrap();
    let mut sum = [0.0; 3];
    for (cell, rest) in places.iter().enumerate() {
        let of = |values: &[f64]| [0, 1, 2].map(|axis| values[3 * cell + axis]);
        let (u, v, mass) = (of(&state.u), of(&state.v), model.mass()[3 * cell]);
        let [x, y, z] = [0, 1, 2].map(|axis| rest[axis] + u[axis]);
        let own = [
            y * v[2] - z * v[1],
            z * v[0] - x * v[2],
            x * v[1] - y * v[0],
        ];
        (0..3).for_each(|axis| sum[axis] += mass * own[axis]);
    }
    sum
}

#[test]
fn a_plate_that_spins_goes_on_spinning_by_energy_sweeps_at_any_step() {
    // The same on both sides of its middle, so that it spins about a principal axis.
    let plate = block([4, 2, 2], [0.09, 0.05, 0.06], Split::Mirrored).unwrap();
    let middle = [0.045, 0.025, 0.03];
    for law in [0, 1] {
        let model = tissue(&plate, None, law);
        let v = rigid(&model, [0.0; 3], [0.0, 0.0, 2.0], middle);
        for share in STEPS {
            let dt = share * limit();
            let mut state = State::new(vec![0.0; model.dofs()], v.clone());
            let before = spin(&model, &state);
            let steps = (1.0 / dt).round() as usize;
            let mut integrator = energy_method("trap", 4);
            advance(&mut *integrator, &model, &mut state, steps, dt);
            let after = spin(&model, &state);
            for (after, expected) in after.into_iter().zip(before) {
                let off = (after - expected).abs() / before[2];
                assert!(off < 0.03, "{law}, {share}: {after} {expected}");
            }
            // Two radians: a corner is where that of a rigid plate would be.
            let (sine, cosine) = (2.0 * dt * steps as f64).sin_cos();
            let [x, y] = [-middle[0], -middle[1]];
            let turned = [x * cosine - y * sine, x * sine + y * cosine];
            let off = (x + state.u[0] - turned[0]).hypot(y + state.u[1] - turned[1]);
            assert!(off < 0.05 * x.hypot(y), "{law}, {share}: {off}");
        }
    }
}
