//! Bodies of which parts are moved.

use std::f64::consts::PI;

use crate::common::{
    at_most, body, build, figure, held, held_along, jitter, linear, load, max_abs, solve, springs,
};
use sinew_core::{LinearSystem, LoadTime, Ramp, System};
use sinew_fem::{
    Cause, Course, FemError, Item, Law, LoadKind, Model, Moving, On, Problem, Rayleigh, SpringRule,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const SIZE: [f64; 3] = [0.03, 0.04, 0.1];
const YOUNGS_MODULUS: f64 = 3500.0;

fn bar() -> TetMesh {
    let mut mesh = structured::block([3, 4, 5], SIZE, Split::Kuhn).unwrap();
    jitter(&mut mesh, 0.002, 5);
    mesh
}

fn moving(on: impl Into<On>, axes: [bool; 3], displacement: [f64; 3], ramp: Ramp) -> Moving {
    Moving::new(on, [Course::new(displacement, ramp)]).along(axes)
}

fn all_axes(on: impl Into<On>, displacement: [f64; 3], ramp: Ramp) -> Moving {
    moving(on, [true; 3], displacement, ramp)
}

const Z: [bool; 3] = [false, false, true];

fn rise() -> Ramp {
    Ramp::Sin2 { rise: 0.2 }
}

/// The equilibrium under the loads and motions of a time (s).
fn settled(model: &Model, t: f64) -> Vec<f64> {
    let mut force = vec![0.0; model.dofs()];
    model.operators().external_force(t, &mut force);
    solve(model, &force)
}

fn sum(forces: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| forces.iter().map(|force| force[axis]).sum())
}

/// Hooke's law: a bar that is longer by d pulls with E A d/L at both ends.
#[test]
fn a_bar_pulled_at_its_end_pulls_back_by_hookes_law() {
    let (mesh, d) = (bar(), 0.004);
    let hookes = YOUNGS_MODULUS * SIZE[0] * SIZE[1] * d / SIZE[2];
    let problem = Problem {
        fixed: vec![held("bottom")],
        moves: vec![all_axes("top", [0.0, 0.0, d], rise())],
        ..body(linear(YOUNGS_MODULUS, 0.0))
    };
    let model = build(&mesh, &problem);
    let u = settled(&model, 0.3);
    let v = vec![0.0; model.dofs()];
    for (end, sign) in [("top", 1.0), ("bottom", -1.0)] {
        let [x, y, z] = model.reaction(0.3, &u, &v, &end.into()).unwrap();
        at_most(end, (z / (sign * hookes) - 1.0).abs(), 1e-10);
        at_most("sideways", x.abs().max(y.abs()) / hookes, 1e-10);
    }
    let mut at = vec![[0.0; 3]; mesh.points.len()];
    model.displacements_at(0.3, &u, &mut at).unwrap();
    for (point, u) in mesh.points.iter().zip(&at) {
        let expected = d * point[2] / SIZE[2];
        assert!((u[2] - expected).abs() < 1e-10 * d, "{point:?}: {u:?}");
    }
    let mut stress = vec![[0.0; 6]; mesh.tets.len()];
    model.stress(0.3, &u, &mut stress).unwrap();
    let expected = YOUNGS_MODULUS * d / SIZE[2];
    assert!(
        stress
            .iter()
            .all(|[.., zz, _, _, _]| (zz / expected - 1.0).abs() < 1e-10)
    );

    // Half way up, half of it, wherever the free end of the bar is.
    let u = settled(&model, 0.1);
    let [_, _, z] = model.reaction(0.1, &u, &v, &"top".into()).unwrap();
    at_most("half way", (2.0 * z / hookes - 1.0).abs(), 1e-10);
}

fn table() -> Vec<Course> {
    let times = [0.04, 0.1, 0.12, 0.3];
    let positions = [
        [0.0; 3],
        [0.0, 1e-3, 4e-3],
        [1e-3, 1e-3, 2e-3],
        [0.0, 0.0, 5e-3],
    ];
    Course::along(&times, &positions)
}

fn held_and_moved(law: Law, damping: Rayleigh) -> Problem {
    Problem {
        fixed: vec![held("bottom")],
        moves: vec![Moving::new("top", table())],
        loads: vec![
            load("sides", LoadKind::Pressure(30.0)),
            load("tissue", LoadKind::Force([0.1, 0.0, -0.2])),
        ],
        gravity: Some([0.0, 1.0, -9.81]),
        damping,
        ..body(law)
    }
}

/// Newton's first law: the fixed and the moved parts together bear all loads.
#[test]
fn reactions_of_held_and_moved_parts_balance_all_loads() {
    let mesh = bar();
    for law in [
        linear(YOUNGS_MODULUS, 0.45),
        springs(YOUNGS_MODULUS, SpringRule::VanGelder, true),
    ] {
        let damping = Rayleigh::new(2.0, 0.01);
        let model = build(&mesh, &held_and_moved(law, damping));
        let (u, v) = (settled(&model, 9.0), vec![0.0; model.dofs()]);
        let mut forces = vec![[f64::NAN; 3]; mesh.points.len()];
        model.reactions(9.0, &u, &v, &mut forces).unwrap();
        let report = model.report();
        let asked = report.loads.iter().chain(&report.gravity);
        let asked: Vec<[f64; 3]> = asked.map(|facts| facts.asked).collect();
        let (reactions, loads) = (sum(&forces), sum(&asked));
        for axis in 0..3 {
            let off = reactions[axis] + loads[axis];
            at_most("unbalanced", off.abs() / max_abs(&loads), 1e-10);
        }
        // Of a part, and of a node.
        let top = model.reaction(9.0, &u, &v, &"top".into()).unwrap();
        let bottom = model.reaction(9.0, &u, &v, &"bottom".into()).unwrap();
        for axis in 0..3 {
            assert!((top[axis] + bottom[axis] - reactions[axis]).abs() < 1e-12);
        }
        let node = mesh.group_nodes(mesh.group("top").unwrap())[3];
        let one = model.reaction_of_nodes(9.0, &u, &v, &[node]).unwrap();
        assert_eq!(one, forces[node as usize]);
    }
}

/// Newton's second law: at any time, loads and reactions change the momentum, and mass damping takes from it.
#[test]
fn reactions_in_motion_are_the_change_of_momentum() {
    let mesh = bar();
    let damping = Rayleigh::new(5.0, 2e-3);
    let law = Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule: SpringRule::Lloyd,
        calibrate: true,
        damping_ratio: 0.1,
    };
    let mut problem = held_and_moved(law, damping);
    problem.moves[0].courses = vec![Course::new([1e-3, -2e-3, 4e-3], rise())];
    let model = build(&mesh, &problem);
    let t = 0.07;
    let value = |seed: f64| move |dof: usize| 1e-3 * (dof as f64 * seed).sin();
    let [u, v] = [1.3, 2.9].map(|seed| {
        let field =
            (0..mesh.points.len()).map(|node| [0, 1, 2].map(|axis| value(seed)(3 * node + axis)));
        let mut dofs = vec![0.0; model.dofs()];
        model
            .to_dofs(&field.collect::<Vec<_>>(), &mut dofs)
            .unwrap();
        dofs
    });
    let mut a = vec![0.0; model.dofs()];
    model.operators().net_force(LoadTime::at(t), &u, &v, &mut a);
    a.iter_mut().zip(model.mass()).for_each(|(a, m)| *a /= m);
    let nodes = mesh.points.len();
    let mut velocities = vec![[0.0; 3]; nodes];
    model.velocities_at(t, &v, &mut velocities).unwrap();
    let mut accelerations = vec![[0.0; 3]; nodes];
    model.to_nodes(&a, &mut accelerations).unwrap();
    // The prescribed part, by the formula of the rise: d^2/dt^2 sin^2(pi t/(2 T)) = (pi/T)^2/2 cos(pi t/T).
    let rate = PI / 0.2;
    for node in mesh.group_nodes(mesh.group("top").unwrap()) {
        for (axis, d) in [1e-3, -2e-3, 4e-3].into_iter().enumerate() {
            accelerations[node as usize][axis] = 0.5 * d * rate * rate * (rate * t).cos();
            let v = 0.5 * d * rate * (rate * t).sin();
            assert!((velocities[node as usize][axis] - v).abs() < 1e-15);
        }
    }
    let mut reactions = vec![[0.0; 3]; nodes];
    model.reactions(t, &u, &v, &mut reactions).unwrap();
    let report = model.report();
    let asked: Vec<[f64; 3]> = report
        .loads
        .iter()
        .chain(&report.gravity)
        .map(|facts| facts.asked)
        .collect();
    let (reactions, loads) = (sum(&reactions), sum(&asked));
    for axis in 0..3 {
        let of = |fields: &[[f64; 3]]| -> f64 {
            let masses = model.node_masses().iter().zip(fields);
            masses.map(|(m, field)| m * field[axis]).sum()
        };
        let momentum = of(&accelerations) + 5.0 * of(&velocities);
        let force = reactions[axis] + loads[axis];
        at_most(
            "missing force",
            (force - momentum).abs() / momentum.abs().max(1e-2),
            1e-10,
        );
    }
}

/// A load on a moved part changes its reaction and nothing else.
#[test]
fn a_load_on_a_moved_part_changes_its_reaction_alone() {
    let mesh = bar();
    let mut problem = Problem {
        fixed: vec![held("bottom")],
        moves: vec![all_axes("top", [0.0, 0.0, 1e-3], rise())],
        ..body(linear(YOUNGS_MODULUS, 0.3))
    };
    let without = build(&mesh, &problem);
    for kind in [
        LoadKind::Traction([0.0, 0.0, 70.0]),
        LoadKind::Force([0.0, 0.0, 70.0 * SIZE[0] * SIZE[1]]),
    ] {
        problem.loads = vec![load("top", kind)];
        let with = build(&mesh, &problem);
        let (u, v) = (settled(&with, 1.0), vec![0.0; with.dofs()]);
        assert_eq!(u, settled(&without, 1.0));
        let before = without.reaction(1.0, &u, &v, &"top".into()).unwrap();
        let after = with.reaction(1.0, &u, &v, &"top".into()).unwrap();
        let expected = 70.0 * SIZE[0] * SIZE[1];
        figure(
            "carried by the load (N)",
            before[2] - after[2],
            expected,
            1e-12,
        );
        assert_eq!(with.report().moves[0].loads, [0]);
        assert_eq!(with.item_of_load(0), Some(Item::Load(0)));
        assert_eq!(with.item_of_load(1), Some(Item::Move(0)));
        assert_eq!(with.item_of_load(2), None);
    }
    assert!(without.report().moves[0].loads.is_empty());
}

#[test]
fn axes_that_are_not_moved_stay_free() {
    let mesh = bar();
    let problem = Problem {
        fixed: vec![held("bottom")],
        moves: vec![moving("top", Z, [0.0, 0.0, 4e-3], rise())],
        ..body(linear(YOUNGS_MODULUS, 0.4))
    };
    let model = build(&mesh, &problem);
    let u = settled(&model, 1.0);
    let (corner, _) = mesh.nearest_node([SIZE[0], SIZE[1], SIZE[2]]);
    let [_, _, z] = model.node_displacement(1.0, &u, corner).unwrap();
    assert_eq!(z, 4e-3);
    // Stretched along z, it gets thinner: by about nu d/L.
    for axis in [0, 1] {
        let mean = |side: f64| {
            let (nodes, points) = (0..mesh.points.len() as u32, &mesh.points);
            let on_side = nodes.filter(|node| points[*node as usize][axis] == side);
            let on_top = on_side.filter(|node| points[*node as usize][2] == SIZE[2]);
            let u: Vec<f64> = on_top
                .map(|node| model.node_displacement(1.0, &u, node).unwrap()[axis])
                .collect();
            u.iter().sum::<f64>() / u.len() as f64
        };
        let thinner = (mean(0.0) - mean(SIZE[axis])) / SIZE[axis];
        figure("lateral strain", thinner, 0.4 * 4e-3 / SIZE[2], 2e-3);
    }
    let [x, y, z] = [0, 1, 2].map(|axis| model.courses(corner, axis).len());
    assert_eq!([x, y, z], [0, 0, 1]);
}

#[test]
fn another_motion_of_the_same_parts_shares_the_mesh() {
    let mesh = bar();
    let damping = Rayleigh::new(1.0, 1e-3);
    let first = held_and_moved(linear(YOUNGS_MODULUS, 0.3), damping);
    let mut second = first.clone();
    // What was moved is held, and the other way round.
    second.fixed = vec![held("top")];
    second.moves = vec![all_axes("bottom", [1e-3, 0.0, 2e-3], rise())];
    let shared = build(&mesh, &first).with_problem(&second).unwrap();
    let anew = build(&mesh, &second);
    assert_eq!(shared.operators().loads(), anew.operators().loads());
    let mut other = first.clone();
    other.moves[0].axes = Z;
    other.moves[0].courses.truncate(0);
    let refused = build(&mesh, &first).with_problem(&other).unwrap_err();
    assert!(matches!(refused.cause(), Cause::OtherSupports { .. }));
}

fn refusal(moves: Vec<Moving>, damping: Rayleigh, law: Law) -> FemError {
    let problem = Problem {
        fixed: vec![held_along("bottom", [true, false, true])],
        moves,
        damping,
        ..body(law)
    };
    Model::build(&bar(), &problem).unwrap_err()
}

#[test]
fn motions_that_make_no_sense_are_refused() {
    let undamped = Rayleigh::default();
    let elastic = linear(YOUNGS_MODULUS, 0.3);
    let refused = |moves: Vec<Moving>| refusal(moves, undamped, elastic.clone());
    let up = |on: &str| moving(on, Z, [0.0, 0.0, 1e-3], rise());

    let held_too = refused(vec![up("top"), up("bottom")]);
    assert_eq!(held_too.item(), Item::Move(1));
    assert_eq!(held_too.cause(), &Cause::MovedAndHeld { tag: 1, axis: 2 });
    // Free along y, so that it may be moved there.
    let along_y = moving("bottom", [false, true, false], [0.0, 1e-3, 0.0], rise());
    let problem = Problem {
        fixed: vec![held_along("bottom", [true, false, true])],
        moves: vec![along_y],
        ..body(elastic.clone())
    };
    assert!(Model::build(&bar(), &problem).is_ok());

    let first_on_top = 1 + (4 * 5 * 5) as u64;
    let twice = refused(vec![up("top"), up("top")]);
    assert_eq!(twice.item(), Item::Move(1));
    let expected = Cause::MovedTwice {
        tag: first_on_top,
        axis: 2,
        first: 1,
    };
    assert_eq!(twice.cause(), &expected);

    let unknown = refused(vec![up("lid")]);
    assert!(matches!(unknown.cause(), Cause::Group(_)), "{unknown}");
    let unnamed = refused(vec![moving("top", Z, [0.0, 1e-3, 1e-3], rise())]);
    assert_eq!(
        unnamed.cause(),
        &Cause::UnnamedAxis {
            axis: 1,
            found: 1e-3
        }
    );
    let endless = refused(vec![moving("top", Z, [0.0, 0.0, f64::NAN], rise())]);
    assert!(matches!(endless.cause(), Cause::Value { .. }), "{endless}");
    let no_rise = refused(vec![moving("top", Z, [0.0; 3], Ramp::Sin2 { rise: 0.0 })]);
    assert!(matches!(no_rise.cause(), Cause::Ramp(_)), "{no_rise}");
    let all = refused(vec![
        all_axes(On::Nodes((30..120).collect()), [1e-3; 3], rise()),
        all_axes(On::Nodes((20..30).collect()), [1e-3; 3], rise()),
        moving(
            On::Nodes((0..20).collect()),
            [false, true, false],
            [0.0, 1e-3, 0.0],
            rise(),
        ),
    ]);
    assert_eq!(all.item(), Item::Move(2));
    assert!(matches!(all.cause(), Cause::NothingFree { .. }), "{all}");
}

#[test]
fn a_jump_is_refused_where_damping_would_see_its_velocity() {
    let jump = || {
        vec![moving(
            "top",
            Z,
            [0.0, 0.0, 1e-3],
            Ramp::Pulse { from: 0.1, to: 0.3 },
        )]
    };
    let refused = Cause::PositionJumps { instant: 0.1 };
    let by_stiffness = Rayleigh::new(0.0, 1e-3);
    let by_mass = Rayleigh::new(10.0, 0.0);
    let elastic = linear(YOUNGS_MODULUS, 0.3);
    let dashpots = Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule: SpringRule::Lloyd,
        calibrate: true,
        damping_ratio: 0.1,
    };
    for (damping, law) in [(by_stiffness, elastic.clone()), (by_mass, dashpots)] {
        let error = refusal(jump(), damping, law);
        assert_eq!((error.item(), error.cause()), (Item::Move(0), &refused));
    }
    let problem = Problem {
        fixed: vec![held("bottom")],
        moves: jump(),
        damping: by_mass,
        ..body(elastic.clone())
    };
    let model = build(&bar(), &problem);
    assert_eq!(model.report().moves[0].jump, Some(0.1));
    // A table that does not begin at rest jumps at once.
    let late = Course::along(&[0.1, 0.2], &[[0.0, 0.0, 1e-3], [0.0; 3]]);
    let moves = vec![Moving::new("top", late).along(Z)];
    let error = refusal(moves, by_stiffness, elastic);
    assert_eq!(error.cause(), &Cause::PositionJumps { instant: 0.0 });
}
