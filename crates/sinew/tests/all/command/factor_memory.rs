//! Factors that take more memory than they may.

use std::fs;

use crate::common::{Said, sinew};

const SCENE: &str = "gravity = [0.0, 0.0, -9.81]\n[mesh]\ncube = { cells = 6, edge = 0.1 }\n[[region]]\ndensity = 1000.0\n\
                     model = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[probe]]\n\
                     name = \"top\"\npoint = [0.05, 0.05, 0.1]\n[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.01\n";

fn says(arguments: &[&str]) -> Said {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let (verb, rest) = arguments.split_first().unwrap();
    let said = sinew(folder.path(), &[&[*verb, "scene.toml"], rest].concat());
    match *verb {
        // Lines of a plan are broken anywhere.
        "plan" => Said {
            out: said.out.split_whitespace().collect::<Vec<_>>().join(" "),
            ..said
        },
        _ => said,
    }
}

/// The numbers of a table after its head.
fn numbers(table: &str) -> Vec<f64> {
    let rows = table.lines().skip(1).flat_map(|row| row.split(','));
    rows.map(|number| number.parse().unwrap()).collect()
}

#[test]
fn a_linear_body_is_solved_without_a_factor_and_that_is_said() {
    let direct = says(&["run"]);
    let iterated = says(&["run", "--set", "run.memory=0.1"]);
    for said in [&direct, &iterated] {
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    assert!(
        !direct.err.contains("conjugate gradients"),
        "{}",
        direct.err
    );
    let remark = "equations were solved by conjugate gradients, in ";
    assert!(iterated.err.contains(remark), "{}", iterated.err);
    let (one, other) = (numbers(&direct.out), numbers(&iterated.out));
    assert_eq!(one.len(), other.len());
    let largest = one.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (a, b) in one.iter().zip(&other) {
        assert!((a - b).abs() < 1e-9 * largest, "{a} {b}");
    }
}

#[test]
fn modes_are_found_without_a_factor() {
    let [direct, iterated] = [
        &["modes", "--count", "6"][..],
        &["modes", "--count", "6", "--set", "run.memory=0.1"],
    ]
    .map(says);
    for said in [&direct, &iterated] {
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    // To all digits that are shown; shapes of modes of one frequency are any that span the same motions.
    let frequencies = |said: &Said| -> Vec<String> {
        let rows = said.out.lines().skip(2);
        rows.filter_map(|row| row.split_whitespace().nth(1).map(str::to_owned))
            .collect()
    };
    assert_eq!(frequencies(&direct).len(), 6, "{}", direct.out);
    assert_eq!(frequencies(&direct), frequencies(&iterated));
}

#[test]
fn a_force_law_goes_on_without_a_factor_unless_it_is_asked_for() {
    let law = [
        "--set",
        "region.1.model=neo-hookean",
        "--set",
        "run.memory=0.1",
    ];
    let said = says(&[&["run", "--set", "run.factor=always"][..], &law].concat());
    assert_ne!(said.code, Some(0), "{}", said.err);
    assert!(
        said.err.contains("MB of memory are left") && said.err.contains("memory = "),
        "{}",
        said.err
    );
    let said = says(&[&["run"][..], &law].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let said = says(&[&["plan"][..], &law].concat());
    assert!(
        said.out.contains("more than there is: steps do without it"),
        "{}{}",
        said.out,
        said.err
    );
}

#[test]
fn a_plan_tells_the_size_of_the_factor() {
    let said = says(&["plan"]);
    assert!(said.out.contains("factor: about "), "{}", said.out);
    let said = says(&["plan", "--set", "run.memory=0.1"]);
    assert!(
        said.out.contains("conjugate gradients take its place"),
        "{}",
        said.out
    );
    let explicit = [
        "plan",
        "--set",
        "run.integrator=central-difference",
        "--set",
        "run.dt=1e-4",
    ];
    let said = says(&explicit);
    assert!(!said.out.contains("factor: about"), "{}", said.out);
}
