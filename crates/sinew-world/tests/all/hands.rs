//! Actions of a program: forces on nodes, jaws of tools, and times that are not whole steps.

use sinew_scene::SceneBody;
use sinew_world::{AdvanceToError, Advanced, Command, CommandError, Ended, World};

use crate::common::{CUBE, session};

/// A free block at rest.
const FREE: &str = r#"
[mesh]
block = { cells = [2, 2, 4], size = [0.04, 0.04, 0.08] }
[[region]]
density = 1000.0
model = "neo-hookean"
youngs_modulus = 6000.0
poissons_ratio = 0.3
[cutting]
snap = 0.2
[run]
duration = 1.0
integrator = "central-difference"
dt = 5e-4
"#;

fn nodes_near(body: &SceneBody, is_near: impl Fn(&[f64; 3]) -> bool) -> Vec<u32> {
    let mesh = &body.model().body().unwrap().mesh;
    let nodes = (0..).zip(&mesh.points);
    nodes
        .filter_map(|(node, at)| is_near(at).then_some(node))
        .collect()
}

/// Momentum (kg m/s) of the nodes whose z at rest is within a range (m).
fn momentum(world: &mut World, z: [f64; 2]) -> [f64; 3] {
    let body = std::sync::Arc::clone(world.body());
    let body = body.model().body().unwrap();
    let mut velocities = vec![[0.0; 3]; body.mesh.points.len()];
    world.velocities(&mut velocities).unwrap();
    let mut sum = [0.0; 3];
    let all = body.mesh.points.iter().zip(body.model.node_masses());
    for ((at, mass), velocity) in all.zip(velocities) {
        if (z[0]..=z[1]).contains(&at[2]) {
            for (sum, v) in sum.iter_mut().zip(velocity) {
                *sum += mass * v;
            }
        }
    }
    sum
}

/// A load of the scene on a group equals the same forces on its nodes: the methods treat both equally.
#[test]
fn forces_on_nodes_move_the_body_as_a_load_of_the_scene_does() {
    for method in [
        "central-difference",
        "newmark",
        "symplectic-euler",
        "cnn-symplectic",
    ] {
        let rest = format!(
            "{}[run]\nduration = 0.1\nintegrator = \"{method}\"\ndt = 1e-3\n",
            CUBE.split("[[load]]").next().unwrap()
        )
        .replace("gravity = [0.0, 0.0, -9.81]\n", "");
        let loaded = rest.replace(
            "[run]",
            "[[load]]\ngroup = \"top\"\nforce = [0.16, 0.0, -0.32]\n[run]",
        );
        let (mut by_load, mut by_hand) = (session(&loaded), session(&rest));
        let top = nodes_near(by_hand.body(), |at| at[2] > 0.0599);
        let share = 1.0 / top.len() as f64;
        let forces = top
            .iter()
            .map(|node| (*node, [0.16 * share, 0.0, -0.32 * share]));
        by_hand.command(Command::Forces(forces.collect())).unwrap();
        by_load.advance(60, &mut ()).unwrap();
        by_hand.advance(60, &mut ()).unwrap();
        let (u, expected) = (&by_hand.state().u, &by_load.state().u);
        let largest = expected.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        assert!(largest > 1e-4, "{method}: {largest}");
        for (u, expected) in u.iter().zip(expected) {
            assert!(
                (u - expected).abs() < 1e-9 * largest,
                "{method}: {u} {expected}"
            );
        }
        // None from here on: it swings back.
        by_hand.command(Command::Forces(Vec::new())).unwrap();
        by_hand.advance(60, &mut ()).unwrap();
        assert_eq!(
            by_hand.inputs().forces().len(),
            1,
            "{method}: the last one is over"
        );
    }
}

/// `F = dp/dt` before and after the cut, of the piece on which the force acts.
#[test]
fn a_force_stays_with_its_node_when_the_body_is_cut() {
    let mut world = session(FREE);
    let top = nodes_near(world.body(), |at| at[2] > 0.0799);
    let force = [2e-5, -1e-5, 3e-4];
    let share = force.map(|force| force / top.len() as f64);
    world
        .command(Command::Forces(
            top.iter().map(|node| (*node, share)).collect(),
        ))
        .unwrap();
    world.advance(40, &mut ()).unwrap();
    let all = [-1.0, 1.0];
    let before = momentum(&mut world, all);
    for (p, force) in before.iter().zip(force) {
        assert!(
            (p - force * world.t()).abs() < 1e-6 * force.abs() * world.t(),
            "{before:?}"
        );
    }
    let blade = |x: f64| [[x, -0.01, 0.0391], [x, 0.05, 0.0391]];
    let (from, to) = (blade(-0.01), blade(0.05));
    world.command(Command::Cut { from, to }).unwrap();
    world.step().unwrap();
    assert!(world.cuts().unwrap().changes > 0);
    let (upper, lower) = ([0.0392, 1.0], [-1.0, 0.0390]);
    let at_cut = (
        momentum(&mut world, all),
        momentum(&mut world, lower),
        world.t(),
    );
    world.advance(100, &mut ()).unwrap();
    let passed = world.t() - at_cut.2;
    let gained = momentum(&mut world, all);
    let of_lower = momentum(&mut world, lower);
    assert!(momentum(&mut world, upper).iter().any(|p| p.abs() > 1e-6));
    for axis in 0..3 {
        let gain = (gained[axis] - at_cut.0[axis]) / passed;
        assert!(
            (gain - force[axis]).abs() < 1e-3 * force[axis].abs(),
            "{gain} {force:?}"
        );
        let lower = (of_lower[axis] - at_cut.1[axis]) / passed;
        assert!(
            lower.abs() < 0.05 * force[2],
            "its lips alone: {lower} {force:?}"
        );
    }
}

#[test]
fn forces_that_cannot_be_are_refused_by_node() {
    let mut world = session(CUBE);
    let said = |world: &mut World, forces: Vec<(u32, [f64; 3])>| {
        world
            .command(Command::Forces(forces))
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        said(&mut world, vec![(64, [0.0; 3])]),
        "node index 64 is out of range: the mesh has 64 nodes, counted from 0"
    );
    assert_eq!(
        said(&mut world, vec![(3, [0.0, f64::NAN, 0.0])]),
        "the vector at node index 3 has a component of NaN: expected finite numbers"
    );
    assert!(world.log().entries().is_empty());
    let spring = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
                  [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
    let refused = session(spring).command(Command::Forces(Vec::new()));
    assert!(matches!(refused, Err(CommandError::NoNodes)));
}

/// A ball that is pressed on the cube moves its top along while its jaws are closed.
#[test]
fn a_tool_takes_with_it_what_it_holds_and_lets_go_of_it() {
    let text = CUBE
        .replace("gravity = [0.0, 0.0, -9.81]\n", "")
        .replace("friction = 0.3\n", "");
    let text = format!(
        "{}{}",
        text.split("[[load]]").next().unwrap(),
        &text[text.find("[[tool]]").unwrap()..]
    );
    let mut world = session(&text);
    let ball = world.tool("ball").unwrap();
    let go = |world: &mut World, z: f64, steps: usize| {
        let from = world.tool_pose(ball).position()[2];
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            let at = [0.03, 0.03, from + share * (z - from)];
            world.steer(ball, at, [0.0; 3]).unwrap();
            world.step().unwrap();
        }
    };
    let lifted = |world: &World| {
        let body = world.body().model().body().unwrap();
        let mut u = vec![[0.0; 3]; body.mesh.points.len()];
        world.displacements(&mut u).unwrap();
        u.iter().map(|u| u[2]).fold(f64::NEG_INFINITY, f64::max)
    };
    go(&mut world, 0.066, 50);
    assert!(world.tool_report(ball).unwrap().contacts > 0);
    let tool = || "ball".into();
    world.command(Command::Grasp { tool: tool() }).unwrap();
    go(&mut world, 0.078, 100);
    assert!(lifted(&world) > 3e-3, "{}", lifted(&world));
    let report = world.tool_report(ball).unwrap();
    assert!(report.force[2] < -1e-3, "it pulls back: {report:?}");
    // What is held is kept and continued.
    let saved = world.save();
    world.command(Command::Release { tool: tool() }).unwrap();
    go(&mut world, 0.09, 200);
    assert!(lifted(&world) < 1e-3, "{}", lifted(&world));
    assert_eq!(world.tool_report(ball).unwrap().contacts, 0);
    let end = world.save();
    world.restore(&saved).unwrap();
    world.command(Command::Release { tool: tool() }).unwrap();
    go(&mut world, 0.09, 200);
    assert!(world.save() == end);
    // Closed far away it holds nothing, also not what it held before.
    world.command(Command::Grasp { tool: tool() }).unwrap();
    go(&mut world, 0.1, 20);
    assert!(lifted(&world) < 1e-3);
}

/// Forces on the nodes that a grasp holds are not determined by the motion alone: parts of them that cancel must not grow.
/// The moment of the others is at most their sum times the radius.
#[test]
fn a_thin_ball_that_grasps_has_the_torque_of_its_size() {
    let text = r#"
[mesh]
block = { cells = [10, 10, 10], size = [0.1, 0.1, 0.1] }
[[region]]
density = 1000.0
model = "neo-hookean"
youngs_modulus = 5000.0
poissons_ratio = 0.4
[[fixed]]
group = "bottom"
[[tool]]
name = "ball"
shape = { sphere = { radius = 0.012 } }
start = [0.0431, 0.0527, 0.1125]
hold = true
[run]
duration = 1.0
integrator = "central-difference"
dt = 4e-4
"#;
    let mut world = session(text);
    let ball = world.tool("ball").unwrap();
    let (mut force, mut torque) = (0.0_f64, 0.0_f64);
    let norm = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    for step in 0..80 {
        // Down by 10 mm, and up again by half of it.
        let down = 4e-4 * f64::from(step.min(26)) - 1e-4 * f64::from((step - 26).max(0));
        let at = [0.0431, 0.0527, 0.1125 - down];
        world.steer(ball, at, [0.0; 3]).unwrap();
        if step == 14 {
            let tool = "ball".into();
            world.command(Command::Grasp { tool }).unwrap();
        }
        world.step().unwrap();
        let report = world.tool_report(ball).unwrap();
        force = force.max(norm(report.force));
        torque = torque.max(norm(report.torque));
    }
    assert!(world.tool_report(ball).unwrap().contacts > 3);
    assert!(force > 0.05, "{force} N");
    assert!(torque < 0.012 * force, "{torque} N m at {force} N");
}

#[test]
fn a_time_ends_with_its_last_step_and_all_its_steps_have_one_length() {
    for method in ["central-difference", "newmark", "cnn-symplectic"] {
        let tools = &CUBE[CUBE.find("[[tool]]").unwrap()..CUBE.find("[run]").unwrap()];
        let text = CUBE.replace("symplectic-euler", method).replace(tools, "");
        let mut world = session(&text);
        assert_eq!(world.dt(), 0.002);
        let advanced = world.advance_by(0.01, &mut ()).unwrap();
        assert_eq!(
            advanced,
            Advanced {
                ended: Ended::Finished,
                steps: 5,
                shortened: None
            }
        );
        let advanced = world.advance_by(0.005, &mut ()).unwrap();
        assert_eq!(advanced.steps, 3);
        assert!(
            (advanced.shortened.unwrap() - 0.005 / 3.0).abs() < 1e-15,
            "{advanced:?}"
        );
        assert!((world.t() - 0.015).abs() < 1e-15);
        assert_eq!(world.dt(), 0.002, "{method}");
        // Less than a step, and nothing.
        assert_eq!(world.advance_by(1e-4, &mut ()).unwrap().steps, 1);
        assert_eq!(world.advance_by(0.0, &mut ()).unwrap().steps, 0);
        for by in [-1e-3, f64::NAN, f64::INFINITY] {
            let refused = world.advance_by(by, &mut ());
            assert!(matches!(refused, Err(AdvanceToError::Time { .. })), "{by}");
        }
        for _ in 0..20 {
            world.advance_by(0.005, &mut ()).unwrap();
        }
        assert!((world.t() - 0.1151).abs() < 1e-14, "{}", world.t());
    }
}

/// A leapfrog whose steps change from long to short and back, near its limit, adds energy.
#[test]
fn a_body_comes_to_rest_however_its_time_is_divided() {
    let text = "gravity = [0.0, 0.0, -1.0]\n[mesh]\ncube = { cells = 4, edge = 0.1 }\n[[region]]\ndensity = 1000.0\n\
        model = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n\
        [damping]\nmass = 10.0\n[run]\nduration = 3.0\nintegrator = \"central-difference\"\ndt = \"auto\"\n";
    for by in [0.6, 0.8, 1.3, 1.7] {
        let mut world = session(text);
        let by = by * world.dt();
        for _ in 0..3000 {
            assert_eq!(
                world.advance_by(by, &mut ()).unwrap().ended,
                Ended::Finished
            );
        }
        let kinetic = world.energy().unwrap().unwrap().kinetic;
        assert!(kinetic < 1e-20, "steps of {by} s: {kinetic} J");
    }
}
