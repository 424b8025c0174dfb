//! The reference of scenes and their JSON schema in `docs`.

use std::fs;
use std::path::Path;

use crate::common::sinew;

#[track_caller]
fn assert_is_printed(file: &str, arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), arguments);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs")
        .join(file);
    let kept = fs::read_to_string(path).unwrap_or_default();
    assert!(
        kept == said.out,
        "docs/{file} differs from what `sinew {}` prints; `cargo xtask reference` writes it anew",
        arguments.join(" ")
    );
}

#[test]
fn the_reference_is_what_the_command_prints() {
    assert_is_printed("scene-reference.md", &["scene-reference"]);
}

#[test]
fn the_schema_is_what_the_command_prints() {
    assert_is_printed("scene.schema.json", &["scene-reference", "--json-schema"]);
}
