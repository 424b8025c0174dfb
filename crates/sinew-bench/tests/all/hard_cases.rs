//! The quick hard cases: every mark that does not take long is passed.

use std::path::Path;

use sinew_bench::hard::HardBench;
use sinew_bench::results::{BenchResults, Mark, MarkVerdict};
use sinew_bench::{BenchError, machine};
use sinew_measure::RowVerdict;

fn quick() -> BenchResults {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let bench = HardBench {
        scenes,
        quick: true,
    };
    bench.run("test".into(), machine(), |_| ()).unwrap()
}

fn mark<'a>(results: &'a BenchResults, case: &str) -> &'a Mark {
    let mut marks = results.marks.iter();
    marks.find(|mark| mark.case.starts_with(case)).unwrap()
}

/// One test, because all of it is one run.
#[test]
fn the_quick_marks_are_passed_and_tell_what_they_measured() {
    let results = quick();
    let failed: Vec<&Mark> = results.failed_marks().collect();
    assert!(failed.is_empty(), "{failed:#?}");
    let count = |verdict| {
        results
            .marks
            .iter()
            .filter(|mark| mark.verdict == verdict)
            .count()
    };
    assert_eq!(count(MarkVerdict::Pass), 20);

    // 5.92 % is the figure of an independent implementation of the same network.
    let reproduction = mark(&results, "the reproduction scene");
    assert!((reproduction.figure.unwrap() - 0.0592).abs() < 5e-5);
    assert!(reproduction.by.starts_with("cnn-stabilised block"));

    // The paper's network ends as it is published to: bounded by its clamp, everywhere wrong.
    let rows: Vec<_> = results.rows_of("paper-cube").collect();
    let paper = rows.iter().find(|row| row.integrator == "cnn").unwrap();
    assert_eq!(paper.verdict(), RowVerdict::Guarded);
    assert!((paper.step_over_critical.unwrap() - 2.527).abs() < 1e-3);

    // A diverged run stands among the others and stops nothing.
    let diverged = rows
        .iter()
        .position(|row| row.verdict() == RowVerdict::Diverged)
        .unwrap();
    assert!(diverged + 1 < rows.len());

    // Theory against measurement: inside its stable step no run of central difference is unbounded.
    let map = results.maps.first().unwrap();
    let panels = map
        .panels
        .iter()
        .filter(|panel| panel.method == "central-difference");
    let mut inside = 0;
    let mut beyond = 0;
    for panel in panels {
        for (limit, runs) in panel.stable_steps.iter().zip(&panel.runs) {
            for (dt, run) in map.steps.iter().zip(runs) {
                if *dt <= limit.unwrap() {
                    assert!(run.bounded, "{dt} s is within {limit:?} s");
                    inside += 1;
                } else if *dt > 1.1 * limit.unwrap() {
                    assert!(!run.bounded, "{dt} s is beyond {limit:?} s");
                    beyond += 1;
                }
            }
        }
    }
    assert!(inside > 0 && beyond > 0);

    // What was measured can be kept and read.
    let json = results.to_json().unwrap();
    assert_eq!(BenchResults::from_json(&json).unwrap(), results);
}

/// A folder with the quick hard scenes, apart from one.
fn scenes_without(missing: &str) -> tempfile::TempDir {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().unwrap();
    for from in ["scenes", "scenes/hard", "meshes"] {
        let to = folder.path().join(from);
        std::fs::create_dir_all(&to).unwrap();
        for entry in std::fs::read_dir(root.join(from)).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_file() && entry.file_name() != missing {
                std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
            }
        }
    }
    folder
}

#[test]
fn a_hard_scene_that_cannot_be_read_fails_its_own_marks_only() {
    let folder = scenes_without("nearly-free.toml");
    let bench = HardBench {
        scenes: folder.path().join("scenes"),
        quick: true,
    };
    let results = bench.run("test".into(), machine(), |_| ()).unwrap();
    let missing = results.all_missing();
    assert_eq!(missing.len(), 1, "{missing:#?}");
    assert!(missing[0].scene.ends_with("nearly-free.toml"));
    let failed: Vec<&Mark> = results.failed_marks().collect();
    assert_eq!(failed.len(), 1, "{failed:#?}");
    assert_eq!(failed[0].case, "nearly free body, pulse");
    assert_eq!(failed[0].measured, "nearly-free was not read");
    assert_eq!(results.maps.len(), 1);
}

#[test]
fn without_any_hard_scene_there_are_no_results() {
    let folder = tempfile::tempdir().unwrap();
    let bench = HardBench {
        scenes: folder.path().to_owned(),
        quick: true,
    };
    let error = bench.run("test".into(), machine(), |_| ()).unwrap_err();
    assert!(matches!(error, BenchError::Cases(cases) if cases.len() > 5));
}
