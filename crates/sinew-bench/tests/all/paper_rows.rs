//! Rows of the bench on the paper's two scenes, against the figures known for them.

use std::path::PathBuf;
use std::sync::OnceLock;

use sinew_bench::results::BenchResults;
use sinew_bench::{Bench, default_steps};
use sinew_measure::{Row, RowOutcome, RowVerdict};
use sinew_verify::Machine;
use sinew_verify::Progress;

fn scene(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../scenes")
        .join(name)
}

fn run(name: &str, integrators: &[&str], steps: &[f64]) -> BenchResults {
    let bench = Bench {
        scenes: vec![scene(name)],
        integrators: integrators.iter().map(|id| (*id).to_owned()).collect(),
        steps: steps.to_vec(),
        quick: true,
    };
    bench
        .run("test".into(), Machine::default(), |_| {})
        .unwrap()
}

fn cube() -> &'static BenchResults {
    static RESULTS: OnceLock<BenchResults> = OnceLock::new();
    RESULTS.get_or_init(|| run("paper-cube.toml", &[], &default_steps(0.02, true)))
}

fn row(integrator: &str, dt: f64) -> &'static Row {
    let rows = cube().rows.iter();
    let mut rows = rows.filter(|row| row.integrator == integrator && (row.dt - dt).abs() < 1e-9);
    rows.next().unwrap()
}

fn close(value: f64, expected: f64, relative: f64) {
    assert!(
        (value / expected - 1.0).abs() <= relative,
        "{value} instead of {expected}"
    );
}

#[test]
fn the_papers_network_at_20_ms_is_bounded_wrong_and_never_settles() {
    let row = row("cnn", 0.02);
    close(row.error.unwrap(), 25.2, 0.02);
    assert_eq!(row.inverted, 1676);
    close(row.saturated, 0.766, 1e-3);
    close(row.max_u.unwrap(), 0.160, 5e-3);
    close(row.late_amplitude.unwrap(), 0.080, 5e-3);
    assert!(row.bounded && !row.settles && row.guarded);
    assert_eq!(row.verdict(), RowVerdict::Guarded);
    assert_eq!(
        (row.steps, row.work.sweeps, row.sweeps_per_s),
        (50, 50, 50.0)
    );
    assert_eq!(row.label(), "cnn Q=4");
}

#[test]
fn forward_euler_at_20_ms_diverges_and_the_bench_goes_on() {
    let row = row("forward-euler", 0.02);
    assert_eq!(row.outcome, RowOutcome::Diverged);
    assert_eq!(row.error, None);
    assert!(!row.bounded && !row.settles);
    assert!(row.diverged_at_s.unwrap() < 0.5);
    let rows = &cube().rows;
    let at = rows.iter().position(|other| other == row).unwrap();
    let later = &rows[at + 1..];
    assert!(later.iter().any(|row| row.outcome == RowOutcome::Finished));
    assert_eq!(cube().skipped, []);
}

/// Every integrator, and the variants for other parts of the front, in three steps each.
#[test]
fn every_method_runs() {
    let mut expected: Vec<String> = sinew_integrators::ids()
        .iter()
        .map(|id| match *id {
            "cnn" | "cnn-symplectic" => format!("{id} Q=4"),
            id => id.to_owned(),
        })
        .collect();
    for kind in ["chebyshev 4", "chebyshev 8"] {
        expected.push(format!("cnn-stabilised {kind}"));
    }
    for kind in [
        "two-step",
        "two-step tolerance=0.001",
        "two-step fit=load",
        "krylov",
    ] {
        expected.push(format!("propagator {kind}"));
    }
    expected.push("modal vectors=ritz".to_owned());
    let mut found: Vec<String> = cube().rows.iter().map(Row::label).collect();
    assert_eq!(found.len(), 3 * expected.len());
    found.sort();
    found.dedup();
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn the_reference_knows_its_own_error_and_the_case_its_facts() {
    let case = cube().case("paper-cube").unwrap();
    assert_eq!(case.dofs, 2673);
    assert!(case.reference_error < 1e-10);
    close(case.max_u_m, 0.0169, 1e-3); // still creeping towards .01695
    close(case.critical_step_s.unwrap(), 0.0079, 3e-3);
}

/// The error is computed over all steps if dt does not divide the distance between the instants.
#[test]
fn the_papers_oscillator_at_15_ms_is_compared_at_every_step() {
    let results = run(
        "paper-oscillator.toml",
        &["cnn", "central-difference"],
        &[0.015],
    );
    assert_eq!(results.rows[0].steps, 67);
    close(results.rows[0].error.unwrap(), 3.496, 1e-3);
    close(results.rows[1].error.unwrap(), 0.0542, 1e-3);
}

#[test]
fn what_cannot_be_asked_is_refused_before_anything_runs() {
    let refused = |integrator: &str, dt: f64, scene: PathBuf| {
        let bench = Bench {
            scenes: vec![scene],
            integrators: vec![integrator.to_owned()],
            steps: vec![dt],
            quick: true,
        };
        let mut begun = Vec::new();
        let outcome = bench.run("test".into(), Machine::default(), |progress| {
            begun.push(progress);
        });
        let runs = begun
            .iter()
            .filter(|progress| matches!(progress, Progress::Run { .. }));
        assert_eq!(runs.count(), 0, "{begun:?}");
        outcome.unwrap_err().to_string()
    };
    let paper = || scene("paper-oscillator.toml");
    assert!(refused("cn", 0.02, paper()).starts_with("unknown integrator `cn`; there are"));
    assert_eq!(
        refused("cnn", -0.02, paper()),
        "--dt -0.02: expected a finite step above 0 s"
    );
    assert!(refused("cnn", 0.02, scene("none.toml")).contains("none.toml"));
}
