//! Forces at supports.

use crate::common::{
    DENSITY, add_node_group, at_most, body, build, equilibrium, figure, held, held_along, jitter,
    linear, load, max_abs, springs,
};
use sinew_core::{LinearSystem, LoadTime, Ramp, System};
use sinew_fem::{
    Cause, FieldError, Law, LoadKind, LoadSpec, On, Problem, Rayleigh, SpringRule,
    SupportMotionError,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const SIZE: [f64; 3] = [0.03, 0.04, 0.1];
const YOUNGS_MODULUS: f64 = 3500.0;

fn bar() -> TetMesh {
    let mut mesh = structured::block([3, 4, 5], SIZE, Split::Kuhn).unwrap();
    jitter(&mut mesh, 0.002, 11);
    for (axis, name) in ["x = 0", "y = 0"].into_iter().enumerate() {
        add_node_group(&mut mesh, name, |point| point[axis] == 0.0);
    }
    mesh
}

fn damped_springs() -> Law {
    Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule: SpringRule::Lloyd,
        calibrate: true,
        damping_ratio: 0.3,
    }
}

/// Three arbitrary numbers for each node.
fn field(nodes: usize, seed: f64) -> Vec<[f64; 3]> {
    let value = |node: usize, axis: usize| ((3 * node + axis) as f64 * seed).sin();
    (0..nodes)
        .map(|node| std::array::from_fn(|axis| value(node, axis)))
        .collect()
}

fn sum(forces: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|axis| forces.iter().map(|force| force[axis]).sum())
}

/// A problem with various supports, with loads on fixed and on free parts.
fn held_and_loaded(law: Law) -> Problem {
    Problem {
        fixed: vec![
            held("bottom"),
            held_along("x = 0", [true, false, false]),
            held_along("y = 0", [false, true, false]),
        ],
        loads: vec![
            load("top", LoadKind::Traction([3.0, -2.0, 70.0])),
            load("sides", LoadKind::Pressure(40.0)),
            load("tissue", LoadKind::Force([0.1, 0.2, -0.3])),
        ],
        gravity: Some([0.5, -1.0, -9.81]),
        ..body(law)
    }
}

/// Newton's first law: the sum of all reactions is the opposite of all loads.
#[test]
fn at_rest_reactions_balance_all_loads() {
    let mesh = bar();
    let laws = [
        linear(YOUNGS_MODULUS, 0.0),
        linear(YOUNGS_MODULUS, 0.45),
        springs(YOUNGS_MODULUS, SpringRule::VanGelder, false),
        damped_springs(),
    ];
    for law in laws {
        let model = build(&mesh, &held_and_loaded(law.clone()));
        let u = equilibrium(&model);
        let v = vec![0.0; u.len()];
        let mut reactions = vec![[f64::NAN; 3]; mesh.points.len()];
        model.reactions(0.0, &u, &v, &mut reactions).unwrap();
        let report = model.report();
        let asked = report.loads.iter().chain(&report.gravity);
        let asked: Vec<[f64; 3]> = asked.map(|facts| facts.asked).collect();
        let weight = DENSITY * SIZE.iter().product::<f64>() * 9.81;
        let (total, loads) = (sum(&reactions), sum(&asked));
        for axis in 0..3 {
            let off = (total[axis] + loads[axis]).abs();
            at_most(&format!("{law}: reactions and loads"), off / weight, 1e-10);
        }
        for (node, reaction) in (0..).zip(&reactions) {
            assert_eq!(model.reaction_of_nodes(0.0, &u, &v, &[node]), Ok(*reaction));
        }
        let everywhere = model.reaction(0.0, &u, &v, &"tissue".into()).unwrap();
        for (axis, reached) in everywhere.into_iter().enumerate() {
            figure("reaction of all nodes", reached, total[axis], 1e-12);
        }
    }
}

/// A bar of nu = 0 has no transverse force at its clamp: each node there carries its share.
#[test]
fn a_pulled_bar_is_held_by_the_opposite_force() {
    let mesh = bar();
    let mut problem = body(linear(YOUNGS_MODULUS, 0.0));
    problem.fixed = vec![held("bottom")];
    problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, 70.0]))];
    let model = build(&mesh, &problem);
    let (u, force) = (equilibrium(&model), 70.0 * SIZE[0] * SIZE[1]);
    let v = vec![0.0; u.len()];
    let [x, y, z] = model.reaction(0.0, &u, &v, &"bottom".into()).unwrap();
    figure("reaction / F", z / force, -1.0, 1e-11);
    figure("across / F", x.abs().max(y.abs()) / force, 0.0, 1e-11);
    // A third of each triangle's share, as for the traction of the other end.
    let (corner, _) = mesh.nearest_node([0.0, 0.0, 0.0]);
    let shares = build(
        &mesh,
        &Problem {
            loads: vec![load("bottom", LoadKind::Traction([0.0, 0.0, -70.0]))],
            ..body(linear(YOUNGS_MODULUS, 0.0))
        },
    );
    let mut expected = vec![0.0; shares.dofs()];
    shares
        .operators()
        .external_force(LoadTime::at(0.0), &mut expected);
    let expected = expected[3 * corner as usize + 2];
    let reached = model.reaction_of_nodes(0.0, &u, &v, &[corner]).unwrap()[2];
    figure(
        "reaction at a corner / F",
        reached / force,
        expected / force,
        1e-11,
    );
    let free = model.reaction(0.0, &u, &v, &"top".into());
    assert_eq!(free, Ok([0.0; 3]));
}

/// The supports carry M a + D v + K u - F at fixed components, from the rows of the same body without supports, for any
/// motion.
#[test]
fn moving_supports_feel_the_rows_of_the_free_body() {
    let mesh = bar();
    for law in [linear(YOUNGS_MODULUS, 0.45), damped_springs()] {
        let rise = Ramp::Table {
            times: vec![0.0, 1.0],
            values: vec![0.0, 1.0],
        };
        let mut problem = held_and_loaded(law.clone());
        problem.loads.truncate(2);
        problem.loads[0].ramp = rise;
        problem.loads.push(LoadSpec {
            on: "sides".into(),
            ..problem.loads[0].clone()
        });
        problem.damping = Rayleigh::new(3.0, 0.02);
        let model = build(&mesh, &problem);
        problem.fixed.clear();
        let free = build(&mesh, &problem);

        let nodes = mesh.points.len();
        let (u, v, a) = (field(nodes, 1.3), field(nodes, 2.9), field(nodes, 0.7));
        let mut expected = vec![0.0; 3 * nodes];
        let (flat_u, flat_v) = (u.as_flattened(), v.as_flattened());
        let operators = free.operators();
        operators.net_force(LoadTime::at(0.25), flat_u, flat_v, &mut expected);
        for ((force, mass), a) in expected.iter_mut().zip(free.mass()).zip(a.as_flattened()) {
            *force = mass * a - *force;
        }
        let size = max_abs(&expected);
        let mut reached = vec![[f64::NAN; 3]; nodes];
        let motion = [&*u, &*v, &*a];
        model.moving_reactions(0.25, motion, &mut reached).unwrap();
        let mut worst = 0.0_f64;
        for (node, force) in (0..).zip(&reached) {
            for axis in 0..3 {
                let held = model
                    .cell_of_node(node)
                    .is_none_or(|cell| model.pinned()[3 * cell as usize + axis]);
                let row = expected[3 * node as usize + axis];
                let expected = if held { row } else { 0.0 };
                worst = worst.max((force[axis] - expected).abs());
            }
        }
        at_most(&format!("{law}: rows of supports"), worst / size, 1e-13);

        // Where supports rest, the same comes out of the degrees of freedom.
        let (mut on_dofs, mut still) = (Vec::new(), Vec::new());
        for values in [&u, &v] {
            let mut dofs = vec![0.0; model.dofs()];
            model.to_dofs(values, &mut dofs).unwrap();
            let mut nodal = vec![[0.0; 3]; nodes];
            model.to_nodes(&dofs, &mut nodal).unwrap();
            on_dofs.push(dofs);
            still.push(nodal);
        }
        let zero = vec![[0.0; 3]; nodes];
        let motion = [&*still[0], &*still[1], &*zero];
        model.moving_reactions(0.25, motion, &mut reached).unwrap();
        let mut resting = vec![[f64::NAN; 3]; nodes];
        model
            .reactions(0.25, &on_dofs[0], &on_dofs[1], &mut resting)
            .unwrap();
        assert_eq!(resting, reached);
    }
}

/// K_fp d and D_fp d are those entries of the free body's K d and D d that move.
#[test]
fn supports_that_move_pull_by_the_columns_of_the_free_body() {
    let mesh = bar();
    for (law, stiffness) in [
        (linear(YOUNGS_MODULUS, 0.45), 0.0),
        (linear(YOUNGS_MODULUS, 0.45), 0.02),
        (damped_springs(), 0.02),
    ] {
        let mut problem = held_and_loaded(law.clone());
        problem.damping = Rayleigh::new(3.0, stiffness);
        let model = build(&mesh, &problem);
        problem.fixed.clear();
        let free = build(&mesh, &problem);

        let nodes = mesh.points.len();
        let mut d = field(nodes, 1.7);
        for (node, d) in (0..).zip(&mut d) {
            if let Some(cell) = model.cell_of_node(node) {
                let held = &model.pinned()[3 * cell as usize..];
                let moving = d.iter_mut().zip(held).filter(|(_, held)| !**held);
                moving.for_each(|(d, _)| *d = 0.0);
            }
        }
        let pattern: Vec<(u32, [f64; 3])> = (0..).zip(d.iter().copied()).collect();
        let motion = model.support_motion(&pattern).unwrap();
        let on_dofs = |full: &[f64]| {
            let mut dofs = vec![0.0; model.dofs()];
            model.to_dofs(full.as_chunks::<3>().0, &mut dofs).unwrap();
            dofs
        };
        let mut pull = vec![0.0; 3 * nodes];
        free.operators()
            .stiffness()
            .multiply(d.as_flattened(), &mut pull);
        let mut drag = vec![0.0; 3 * nodes];
        free.operators()
            .subtract_damping(d.as_flattened(), &mut drag);
        drag.iter_mut().for_each(|force| *force = -*force);
        for (name, entries, full) in [
            ("K_fp d", &motion.stiffness, &pull),
            ("D_fp d", &motion.damping, &drag),
        ] {
            let expected = on_dofs(full);
            let mut reached = vec![0.0; model.dofs()];
            for (dof, force) in entries {
                reached[*dof as usize] += force;
            }
            let off = reached.iter().zip(&expected).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max) / max_abs(full);
            at_most(&format!("{law}, beta = {stiffness}: {name}"), off, 1e-13);
            assert!(entries.is_sorted_by_key(|(dof, _)| *dof));
        }
        assert!(!motion.stiffness.is_empty());
        let undamped = matches!(law, Law::Linear { .. }) && stiffness == 0.0;
        assert_eq!(motion.damping.is_empty(), undamped);
    }
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let mesh = bar();
    let model = build(&mesh, &held_and_loaded(linear(YOUNGS_MODULUS, 0.3)));
    let (nodes, zero) = (mesh.points.len(), vec![0.0; model.dofs()]);
    let on = On::Nodes(vec![0, 500]);
    let unknown = Cause::NodeOutOfRange { node: 500, nodes };
    assert_eq!(
        model.reaction(0.0, &zero, &zero, &on),
        Err(FieldError::Place(unknown.clone()))
    );
    assert_eq!(
        model.reaction_of_nodes(0.0, &zero, &zero, &[500]),
        Err(FieldError::Place(unknown))
    );
    assert!(matches!(
        model.reaction(0.0, &zero, &zero, &"lid".into()),
        Err(FieldError::Place(Cause::Group(_)))
    ));
    let mut out = vec![[0.0; 3]; nodes];
    for (u, v) in [(&zero[1..], &*zero), (&*zero, &zero[1..])] {
        let refused = model.reactions(0.0, u, v, &mut out);
        assert!(matches!(refused, Err(FieldError::Length { .. })));
    }
    // A node of x = 0 above the bottom is held in x only.
    let (roller, _) = mesh.nearest_node([0.0, SIZE[1], SIZE[2]]);
    assert!(model.support_motion(&[(roller, [1.0, 0.0, 0.0])]).is_ok());
    let refused = model.support_motion(&[(roller, [1.0, 0.0, 2.0])]);
    let (node, axis) = (roller, 2);
    assert_eq!(refused, Err(SupportMotionError::NotHeld { node, axis }));
}
