//! Scenes whose body is cut.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use sinew_world::World;

use crate::common::{advance, build, end_of, following};
use sinew_core::{Inputs, State};
use sinew_scene::{CutTotals, Cutter, Scene, SceneBody, Simulation};

const STROKES: &str = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n";

/// A bar along z with a fixed foot.
fn bar(cutting: &str, run: &str) -> String {
    format!(
        "gravity = [0.0, 0.0, 9.81]\n[mesh]\nblock = {{ cells = [2, 2, 6], size = [0.02, 0.02, 0.06] }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
         youngs_modulus = 3500.0\npoissons_ratio = 0.3\n[[fixed]]\nwhere = {{ below = {{ z = 0.0 }} }}\n[[probe]]\nname = \"tip\"\n\
         point = [0.02, 0.02, 0.06]\n{cutting}[run]\nduration = 0.05\n{run}"
    )
}

const EXPLICIT: &str = "integrator = \"central-difference\"\ndt = 2e-4\n";

/// A blade along y that moves along x through the middle, from `begin` to `end` (s).
fn across(begin: f64, end: f64) -> String {
    format!(
        "{STROKES}1,{begin},-0.001,-0.01,0.03,-0.001,0.03,0.03\n1,{end},0.021,-0.01,0.03,0.021,0.03,0.03\n"
    )
}

fn load(folder: &Path, text: &str, strokes: &str) -> Simulation {
    let path = folder.join("scene.toml");
    fs::write(folder.join("strokes.csv"), strokes).unwrap();
    fs::write(&path, text).unwrap();
    Scene::load(path).and_then(Scene::build).unwrap()
}

/// A run to its end: the scene on the remaining body, its state, and the cuts.
struct Ended {
    body: Arc<SceneBody>,
    state: State,
    totals: CutTotals,
    mass: [f64; 2],
    pieces: usize,
}

/// Runs a scene in parts of `steps` steps each.
fn run_in_parts(simulation: Simulation, steps: usize) -> Ended {
    let mut left = simulation.run().steps;
    let mut run = following(simulation);
    let mass = run.cutter().unwrap().mass();
    while left > 0 {
        let part = steps.min(left);
        advance(&mut run, part);
        left -= part;
    }
    let cutter = run.cutter().unwrap();
    // The cuts that made the body know its surface; here it is found in the mesh.
    let body = run.body().model().body().unwrap();
    assert_eq!(**body.surface(), body.mesh.boundary_surface());
    Ended {
        body: Arc::clone(run.body()),
        state: run.state().clone(),
        totals: *cutter.totals(),
        mass: [mass, cutter.mass()],
        pieces: cutter.pieces(),
    }
}

fn run(simulation: Simulation) -> Ended {
    run_in_parts(simulation, usize::MAX)
}

/// Position of the centre of mass (m) of the nodes that `picks` selects by their position at rest.
fn centre(ended: &Ended, picks: impl Fn([f64; 3]) -> bool) -> [f64; 3] {
    let body = ended.body.model().body().unwrap();
    let mut u = vec![[0.0; 3]; body.mesh.points.len()];
    body.model
        .displacements_at(ended.state.t(), &ended.state.u, &mut u)
        .unwrap();
    let (mut sum, mut whole) = ([0.0; 3], 0.0);
    let nodes = body
        .mesh
        .points
        .iter()
        .zip(&u)
        .zip(body.model.node_masses());
    for ((place, u), mass) in nodes.filter(|((place, _), _)| picks(**place)) {
        for axis in 0..3 {
            sum[axis] += mass * (place[axis] + u[axis]);
        }
        whole += mass;
    }
    sum.map(|sum| sum / whole)
}

/// A piece may fall beyond 100 times its size, at which a supported body counts as diverged.
#[test]
fn a_piece_may_fall_far() {
    let folder = tempfile::tempdir().unwrap();
    let text = bar("[cutting]\ntable = \"strokes.csv\"\n", EXPLICIT)
        .replace("duration = 0.05", "duration = 1.3");
    let ended = run(load(folder.path(), &text, &across(0.0, 2e-4)));
    let fallen = ended.state.u.iter().copied().fold(0.0, f64::max);
    let expected = 0.5 * 9.81 * ended.state.t() * (ended.state.t() + 2e-4);
    assert!((fallen / expected - 1.0).abs() < 1e-3, "{fallen} m");
}

#[test]
fn a_piece_that_is_cut_off_falls_as_galileo_says() {
    let folder = tempfile::tempdir().unwrap();
    // The blade comes through in the first step, when nothing has moved.
    let text = bar("[cutting]\ntable = \"strokes.csv\"\n", EXPLICIT);
    let ended = run(load(folder.path(), &text, &across(0.0, 2e-4)));
    assert_eq!((ended.pieces, ended.totals.changes), (2, 1));
    assert!((ended.totals.report.area - 4e-4).abs() < 1e-17);
    assert_eq!(ended.totals.report.new_nodes, 9);
    assert!((ended.mass[1] / ended.mass[0] - 1.0).abs() < 1e-14);
    // Copies follow all nodes that there were; the upper half lies above the cut, or is one of them or not.
    let body = ended.body.model().body().unwrap();
    let tets = body.mesh.tets.iter();
    let upper: Vec<u32> = tets
        .filter(|nodes| {
            let z: f64 = nodes
                .iter()
                .map(|node| body.mesh.points[*node as usize][2])
                .sum();
            z / 4.0 > 0.03
        })
        .flatten()
        .copied()
        .collect();
    let mut u = vec![[0.0; 3]; body.mesh.points.len()];
    body.model
        .displacements_at(ended.state.t(), &ended.state.u, &mut u)
        .unwrap();
    let (mut fallen, mut mass) = (0.0, 0.0);
    for (node, own) in body.model.node_masses().iter().enumerate() {
        if upper.contains(&(node as u32)) {
            fallen += own * u[node][2];
            mass += own;
        }
    }
    assert!((mass / ended.mass[0] - 0.5).abs() < 1e-14);
    // The method is exact for a constant acceleration.
    let t = ended.state.t();
    let expected = 9.81 * t * t / 2.0;
    assert!(
        (fallen / mass / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        fallen / mass
    );
}

#[test]
fn a_body_goes_on_after_its_cut_as_one_that_is_built_on_the_mesh_that_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let text = bar("[cutting]\ntable = \"strokes.csv\"\n", EXPLICIT);
    let simulation = load(folder.path(), &text, &across(0.01, 0.02));
    let mut cutter = simulation.cutter().unwrap().unwrap();
    let mut integrator = simulation.integrator().unwrap();
    let mut state = simulation.initial_state().clone();
    let mut now = Arc::clone(simulation.body());
    let (mut last, mut steps) = (None, 0);
    while state.t() < 0.05 - 1e-9 {
        let end = state.t() + 2e-4;
        if let Some(next) = cutter
            .follow(&now, &mut state, Inputs::none(), end)
            .unwrap()
        {
            now = Arc::new(next);
            last = Some((state.clone(), steps));
        }
        integrator.step(now.system(), &mut state, 2e-4).unwrap();
        steps += 1;
    }
    assert!(cutter.totals().changes > 1, "{:?}", cutter.totals());
    let (mut other, from) = last.unwrap();
    let mut mesh = now.model().body().unwrap().mesh.as_ref().clone();
    // Its parts are chosen anew.
    mesh.groups.clear();
    let whole = text.replace("[cutting]\ntable = \"strokes.csv\"\n", "");
    let fresh = Scene::parse(sinew_scene::SceneSource::new("fresh.toml", whole)).unwrap();
    let fresh = fresh.build_on(mesh).unwrap();
    let mut integrator = fresh.integrator().unwrap();
    for _ in from..steps {
        integrator.step(fresh.system(), &mut other, 2e-4).unwrap();
    }
    assert_eq!(other.u, state.u);
    assert_eq!(other.v, state.v);
}

#[test]
fn a_run_in_parts_has_the_bits_of_the_whole() {
    for run_table in [EXPLICIT, "integrator = \"cnn-stabilised\"\ndt = 0.005\n"] {
        let folder = tempfile::tempdir().unwrap();
        let text = bar(
            "[cutting]\nsnap = 0.25\ntable = \"strokes.csv\"\n",
            run_table,
        );
        let strokes = format!(
            "{}2,0.031,0.0,-0.01,0.05,0.0,0.03,0.05\n2,0.04,0.0101,-0.01,0.051,0.0101,0.03,0.05\n",
            across(0.0101, 0.0202)
        );
        let whole = run(load(folder.path(), &text, &strokes));
        assert!(whole.totals.changes > 1);
        for steps in [1, 7] {
            let parts = run_in_parts(load(folder.path(), &text, &strokes), steps);
            assert_eq!(parts.state, whole.state);
            assert_eq!(parts.totals, whole.totals);
        }
    }
}

#[test]
fn a_scene_whose_blade_never_comes_has_the_motion_of_one_without() {
    let folder = tempfile::tempdir().unwrap();
    let text = bar("[cutting]\ntable = \"strokes.csv\"\n", EXPLICIT);
    let ended = run(load(folder.path(), &text, &across(9.0, 9.1)));
    assert_eq!(ended.totals, CutTotals::default());
    let whole = load(folder.path(), &bar("", EXPLICIT), "");
    let state = end_of(whole);
    assert_eq!(ended.state.u, state.u);
}

/// The strokes of a table, a tool on the same path, and sheets from outside make the same cut.
#[test]
fn one_way_of_a_blade_makes_one_cut_whoever_leads_it() {
    let folder = tempfile::tempdir().unwrap();
    let by_table = bar("[cutting]\ntable = \"strokes.csv\"\n", EXPLICIT);
    let table = run(load(folder.path(), &by_table, &across(0.0, 2e-4)));
    let tool = "[[tool]]\nname = \"scalpel\"\nshape = { blade = { length = 0.04 } }\nrotation = [1.5707963267948966, 0.0, 0.0]\n\
                start = [-0.001, 0.01, 0.03]\nvelocity = [110.0, 0.0, 0.0]\n[cutting]\ntool = \"scalpel\"\n";
    let by_tool = run(load(folder.path(), &bar(tool, EXPLICIT), ""));
    assert_eq!(by_tool.totals.report.faces, table.totals.report.faces);
    assert_eq!((by_tool.pieces, table.pieces), (2, 2));
    let mesh = |ended: &Ended| ended.body.model().body().unwrap().mesh.tets.clone();
    assert_eq!(mesh(&by_tool), mesh(&table));
    let simulation = load(folder.path(), &bar("[cutting]\n", EXPLICIT), "");
    let mut cutter = simulation.cutter().unwrap().unwrap();
    let mut state = simulation.initial_state().clone();
    let blade = |x: f64| [[x, -0.01, 0.03], [x, 0.03, 0.03]];
    let sheet = [blade(-0.001), blade(0.021)];
    let cut = cutter.cut(sheet, simulation.body(), &mut state, Inputs::none());
    let cut = cut.unwrap().unwrap();
    assert_eq!(cut.model().body().unwrap().mesh.tets, mesh(&table));
}

#[test]
fn what_is_inside_a_burner_goes_with_its_mass_and_its_probes() {
    let folder = tempfile::tempdir().unwrap();
    let tool = "[[tool]]\nname = \"burner\"\nshape = { box = { size = [0.1, 0.1, 0.02] } }\nstart = [0.0, 0.0, 0.06]\nhold = true\n\
                [cutting]\nremove = { tool = \"burner\" }\n";
    let at_rest = bar(tool, EXPLICIT).replace("9.81", "0.0");
    let ended = run(load(folder.path(), &at_rest, ""));
    let report = ended.totals.report;
    // One of six layers of eight cells.
    assert_eq!(report.removed_tets, 24);
    assert!((report.removed_mass / ended.mass[0] - 1.0 / 6.0).abs() < 1e-14);
    assert!(
        (ended.mass[1] + report.removed_mass - ended.mass[0]).abs() < 1e-15 * ended.mass[0] * 4.0
    );
    let probe = &ended.body.probes()[0];
    assert!(probe.is_gone);
    assert!(probe.displacement(0.05, &ended.state.u).all(f64::is_nan));
    assert!(
        centre(&ended, |place| place[2] > 0.049)
            .iter()
            .all(|x| x.is_finite())
    );
}

#[test]
fn a_loose_piece_is_taken_away_where_the_scene_says_so_and_a_held_one_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let cutting = "[cutting]\ntable = \"strokes.csv\"\npieces = \"remove\"\n";
    let ended = run(load(
        folder.path(),
        &bar(cutting, EXPLICIT),
        &across(0.0, 2e-4),
    ));
    assert_eq!(ended.pieces, 1);
    assert!((ended.mass[1] / ended.mass[0] - 0.5).abs() < 1e-14);
    let held = format!("{cutting}[[fixed]]\nwhere = {{ above = {{ z = 0.06 }} }}\n");
    let ended = run(load(
        folder.path(),
        &bar(&held, EXPLICIT),
        &across(0.0, 2e-4),
    ));
    assert_eq!(ended.pieces, 2);
    assert!((ended.mass[1] / ended.mass[0] - 1.0).abs() < 1e-14);
}

/// Strokes before t = 0 cut the body that the motion starts with, and the scene can be built on that body alone.
#[test]
fn strokes_before_the_motion_cut_the_body_that_it_starts_with() {
    let folder = tempfile::tempdir().unwrap();
    let cutting = "[cutting]\ntable = \"strokes.csv\"\n";
    let built =
        |begin: f64, end: f64| load(folder.path(), &bar(cutting, EXPLICIT), &across(begin, end));
    let run_on_the_way = run(built(-0.3, -0.1));
    assert_eq!(
        (run_on_the_way.pieces, run_on_the_way.totals.changes),
        (2, 1)
    );
    assert!(!built(-0.3, -0.1).is_cut_later());
    assert!(!built(-0.3, 0.0).is_cut_later());
    let beforehand = built(-0.3, -0.1).cut_beforehand().unwrap();
    assert!(!beforehand.is_cut());
    let state = end_of(beforehand);
    assert_eq!(state, run_on_the_way.state);

    // A stroke that goes on is only begun beforehand.
    let later = built(-0.1, 0.1);
    assert!(later.is_cut_later());
    let begun = later.cut_beforehand().unwrap();
    let nodes = begun.model().body().unwrap().mesh.points.len();
    let whole = 3 * 3 * 7;
    assert!(nodes > whole && nodes < whole + 9, "{nodes}");
}

#[test]
fn a_frozen_piece_stays_where_it_came_off_and_keeps_its_mass() {
    let folder = tempfile::tempdir().unwrap();
    let ended = |pieces: &str, duration: &str| {
        let cutting = format!("[cutting]\ntable = \"strokes.csv\"\npieces = \"{pieces}\"\n");
        let text = bar(&cutting, EXPLICIT).replace("duration = 0.05", duration);
        run(load(folder.path(), &text, &across(0.02, 0.0202)))
    };
    let [soon, frozen] = ["duration = 0.021", "duration = 0.05"].map(|end| ended("freeze", end));
    let removed = ended("remove", "duration = 0.05");
    assert_eq!((frozen.pieces, frozen.totals.report.frozen_tets), (2, 72));
    assert!((frozen.mass[1] / frozen.mass[0] - 1.0).abs() < 1e-14);
    let tip = |ended: &Ended| -> Vec<f64> {
        let probe = &ended.body.probes()[0];
        probe.displacement(0.0, &ended.state.u).collect()
    };
    assert!(tip(&frozen)[2] > 1e-4);
    assert_eq!(tip(&frozen), tip(&soon));
    assert_eq!(frozen.state.u, removed.state.u);
}

/// Loads on a frozen piece have no effect, as if the piece were removed with its load.
#[test]
fn a_frozen_piece_keeps_the_loads_that_were_on_it() {
    let folder = tempfile::tempdir().unwrap();
    for load_on_top in [
        "traction = [0.0, 0.0, 5.0]",
        "force = [0.0, 0.0, 0.002]",
        "pressure = 5.0",
    ] {
        let ended = |pieces: &str| {
            let cutting = format!(
                "[[load]]\ngroup = \"top\"\n{load_on_top}\n[cutting]\ntable = \"strokes.csv\"\npieces = \"{pieces}\"\n"
            );
            run(load(
                folder.path(),
                &bar(&cutting, EXPLICIT),
                &across(0.02, 0.0202),
            ))
        };
        let [frozen, removed] = ["freeze", "remove"].map(ended);
        assert_eq!((frozen.pieces, removed.pieces), (2, 1), "{load_on_top}");
        assert_eq!(frozen.state.u, removed.state.u, "{load_on_top}");
    }
}

/// The part of a force on nodes that were frozen or removed is not redistributed to the others.
#[test]
fn the_share_of_a_force_on_each_node_stays_as_pieces_come_off() {
    for pieces in ["freeze", "remove"] {
        let folder = tempfile::tempdir().unwrap();
        let cutting = &format!(
            "[[load]]\nwhere = {{ above = {{ x = 0.02 }} }}\nforce = [0.1, 0.0, 0.0]\n[cutting]\ntable = \"strokes.csv\"\npieces = \"{pieces}\"\n"
        );
        let ended = run(load(
            folder.path(),
            &bar(cutting, EXPLICIT),
            &across(0.0, 2e-4),
        ));
        let linear = ended.body.system().as_linear().unwrap();
        let [on_side, ..] = linear.operators().loads() else {
            panic!("the load and gravity");
        };
        let along_x = on_side.entries.iter().map(|(_, force)| *force);
        assert!((6..=9).contains(&along_x.len()));
        assert!(
            along_x
                .into_iter()
                .all(|force| (force - 0.1 / 18.0).abs() < 1e-15)
        );
    }
}

/// Strokes that cross each other part a face whose nodes stay joined around it.
#[test]
fn a_face_that_is_parted_alone_is_no_surface() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[mesh]\nblock = { cells = [6, 4, 3], size = [0.06, 0.03, 0.02], split = \"kuhn\" }\n[[region]]\ndensity = 1000.0\n\
                model = \"linear\"\nyoungs_modulus = 8000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[cutting]\n\
                table = \"strokes.csv\"\nsnap = 0.4\n[run]\nduration = 0.016\nintegrator = \"central-difference\"\ndt = 2e-4\n";
    let strokes = format!(
        "{STROKES}1,0.001,0.0247855,-0.003,-0.003,0.0247855,-0.003,0.012\n\
         1,0.006,0.0215589,0.0177391,-0.003,0.0215589,0.0177391,0.024\n\
         2,0.00725,-0.003,-0.003,0.00422693,-0.003,0.034,0.00422693\n\
         2,0.01225,0.0545852,-0.003,0.00422693,0.0545852,0.034,0.00422693\n\
         3,0.0135,-0.003,-0.003,0.00550155,-0.003,0.034,0.00550155\n\
         3,0.015375,0.0329556,-0.003,0.00550155,0.0329556,0.034,0.00550155\n"
    );
    // Its end compares the surface with that of the mesh.
    let ended = run(load(folder.path(), text, &strokes));
    assert!(ended.totals.changes > 5, "{:?}", ended.totals);
}

#[test]
fn toughness_is_the_work_of_the_blade_and_leaves_the_motion_alone() {
    let folder = tempfile::tempdir().unwrap();
    let with = |toughness: &str| {
        let cutting = format!("[cutting]\ntable = \"strokes.csv\"\ntoughness = {toughness}\n");
        run(load(
            folder.path(),
            &bar(&cutting, EXPLICIT),
            &across(0.0, 2e-4),
        ))
    };
    let (none, some) = (with("0.0"), with("150.0"));
    assert_eq!(none.totals.blade_work, 0.0);
    assert!((some.totals.blade_work - 150.0 * 4e-4).abs() < 1e-15);
    assert_eq!(none.state, some.state);
}

/// A jaw above the top of the bar: pressed down by 1 mm, then raised by 4 mm.
fn write_jaw(folder: &Path) {
    fs::write(
        folder.join("jaw.csv"),
        "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,0,0,0.0601,3.141592653589793,0,0\n0.01,0,0,0.059,3.141592653589793,0,0\n\
         0.02,0,0,0.059,3.141592653589793,0,0\n0.05,0,0,0.063,3.141592653589793,0,0\n",
    )
    .unwrap();
}

#[test]
fn a_piece_that_a_tool_holds_is_no_loose_one() {
    let folder = tempfile::tempdir().unwrap();
    write_jaw(folder.path());
    // Strokes from 20 ms on; the grasp ends before, or never.
    for (pieces, to, is_taken) in [
        ("freeze", 1.0, false),
        ("remove", 1.0, false),
        ("freeze", 0.015, true),
        ("remove", 0.015, true),
    ] {
        let tables = format!(
            "[[tool]]\nname = \"jaw\"\nshape = {{ plane = {{}} }}\ntable = \"jaw.csv\"\ngrasp = {{ from = 0.001, to = {to} }}\n\
             [cutting]\ntable = \"strokes.csv\"\npieces = \"{pieces}\"\n"
        );
        let strokes = across(0.02, 0.0202);
        let ended = run(load(folder.path(), &bar(&tables, EXPLICIT), &strokes));
        let report = ended.totals.report;
        let taken = report.frozen_tets + report.removed_tets;
        assert_eq!(taken, if is_taken { 72 } else { 0 }, "{pieces}, {to}");
    }
}

/// A jaw that grasps the top continues to grasp it, copies included, and its work continues.
#[test]
fn a_grasp_outlives_a_cut() {
    let folder = tempfile::tempdir().unwrap();
    write_jaw(folder.path());
    // Across the top, so that nodes which are held are copied.
    let strokes = format!(
        "{STROKES}1,0.02,0.0101,-0.01,0.07,0.0101,0.03,0.07\n1,0.022,0.0101,-0.01,0.035,0.0101,0.03,0.035\n"
    );
    // With friction, tools keep velocities as well.
    for friction in ["0.0", "0.3"] {
        let jaw = format!(
            "[[tool]]\nname = \"jaw\"\nshape = {{ plane = {{}} }}\ntable = \"jaw.csv\"\ngrasp = {{ from = 0.001, to = 1.0 }}\n\
             friction = {friction}\n"
        );
        let cut = format!("{jaw}[cutting]\ntable = \"strokes.csv\"\n");
        let ended = run(load(folder.path(), &bar(&cut, EXPLICIT), &strokes));
        assert!(ended.totals.report.new_nodes > 0);
        let body = ended.body.model().body().unwrap();
        let (tools, state) = (body.tools.as_ref().unwrap(), &ended.state);
        let report = tools.report(state, 0);
        // All 9 nodes of the top and the copies of those in the cut are still at the jaw.
        let top = body.mesh.points.iter().filter(|place| place[2] > 0.0599);
        let top = top.count();
        assert!(top > 9, "{top}");
        assert_eq!((report.contacts, report.seized), (top, 9));
        let whole = load(folder.path(), &bar(&jaw, EXPLICIT), "");
        let tools = Arc::clone(whole.model().tools().unwrap());
        let other = end_of(whole);
        let theirs = tools.report(&other, 0);
        assert!((report.work / theirs.work - 1.0).abs() < 0.5);
        let probe = ended.body.probes()[0].displacement(state.t(), &state.u);
        assert!((probe.last().unwrap() - 0.003).abs() < 1.1e-3);
    }
}

/// Steps so short that most of them reach no edge or face of a tetrahedron: the blade still counts as being in the
/// tissue, also in a cutter that is restored from its bytes.
#[test]
fn a_tool_cuts_in_any_steps_what_a_table_cuts() {
    let folder = tempfile::tempdir().unwrap();
    let tool = "[[tool]]\nname = \"scalpel\"\nshape = { blade = { length = 0.04 } }\nrotation = [1.5707963267948966, 0.0, 0.0]\n\
                start = [-0.001, 0.01, 0.0323]\nvelocity = [0.5, 0.0, 0.0]\n[cutting]\ntool = \"scalpel\"\nsnap = 0.0\n";
    let table = "[cutting]\ntable = \"strokes.csv\"\nsnap = 0.0\n";
    let at_rest = |text: String| text.replace("gravity = [0.0, 0.0, 9.81]\n", "");
    let strokes = format!(
        "{STROKES}1,0,-0.001,-0.01,0.0323,-0.001,0.03,0.0323\n1,0.046,0.022,-0.01,0.0323,0.022,0.03,0.0323\n"
    );
    for dt in ["1e-3", "2e-4", "5e-5"] {
        let run_in = |text: &str| {
            let text = at_rest(bar(text, &EXPLICIT.replace("2e-4", dt)));
            run(load(folder.path(), &text, &strokes)).totals.report
        };
        let (by_tool, by_table) = (run_in(tool), run_in(table));
        assert_eq!(by_table.faces, 8);
        assert_eq!(by_tool.faces, by_table.faces, "{dt}");
    }
    let simulation = load(folder.path(), &at_rest(bar(tool, EXPLICIT)), "");
    let mut cutter = simulation.cutter().unwrap().unwrap();
    let mut state = simulation.initial_state().clone();
    let (mut now, mut end) = (None, 0.0);
    while now.is_none() {
        end += 2e-4;
        now = cutter
            .follow(simulation.body(), &mut state, Inputs::none(), end)
            .unwrap();
        let mut taken_over = simulation.cutter().unwrap().unwrap();
        taken_over
            .restore(&cutter.save(), simulation.body())
            .unwrap();
        assert_eq!(taken_over.save(), cutter.save());
        cutter = taken_over;
    }
    assert!(cutter.totals().report.faces > 0);
}

/// A blade of the scene outside the tissue is not lifted repeatedly: tetrahedra that a user's blade has partly entered
/// keep that state.
#[test]
fn a_blade_in_the_air_leaves_the_cut_of_a_hand_alone() {
    let area = |tables: &str| {
        let simulation = build(&bar(tables, EXPLICIT));
        let mut cutter = simulation.cutter().unwrap().unwrap();
        let mut state = simulation.initial_state().clone();
        let blade = |x: f64| [[x, -0.01, 0.032], [x, 0.03, 0.032]];
        let mut now: Option<SceneBody> = None;
        for n in 0..60 {
            let [from, to] = [n, n + 1].map(|n| blade(-0.001 + 4e-4 * f64::from(n)));
            let before = now.as_ref().unwrap_or(simulation.body());
            let cut = cutter.cut([from, to], before, &mut state, Inputs::none());
            now = cut.unwrap().or(now);
            let before = now.as_ref().unwrap_or(simulation.body());
            let end = 1e-4 * f64::from(n + 1);
            let cut = cutter.follow(before, &mut state, Inputs::none(), end);
            assert!(cut.unwrap().is_none());
        }
        cutter.totals().report.area
    };
    let alone = area("[cutting]\n");
    assert!(alone > 3.9e-4, "{alone}");
    let scalpel = "[[tool]]\nname = \"scalpel\"\nshape = { blade = { length = 0.02 } }\nstart = [0.1, 0.1, 0.1]\nvelocity = [0.01, 0.0, 0.0]\n\
                   [cutting]\ntool = \"scalpel\"\n";
    assert_eq!(area(scalpel), alone);
}

/// A node that a jaw grasps would be accelerated if its rest position were moved: snapping does not move it, and its
/// copy is grasped as well.
#[test]
fn what_a_jaw_holds_is_not_snapped() {
    let folder = tempfile::tempdir().unwrap();
    write_jaw(folder.path());
    let strokes = format!(
        "{STROKES}1,0.02,0.0122,-0.01,0.07,0.0122,0.03,0.07\n1,0.022,0.0122,-0.01,0.035,0.0122,0.03,0.035\n"
    );
    let tables = "[[tool]]\nname = \"jaw\"\nshape = { plane = {} }\ntable = \"jaw.csv\"\ngrasp = { from = 0.001, to = 1.0 }\n\
                  [cutting]\ntable = \"strokes.csv\"\nsnap = 0.3\n";
    let ended = run(load(folder.path(), &bar(tables, EXPLICIT), &strokes));
    assert!(ended.totals.report.moved_nodes > 0);
    let body = ended.body.model().body().unwrap();
    let top = body.mesh.points.iter().filter(|place| place[2] > 0.0599);
    let top: Vec<_> = top.collect();
    assert!(top.len() > 9);
    let on_grid = |x: f64| (100.0 * x - (100.0 * x).round()).abs() < 1e-12;
    assert!(top.iter().all(|place| on_grid(place[0])), "{top:?}");
    let report = body.tools.as_ref().unwrap().report(&ended.state, 0);
    assert_eq!((report.contacts, report.seized), (top.len(), 9));
}

fn refusal(text: &str, strokes: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(folder.path().join("strokes.csv"), strokes).unwrap();
    fs::write(&path, text).unwrap();
    let error = Scene::load(path).and_then(Scene::build).unwrap_err();
    error
        .to_string()
        .replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn each_mistake_has_its_line() {
    let by_table = "[cutting]\ntable = \"strokes.csv\"\n";
    let with = |cutting: &str| refusal(&bar(cutting, EXPLICIT), STROKES);
    let row = |rows: &str| refusal(&bar(by_table, EXPLICIT), &format!("{STROKES}{rows}"));
    for (said, expected) in [
        (
            with("[cutting]\nsnap = 0.7\n"),
            "scene.toml:15: [cutting]: snap = 0.7: expected a share from 0 to 0.5",
        ),
        (
            with("[cutting]\ntool = \"knife\"\n"),
            "scene.toml:15: [cutting]: tool = \"knife\": expected the name of a [[tool]] with shape = { blade = { length = .. } }: there is none",
        ),
        (
            with("[cutting]\ntable = \"strokes.csv\"\ntool = \"knife\"\n"),
            "scene.toml:15: [cutting]: `table` does not go with `tool`, which is a blade as well",
        ),
        (
            with("[cutting]\nremove = { tool = \"x\" }\n"),
            "scene.toml:15: [cutting] remove: tool = \"x\": expected the name of a [[tool]] that is no blade: there is none",
        ),
        (
            with(
                "[[tool]]\nname = \"knife\"\nshape = { blade = { length = 0.02 } }\nstart = [0.0, 0.0, 0.0]\nhold = true\n",
            ),
            "scene.toml:16: [[tool]] 1: `shape` is a blade, which cuts where [cutting] has tool = \"its name\" only",
        ),
        (
            with(
                "[[tool]]\nname = \"knife\"\nshape = { blade = { length = 0.02 } }\nstart = [0.0, 0.0, 0.0]\nhold = true\nfriction = 0.2\n[cutting]\ntool = \"knife\"\n",
            ),
            "scene.toml:19: [[tool]] 1: `friction` does not go with a tool that cuts, which touches nothing",
        ),
        (
            with(by_table),
            "scene.toml:15: [cutting]: strokes.csv:1: there is no row below the names of the columns: expected at least one",
        ),
        (
            row("1,0,0,0,0,0,1,0\n"),
            "scene.toml:15: [cutting]: strokes.csv:2: row 1: stroke 1 has this row only; a stroke needs two poses of the blade",
        ),
        (
            row("1,0,0,0,0,0,1,0\n1,0,1,0,0,1,1,0\n"),
            "scene.toml:15: [cutting]: strokes.csv:3: t_s = 0 does not come after 0, the time of the row before",
        ),
        (
            row("1,0,0,0,0,0,1,0\n1,1,1,0,0,2e6,1,0\n"),
            "scene.toml:15: [cutting]: strokes.csv:3: row 2: an end of the blade at 2e6 m: expected at most 1e6 m in size",
        ),
        (
            row("1,0,0,0,0,0,1,0\n1,1,1,0,0,nan,1,0\n"),
            "scene.toml:15: [cutting]: strokes.csv:3: bx_m is \"nan\": expected a finite number",
        ),
        (
            row(
                "1,0,0,0,0,0,1,0\n1,1,1,0,0,1,1,0\n2,2,0,0,0,0,1,0\n2,3,1,0,0,0,1,0\n1,4,0,0,0,0,1,0\n1,5,0,0,0,0,1,1\n",
            ),
            "scene.toml:15: [cutting]: strokes.csv:6: row 5: stroke 1 already ended in an earlier row; give the new stroke another number",
        ),
    ] {
        assert_eq!(said, expected);
    }
    let auto = bar(
        "[cutting]\n",
        "integrator = \"central-difference\"\ndt = \"auto\"\n",
    );
    let averaged = auto.replace("poissons_ratio", "element = \"fbar\"\npoissons_ratio");
    let said = refusal(&averaged, "");
    assert!(
        said.starts_with(
            "scene.toml:19: [run]: dt = \"auto\" finds no step that is stable after cuts"
        ),
        "{said}"
    );
    let oscillator = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n[cutting]\n[run]\nduration = 1.0\n\
                      integrator = \"central-difference\"\ndt = 0.01\n";
    assert_eq!(
        refusal(oscillator, ""),
        "scene.toml:6: `cutting` does not go with [oscillator]"
    );
}

#[test]
fn a_cut_that_leaves_nothing_ends_the_run_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let tool = "[[tool]]\nname = \"burner\"\nshape = { box = { size = [1.0, 1.0, 1.0] } }\nstart = [0.0, 0.0, 0.0]\nhold = true\n\
                [cutting]\nremove = { tool = \"burner\" }\n";
    let simulation = load(folder.path(), &bar(tool, EXPLICIT), "");
    let mut cutter: Cutter = simulation.cutter().unwrap().unwrap();
    let mut state = simulation.initial_state().clone();
    let ended = cutter.follow(simulation.body(), &mut state, Inputs::none(), 2e-4);
    let said = ended.err().unwrap().to_string();
    assert_eq!(said, "nothing that moves is left of the body");
}

/// The published bounds of a cube of 11^3 nodes at nu = .45: 1.216 ms by tetrahedra, 1.821 ms by the body.
#[test]
fn a_plan_shows_the_step_before_and_after_cuts_beside_that_of_the_body() {
    let text = "[mesh]\ncube = { cells = 10, edge = 0.1, split = \"kuhn\" }\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
                youngs_modulus = 3500.0\npoissons_ratio = 0.45\n[[fixed]]\ngroup = \"bottom\"\n[cutting]\n[run]\nduration = 0.1\n\
                integrator = \"central-difference\"\ndt = 0.001\n";
    let plan = build(text).plan();
    let section = plan
        .sections
        .iter()
        .find(|section| section.heading == "cutting");
    let lines = &section.unwrap().lines;
    assert_eq!(lines[0], "by commands");
    assert!(lines[1].contains(": 0.001216 s;"), "{lines:?}");
    assert!(lines[1].ends_with(" 0.001821 s"), "{lines:?}");
}

#[test]
fn the_certificate_counts_steps_before_and_after_cuts() {
    let folder = tempfile::tempdir().unwrap();
    let cutting = "[cutting]\ntable = \"strokes.csv\"\n";
    let text = bar(cutting, "integrator = \"cnn-energy\"\ndt = 1e-3\n");
    let mut run = following(load(folder.path(), &text, &across(0.01, 0.02)));
    advance(&mut run, 40);
    assert_eq!(run.cutter().unwrap().pieces(), 2);
    let said = run.integrator().remarks().join("\n");
    assert!(said.contains("in 40 steps it rose by"), "{said}");
}

/// Before the cut the strip has the stress of its law with nu = 0, P = mu (l - 1/l); after it the slit is open and the
/// strip softer.
#[test]
fn the_strip_is_pulled_as_its_law_says_and_its_slit_opens() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ready/slit.toml");
    let simulation = Scene::load(path).and_then(Scene::build).unwrap();
    let mass = simulation.model().body().unwrap().model.report().mass;
    let steps = simulation.run().steps;
    let mut run = following(simulation);
    // The blade begins in the middle of the duration.
    advance(&mut run, steps / 2);
    let (stretch, mu) = (1.1, 3500.0 / 2.0);
    let pull = mu * (stretch - 1.0 / stretch) * 0.04 * 0.01;
    let force = |run: &World| run.reactions().unwrap()[3].force[0];
    is_near(force(&run), pull, 1e-3);
    assert_eq!(run.cutter().unwrap().totals().changes, 0);
    advance(&mut run, steps - steps / 2);
    let after = force(&run) / pull;
    assert!(
        (0.2..0.8).contains(&after),
        "{after} {:?} {}",
        run.cutter().unwrap().totals(),
        run.state().t()
    );
    let totals = *run.cutter().unwrap().totals();
    // From an edge to the middle, through all of the thickness, as the mesh has it.
    is_near(totals.report.area, 0.02 * 0.01, 0.3);
    is_near(totals.blade_work, 50.0 * totals.report.area, 1e-12);
    is_near(run.cutter().unwrap().mass(), mass, 1e-12);
    // Both lips at the edge, of which one has the probe, are apart by more than half of what the ends are pulled.
    let cut = run.body().model().body().unwrap();
    let mut places = vec![[0.0; 3]; cut.mesh.points.len()];
    let (t, u) = (run.state().t(), &run.state().u);
    cut.model.positions(t, u, &mut places).unwrap();
    let from = cut.cut.as_ref().unwrap();
    let own = run.body().probes()[0].nodes[0].index;
    let origin = from.cut.origins[own as usize];
    let copies = (0..)
        .zip(&from.cut.origins)
        .filter(|(_, other)| **other == origin);
    let x: Vec<f64> = copies
        .map(|(node, _): (usize, _)| places[node][0])
        .collect();
    assert_eq!(x.len(), 2);
    assert!((x[0] - x[1]).abs() > 0.004, "{x:?}");
}

fn is_near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value / expected - 1.0).abs() < tolerance,
        "{value} {expected}"
    );
}
