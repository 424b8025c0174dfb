//! Test that the names of integrators are in one list only.

use std::fs;
use std::path::{Path, PathBuf};

/// Lists of runs that concern particular methods.
const LISTS: [&str; 17] = [
    "sinew-bench/src/beside/simulators/own_runs.rs",
    "sinew-bench/src/verify/pressed.rs",
    "sinew-bench/src/kernels/laps.rs",
    "sinew-bench/src/kernels/pulled.rs",
    "sinew-bench/src/scale/methods.rs",
    "sinew-bench/src/scale/newmark.rs",
    "sinew-bench/src/hard/cases.rs",
    "sinew-bench/src/hard/methods.rs",
    "sinew-bench/src/hard/maps.rs",
    "sinew-bench/src/hard/checks/",
    "sinew-bench/src/hard/large/",
    "sinew-bench/src/nonlinear/methods.rs",
    "sinew-bench/src/planned/methods.rs",
    "sinew-bench/src/reproduce/",
    "sinew-bench/src/verify/subjects/",
    "sinew-bench/src/verify/quasi_static.rs",
    "sinew/src/command/live/papers_cube.rs",
];

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

/// The lines of code before the tests of a file.
fn code(text: &str) -> impl Iterator<Item = &str> {
    let code = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = code.unwrap_or_default().lines();
    lines.filter(|line| !line.trim_start().starts_with("//"))
}

#[test]
fn what_chooses_between_integrators_names_none() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for part in ["sinew-measure", "sinew-bench", "sinew-scene", "sinew"] {
        sources(&crates.join(part).join("src"), &mut files);
    }
    assert!(files.len() > 50, "{}", files.len());
    let quoted: Vec<String> = sinew_integrators::ids()
        .iter()
        .map(|id| format!("\"{id}\""))
        .collect();
    for file in files {
        let name = file.strip_prefix(&crates).unwrap().to_string_lossy();
        let name = name.replace('\\', "/");
        if LISTS.iter().any(|list| name.starts_with(list)) || name.ends_with("/tests.rs") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        for line in code(&text) {
            let named = quoted.iter().find(|id| line.contains(id.as_str()));
            assert_eq!(named, None, "{name}: {line}");
        }
    }
}
