//! Messages about input that has no effect, or that loads tissue beyond its limits.

use std::fs;

use crate::common::sinew;

const BODY: &str = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                    youngs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n";

const RUN: &str = "[run]\nduration = 0.05\nintegrator = \"central-difference\"\ndt = 0.001\n";

const WEIGHT: &str = "gravity = [0.0, 0.0, -9.81]\n";

/// Code and standard error of a command on a scene.
fn says(scene: &str, files: &[(&str, &str)], arguments: &[&str]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    let (verb, rest) = arguments.split_first().unwrap();
    let said = sinew(folder.path(), &[&[*verb, "scene.toml"], rest].concat());
    (said.code, said.err + &said.out)
}

/// A run and its messages without its table.
fn run(scene: &str, files: &[(&str, &str)]) -> String {
    let (code, said) = says(scene, files, &["run", "--probes", "probes.csv"]);
    assert_eq!(code, Some(0), "{said}");
    let (code, with_folder) = says(scene, files, &["run", "--out", "out"]);
    assert_eq!(code, Some(0), "{with_folder}");
    for line in said.lines().filter(|line| line.starts_with("warning: ")) {
        let is_known = line.contains("no [[probe]]") || with_folder.contains(line);
        assert!(is_known, "{line}\n--\n{with_folder}");
    }
    said
}

#[test]
fn a_body_on_which_nothing_acts_is_named() {
    let scene = format!("{BODY}{RUN}");
    let said = run(&scene, &[]);
    assert!(said.contains("warning: nothing acts on the body"), "{said}");
    let (code, plan) = says(&scene, &[], &["plan"]);
    assert_eq!(code, Some(0), "{plan}");
    assert!(plan.contains("nothing acts on the body"), "{plan}");
    for acting in [
        format!("{WEIGHT}{BODY}{RUN}"),
        format!("{BODY}[[load]]\ngroup = \"top\"\npressure = 1.0\n{RUN}"),
        format!("{BODY}[[move]]\ngroup = \"top\"\naxes = \"z\"\nvelocity = [0.0, 0.0, 0.1]\n{RUN}"),
        format!("{BODY}[[initial]]\nvelocity = [0.0, 0.0, 0.1]\n{RUN}"),
    ] {
        let said = run(&acting, &[]);
        assert!(!said.contains("nothing acts"), "{acting}\n{said}");
    }
}

#[test]
fn tools_blades_and_burners_that_meet_no_body_are_named() {
    let tool = |start: &str| {
        format!(
            "{BODY}[[tool]]\nname = \"ball\"\nshape = {{ sphere = {{ radius = 0.02 }} }}\nstart = {start}\n\
             velocity = [0.0, 0.0, -0.1]\n{RUN}"
        )
    };
    let never = "tool `ball` pushed no node";
    let said = run(&tool("[0.05, 0.05, 0.3]"), &[]);
    assert!(said.contains(never), "{said}");
    let said = run(&tool("[0.05, 0.05, 0.121]"), &[]);
    assert!(!said.contains(never), "{said}");

    let blade = |x: f64| {
        format!(
            "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,0,{x},-0.01,0.12,{x},0.11,0.12\n1,0.04,{x},-0.01,0.06,{x},0.11,0.06\n"
        )
    };
    let scene = format!("{WEIGHT}{BODY}[cutting]\ntable = \"blade.csv\"\n{RUN}");
    let uncut = "nothing was cut: what [cutting] names met no face";
    let said = run(&scene, &[("blade.csv", &blade(0.3))]);
    assert!(said.contains(uncut), "{said}");
    let said = run(&scene, &[("blade.csv", &blade(0.05))]);
    assert!(!said.contains(uncut), "{said}");
    let burner = |start: &str| {
        format!(
            "{WEIGHT}{BODY}[cutting]\nremove = {{ tool = \"burner\" }}\n[[tool]]\nname = \"burner\"\n\
             shape = {{ sphere = {{ radius = 0.05 }} }}\nstart = {start}\nhold = true\n{RUN}"
        )
    };
    assert!(run(&burner("[0.05, 0.05, 0.3]"), &[]).contains(uncut));
    assert!(!run(&burner("[0.05, 0.05, 0.1]"), &[]).contains(uncut));
    let said = run(&format!("{WEIGHT}{BODY}[cutting]\n{RUN}"), &[]);
    assert!(said.contains("[cutting] names nothing that cuts"), "{said}");
}

#[test]
fn a_load_that_no_tissue_bears_is_named_where_the_step_is_stable() {
    let scene = format!("{BODY}[[load]]\ngroup = \"top\"\npressure = 6e7\n{RUN}");
    let (code, said) = says(&scene, &[], &["run"]);
    assert_eq!(code, Some(1), "{said}");
    for part in [
        "warning: [[load]] 1 on `top` is out of proportion: its stress of 6e7 Pa is 12000 times the Young's modulus",
        "error: the run diverged",
        "[[load]] 1 on `top` is out of proportion",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert!(!said.contains("names the stable step"), "{said}");
    let long = format!("{BODY}[[load]]\ngroup = \"top\"\npressure = 60.0\n{RUN}");
    let (code, said) = says(
        &long,
        &[],
        &["run", "--dt", "0.05", "--set", "run.duration=5"],
    );
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("`sinew plan` names the stable step"),
        "{said}"
    );
    // Soft as nothing is: five pascals under its own weight.
    let soft = format!("{WEIGHT}{BODY}{RUN}").replace("5000.0", "5.0");
    let (_, said) = says(&soft, &[], &["run"]);
    assert!(said.contains("gravity is out of proportion"), "{said}");
}

#[test]
fn a_step_of_the_command_line_in_the_place_of_auto_is_said() {
    let text = format!("{WEIGHT}{BODY}{RUN}").replace("dt = 0.001", "dt = \"auto\"");
    let stiffening = text.replace("linear", "neo-hookean");
    let said_of = |arguments: &[&str]| {
        let (code, said) = says(
            &stiffening,
            &[],
            &[&["run", "--probes", "p.csv"], arguments].concat(),
        );
        assert_eq!(code, Some(0), "{said}");
        said.contains("is replaced by a step that is not cut")
    };
    assert!(said_of(&["--dt", "0.0005"]));
    assert!(said_of(&["--set", "run.dt=0.0005"]));
    assert!(!said_of(&["--dt", "auto"]));
    assert!(!said_of(&["--dt", "0.0005", "--set", "run.substeps=auto"]));
    assert!(!said_of(&[]));
}

#[test]
fn one_thread_is_what_every_method_takes() {
    for entry in sinew_integrators::entries() {
        let id = entry.id;
        let scene = format!("{WEIGHT}{BODY}[[load]]\ngroup = \"top\"\npressure = 1.0\n{RUN}");
        for threads in ["1", "auto"] {
            let set = format!("run.integrator={id}");
            let arguments = [
                "run",
                "--probes",
                "p.csv",
                "--dt",
                "1e-4",
                "--threads",
                threads,
                "--set",
                &set,
            ];
            let (_, said) = says(&scene, &[], &arguments);
            assert!(!said.contains("no option `threads`"), "{id}: {said}");
        }
    }
}

#[test]
fn a_table_of_the_command_line_is_added_to_the_scene() {
    let scene = format!("{BODY}{RUN}");
    let arguments = [
        "run",
        "--probes",
        "p.csv",
        "--set",
        "load.1.group=top",
        "--set",
        "load.1.pressure=10",
    ];
    let (code, said) = says(
        &scene,
        &[],
        &[&arguments[..], &["--set", "damping.mass=2"]].concat(),
    );
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("nothing acts"), "{said}");
    let (code, said) = says(&scene, &[], &["run", "--set", "lod.1.group=top"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("did you mean `load`?"), "{said}");
}
