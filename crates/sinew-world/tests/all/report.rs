//! Fields, forces and tools in the reports of a world, compared with balances of forces and closed forms.

use sinew_core::{Options, State};
use sinew_fem::stress::von_mises;
use sinew_scene::{Scene, SceneSource};
use sinew_world::{Command, ReportError, World};

use crate::common::{CUBE, build, following, session};

fn sum(vectors: &[[f64; 3]]) -> [f64; 3] {
    let along = |axis: usize| vectors.iter().map(|vector| vector[axis]).sum();
    [along(0), along(1), along(2)]
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A bar under uniform tension: its end faces slide, so that its stress is uniform.
const BAR: &str = r#"
[mesh]
block = { cells = [4, 2, 3], size = [0.2, 0.1, 0.1] }
[[region]]
density = 1000.0
model = "linear"
youngs_modulus = 3000.0
poissons_ratio = 0.3
[[fixed]]
where = { below = { x = 0.0 } }
axes = "x"
[[fixed]]
where = { sphere = { center = [0.0, 0.0, 0.0], radius = 0.01 } }
[[fixed]]
where = { sphere = { center = [0.0, 0.1, 0.0], radius = 0.01 } }
axes = "z"
[[load]]
name = "pull"
where = { above = { x = 0.2 } }
traction = [30.0, 0.0, 0.0]
[[initial]]
static = ["pull"]
[run]
duration = 0.1
integrator = "newmark"
dt = 0.01
"#;

#[test]
fn a_bar_in_even_tension_has_the_stress_strain_and_reaction_of_the_closed_form() {
    let mut world = following(build(BAR));
    let body = world.body().model().body().unwrap();
    let (nodes, tets) = (body.mesh.points.len(), body.mesh.tets.len());
    let places = body.mesh.points.clone();
    let (mut u, mut x) = (vec![[0.0; 3]; nodes], vec![[0.0; 3]; nodes]);
    let mut s = vec![[0.0; 6]; tets];
    let mut e = s.clone();
    world.displacements(&mut u).unwrap();
    world.positions(&mut x).unwrap();
    world.stress(&mut s).unwrap();
    world.strain(&mut e).unwrap();
    for ((place, u), x) in places.iter().zip(&u).zip(&x) {
        assert!((u[0] - 0.01 * place[0]).abs() < 1e-12, "{place:?}: {u:?}");
        assert_eq!(*x, [0, 1, 2].map(|axis| place[axis] + u[axis]));
    }
    for (s, e) in s.iter().zip(&e) {
        assert!((s[0] - 30.0).abs() < 1e-8 && (von_mises(s) - 30.0).abs() < 1e-8);
        assert!((e[0] - 0.01).abs() < 1e-12 && (e[1] + 0.003).abs() < 1e-12);
    }
    let reactions = world.reactions().unwrap();
    assert!((reactions[0].force[0] + 0.3).abs() < 1e-9, "{reactions:?}");
    // The face narrows by 0.003 towards the held edges, so that the force acts 0.15 mm beside its middle at rest.
    let moment = 0.3 * 0.003 * 0.05;
    let off = [0.0, moment, -moment];
    let off = [0, 1, 2].map(|axis| reactions[0].moment[axis] - off[axis]);
    assert!(norm(off) < 1e-12, "{reactions:?}");
    let energy = world.energy().unwrap().unwrap();
    let closed = 0.5 * 30.0 * 0.01 * 0.002;
    assert!((energy.elastic / closed - 1.0).abs() < 1e-9, "{energy:?}");
    assert_eq!(energy.kinetic, 0.0);
    let refused = world.stress(&mut s[1..]);
    assert!(matches!(refused, Err(ReportError::Field(_))), "{refused:?}");
}

#[test]
fn the_forces_on_nodes_are_the_force_on_the_tool_and_what_is_left_moves_the_body() {
    let mut world = session(CUBE);
    let ball = world.tool("ball").unwrap();
    let plate = world.tool("plate").unwrap();
    assert_eq!(world.tools().collect::<Vec<_>>(), [ball, plate]);
    let nodes = world.body().model().body().unwrap().mesh.points.len();
    let mut forces = vec![[0.0; 3]; nodes];
    let mut pushed = 0;
    for _ in 0..200 {
        world.step().unwrap();
        world.contact_forces(&mut forces).unwrap();
        let report = world.tool_report(ball).unwrap();
        let on_plate = world.tool_report(plate).unwrap().force;
        let on_nodes = sum(&forces);
        for axis in 0..3 {
            let on_tools = report.force[axis] + on_plate[axis];
            let off = on_nodes[axis] + on_tools;
            assert!(off.abs() <= 1e-12, "{report:?}, {on_plate:?}: {on_nodes:?}");
        }
        pushed += usize::from(report.contacts > 0);
        let gap = world.tool_gap(ball).unwrap().gap;
        assert!(report.contacts == 0 || gap < 1e-3, "{gap}");
    }
    assert!(pushed > 10, "{pushed}");
    assert!(world.work_of_tools() > 0.0);
}

/// The velocity of a leapfrog is that in the middle of a step; that of the report is at the time of the state.
#[test]
fn velocities_are_those_at_the_time_of_the_state() {
    let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = 1.0\n\
                [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 1e-4\n";
    let scene = Scene::parse(SceneSource::new("spring.toml", text)).unwrap();
    let mut world = World::new(scene).unwrap();
    world.advance(745, &mut ()).unwrap();
    let omega = 1000f64.sqrt();
    let kinetic = 0.05 * (omega * world.t()).cos().powi(2);
    let found = world.energy().unwrap().unwrap();
    assert!(
        (found.kinetic - kinetic).abs() < 2e-6,
        "{found:?} {kinetic}"
    );
    let in_the_middle = 0.05 * world.state().v[0].powi(2);
    assert!(
        (in_the_middle - kinetic).abs() > 1e-5,
        "{in_the_middle} {kinetic}"
    );
    let refused = world.velocities(&mut []);
    assert!(matches!(refused, Err(ReportError::NoMesh)));
    assert!(world.surface().is_none() && world.reactions().unwrap().is_empty());
}

#[test]
fn the_topology_epoch_grows_with_every_other_mesh_and_with_nothing_else() {
    let mut world = session(&CUBE.replace("[run]", "[cutting]\nsnap = 0.2\n[run]"));
    let nodes = |world: &World| world.body().model().body().unwrap().mesh.points.len();
    let (first, whole) = (world.topology_epoch(), nodes(&world));
    let uncut = world.save();
    world.advance(20, &mut ()).unwrap();
    world.restore(&uncut).unwrap();
    assert_eq!(world.topology_epoch(), first, "the same body");
    let blade = |z: f64| [[0.022, -0.01, z], [0.022, 0.07, z]];
    let (from, to) = (blade(0.07), blade(0.035));
    world.command(Command::Cut { from, to }).unwrap();
    world.step().unwrap();
    let cut = world.topology_epoch();
    assert!(cut > first && nodes(&world) > whole);
    let surface = world.surface().unwrap();
    assert!(
        surface
            .nodes
            .iter()
            .all(|node| (*node as usize) < nodes(&world))
    );
    world.restore(&uncut).unwrap();
    assert!(world.topology_epoch() > cut && nodes(&world) == whole);
    let mut positions = vec![[0.0; 3]; whole];
    world.positions(&mut positions).unwrap();
}

/// A restored world keeps the set-up of its method, and continues with the same bits as a world that was built for it.
#[test]
fn every_method_continues_from_a_saved_world_with_the_same_bits() {
    let free = CUBE.split("[[tool]]").next().unwrap();
    let run = &CUBE[CUBE.find("[run]").unwrap()..];
    let free = format!("{free}{run}");
    let mut seen = 0;
    for entry in sinew_integrators::entries() {
        let mut world = session(&free);
        let (id, options) = (entry.id.to_owned(), Options::new());
        if world.command(Command::Integrator { id, options }).is_err() {
            continue;
        }
        seen += 1;
        world.advance(7, &mut ()).unwrap();
        let saved = world.save();
        let end = |world: &mut World| -> State {
            world.advance(9, &mut ()).unwrap();
            world.state().clone()
        };
        let expected = end(&mut world);
        world.restore(&saved).unwrap();
        assert!(end(&mut world) == expected, "{}: here", entry.id);
        let mut other = session(&free);
        let bytes = saved.to_bytes().unwrap();
        other
            .restore(&sinew_world::Saved::from_bytes(&bytes).unwrap())
            .unwrap();
        assert!(end(&mut other) == expected, "{}: elsewhere", entry.id);
    }
    assert!(seen > 6, "{seen} methods");
}

#[test]
fn a_refused_restore_changes_nothing() {
    let cut = CUBE.replace("[run]", "[cutting]\nsnap = 0.2\n[run]");
    let mut world = session(&cut);
    world.advance(10, &mut ()).unwrap();
    let before = world.save();
    let others = [
        session(CUBE).save(),
        session(&cut.replace("cells = 3", "cells = 2")).save(),
        following(build(&cut)).save(),
        session(&cut.replace("youngs_modulus = ", "youngs_modulus = 1")).save(),
    ];
    for (number, other) in others.iter().enumerate() {
        assert!(world.restore(other).is_err(), "{number}");
        assert!(world.save() == before, "{number}");
    }
    let bytes = before.to_bytes().unwrap();
    for bit in (0..8 * bytes.len()).step_by(997) {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(sinew_world::Saved::from_bytes(&flipped).is_err(), "{bit}");
    }
    world.step().unwrap();
}
