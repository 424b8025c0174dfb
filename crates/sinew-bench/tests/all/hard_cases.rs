//! The bench of hard cases without its scenes.

use sinew_bench::BenchError;
use sinew_bench::hard::HardBench;
use sinew_verify::machine;

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
