//! Simulations built from scenes: states, probes, samples and files.

use crate::common::{build, numbers, run};
use sinew_core::{LinearSystem as _, LoadTime, System};
use sinew_scene::{Simulation, WarningKind};

/// A cube of 3 x 3 x 3 cells of 0.1 m with the given support, and `rest` added at the end of the scene.
fn cube(fixed: &str, rest: &str) -> Simulation {
    let text = format!(
        r#"
gravity = [0, 0, -9.81]
[mesh]
cube = {{ cells = 3, edge = 0.3 }}
[[region]]
density = 1000
model = "linear"
youngs_modulus = 1e4
poissons_ratio = 0.3
[[fixed]]
{fixed}
[[load]]
name = "pull"
group = "top"
traction = [0, 0, 50]
ramp = {{ kind = "sin2", rise = 0.5 }}
[[load]]
name = "shear"
group = "top"
traction = [20, 0, 0]
[run]
duration = 0.1
samples = 4
integrator = "central-difference"
dt = 0.002
{rest}
"#
    );
    build(&text)
}

const HELD: &str = r#"group = "bottom""#;

fn body(simulation: &Simulation) -> &sinew_scene::BodyModel {
    simulation.model().body().unwrap()
}

/// Displacement or velocity of the node at a point.
fn at(simulation: &Simulation, field: &[f64], point: [f64; 3]) -> [f64; 3] {
    let body = body(simulation);
    let (node, distance) = body.mesh.nearest_node(point);
    assert!(distance < 1e-12);
    body.model.node_displacement(0.0, field, node).unwrap()
}

#[test]
fn a_stretch_is_linear_in_the_distance_from_its_origin() {
    let simulation = cube(
        HELD,
        "[[initial]]\nstretch = [0.1, 0.2, -0.5]\norigin = [0.3, 0, 0.1]",
    );
    let u = &simulation.initial_state().u;
    let [x, y, z] = at(&simulation, u, [0.1, 0.2, 0.3]);
    assert!((x + 0.02).abs() < 1e-15);
    assert!((y - 0.04).abs() < 1e-15);
    assert!((z + 0.1).abs() < 1e-15);
    assert_eq!(
        at(&simulation, u, [0.3, 0.3, 0.0]),
        [0.0; 3],
        "held nodes stay"
    );
    assert!(simulation.initial_state().v.iter().all(|v| *v == 0.0));
}

#[test]
fn the_last_word_on_a_group_counts() {
    let simulation = cube(
        HELD,
        "[[initial]]\nvelocity = [1, 2, 3]\n[[initial]]\ngroup = \"top\"\nvelocity = [4, 5, 6]\n\
         [[initial]]\ngroup = \"top\"\ndisplacement = [7, 8, 9]",
    );
    let state = simulation.initial_state();
    assert_eq!(at(&simulation, &state.v, [0.1, 0.1, 0.2]), [1.0, 2.0, 3.0]);
    assert_eq!(at(&simulation, &state.v, [0.1, 0.1, 0.3]), [4.0, 5.0, 6.0]);
    assert_eq!(at(&simulation, &state.u, [0.1, 0.1, 0.3]), [7.0, 8.0, 9.0]);
    assert_eq!(at(&simulation, &state.u, [0.1, 0.1, 0.2]), [0.0; 3]);
}

#[test]
fn components_held_alone_do_not_start() {
    let simulation = cube(
        "group = \"bottom\"\naxes = \"z\"",
        "[[initial]]\nvelocity = [1, 2, 3]",
    );
    let state = simulation.initial_state();
    assert_eq!(at(&simulation, &state.v, [0.1, 0.1, 0.0]), [1.0, 2.0, 0.0]);
    assert_eq!(at(&simulation, &state.v, [0.1, 0.1, 0.1]), [1.0, 2.0, 3.0]);
}

#[test]
fn a_static_state_balances_the_named_loads_at_full_value() {
    for (loads, x, z, weights) in [
        (r#"["pull"]"#, 0.0, 4.5, 0.0),
        (r#"["shear", "pull"]"#, 1.8, 4.5, 0.0),
        (r#"["gravity", "pull"]"#, 0.0, 4.5, 1.0),
    ] {
        let simulation = cube(HELD, &format!("[[initial]]\nstatic = {loads}"));
        let body = body(&simulation);
        let state = simulation.initial_state();
        let mut force = vec![0.0; body.model.dofs()];
        let operators = body.model.operators();
        operators.stiffness().multiply(&state.u, &mut force);
        let sum = |axis: usize| force.iter().skip(axis).step_by(3).sum::<f64>();
        let weight: f64 = body
            .model
            .mass()
            .iter()
            .step_by(3)
            .map(|mass| mass * -9.81)
            .sum();
        let z = z + weights * weight;
        assert!((sum(0) - x).abs() < 1e-8, "{loads}: {} N along x", sum(0));
        assert!((sum(1)).abs() < 1e-8);
        assert!((sum(2) - z).abs() < 1e-8, "{loads}: {} N along z", sum(2));
        // Also at each node: the loads stand in the order of the scene, gravity last.
        for (load, name) in operators.loads().iter().zip(["pull", "shear", "gravity"]) {
            if loads.contains(name) {
                for &(dof, value) in &load.entries {
                    force[dof as usize] -= value;
                }
            }
        }
        let worst = force.iter().fold(0.0_f64, |worst, f| worst.max(f.abs()));
        assert!(worst < 1e-9, "{loads}: {worst} N are left at a node");
    }
}

#[test]
fn probes_follow_the_nearest_node() {
    let probe =
        |name: &str, point: &str| format!("[[probe]]\nname = \"{name}\"\npoint = {point}\n");
    let simulation = cube(
        HELD,
        &format!(
            "[[initial]]\ndisplacement = [1, 2, 3]\n{}{}",
            probe("corner", "[0.3, 0.3, 0.34]"),
            probe("held", "[0.1, 0.1, 0.0]")
        ),
    );
    let [corner, held] = &simulation.probes()[..] else {
        panic!("two probes");
    };
    let node = corner.node.unwrap();
    assert_eq!(body(&simulation).mesh.points[node.index as usize], [0.3; 3]);
    assert!((node.distance - 0.04).abs() < 1e-12);
    assert_eq!(node.tag, 64);
    let u = &simulation.initial_state().u;
    assert_eq!(
        corner.displacement(0.0, u).collect::<Vec<_>>(),
        [1.0, 2.0, 3.0]
    );
    assert_eq!(held.nodes[0].dofs, [None; 3]);
    assert_eq!(held.displacement(0.0, u).collect::<Vec<_>>(), [0.0; 3]);
}

#[test]
fn samples_span_the_duration() {
    let simulation = cube(HELD, "");
    let times: Vec<f64> = simulation.sample_times().collect();
    assert_eq!((times.len(), times[0], times[4]), (5, 0.0, 0.1));
    assert!(
        times
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - 0.025).abs() < 1e-15)
    );
    assert_eq!(simulation.run().steps, 50);
    assert!(
        (simulation.run().divergence_limit - 30.0).abs() < 1e-12,
        "100 edges"
    );
}

#[test]
fn an_oscillator_starts_as_written_and_feels_its_force() {
    let text = "[oscillator]\nmass = 2\nstiffness = 50\ndamping = 0\ndisplacement = 0.5\n\
                velocity = -1\nforce = 3\n\
                [run]\nduration = 1\nintegrator = \"newmark\"\ndt = 0.01";
    let simulation = build(text);
    let state = simulation.initial_state();
    assert_eq!((state.u[0], state.v[0]), (0.5, -1.0));
    let mut force = [0.0];
    simulation
        .system()
        .as_linear()
        .unwrap()
        .operators()
        .external_force(LoadTime::at(0.0), &mut force);
    assert_eq!(force, [3.0]);
    assert!(simulation.model().body().is_none());
}

#[test]
fn a_run_writes_its_probes() {
    let simulation = cube(HELD, "[[probe]]\nname = \"tip\"\npoint = [0.3, 0.3, 0.3]");
    let folder = tempfile::tempdir().unwrap();
    let (state, csv) = run(&simulation, folder.path());
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(rows[0], "t_s,tip_u_x_m,tip_u_y_m,tip_u_z_m");
    assert_eq!(rows.len(), 52, "a head, the start and 50 steps");
    let last = numbers(rows[51]);
    assert_eq!(last[0], state.t());
    assert_eq!(last[1..], at(&simulation, &state.u, [0.3; 3]));
    assert!(last[3] < 0.0, "it hangs down");
}

#[test]
fn an_automatic_step_is_stable_however_long_the_run() {
    for duration in [1.0, 1e6, 1e9, 1e12] {
        let text = format!(
            "[oscillator]\nmass = 1.0\nstiffness = 1e6\ndamping = 0.1\nvelocity = 1.0\n\
             [run]\nduration = {duration:e}\nintegrator = \"central-difference\"\ndt = \"auto\"\n"
        );
        let simulation = build(&text);
        // 2/omega.
        assert!(
            simulation.dt() <= 0.002,
            "{duration} s: {}",
            simulation.dt()
        );
        assert!(simulation.dt() > 0.001);
    }
}

/// The paper's oscillator is stable under central difference up to 2/omega = .0632 s; nine tenths of
/// that cover the 20 ms between two instants in one step, and 1 s in eighteen.
#[test]
fn an_automatic_step_is_stable_and_meets_the_instants() {
    let scene = |samples: usize| {
        let text = format!(
            "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
             [run]\nduration = 1.0\nsamples = {samples}\nintegrator = \"central-difference\"\n\
             dt = \"auto\"\n"
        );
        build(&text)
    };
    assert_eq!(scene(50).dt(), 0.02);
    assert_eq!(scene(1).dt(), 1.0 / 18.0);
    assert_eq!(scene(1).run().steps, 18);
    let plan = scene(1).plan().to_string();
    assert!(plan.contains("dt = \"auto\": 0.05556 s"), "{plan}");
    let kinds: Vec<WarningKind> = scene(1).warnings().iter().map(|w| w.kind).collect();
    assert!(!kinds.contains(&WarningKind::UnstableStep), "{kinds:?}");
    assert!(!kinds.contains(&WarningKind::UnevenSteps), "{kinds:?}");
}
