//! `sinew compare`, `sinew modes` and values of the command line.

use crate::common::sinew;

const BEAM: &str = "[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                    youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\n\
                    group = \"top\"\npressure = 20.0\n[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.005\n\
                    [[probe]]\nname = \"top\"\npoint = [0.05, 0.05, 0.1]\n\
                    [output]\nfields = { frames = 10 }\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("beam.toml"), BEAM).unwrap();
    folder
}

#[test]
fn twice_as_stiff_is_half_as_far_and_the_folder_says_what_was_set() {
    let folder = folder();
    let run = |arguments: &[&str]| {
        let said = sinew(folder.path(), arguments);
        assert_eq!(said.code, Some(0), "{}", said.err);
    };
    let stiff = [
        "--set",
        "region.1.youngs_modulus=6e3",
        "--set",
        "region.1.density=2000",
    ];
    run(&["run", "beam.toml", "--out", "soft"]);
    run(&[&["run", "beam.toml", "--out", "stiff"][..], &stiff].concat());
    run(&[
        "run",
        "beam.toml",
        "--out",
        "other",
        "--integrator",
        "generalized-alpha",
        "--dt",
        "0.001",
    ]);

    // With both doubled all moves as before, half as far.
    let said = sinew(folder.path(), &["compare", "soft", "stiff", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let differences = object["differences"].as_array().unwrap();
    let top = differences
        .iter()
        .find(|difference| difference["quantity"] == "top_u")
        .unwrap();
    assert!(
        (top["relative"].as_f64().unwrap() - 0.5).abs() < 1e-9,
        "{top}"
    );

    let said = sinew(
        folder.path(),
        &["compare", "soft", "other", "--tolerance", "0.3"],
    );
    assert_eq!(said.code, Some(0), "{}\n{}", said.out, said.err);
    let said = sinew(
        folder.path(),
        &["compare", "soft", "stiff", "--tolerance", "0.3"],
    );
    assert_eq!(said.code, Some(1));
    assert!(
        said.err.contains("the results differ by") && said.out.contains("top_u"),
        "{}",
        said.err
    );

    let repeat = std::fs::read_to_string(folder.path().join("stiff/run.json")).unwrap();
    assert!(repeat.contains("region.1.youngs_modulus=6e3"), "{repeat}");
    let scene = std::fs::read_to_string(folder.path().join("stiff/scene.toml")).unwrap();
    assert_eq!(
        scene,
        BEAM.replace("= 3000.0", "= 6e3")
            .replace("= 1000.0", "= 2000")
    );
    assert_eq!(
        std::fs::read_to_string(folder.path().join("beam.toml")).unwrap(),
        BEAM
    );
}

#[test]
fn values_that_do_not_fit_are_one_error() {
    let folder = folder();
    let cases = [
        (
            "regoin.1.density=1",
            "the scene has no `regoin`; did you mean `region`?",
        ),
        (
            "region.3.density=1",
            "the scene has 1 of `region`, counted from 1",
        ),
        ("region.1.density=-1", "density = -1: expected"),
        ("run.dt", "expected KEY=VALUE"),
        ("run.integrator=newmakr", "unknown integrator `newmakr`"),
    ];
    for (value, expected) in cases {
        let said = sinew(
            folder.path(),
            &["run", "beam.toml", "--set", value, "--out", "out"],
        );
        assert_eq!(said.code, Some(2), "{value}");
        assert!(said.err.contains(expected), "{value}: {}", said.err);
        assert_eq!(said.err.matches("error:").count(), 1);
        assert!(!folder.path().join("out").exists());
    }
    let said = sinew(folder.path(), &["compare", "beam.toml", "."]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err.contains("the folder has no completed run"),
        "{}",
        said.err
    );
}

#[test]
fn modes_are_a_table_and_a_series() {
    let folder = folder();
    let said = sinew(
        folder.path(),
        &["modes", "beam.toml", "--count", "4", "--out", "modes"],
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    let rows = said
        .out
        .lines()
        .filter(|line| line.trim_start().starts_with(['1', '2', '3', '4']));
    assert_eq!(rows.count(), 4, "{}", said.out);
    for name in ["modes.csv", "fields.pvd", "fields/frame-00003.vtu"] {
        assert!(folder.path().join("modes").join(name).exists(), "{name}");
    }
    let table = std::fs::read_to_string(folder.path().join("modes/modes.csv")).unwrap();
    let rows = table.lines().skip(1);
    let rows: Vec<Vec<f64>> = rows
        .map(|row| row.split(',').map(|value| value.parse().unwrap()).collect())
        .collect();
    for pair in rows.windows(2) {
        assert!(0.0 < pair[0][1] && pair[0][1] <= pair[1][1], "{table}");
    }
    // A part of the mass, and most of it in the first modes.
    for axis in 3..6 {
        let sum: f64 = rows.iter().map(|row| row[axis]).sum();
        assert!((0.05..1.0).contains(&sum), "{table}");
    }
    for count in ["0", "-1", "many"] {
        let said = sinew(folder.path(), &["modes", "beam.toml", "--count", count]);
        assert_eq!(said.code, Some(2), "{count}");
    }
}

#[test]
fn two_values_for_one_key_are_refused_and_both_named() {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["new", "--ready", "held-cube"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for (values, both) in [
        (
            ["--dt", "0.01", "--set", "run.dt=0.02"],
            ["`--dt 0.01`", "`--set run.dt=0.02`"],
        ),
        (
            [
                "--integrator",
                "newmark",
                "--set",
                "run . integrator = \"rk4\"",
            ],
            [
                "`--integrator newmark`",
                "`--set run . integrator = \"rk4\"`",
            ],
        ),
        (
            ["--set", "run.duration=1", "--set", "run.duration=2"],
            ["`--set run.duration=1`", "`--set run.duration=2`"],
        ),
    ] {
        let said = sinew(
            folder.path(),
            &[&["run", "held-cube.toml"][..], &values].concat(),
        );
        assert_eq!(said.code, Some(2), "{}", said.err);
        assert!(
            both.iter().all(|one| said.err.contains(one)),
            "{}",
            said.err
        );
        assert_eq!(said.out, "");
    }
}

#[test]
fn a_negative_step_and_one_without_end_are_named_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["new", "--ready", "held-cube"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for (dt, expected) in [
        ("-1", "dt = -1: expected a finite step above 0 s"),
        ("1e-300", "takes 1.000e300 steps"),
    ] {
        let said = sinew(folder.path(), &["run", "held-cube.toml", "--dt", dt]);
        assert_eq!(said.code, Some(2), "{}", said.err);
        assert!(said.err.contains(expected), "{}", said.err);
        assert_eq!(said.out, "");
    }
}

#[test]
fn scenes_are_run_to_be_compared_and_leave_nothing() {
    let folder = folder();
    let temporary = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["run", "beam.toml", "--out", "kept"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    std::fs::write(
        folder.path().join("soft.toml"),
        BEAM.replace("3000.0", "1500.0"),
    )
    .unwrap();
    let compare = |one: &str, other: &str| {
        let output = assert_cmd::Command::cargo_bin("sinew")
            .unwrap()
            .current_dir(folder.path())
            .env("TMPDIR", temporary.path())
            .args(["compare", one, other, "--tolerance", "1e-9", "--json"])
            .output()
            .unwrap();
        let left = std::fs::read_dir(temporary.path()).unwrap().count();
        assert_eq!(left, 0, "something stayed");
        let object: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        (output.status.code(), object["largest_relative"].as_f64())
    };
    assert_eq!(compare("kept", "beam.toml"), (Some(0), Some(0.0)));
    assert_eq!(compare("beam.toml", "beam.toml"), (Some(0), Some(0.0)));
    let (code, difference) = compare("soft.toml", "kept");
    assert_eq!(code, Some(1));
    assert!(difference.unwrap() > 0.3);
    assert_eq!(compare("nowhere.toml", "kept").0, Some(2));
    assert_eq!(compare("nowhere", "kept").0, Some(2));
    let names = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(names, 3, "two scenes and what was kept");
}
