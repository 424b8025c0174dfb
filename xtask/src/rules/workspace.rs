//! The crates of the workspace and their dependencies, as reported by cargo.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::breach::RuleError;

/// A crate of the workspace.
#[derive(Debug, Default)]
pub(super) struct Package {
    pub(super) name: String,
    /// Names of the crates that it needs to be built for its users.
    pub(super) needs: Vec<String>,
    /// Names of the crates that only its tests, examples and benches need.
    pub(super) tests_need: Vec<String>,
    /// True if it is published: not `publish = false`.
    pub(super) is_published: bool,
}

/// The crates of the workspace in a folder, without the examples, which are written as if they were outside the
/// repository.
pub(super) fn packages(root: &Path) -> Result<Vec<Package>, RuleError> {
    let text = cargo(root, &["metadata", "--no-deps", "--format-version", "1"])?;
    let metadata: Value = serde_json::from_str(&text).map_err(|error| RuleError::Cargo {
        command: "metadata".into(),
        reason: error.to_string(),
    })?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let examples = root.join("examples");
    let ours = packages.filter(|value| {
        let manifest = value["manifest_path"].as_str().unwrap_or_default();
        !Path::new(manifest).starts_with(&examples)
    });
    Ok(ours.map(package).collect())
}

fn package(value: &Value) -> Package {
    let name = |value: &Value| value["name"].as_str().unwrap_or_default().to_owned();
    let dependencies = value["dependencies"].as_array();
    let of_kind = |is_for_tests: bool| {
        let dependencies = dependencies.into_iter().flatten();
        let wanted = dependencies.filter(|other| (other["kind"] == "dev") == is_for_tests);
        wanted.map(name).collect()
    };
    Package {
        name: name(value),
        needs: of_kind(false),
        tests_need: of_kind(true),
        is_published: value["publish"].is_null(),
    }
}

/// The standard output of a cargo command that is run in `root`.
pub(super) fn cargo(root: &Path, arguments: &[&str]) -> Result<String, RuleError> {
    let failed = |reason: String| RuleError::Cargo {
        command: arguments.join(" "),
        reason,
    };
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(root)
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
