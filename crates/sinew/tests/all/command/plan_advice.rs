//! `sinew plan --tolerance`, as a user meets it.

use crate::common::{Said, sinew};
use serde_json::Value;

const SPRING: &str = "title = \"a spring\"
[oscillator]
mass = 0.1
stiffness = 100.0
damping = 1.0
velocity = -5.0
[run]
duration = 1.0
integrator = \"cnn\"
dt = 0.02
saturation = 4.0
";

/// Runs `sinew plan` on a scene.
fn plan(scene: &str, arguments: &[&str]) -> Said {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), scene).unwrap();
    let arguments: Vec<&str> = ["plan", "scene.toml"]
        .into_iter()
        .chain(arguments.iter().copied())
        .collect();
    sinew(directory.path(), &arguments)
}

#[test]
fn the_advice_runs_when_it_is_pasted_and_its_error_stands_next_to_its_cost() {
    let said = plan(SPRING, &["--tolerance", "1e-2"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let (plan, advice) = said
        .out
        .split_once("cheapest with an error of at most 1 %")
        .unwrap();
    assert!(plan.contains("`cnn` is stable up to dt = 0.01 s"), "{plan}");
    let head = advice.lines().next().unwrap();
    assert!(
        head.contains(" % at ") && head.ends_with(" CPU s/s)"),
        "{head}"
    );
    for part in [
        "runner-up",
        "as written",
        "426",
        "guarded",
        "ten times better (0.1 %)",
    ] {
        assert!(advice.contains(part), "{part} is not in\n{advice}");
    }

    let table = &advice[advice.find("[run]").unwrap()..];
    let table = &table[..table.find("\n\n").unwrap()];
    let scene = format!("{}{table}\n", &SPRING[..SPRING.find("[run]").unwrap()]);
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("advised.toml"), &scene).unwrap();
    let run = sinew(directory.path(), &["run", "advised.toml"]);
    assert_eq!(run.code, Some(0), "{scene}\n{}", run.err);
}

#[test]
fn as_json_it_is_one_object_with_the_same_run() {
    let said = plan(SPRING, &["--tolerance", "1e-3", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let advice: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(advice["met"], true);
    let error = advice["advised"]["row"]["error"].as_f64().unwrap();
    assert!(error > 0.0 && error <= 1e-3);
    let table = advice["advised"]["run_table"].as_str().unwrap();
    assert!(table.starts_with("[run]\nduration = 1.0\nsamples = 50\nintegrator = "));
    assert_eq!(advice["as_written"]["row"]["guarded"], true);
    let missing = advice["missing"].as_array().unwrap();
    let budget = missing.iter().find(|m| m["field"] == "budget_cpu_s_per_s");
    assert_eq!(budget.unwrap()["reason"], "no budget was asked for");
}

/// A cube that settles, and is pressed ten times as hard long after the pilots' time is up.
const PRESSED_LATE: &str = "title = \"pressed late\"
[mesh]
cube = { cells = 6, edge = 0.1 }
[[region]]
group = \"tissue\"
density = 1060.0
model = \"linear\"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 2.0
[[fixed]]
group = \"sides\"
[[load]]
group = \"top\"
traction = [0.0, 0.0, -20.0]
ramp = { kind = \"sin2\", rise = 0.5 }
[[load]]
group = \"top\"
traction = [0.0, 0.0, -200.0]
ramp = { kind = \"pulse\", from = 300.0, to = 300.13 }
[run]
duration = 400.0
samples = 4000
integrator = \"central-difference\"
dt = 0.005
";

const HASTY: [&str; 4] = ["--tolerance", "1e-2", "--pilot-seconds", "1"];

#[test]
fn where_loads_change_after_the_pilots_the_first_line_says_up_to_when_the_advice_holds() {
    let said = plan(PRESSED_LATE, &HASTY);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let advice = &said.out[said.out.find("\ncheapest with ").unwrap()..];
    let first = advice.trim_start().lines().next().unwrap();
    let start = "cheapest with an error of at most 1 % up to t = ";
    let end = " s of 400 s, before loads change at t = 300 s and 300.13 s: ";
    assert!(first.starts_with(start) && first.contains(end), "{first}");
    assert!(
        first.contains(" % expected by 400 s but for later loads, at "),
        "{first}"
    );
    for part in [
        "expected",
        "no short run covers the loads from t = 300 s and 300.13 s on",
    ] {
        assert!(advice.contains(part), "{part} is not in\n{advice}");
    }
}

#[test]
fn met_is_true_only_where_the_whole_scene_was_followed() {
    let said = plan(PRESSED_LATE, &[&HASTY[..], &["--json"]].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let part: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(part["met"], false);
    assert_eq!(part["duration_s"], 400.0);
    assert!(part["advised"]["run_table"].is_string());
    let until = part["met_until_s"].as_f64().unwrap();
    assert!(0.0 < until && until < 300.0, "{until}");
    assert_eq!(part["unseen_load_changes_s"][0], 300.0);
    let row = &part["advised"]["row"];
    assert!(row["expected_error"].as_f64() >= row["error"].as_f64());

    let said = plan(SPRING, &["--tolerance", "1e-2", "--json"]);
    let whole: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(whole["met"], true);
    assert_eq!(whole["met_until_s"], whole["duration_s"]);
    assert_eq!(whole["unseen_load_changes_s"].as_array().unwrap().len(), 0);
}

#[test]
fn what_no_budget_buys_is_an_answer_too() {
    let said = plan(SPRING, &["--tolerance", "1e-2", "--budget", "1e-12"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let answer = "nothing measured has an error of at most 1 % within 1e-12 CPU s/s; nearest: ";
    assert!(said.out.contains(answer), "{}", said.out);
    assert!(said.out.contains("no sound run is within the budget"));
    assert!(!said.out.contains("\n[run]\n"), "nothing to paste");
}

#[test]
fn a_question_without_an_answer_is_refused_with_what_to_ask() {
    let tolerance = "expected a fraction above 0 and below 1, such as 1e-2";
    let budget = "expected finite CPU seconds per simulated second above 0";
    let cases: [(&[&str], &str); 10] = [
        (&["--tolerance", "0"], tolerance),
        (&["--tolerance", "-1e-2"], tolerance),
        (&["--tolerance", "1"], tolerance),
        (&["--tolerance", "nan"], tolerance),
        (
            &["--tolerance", "small"],
            "expected a number, such as 1e-2 or 1%",
        ),
        (
            &["--tolerance", "150%"],
            "a tolerance of 1.5: expected a fraction",
        ),
        (&["--tolerance", "1e-2", "--budget", "0"], budget),
        (&["--tolerance", "1e-2", "--budget", "-1"], budget),
        (&["--tolerance", "1e-2", "--budget", "inf"], budget),
        (
            &["--tolerance", "1e-2", "--pilot-seconds", "0"],
            "expected a finite time above 0 s",
        ),
    ];
    for (arguments, expected) in cases {
        let said = plan(SPRING, arguments);
        assert_eq!(said.code, Some(2), "{arguments:?}");
        assert!(said.err.contains(expected), "{arguments:?}: {}", said.err);
        assert_eq!(said.err.matches("error:").count(), 1, "{}", said.err);
        assert_eq!(said.out, "", "{arguments:?}");
    }
}

#[test]
fn a_scene_without_a_reference_says_what_to_do() {
    let cases = [
        (
            "velocity = -5.0",
            "velocity = 0.0",
            "give it a load or an initial state",
        ),
        (
            "stiffness = 100.0",
            "stiffness = 1e40",
            "shorten [run] duration",
        ),
    ];
    for (from, to, expected) in cases {
        assert!(SPRING.contains(from));
        let said = plan(
            &SPRING.replace(from, to),
            &["--tolerance", "1e-2", "--json"],
        );
        assert_eq!(said.code, Some(2), "{to}");
        assert!(said.err.starts_with("error: scene.toml: "), "{}", said.err);
        assert!(said.err.contains(expected), "{to}: {}", said.err);
        assert_eq!(said.err.matches("error:").count(), 1, "{}", said.err);
        assert_eq!(said.out, "", "{to}");
    }
}

#[test]
fn a_budget_alone_is_a_question_and_json_has_the_plan_beside_its_answer() {
    let said = plan(SPRING, &["--budget", "1"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(
        said.out.contains("most accurate with at most 1 CPU s/s: "),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("\n[run]\n") && !said.out.contains("ten times"),
        "{}",
        said.out
    );

    let said = plan(SPRING, &["--budget", "1", "--json"]);
    let object: Value = serde_json::from_str(&said.out).unwrap();
    assert!(object["advised"]["row"]["cpu_s_per_s"].as_f64().unwrap() <= 1.0);
    let missing = object["missing"].as_array().unwrap();
    assert!(missing.iter().any(|entry| entry["field"] == "tolerance"));
    assert_eq!(object["plan"]["steps"], 50);
    let sweeps = object["plan"]["cost"]["time"]["sweeps"].as_f64().unwrap();
    assert!((45.0..110.0).contains(&sweeps), "{sweeps}");
}
