//! Scenes in which rigid tools press on a body.

use std::fs;

use crate::common::build;
use sinew_core::{Inputs, Outcome, System, simulate};
use sinew_scene::{Scene, Simulation};

fn scene(tools: &str) -> String {
    format!(
        "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\n\
         poissons_ratio = 0.0\n[[fixed]]\ngroup = \"bottom\"\n{tools}[run]\nduration = 0.1\nintegrator = \"symplectic-euler\"\ndt = 0.001\n"
    )
}

const BALL: &str = "[[tool]]\nname = \"ball\"\nshape = { sphere = { radius = 0.08 } }\n";

fn ball(more: &str) -> String {
    scene(&format!("{BALL}{more}"))
}

/// The warnings of a simulation, one line each.
fn said(simulation: &Simulation) -> Vec<String> {
    let warnings = simulation.warnings();
    warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_body_knows_its_tools_and_one_without_is_untouched() {
    let simulation = build(&ball("start = [0.05, 0.05, 0.2]\nhold = true\n"));
    let body = simulation.model().body().unwrap();
    assert!(body.model.contact().is_some());
    // Nodes on the surface, but for the 9 of the bottom, which are held.
    let tools = body.tools.as_ref().unwrap();
    assert_eq!(tools.touched_cells().len(), 27 - 1 - 9);
    let untouched = build(&scene(""));
    let body = untouched.model().body().unwrap();
    assert!(body.model.contact().is_none() && body.tools.is_none());
}

#[test]
fn a_group_is_all_that_a_tool_touches() {
    let text = ball("start = [0.05, 0.05, 0.2]\nhold = true\ntouches = \"top\"\n");
    let simulation = build(&text);
    let tools = simulation.model().body().unwrap().tools.clone().unwrap();
    assert_eq!(tools.touched_cells().len(), 9);
    assert!(tools.touched_cells().iter().all(|cell| cell.rest[2] == 0.1));
}

/// The position of a node that is moved in one direction depends on more than its degrees of freedom, so tools ignore
/// it.
#[test]
fn moved_nodes_and_held_directions_are_told_apart() {
    let text = ball(
        "start = [0.05, 0.05, 0.2]\nhold = true\n[[fixed]]\nwhere = { below = { x = 0.0 } }\naxes = \"x\"\n[[move]]\n\
         where = { above = { x = 0.1, z = 0.05 } }\naxes = \"x\"\nvelocity = [0.1, 0.0, 0.0]\n",
    );
    let simulation = build(&text);
    let tools = simulation.model().body().unwrap().tools.clone().unwrap();
    assert_eq!(tools.touched_cells().len(), 27 - 1 - 9 - 6);
    for cell in tools.touched_cells() {
        assert_eq!(cell.free, [cell.rest[0] > 0.0, true, true]);
    }
}

#[test]
fn a_table_moves_and_turns_a_tool_and_is_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("press.toml");
    fs::write(
        folder.path().join("ball.csv"),
        "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0.1,0.05,0.05,0.2,0,0,0\n0.2,0.05,0.05,0.1,0,0,1\n",
    )
    .unwrap();
    fs::write(&path, ball("table = \"ball.csv\"\n")).unwrap();
    let scene = Scene::load(&path).unwrap();
    let files = [path.clone(), folder.path().join("ball.csv")];
    assert_eq!(scene.input_files(), files);
    assert_eq!(Scene::input_files_of(&path), files);
    let simulation = scene.build().unwrap();
    let tools = simulation.model().body().unwrap().tools.clone().unwrap();
    for (t, z, turned) in [(0.0, 0.2, 0.0), (0.15, 0.15, 0.5), (1.0, 0.1, 1.0)] {
        let pose = tools.tools()[0].motion.at(t, Inputs::none());
        assert!((pose.position()[2] - z).abs() < 1e-15);
        assert!((pose.rotation_vector()[2] - turned).abs() < 1e-15);
    }
}

#[test]
fn a_plan_says_what_tools_do() {
    let tools = format!(
        "{BALL}start = [0.05, 0.05, 0.2]\nvelocity = [0.0, 0.0, -0.1]\nfriction = 0.2\ngrasp = {{ from = 0.01, to = 0.05 }}\n\
         [[tool]]\nname = \"hand\"\nshapes = [{{ box = {{ size = [0.2, 0.2, 0.2] }} }}, {{ plane = {{}} }}]\nstart = [0.0, 0.0, -0.2]\n\
         hold = true\ntouches = \"top\"\nstarts_inside = \"push\"\n"
    );
    let plan = build(&scene(&tools)).plan().to_string();
    let lines: Vec<&str> = plan.lines().collect();
    let at = lines.iter().position(|line| line.starts_with("tools"));
    let at = at.unwrap();
    insta::assert_snapshot!(lines[at..at + 4].join("\n"), @r"
    tools       `ball`: sphere of radius 0.08 m from [0.05, 0.05, 0.2] m at [0, 0, -0.1] m/s; touches
                  the surface, 17 nodes, friction 0.2, grasps from 0.01 s to 0.05 s
                `hand`: box of [0.2, 0.2, 0.2] m and plane fixed at [0, 0, -0.2] m; touches `top`, 9
                  nodes, pushes out what is inside at t = 0
    ");
}

#[test]
fn thin_fast_and_pushing_tools_are_warned_about() {
    let thin = ball("start = [0.05, 0.05, 0.115]\nhold = true\n").replace("0.08", "0.01");
    let fast = ball("start = [0.05, 0.05, 0.2]\nvelocity = [0.0, 0.0, -200.0]\n");
    let pushing = ball("start = [0.05, 0.05, 0.17]\nhold = true\nstarts_inside = \"push\"\n");
    insta::assert_snapshot!(said(&build(&thin)).join("\n"), @"tool `ball` has a radius or half a thickness of 0.01 m, below the longest edge of the surface within its reach: it meets triangles as well as nodes, and how deep it gets depends on the mesh; refine the mesh where it presses");
    insta::assert_snapshot!(said(&build(&fast)).join("\n"), @"tool `ball` goes 0.2 m in a step, farther than the body is large, 0.1 m; is its velocity in m/s?");
    insta::assert_snapshot!(said(&build(&pushing)).join("\n"), @"tool `ball` begins inside the body: the first step pushes node 23 out of it by 0.01 m");
    let still = ball("start = [0.05, 0.05, 0.18]\nhold = true\n");
    assert!(said(&build(&still)).is_empty());
}

/// A plane that moves by 200 sizes of the body within the only step takes it along. A ball whose lowest point lies on a
/// node begins outside, independent of rounding.
#[test]
fn what_a_tool_carries_away_has_diverged_by_any_machine() {
    for machine in ["auto", "general", "reference"] {
        let plane = "[[tool]]\nname = \"lid\"\nshape = { plane = {} }\nstart = [0.05, 0.05, 0.12]\nrotation = [3.141592653589793, 0.0, 0.0]\n\
                     velocity = [0.0, 0.0, -2e4]\n";
        let text = scene(plane).replace(
            "duration = 0.1",
            &format!("duration = 0.001\nmachine = \"{machine}\""),
        );
        let simulation = build(&text);
        let mut state = simulation.initial_state().clone();
        let mut integrator = simulation.integrator().unwrap();
        let run = simulation.run();
        assert_eq!(run.steps, 1);
        let report = simulate(
            simulation.system(),
            &mut *integrator,
            &mut state,
            &run,
            &mut (),
        );
        let outcome = report.unwrap().outcome;
        assert!(
            matches!(outcome, Outcome::Diverged { .. }),
            "{machine}: {outcome:?}"
        );
    }
}

#[test]
fn a_tool_that_begins_on_the_surface_is_not_inside() {
    for radius in [0.01, 0.03, 0.07, 0.11] {
        let text = ball(&format!(
            "start = [0.05, 0.05, {}]\nhold = true\n",
            0.1 + radius
        ));
        build(&text.replace("0.08", &radius.to_string()));
    }
}

/// The force of a tilted plate along a fixed axis is carried by the support of that axis.
#[test]
fn supports_bear_what_tools_push_into_held_directions() {
    let text = scene(
        "[damping]\nmass = 60.0\n[[fixed]]\ngroup = \"top\"\naxes = \"x\"\n[[tool]]\nname = \"plate\"\nshape = { plane = {} }\n\
         start = [0.0, 0.0, 0.097]\nrotation = [0.0, 2.9, 0.0]\nhold = true\nstarts_inside = \"push\"\n",
    );
    let simulation = build(&text.replace("duration = 0.1", "duration = 1.5"));
    let folder = tempfile::tempdir().unwrap();
    let (state, ..) = crate::common::run(&simulation, folder.path());
    let tools = simulation.model().tools().unwrap();
    let force = tools.report(&state, 0).force;
    assert!(
        force[0].abs() > 0.1 * force[2].abs() && force[2] > 0.01,
        "{force:?}"
    );
    let reactions = simulation.body().reactions(&state, Inputs::none()).unwrap();
    for axis in [0, 2] {
        let supports: f64 = reactions.iter().map(|part| part.force[axis]).sum();
        assert!(
            (supports / force[axis] - 1.0).abs() < 1e-6,
            "{supports} {force:?}"
        );
    }
}

/// Without the warning a plate that passes through a moved or fixed top would not be reported.
#[test]
fn a_tool_that_passes_through_nodes_it_does_not_meet_is_warned_about() {
    let plate = "[[tool]]\nname = \"plate\"\nshape = { plane = {} }\nstart = [0.0, 0.0, 0.101]\nrotation = [3.141592653589793, 0.0, 0.0]\n\
                 velocity = [0.0, 0.0, -0.05]\n";
    let moved = "[[move]]\ngroup = \"top\"\naxes = \"x\"\nvelocity = [0.01, 0.0, 0.0]\n";
    insta::assert_snapshot!(said(&build(&scene(&format!("{moved}{plate}")))).join("\n"), @"tool `plate` passes through node 19 at t = 0.02031 s, which is fixed or has a prescribed motion: tools touch free nodes only; keep the tool away from fixed nodes");
    assert!(said(&build(&scene(plate))).is_empty());
}

/// A plate that comes down on a fixed top passes through it, and the run reports this.
#[test]
fn a_tool_that_leaves_nodes_in_it_is_told() {
    let plate = "[[fixed]]\ngroup = \"top\"\naxes = \"z\"\n[[tool]]\nname = \"plate\"\nshape = { plane = {} }\nstart = [0.0, 0.0, 0.101]\n\
                 rotation = [3.141592653589793, 0.0, 0.0]\nvelocity = [0.0, 0.0, -0.05]\n";
    let simulation = build(&scene(plate));
    let folder = tempfile::tempdir().unwrap();
    let (state, ..) = crate::common::run(&simulation, folder.path());
    insta::assert_snapshot!(simulation.body().left_by_tools(&state).join("\n"), @"tool `plate` left a node up to 0.004 m in it: it is fixed in that direction, or lies between two surfaces of the tool");
    assert_eq!(
        simulation.model().tools().unwrap().report(&state, 0).force,
        [0.0; 3]
    );
    let free = plate.replacen("axes = \"z\"", "axes = \"x\"", 1);
    let simulation = build(&scene(&free));
    let (state, ..) = crate::common::run(&simulation, folder.path());
    assert!(simulation.body().left_by_tools(&state).is_empty());
}

/// Without the warning a grasp that closes next to the tissue, or two jaws on one node, would not be reported.
#[test]
fn a_grasp_that_seizes_nothing_and_one_that_comes_second_are_told() {
    let jaw = |name: &str, z: f64, speed: f64, from: f64| {
        format!(
            "[[tool]]\nname = \"{name}\"\nshape = {{ sphere = {{ radius = 0.08 }} }}\nstart = [0.05, 0.05, {z}]\nvelocity = [0.0, 0.0, -{speed}]\n\
             grasp = {{ from = {from}, to = 0.9 }}\n"
        )
    };
    let told = |tools: &str| {
        let simulation = build(&scene(tools));
        let folder = tempfile::tempdir().unwrap();
        let (state, ..) = crate::common::run(&simulation, folder.path());
        simulation.body().left_by_tools(&state).join("\n")
    };
    insta::assert_snapshot!(told(&jaw("far", 0.4, 0.02, 0.05)), @"tool `far` grasped nothing from 0.05 s to 0.9 s: it pushed no node");
    let two = jaw("first", 0.18, 0.02, 0.05) + &jaw("second", 0.1812, 0.04, 0.07);
    insta::assert_snapshot!(told(&two), @r"
    tool `second` did not grasp a node because tool `first` already holds it
    tool `second` grasped nothing from 0.07 s to 0.9 s: it pushed no node
    ");
    assert_eq!(told(&jaw("later", 0.181, 0.02, 0.5)), "");
    assert_eq!(told(&jaw("near", 0.18, 0.02, 0.05)), "");
}

#[test]
fn a_tool_that_is_a_body_says_so_and_gives_way() {
    let tool = ball(
        "start = [0.05, 0.05, 0.185]\nvelocity = [0.0, 0.0, -0.1]\nbody = { mass = 0.05, inertia = [1e-4, 1e-4, 1e-4], coupling = 40.0, \
         rotational_coupling = 0.5 }\n",
    );
    let simulation = build(&tool);
    let plan = simulation.plan().to_string();
    assert!(
        plan.contains("a body of 0.05 kg on springs of 40 N/m and 0.5 N"),
        "{plan}"
    );
    let folder = tempfile::tempdir().unwrap();
    let (state, ..) = crate::common::run(&simulation, folder.path());
    let tools = simulation.model().tools().unwrap();
    let report = tools.report(&state, 0);
    let height = tools.pose(&state, Inputs::none(), 0).position()[2];
    assert!(report.contacts > 0 && report.force[2] > 0.0);
    assert!(height > 0.176, "it is above the end of its path: {height}");
    assert!(simulation.body().left_by_tools(&state).is_empty());
}

/// A tip of a tenth of an edge between nodes: its triangles are found, and it does not pass through.
#[test]
fn a_thin_tip_presses_where_there_is_no_node() {
    let tip =
        ball("start = [0.06, 0.03, 0.106]\nvelocity = [0.0, 0.0, -0.1]\n").replace("0.08", "0.005");
    let simulation = build(&tip);
    let tools = simulation.model().tools().unwrap();
    // Of the surface but for the bottom, all of whose nodes are held.
    assert_eq!(tools.tools()[0].triangles.len(), 5 * 8);
    let folder = tempfile::tempdir().unwrap();
    let (state, ..) = crate::common::run(&simulation, folder.path());
    let report = tools.report(&state, 0);
    assert!(
        report.force[2] > 0.0 && report.residual < 1e-9,
        "{report:?}"
    );
    let pose = tools.pose(&state, Inputs::none(), 0);
    let gap = tools.deepest(&state.u, &pose, 0).unwrap().gap;
    assert!(gap.abs() < 1e-4, "{gap}");
    let far = ball("start = [0.05, 0.05, 0.2]\nhold = true\n").replace("0.08", "0.01");
    let far = build(&far);
    assert!(far.model().tools().unwrap().tools()[0].triangles.is_empty());
    assert!(said(&far).is_empty());
}

/// A plate that is thinner than an edge of the surface presses with its face, around which no triangle can pass; with
/// its edge ahead it acts like a blade.
#[test]
fn a_thin_plate_meets_triangles_where_it_comes_with_its_edge() {
    let plate = |way: &str| {
        scene(&format!(
            "[[tool]]\nname = \"plate\"\nshape = {{ box = {{ size = [0.3, 0.3, 0.01] }} }}\n{way}\n"
        ))
    };
    let triangles = |way: &str| {
        let simulation = build(&plate(way));
        let tools = simulation.model().tools().unwrap();
        tools.tools()[0].triangles.len()
    };
    let down = "velocity = [0.0, 0.0, -0.1]";
    let flat = format!("start = [0.05, 0.05, 0.106]\n{down}");
    assert_eq!(triangles(&flat), 0);
    assert!(said(&build(&plate(&flat))).is_empty());
    let tilted = format!("start = [0.05, 0.05, 0.14]\nrotation = [0.2, 0.0, 0.0]\n{down}");
    assert_eq!(triangles(&tilted), 0);
    let on_edge =
        format!("start = [0.05, 0.05, 0.26]\nrotation = [1.5707963267948966, 0.0, 0.0]\n{down}");
    assert!(triangles(&on_edge) > 0);
    // Tissue may come from anywhere to what stays.
    assert!(triangles("start = [0.05, 0.05, 0.106]\nhold = true") > 0);
}

/// A network updates displacements with a clamped velocity: the previous position of a cell follows from that one, not
/// from the velocity in the state.
#[test]
fn what_flies_away_faster_than_a_network_saturates_is_caught_by_no_tool() {
    let text = "[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\n\
                poissons_ratio = 0.3\n[[initial]]\nvelocity = [0.0, 0.0, 20.0]\n[[tool]]\nname = \"plate\"\n\
                shape = { box = { size = [0.3, 0.3, 0.005] } }\nstart = [0.05, 0.05, -0.0035]\nhold = true\n[run]\nduration = 0.01\n\
                integrator = \"cnn-symplectic\"\ndt = 5e-4\nfree_flight = true\n";
    for more in ["", "machine = \"reference\"\n"] {
        let simulation = build(&format!("{text}{more}"));
        let folder = tempfile::tempdir().unwrap();
        let (state, ..) = crate::common::run(&simulation, folder.path());
        let report = simulation.model().tools().unwrap().report(&state, 0);
        assert_eq!(report.impulse, [0.0; 3]);
        // The network's own limit: 4 m/s.
        let rise = state.u.iter().skip(2).step_by(3);
        assert!(rise.clone().all(|z| (z - 0.04).abs() < 1e-12), "{more}");
    }
}
