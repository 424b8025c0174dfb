//! Strokes through bodies that move while they are cut.

use std::fs;

use crate::common::{advance, build, following, session};
use sinew_core::Inputs;
use sinew_scene::Scene;
use sinew_world::{Command, World};

const STROKES: &str = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n";

/// Runs a scene whose strokes are in a table: returns the number of pieces, and the messages about strokes.
fn cut(text: &str, strokes: &str) -> (usize, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(
        folder.path().join("strokes.csv"),
        format!("{STROKES}{strokes}"),
    )
    .unwrap();
    fs::write(&path, text).unwrap();
    let mut run = following(Scene::load(path).and_then(Scene::build).unwrap());
    let steps = run.scene().run().steps;
    advance(&mut run, steps);
    let cutter = run.cutter().unwrap();
    (cutter.pieces(), cutter.left_by_strokes())
}

fn cube(more: &str, run: &str) -> String {
    format!(
        "[mesh]\ncube = {{ cells = 4, edge = 0.1, split = \"kuhn\" }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 4000.0\n\
         poissons_ratio = 0.4\n{more}[run]\nfree_flight = true\n{run}"
    )
}

#[test]
fn a_stroke_through_a_free_cube_that_deforms_parts_it_by_every_method_with_and_without_moved_nodes()
{
    let strokes = "1,0.010,0.05,-0.01,0.2,0.05,0.11,0.2\n1,0.0115,0.05,-0.01,-0.1,0.05,0.11,-0.1\n";
    for method in ["implicit-euler", "central-difference"] {
        for snap in [0.0, 0.25] {
            let scene = cube(
                &format!(
                    "[[initial]]\nvelocity = [\"0.07*(z-0.05)/0.05\", 0.0, \"0.09*(z-0.05)/0.05\"]\n[cutting]\ntable = \"strokes.csv\"\nsnap = {snap}\n"
                ),
                &format!("duration = 0.014\nintegrator = \"{method}\"\ndt = 5e-4\n"),
            );
            assert_eq!(cut(&scene, strokes), (2, Vec::new()), "{method} {snap}");
        }
    }
}

#[test]
fn a_full_stroke_through_a_stretched_strip_leaves_no_bridge() {
    let strip = |strain: f64| {
        format!(
            "[mesh]\nblock = {{ cells = [8, 4, 2], size = [0.08, 0.04, 0.01] }}\n[[region]]\ndensity = 1060.0\nmodel = \"neo-hookean\"\n\
             youngs_modulus = 3500.0\npoissons_ratio = 0.0\n[damping]\nmass = 40.0\n[[fixed]]\nwhere = {{ below = {{ x = 0.0 }} }}\n[[move]]\n\
             where = {{ above = {{ x = 0.08 }} }}\naxes = \"x\"\ndisplacement = [{}, 0.0, 0.0]\nramp = {{ kind = \"sin2\", rise = 0.1 }}\n[cutting]\n\
             table = \"strokes.csv\"\nsnap = 0.25\n[run]\nduration = 0.5\nintegrator = \"central-difference\"\ndt = 1e-3\n",
            0.08 * strain
        )
    };
    for (strain, x) in [(0.1, 0.042), (0.25, 0.051)] {
        let strokes = format!(
            "1,0.2,{x},-0.005,-0.005,{x},-0.005,0.02\n1,0.48,{x},0.05,-0.005,{x},0.05,0.02\n"
        );
        assert_eq!(cut(&strip(strain), &strokes), (2, Vec::new()), "{strain}");
    }
}

/// A slow blade is followed every few steps. The reference is a blade that commands move in each step.
#[test]
fn a_slow_blade_cuts_what_one_cuts_that_is_followed_in_each_step() {
    let scene = |cutting: &str| {
        cube(
            &format!(
                "[damping]\nmass = 20.0\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, 150.0]\n[cutting]\n{cutting}"
            ),
            "duration = 0.45\nintegrator = \"central-difference\"\ndt = 5e-4\n",
        )
    };
    let (first, last, steps) = (0.13, 0.03, 800);
    let blade = |step: usize| {
        let z = first + (last - first) * step as f64 / steps as f64;
        [[0.052, -0.02, z], [0.052, 0.12, z]]
    };
    let mut driven = session(&scene(""));
    let mut changes = 0;
    for step in 0..900 {
        if step < steps {
            let (from, to) = (blade(step), blade(step + 1));
            driven.command(Command::Cut { from, to }).unwrap();
        }
        driven.step().unwrap();
        changes += usize::from(driven.change().is_some());
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let strokes = format!(
        "{STROKES}1,0.0,0.052,-0.02,{first},0.052,0.12,{first}\n1,0.4,0.052,-0.02,{last},0.052,0.12,{last}\n"
    );
    fs::write(folder.path().join("strokes.csv"), strokes).unwrap();
    fs::write(&path, scene("table = \"strokes.csv\"\n")).unwrap();
    let mut followed = following(Scene::load(path).and_then(Scene::build).unwrap());
    let mut calls = 0;
    let mut own_changes = 0;
    for _ in 0..900 {
        let (clock, dt) = (followed.state().clock, followed.dt());
        let cutter = followed.cutter().unwrap();
        calls += usize::from(cutter.idle_steps(clock, dt, followed.body(), Inputs::none()) == 0);
        followed.step().unwrap();
        own_changes += usize::from(followed.change().is_some());
    }
    assert!((100..200).contains(&calls), "followed {calls} times");
    let area = |world: &World| world.cuts().unwrap().report.area;
    assert!(area(&driven) > 0.005 && changes > 2, "{changes}");
    assert_eq!(area(&followed), area(&driven));
    // What is cut within eight steps is one change.
    assert!(
        (2..=changes).contains(&own_changes),
        "{own_changes} of {changes}"
    );
    // A delay by some steps of 900 of a motion whose size is 1.
    let largest = driven
        .state()
        .u
        .iter()
        .fold(0.0_f64, |most, u| most.max(u.abs()));
    let pairs = driven.state().u.iter().zip(&followed.state().u);
    let away = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(away < 0.01 * largest, "{away} of {largest} m");
    assert!(away > 0.0);
}

#[test]
fn a_cube_that_flies_through_a_resting_blade_is_parted() {
    let scene = cube(
        "[[initial]]\nvelocity = [0.0, 0.0, 2.0]\n[[tool]]\nname = \"scalpel\"\nshape = { blade = { length = 0.2 } }\nrotation = [1.5707963267948966, 0.0, 0.0]\n\
         start = [0.05, 0.05, 0.13]\nvelocity = [0.0, 0.0, 0.0]\n[cutting]\ntool = \"scalpel\"\nsnap = 0.25\n",
        "duration = 0.07\nintegrator = \"central-difference\"\ndt = 5e-4\n",
    );
    let mut run = following(build(&scene));
    let steps = run.scene().run().steps;
    advance(&mut run, steps);
    let cutter = run.cutter().unwrap();
    assert_eq!((cutter.pieces(), cutter.left_by_strokes()), (2, Vec::new()));
    assert!((cutter.totals().report.area - 0.01).abs() < 1e-6);
}

#[test]
fn what_a_hand_leaps_over_is_told_with_its_area_and_place() {
    let scene = cube(
        "[cutting]\n",
        "duration = 0.01\nintegrator = \"central-difference\"\ndt = 5e-4\n",
    );
    let simulation = build(&scene);
    let mut cutter = simulation.cutter().unwrap().unwrap();
    let mut state = simulation.initial_state().clone();
    let blade = |z: f64| [[0.05, -0.01, z], [0.05, 0.11, z]];
    let cut = cutter.cut(
        [blade(0.12), blade(0.07)],
        simulation.body(),
        &mut state,
        Inputs::none(),
    );
    let now = cut.unwrap().unwrap();
    assert_eq!(
        cutter.left_by_strokes(),
        Vec::<String>::new(),
        "it is in the body"
    );
    let cut = cutter.cut(
        [blade(0.03), blade(-0.02)],
        &now,
        &mut state,
        Inputs::none(),
    );
    assert!(cut.unwrap().is_some());
    let said = "strokes that came through the body left 0.005 m2 of it uncut, about [0.05, 0.05, 0.05] m: the parts to both sides hang together \
                there until a further stroke goes through";
    assert_eq!(cutter.left_by_strokes(), [said]);
    cutter.lift();
    assert_eq!(cutter.left_by_strokes(), [said]);
    let mut restored = simulation.cutter().unwrap().unwrap();
    restored.restore(&cutter.save(), simulation.body()).unwrap();
    assert_eq!(restored.left_by_strokes(), [said]);
}

/// A blade that moves down at x through a cube, four cells of 25 mm along an edge, that moves sideways: returns the
/// number of pieces, and the messages about strokes.
fn side_stroke(x: f64, split: &str) -> (usize, Vec<String>) {
    let scene = cube(
        "[[initial]]\nvelocity = [0.0, 0.2, 0.0]\n[cutting]\ntable = \"strokes.csv\"\nsnap = 0.0\n",
        "duration = 0.014\nintegrator = \"central-difference\"\ndt = 5e-4\n",
    );
    let scene = scene.replace("kuhn", split);
    let ends = |z: f64| format!("{x},-0.02,{z},{x},0.12,{z}");
    let strokes = format!("1,0.001,{}\n1,0.01,{}\n", ends(0.12), ends(-0.02));
    cut(&scene, &strokes)
}

#[test]
fn a_stroke_that_passes_less_than_half_a_cell_under_the_surface_and_cuts_nothing_is_told() {
    let (pieces, said) = side_stroke(0.003, "kuhn");
    assert_eq!((pieces, said.len()), (1, 1), "{said:?}");
    insta::assert_snapshot!(said[0], @"1 stroke cut nothing: by t = 0.0085 s the first one passed 0.003 m under the surface, about [0.0125, 0.0519, 0.05] m, where edges are up to 0.0433 m long; faces are cut by a blade that comes through tetrahedra, so that a finer mesh, or a stroke farther in, cuts");
    assert_eq!(
        side_stroke(-0.003, "kuhn"),
        (
            1,
            vec![
                "nothing was cut: what [cutting] names met no face and no middle of a tetrahedron"
                    .to_owned()
            ]
        ),
        "it passed beside"
    );
    assert_eq!(
        side_stroke(0.025, "kuhn"),
        (2, Vec::new()),
        "it cut off a layer"
    );
}

#[test]
fn chips_that_a_stroke_near_the_surface_cuts_off_are_told_with_place_and_size() {
    let (pieces, said) = side_stroke(0.011, "mirrored");
    assert!(pieces > 2, "{pieces} {said:?}");
    insta::assert_snapshot!(said.join("\n"), @r#"strokes cut off 3 chips of at most 8 tetrahedra, the first by t = 0.0085 s about [0.00625, 0.0269, 0.025] m: there they ran nearer to a surface than the mesh is fine; a finer mesh, or a stroke farther in, leaves none, and pieces = "remove" takes loose ones away"#);
}

/// Numbers from -1 to 1, by the constants of Knuth's generator MMIX.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.next())
    }
}

#[test]
fn full_strokes_that_leave_more_than_two_pieces_say_chips_and_others_do_not() {
    let along = |a: [f64; 3], b: [f64; 3], factor: f64| -> [f64; 3] {
        std::array::from_fn(|axis| a[axis] + factor * b[axis])
    };
    let cross = |a: [f64; 3], b: [f64; 3]| {
        let [[a, b, c], [d, e, f]] = [a, b];
        [b * f - c * e, c * d - a * f, a * e - b * d]
    };
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        a.map(|x| x / length)
    };
    let mut chipped = 0;
    for seed in 150..200 {
        let mut random = Random(seed);
        let normal = unit(random.vector());
        let across = unit(cross(normal, random.vector()));
        let ahead = cross(across, normal);
        let through = along([0.05; 3], random.vector(), 0.06);
        let ends = |share: f64| {
            let middle = along(through, ahead, share);
            let ends = [-0.3, 0.3].map(|half| along(middle, across, half));
            let ends = ends.as_flattened().iter();
            ends.map(ToString::to_string).collect::<Vec<_>>().join(",")
        };
        let strokes = format!("1,0.001,{}\n1,0.0075,{}\n", ends(-0.2), ends(0.2));
        let [a, b, c] = random.vector().map(|x| 6.0 * x);
        let velocity =
            format!("[\"{a} * (y - 0.05)\", \"{b} * (z - 0.05)\", \"{c} * (x - 0.05)\"]");
        let scene = cube(
            &format!(
                "[[initial]]\nvelocity = {velocity}\n[cutting]\ntable = \"strokes.csv\"\nsnap = {}\n",
                [0.0, 0.25][seed as usize / 2 % 2]
            ),
            "duration = 0.01\nintegrator = \"central-difference\"\ndt = 5e-4\n",
        );
        let split = ["kuhn", "mirrored"][seed as usize % 2];
        let (pieces, said) = cut(&scene.replace("kuhn", split), &strokes);
        chipped += usize::from(pieces > 2);
        let has_chips = said.iter().any(|said| said.contains("chip"));
        assert_eq!(pieces > 2, has_chips, "{seed}: {pieces} {said:?}");
        assert!(pieces != 2 || said.is_empty(), "{seed}: {said:?}");
    }
    assert!(chipped > 3, "{chipped}");
}
