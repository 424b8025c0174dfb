//! The picture of large deformations.

use std::path::Path;

use sinew_bench::nonlinear::picture;

/// The picture remains in `target/tmp` for inspection.
#[test]
fn the_picture_says_its_error_and_is_small() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let svg = picture(&scenes).unwrap();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("large-deformation.svg");
    std::fs::write(path, &svg).unwrap();
    assert!(svg.len() < 100_000, "{}", svg.len());
    assert!(svg.contains("error over the run") && !svg.contains("left out"));
}
