//! The quick bench of scenes with tools.

use std::path::Path;

use sinew_bench::hands::HandsBench;
use sinew_bench::machine;
use sinew_bench::report::html;
use sinew_bench::results::Mark;

/// One test, because all of it is one run.
#[test]
fn the_quick_marks_are_passed_and_methods_without_contact_are_listed_with_their_reason() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let bench = HandsBench {
        scenes,
        quick: true,
    };
    let results = bench.run("test".into(), machine(), |_| ()).unwrap();
    assert!(results.missing.is_empty());
    let failed: Vec<&Mark> = results.failed_marks().collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(results.marks.len(), 3);

    for case in ["press", "slide", "grasp"] {
        let mut rows = results.rows_of(case);
        let yardstick = rows.next().unwrap();
        assert_eq!(yardstick.cost_ratio, Some(1.0));
        assert!(yardstick.force_error.unwrap() < 0.05, "{yardstick:?}");
        let refused = results
            .skipped
            .iter()
            .find(|skipped| skipped.case == case && skipped.integrator == "rk4");
        assert!(refused.unwrap().reason.contains("tools push cells"));
    }

    let page = html(&results);
    for part in ["force err.", "largest", "id=\"marks\""] {
        assert!(page.contains(part), "{part}");
    }
}
