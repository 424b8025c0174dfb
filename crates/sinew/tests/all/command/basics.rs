//! The `sinew` command, as a user meets it.

use std::path::{Path, PathBuf};

use crate::common::sinew;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../scenes")
        .join(name)
}

#[test]
fn plan_says_what_is_removed_and_which_step_is_stable() {
    let directory = tempfile::tempdir().unwrap();
    let cube = scene("paper-cube.toml");
    let said = sinew(directory.path(), &["plan", cube.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for part in ["3993 -> 2673", "16.2 N act", "stable up to dt = 0.00125"] {
        assert!(said.out.contains(part), "{part} is not in\n{}", said.out);
    }
}

/// The paper's cube by another integrator, written into a directory.
fn cube_by(directory: &Path, integrator: &str) {
    let text = std::fs::read_to_string(scene("paper-cube.toml")).unwrap();
    let mesh = scene("../meshes/paper-cube.msh");
    let text = text
        .replace("../meshes/paper-cube.msh", mesh.to_str().unwrap())
        .replace("integrator = \"cnn\"", integrator)
        .replace("saturation", "# saturation");
    std::fs::write(directory.join("cube.toml"), text).unwrap();
}

/// The paper's Eqs. 5 to 7 with Q = 4 m/s and a step of 20 ms; memory counted by hand: u, v and the
/// mass read, f(v), u and v written, 11247 blocks of 3 x 3 numbers and a column for 891 cells.
#[test]
fn plan_prints_the_program_of_the_papers_network() {
    let directory = tempfile::tempdir().unwrap();
    let cube = scene("paper-cube.toml");
    let said = sinew(
        directory.path(),
        &["plan", cube.to_str().unwrap(), "--program"],
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    let vectors = 6 * 3 * 8;
    let blocks = 11247.0 / 891.0 * 76.0;
    let memory = format!(
        "memory a cell and step: {:.0} bytes = {vectors} of vectors",
        f64::from(vectors) + blocks
    );
    for part in [
        "program of `cnn`, dt = 0.02 s",
        "q = M^-1 (F(t) - K u - 80 M v)",
        "f(v) <- f(v) clamped: each component at most 4",
        "u <- u + 0.02 f(v)",
        "v <- v + 0.02 q",
        "1 sweep over neighbours, 1 pass over the cells",
        &memory,
    ] {
        assert!(said.out.contains(part), "{part} is not in\n{}", said.out);
    }
}

#[test]
fn plan_prints_a_program_as_one_json_object() {
    let directory = tempfile::tempdir().unwrap();
    cube_by(directory.path(), "integrator = \"central-difference\"");
    let said = sinew(
        directory.path(),
        &["plan", "cube.toml", "--program", "--json"],
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let sweep = &object["program"]["step"][0];
    // The kick dt/(1 + alpha dt/2) of the textbook.
    let kick = sweep["updates"][0]["of_q"].as_f64().unwrap();
    assert!((kick - 0.02 / (1.0 + 80.0 * 0.01)).abs() < 1e-15, "{kick}");
    assert_eq!(sweep["minus_stiffness"]["of"], "u");
    assert_eq!(sweep["own"][0]["per_mass"], -80.0);
}

#[test]
fn a_guards_limits_in_the_program_are_those_of_the_motions_start() {
    let directory = tempfile::tempdir().unwrap();
    let scene = "[oscillator]\nmass = 0.1\nstiffness = 100\ndamping = 0\nvelocity = -5\n\
        [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = 0.05\nsaturation = \"auto\"\n";
    std::fs::write(directory.path().join("thrown.toml"), scene).unwrap();
    let said = sinew(
        directory.path(),
        &["plan", "thrown.toml", "--program", "--json"],
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let limit = object["program"]["limits_m_s"][0].as_f64().unwrap();
    // It sets out with 5 m/s, and the guard leaves room above that.
    assert!((5.0..500.0).contains(&limit), "{limit}");
}

#[test]
fn the_stabilising_blocks_are_printed() {
    let directory = tempfile::tempdir().unwrap();
    cube_by(directory.path(), "integrator = \"cnn-stabilised\"");
    let said = sinew(
        directory.path(),
        &["plan", "cube.toml", "--program", "--json"],
    );
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let blocks = object["program"]["p_inverse_per_kg"].as_array().unwrap();
    let first = blocks[0].as_array().unwrap();
    assert_eq!(first.len(), 9);
    // Symmetric, and below the inverse of the mass.
    assert_eq!(first[1], first[3]);
    assert!(first[0].as_f64().unwrap() > 0.0);
}

#[test]
fn plan_says_why_a_method_has_no_program() {
    let directory = tempfile::tempdir().unwrap();
    for (integrator, why) in [
        (
            "integrator = \"newmark\"",
            "`newmark` has no program: each step solves equations",
        ),
        (
            "integrator = \"propagator\"\nkind = \"krylov\"",
            "`propagator` has no program: in a Krylov space",
        ),
        (
            "integrator = \"cnn-stabilised\"\ninner = { kind = \"gauss-seidel\", sweeps = 2 }",
            "`cnn-stabilised` has no program: a Gauss-Seidel iteration",
        ),
    ] {
        cube_by(directory.path(), integrator);
        let said = sinew(directory.path(), &["plan", "cube.toml", "--program"]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(said.out.contains(why), "{}", said.out);
        let said = sinew(
            directory.path(),
            &["plan", "cube.toml", "--program", "--json"],
        );
        let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        assert!(object["program"].is_null());
        assert!(object["reason"].is_string());
    }
}

#[test]
fn run_writes_the_probes_and_calls_a_guarded_run_guarded() {
    let directory = tempfile::tempdir().unwrap();
    let cube = scene("paper-cube.toml");
    let said = sinew(directory.path(), &["run", cube.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.err.contains("guarded: 76.6"), "{}", said.err);
    let csv = said.out;
    assert_eq!(csv.lines().count(), 52);
    assert!(csv.starts_with("t_s,top-centre_u_x_m"));
}

/// The top of a cube is pressed down: the supports below and above it have opposite forces once it rests, except for
/// the remaining motion.
#[test]
fn run_ends_with_the_force_of_each_support_and_motion() {
    let directory = tempfile::tempdir().unwrap();
    let pressed = scene("moved-top.toml");
    let said = sinew(directory.path(), &["run", pressed.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let mut warnings = said
        .err
        .lines()
        .filter(|line| line.starts_with("warning: "));
    let warning = warnings.next().unwrap();
    assert!(warning.starts_with("warning: [[region]] 1 has poissons_ratio = 0.45"));
    // A tenth of the height is much for the linear theory.
    let warning = warnings.next().unwrap();
    assert!(warning.contains("a principal strain of 16 %"), "{warning}");
    assert_eq!(warnings.next(), None);
    let force = |begin: &str| -> f64 {
        let line = said.err.lines().find(|line| line.starts_with(begin));
        let numbers = line.and_then(|line| Some(line.split_once('(')?.1.split_once(')')?.0));
        let z = numbers.and_then(|numbers| numbers.split(", ").nth(2));
        z.unwrap_or_else(|| panic!("{}", said.err)).parse().unwrap()
    };
    let (below, above) = (
        force("[[fixed]] 1 on `bottom`"),
        force("[[move]] 1 on `top`"),
    );
    // Stiffer than a bar that is free at its sides, softer than one that cannot get wider.
    let (free, confined) = (3.5, 3.5 * 0.55 / (1.45 * 0.1));
    assert!(free < below && below < confined, "{below} {above}");
    assert!((below + above).abs() < 0.05 * below, "{below} {above}");
    let csv = said.out;
    assert!(
        csv.lines().last().unwrap().ends_with(",0.0,0.0,-0.01"),
        "{csv}"
    );
    let plan = sinew(directory.path(), &["plan", pressed.to_str().unwrap()]);
    let line = "moves       `top` in x, y, z, 25 nodes: to [0, 0, -0.01] m rising for 0.2 s";
    assert!(plan.out.contains(line), "{}", plan.out);
}

#[test]
fn run_says_into_how_many_parts_the_guard_cut_each_step() {
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("paper-cube.toml")).unwrap();
    let mesh = scene("../meshes/paper-cube.msh");
    let text = text
        .replace("../meshes/paper-cube.msh", mesh.to_str().unwrap())
        .replace("\"cnn\"", "\"forward-euler\"")
        .replace("saturation = 4.0", "saturation = \"auto\"");
    std::fs::write(directory.path().join("guarded.toml"), &text).unwrap();
    let said = sinew(directory.path(), &["run", "guarded.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let cut = "the guard took each step in 18 parts: whole, it is longer than the stable step of `forward-euler`";
    assert!(said.err.contains(cut), "{}", said.err);
    assert!(!said.err.contains("guarded:"), "{}", said.err);
    // Uncut steps are not mentioned.
    let text = text.replace("dt = 0.02", "dt = 0.001");
    std::fs::write(directory.path().join("guarded.toml"), text).unwrap();
    let said = sinew(directory.path(), &["run", "guarded.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for part in ["the guard", "guarded:"] {
        assert!(!said.err.contains(part), "{}", said.err);
    }
}

#[test]
fn a_diverging_run_says_so_keeps_what_it_has_and_fails() {
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("paper-cube.toml")).unwrap();
    let mesh = scene("../meshes/paper-cube.msh");
    let text = text
        .replace("../meshes/paper-cube.msh", mesh.to_str().unwrap())
        .replace("integrator = \"cnn\"", "integrator = \"forward-euler\"")
        .replace("saturation", "# saturation");
    std::fs::write(directory.path().join("euler.toml"), text).unwrap();
    let said = sinew(directory.path(), &["run", "euler.toml"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("diverged at t = 0.16"), "{}", said.err);
    let rows: Vec<&str> = said.out.lines().collect();
    assert_eq!(rows.len(), 9, "a head, the start and 7 steps of 20 ms");
    assert!(rows[8].starts_with("0.14,"), "{}", rows[8]);
}

#[test]
fn a_diverged_run_without_a_folder_ends_with_the_divergence_alone() {
    let directory = tempfile::tempdir().unwrap();
    let text = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 5000.0\n\
                poissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[[probe]]\nname = \"top\"\n\
                point = [0.0, 0.0, 0.1]\n[run]\nduration = 10.0\nintegrator = \"central-difference\"\ndt = 0.05\n";
    std::fs::write(directory.path().join("cube.toml"), text).unwrap();
    let said = sinew(directory.path(), &["run", "cube.toml", "--probes", "u.csv"]);
    let errors = said.err.lines().filter(|line| line.starts_with("error:"));
    let errors: Vec<&str> = errors.collect();
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(
        matches!(errors[..], [error] if error.starts_with("error: the run diverged at t = ")),
        "{}",
        said.err
    );
    assert!(!said.out.contains("reaction"), "{}", said.out);
}

/// Tissue as soft as water under its own weight, and a linear body whose top is moved through its bottom.
#[test]
fn a_run_without_a_folder_warns_of_what_one_with_a_folder_warns_of() {
    let body = |law: &str, tables: &str| {
        format!(
            "gravity = [0.0, 0.0, -9.81]\n[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\n{law}\n\
             [damping]\nmass = 5.0\n[[fixed]]\ngroup = \"bottom\"\n{tables}[run]\nduration = 0.5\ndt = 0.01\n\
             integrator = \"newmark\"\n[[probe]]\nname = \"p\"\npoint = [0.05, 0.05, 0.05]\n"
        )
    };
    let soft = "model = \"linear\"\nyoungs_modulus = 5.0\npoissons_ratio = 0.3";
    let firm = "model = \"linear\"\nyoungs_modulus = 1e5\npoissons_ratio = 0.3";
    let through = "[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, -0.15]\nramp = { kind = \"sin2\", rise = 0.4 }\n";
    let directory = tempfile::tempdir().unwrap();
    for (text, said_of) in [
        (body(soft, ""), "inside out"),
        (body(firm, through), "inside out"),
    ] {
        std::fs::write(directory.path().join("s.toml"), text).unwrap();
        let run = |arguments: &[&str]| {
            let said = sinew(directory.path(), &[&["run", "s.toml"], arguments].concat());
            assert_eq!(said.code, Some(0), "{}", said.err);
            let lines = said.err.lines().filter(|line| line.contains("warning:"));
            lines.map(str::to_owned).collect::<Vec<String>>()
        };
        let (in_folder, alone) = (run(&["--out", "r"]), run(&["--probes", "p.csv"]));
        assert_eq!(alone, in_folder);
        for words in ["principal strain", said_of] {
            assert!(
                alone.iter().any(|line| line.contains(words)),
                "{words}: {alone:?}"
            );
        }
    }
}

#[test]
fn bad_input_gives_one_error_with_file_and_line_and_writes_nothing() {
    let cases = [
        (
            "dt = 0.02 ",
            "dt = -0.02 ",
            "scene.toml:10: [run]: dt = -0.02",
        ),
        (
            "mass = 0.1",
            "mass = nan",
            "scene.toml:3: [oscillator]: mass",
        ),
        (
            "\"cnn\"",
            "\"cn\"",
            "scene.toml:9: [run]: unknown integrator `cn`",
        ),
        (
            "saturation",
            "saturatoin",
            "scene.toml:11: [run]: `cnn` has no option `saturatoin`",
        ),
        (
            "duration = 1.0",
            "duration = 0",
            "scene.toml:8: [run]: duration = 0",
        ),
        ("[run]", "[runn]", "scene.toml:7: unknown key `runn`"),
    ];
    let scene = "title = \"a spring\"\n[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n[run]\nduration = 1.0\nintegrator = \"cnn\"\ndt = 0.02 \nsaturation = 4.0\n";
    for (from, to, expected) in cases {
        let directory = tempfile::tempdir().unwrap();
        assert!(scene.contains(from));
        std::fs::write(directory.path().join("scene.toml"), scene.replace(from, to)).unwrap();
        let said = sinew(directory.path(), &["run", "scene.toml"]);
        assert_eq!(said.code, Some(2), "{to}");
        assert!(said.err.contains(expected), "{to}: {}", said.err);
        assert_eq!(said.err.matches("error:").count(), 1);
        assert_eq!(said.out, "");
        let files = std::fs::read_dir(directory.path()).unwrap().count();
        assert_eq!(files, 1, "{to}: only the scene itself");
    }
}

#[test]
fn a_run_that_would_end_at_a_jump_is_refused_before_it_begins() {
    let directory = tempfile::tempdir().unwrap();
    let scene = r#"
title = "a late tap"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[[load]]
name = "tap"
group = "top"
traction = [0.0, 0.0, -100.0]
ramp = { kind = "pulse", from = 0.9, to = 0.913 }
[run]
duration = 1.0
integrator = "propagator"
kind = "two-step"
dt = 0.02
"#;
    std::fs::write(directory.path().join("tap.toml"), scene).unwrap();
    let said = sinew(directory.path(), &["run", "tap.toml"]);
    assert_eq!(said.code, Some(2), "{}", said.out);
    let expected = "`propagator` takes loads that are constant over each step, and [[load]] \"tap\" changes at t = 0.913 s, in steps of 0.02 s; dt = 0.001 s would do";
    assert!(said.err.contains(expected), "{}", said.err);
    assert_eq!(said.err.matches("error:").count(), 1);
    assert_eq!(said.out, "");
}

#[test]
fn a_missing_scene_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let said = sinew(directory.path(), &["plan", "nowhere.toml"]);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("nowhere.toml"), "{}", said.err);
}

#[test]
fn every_integrator_is_listed() {
    let directory = tempfile::tempdir().unwrap();
    let said = sinew(directory.path(), &["integrators"]);
    for id in sinew::integrators::ids() {
        assert!(said.out.contains(id));
    }
    let advice: Vec<&str> = said.out.lines().take(8).collect();
    assert_eq!((advice[0], advice[7]), ("Which one do I take?", ""));
    assert!(said.out.lines().count() < 40, "{}", said.out);
    let each = sinew::integrators::ids().into_iter().map(|id| {
        let said = sinew(directory.path(), &["integrators", id]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(said.out.starts_with(&format!("{id}: ")), "{}", said.out);
        said.out
    });
    let all = each.collect::<Vec<_>>().concat();
    let words = all.split_whitespace().collect::<Vec<_>>().join(" ");
    let guards = words.matches("saturation guard").count();
    assert_eq!(guards, 6, "{all}");
    let orders = words.matches("with stiffness damping or dashpots: order");
    assert_eq!(orders.count(), 12, "{all}");
    let refused = "with stiffness damping: exact; with dashpots: refused";
    assert!(words.contains(refused), "{all}");
    let said = sinew(directory.path(), &["integrators", "newmrk"]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err.contains("a similar value exists: 'newmark'"),
        "{}",
        said.err
    );
}
