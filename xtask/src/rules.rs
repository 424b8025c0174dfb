//! The rules of ARCHITECTURE.md that a machine can check.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::root;

/// A rule that is broken.
#[derive(Debug, thiserror::Error)]
pub(crate) enum RuleError {
    #[error("`cargo {command}` failed: {reason}")]
    Cargo { command: String, reason: String },
    #[error("{path}: {source}")]
    File {
        path: String,
        source: std::io::Error,
    },
    #[error("{0}")]
    Broken(String),
}

/// Which crates of the workspace each may depend on. Data walks one way; nothing walks back.
const ROOMS: &[(&str, &[&str])] = &[
    ("sinew-sparse", &[]),
    ("sinew-mesh", &[]),
    ("sinew-mesh-tests", &[]),
    ("sinew-core", &["sinew-sparse"]),
    ("sinew-fem", &["sinew-core", "sinew-mesh", "sinew-sparse"]),
    ("sinew-cnn", &["sinew-core", "sinew-sparse"]),
    (
        "sinew-integrators",
        &["sinew-core", "sinew-cnn", "sinew-sparse"],
    ),
    (
        "sinew-scene",
        &["sinew-core", "sinew-mesh", "sinew-fem", "sinew-integrators"],
    ),
    (
        "sinew-measure",
        &["sinew-core", "sinew-integrators", "sinew-scene"],
    ),
    (
        "sinew-bench",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-cnn",
            "sinew-integrators",
            "sinew-scene",
            "sinew-measure",
        ],
    ),
    (
        "sinew",
        &[
            "sinew-sparse",
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-cnn",
            "sinew-integrators",
            "sinew-scene",
            "sinew-measure",
        ],
    ),
    ("xtask", &["sinew-bench", "sinew-measure", "sinew-mesh"]),
];

/// Libraries that only one crate may name.
const PRIVATE: &[(&str, &str)] = &[("faer", "sinew-integrators"), ("nalgebra", "sinew-fem")];

/// Crates whose whole tree, default features on, is free of these libraries.
const LIGHT: &[&str] = &["sinew-core", "sinew-mesh"];
const HEAVY: &[&str] = &["faer", "nalgebra", "rayon"];

/// The most crates in sinew-mesh's tree, itself included.
const MESH_TREE: usize = 14;

/// Sources that read no clock and no file, so that they can run anywhere.
const PURE: &[&str] = &[
    "crates/sinew-sparse/src",
    "crates/sinew-core/src",
    "crates/sinew-fem/src",
    "crates/sinew-cnn/src",
    "crates/sinew-integrators/src",
];
const IMPURE: &[&str] = &["std::fs", "std::net", "std::process", "std::time"];

/// Names that must not stand in a public signature of the crates that use the libraries.
const FOREIGN: &[&str] = &[
    "faer::",
    "nalgebra::",
    "Vector3<",
    "Matrix3<",
    "MatRef<",
    "MatMut<",
];

pub(crate) fn check() -> Result<(), RuleError> {
    dependencies()?;
    light_trees()?;
    sources()?;
    architecture_paths()
}

fn dependencies() -> Result<(), RuleError> {
    let text = cargo(&["metadata", "--no-deps", "--format-version", "1"])?;
    let metadata: Value = serde_json::from_str(&text).map_err(|error| RuleError::Cargo {
        command: "metadata".into(),
        reason: error.to_string(),
    })?;
    let rooms: BTreeMap<&str, &[&str]> = ROOMS.iter().copied().collect();
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let name = package["name"].as_str().unwrap_or_default();
        let Some(allowed) = rooms.get(name) else {
            return broken(format!("crate `{name}` has no place in xtask/src/rules.rs"));
        };
        let dependencies = package["dependencies"].as_array().into_iter().flatten();
        for dependency in dependencies.filter(|dependency| dependency["kind"].is_null()) {
            let other = dependency["name"].as_str().unwrap_or_default();
            if rooms.contains_key(other) && !allowed.contains(&other) {
                return broken(format!("`{name}` must not depend on `{other}`"));
            }
            for (library, owner) in PRIVATE {
                if other == *library && name != *owner {
                    return broken(format!(
                        "only `{owner}` may depend on {library}, not `{name}`"
                    ));
                }
            }
        }
    }
    Ok(())
}

fn light_trees() -> Result<(), RuleError> {
    for package in LIGHT {
        // With the tests' needs for sinew-mesh, whose tests are a package of their own.
        let edges = if *package == "sinew-mesh" {
            "all"
        } else {
            "normal"
        };
        let tree = cargo(&["tree", "-p", package, "-e", edges, "--prefix", "none"])?;
        let mut names: Vec<&str> = tree
            .lines()
            .filter_map(|line| line.split_whitespace().next())
            .collect();
        names.sort_unstable();
        names.dedup();
        if let Some(heavy) = HEAVY.iter().find(|heavy| names.contains(heavy)) {
            return broken(format!("`{package}` pulls in {heavy}"));
        }
        if *package == "sinew-mesh" && names.len() > MESH_TREE {
            return broken(format!(
                "sinew-mesh pulls in {} crates, at most {MESH_TREE} are allowed",
                names.len()
            ));
        }
    }
    Ok(())
}

fn sources() -> Result<(), RuleError> {
    for directory in PURE {
        each_source(&root().join(directory), &mut |path, text| {
            let tests = text.find("#[cfg(test)]").unwrap_or(text.len());
            let code = &text[..tests];
            if let Some(word) = IMPURE.iter().find(|word| code.contains(**word)) {
                return broken(format!("{path} uses {word}"));
            }
            for signature in code.split("\n").filter(|line| {
                let line = line.trim_start();
                line.starts_with("pub ") && !line.starts_with("pub(")
            }) {
                if let Some(word) = FOREIGN.iter().find(|word| signature.contains(**word)) {
                    return broken(format!("{path}: `{}` shows {word}", signature.trim()));
                }
            }
            Ok(())
        })?;
    }
    Ok(())
}

fn each_source(
    directory: &Path,
    check: &mut dyn FnMut(&str, &str) -> Result<(), RuleError>,
) -> Result<(), RuleError> {
    for entry in read(directory, std::fs::read_dir(directory))? {
        let path = read(directory, entry)?.path();
        if path.is_dir() {
            each_source(&path, check)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = read(&path, std::fs::read_to_string(&path))?;
            check(&path.display().to_string(), &text)?;
        }
    }
    Ok(())
}

/// Every path that ARCHITECTURE.md names in backticks exists.
fn architecture_paths() -> Result<(), RuleError> {
    let path = root().join("ARCHITECTURE.md");
    let text = read(&path, std::fs::read_to_string(&path))?;
    for name in text.split('`').skip(1).step_by(2) {
        let is_path = name.contains('/') && !name.contains([' ', '(', '*', '<', '\n']);
        if is_path && !root().join(name).exists() {
            return broken(format!(
                "ARCHITECTURE.md names {name}, which does not exist"
            ));
        }
    }
    Ok(())
}

fn cargo(arguments: &[&str]) -> Result<String, RuleError> {
    let failed = |reason: String| RuleError::Cargo {
        command: arguments.join(" "),
        reason,
    };
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(root())
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn read<T>(path: &Path, result: std::io::Result<T>) -> Result<T, RuleError> {
    result.map_err(|source| RuleError::File {
        path: path.display().to_string(),
        source,
    })
}

fn broken(rule: String) -> Result<(), RuleError> {
    Err(RuleError::Broken(rule))
}
