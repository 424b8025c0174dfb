//! The quick bench of large deformations.

use std::path::Path;

use sinew_bench::machine;
use sinew_bench::nonlinear::{NonlinearBench, picture};
use sinew_bench::report::{brief, html};
use sinew_bench::results::Mark;

/// It is left in `target/tmp`, to be looked at.
#[test]
fn the_picture_says_its_error_and_is_small() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let svg = picture(&scenes).unwrap();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("large-deformation.svg");
    std::fs::write(path, &svg).unwrap();
    assert!(svg.len() < 100_000, "{}", svg.len());
    assert!(svg.contains("error over the run") && !svg.contains("left out"));
}

/// One test, because all of it is one run.
#[test]
fn the_quick_marks_are_passed_and_errors_are_those_in_print() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let bench = NonlinearBench {
        scenes,
        quick: true,
    };
    let results = bench.run("test".into(), machine(), |_| ()).unwrap();
    assert!(results.missing.is_empty() && results.skipped.is_empty());
    let failed: Vec<&Mark> = results.failed_marks().collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(results.marks.len(), 3);

    // Errors at 10 ms of an independent implementation of the same methods.
    for (id, error) in [("newmark", 0.0044), ("cnn-energy", 0.0178)] {
        let mut rows = results.rows_of("push");
        let row = rows.find(|row| row.integrator == id).unwrap();
        let found = row.error.unwrap();
        assert!((found - error).abs() < 0.03 * error, "{id}: {found}");
    }
    // The cost of the yardstick over itself.
    let yardstick = results.rows_of("push").next().unwrap();
    assert_eq!(yardstick.cost_ratio, Some(1.0));
    // The upper plate brings in energy that the body's own forces do not tell.
    assert!(
        results
            .rows_of("bonded-block")
            .all(|row| row.energy_rise.is_none())
    );

    let page = html(&results);
    for part in [
        "Large deformation",
        "energy rise",
        "least J",
        "id=\"marks\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(brief(&results).lines().count() <= 35);
}
