//! The packages as users get them: every published crate is packed, and a program outside the workspace is built with
//! the packed crates and run.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::dist::finish;
use crate::failure::Failure;
use crate::repository::root;
use crate::rules;

/// The program: a scene through the facade, with a known figure.
const PROGRAM: &str = include_str!("../../consumer/main.rs");

/// Packs, unpacks, builds and runs.
///
/// # Errors
/// [`Failure::Chore`] for the first of these that fails.
pub(super) fn check() -> Result<(), Failure> {
    let names = rules::published(&root()).map_err(Failure::chore)?;
    let mut pack = Command::new(env!("CARGO"));
    pack.args(["package", "--no-verify", "--allow-dirty", "--quiet"]);
    for name in &names {
        pack.args(["-p", name]);
    }
    finish(pack.current_dir(root()))?;

    let folder = root().join("target/consumer");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(Failure::chore)?;
    }
    fs::create_dir_all(folder.join("src")).map_err(Failure::chore)?;
    let version = env!("CARGO_PKG_VERSION");
    for name in &names {
        let file = root().join(format!("target/package/{name}-{version}.crate"));
        finish(
            Command::new("tar")
                // With times of now, so that what an earlier run built of other content is not taken for theirs.
                .arg("-xzmf")
                .arg(file)
                .current_dir(&folder),
        )?;
    }
    let workspace = fs::read_to_string(root().join("Cargo.toml")).map_err(Failure::chore)?;
    let manifest = manifest(&names, version, &workspace);
    write(&folder, "Cargo.toml", &manifest)?;
    write(&folder, "src/main.rs", PROGRAM)?;
    // What others than sinew wrote is that of the workspace, and is not built again.
    let lock = fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock"));
    lock.map_err(Failure::chore)?;
    let mut run = Command::new(env!("CARGO"));
    run.args(["run", "--quiet", "--target-dir"])
        .arg(root().join("target"))
        .current_dir(&folder);
    finish(&mut run)
}

/// The manifest of a program that needs the facade and uses every crate as packed. Third-party crates have the flags
/// of the workspace and are shared with it; packed crates are built once, for this program alone, and as fast as
/// possible.
fn manifest(names: &[String], version: &str, workspace: &str) -> String {
    let mut text = format!(
        "[package]\nname = \"consumer\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n[workspace]\n\n\
         [dependencies]\nsinew = \"={version}\"\n\n[patch.crates-io]\n"
    );
    for name in names {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{name} = {{ path = \"{name}-{version}\" }}");
    }
    let profile = workspace.find("[profile.dev]").map(|at| &workspace[at..]);
    let lines = profile.unwrap_or_default().lines();
    for line in lines.filter(|line| !line.starts_with("sinew")) {
        text.push('\n');
        text.push_str(line);
    }
    text + "\n"
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    fs::write(folder.join(name), text).map_err(Failure::chore)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_takes_packed_crates_and_shares_all_others_with_the_workspace() {
        let names = ["sinew".to_owned(), "sinew-core".to_owned()];
        let workspace = "[workspace]\n\n[profile.release]\nx = 1\n\n[profile.dev]\nopt-level = 1\n\n\
                         [profile.dev.package]\nsinew-fem = { opt-level = 2 }\nsha2 = { opt-level = 1 }\n";
        let text = manifest(&names, "1.2.3", workspace);
        let manifest: toml::Table = text.parse().unwrap();
        assert_eq!(manifest["dependencies"]["sinew"].as_str(), Some("=1.2.3"));
        let patch = &manifest["patch"]["crates-io"];
        assert_eq!(
            patch["sinew-core"]["path"].as_str(),
            Some("sinew-core-1.2.3")
        );
        assert_eq!(
            manifest["profile"]["dev"]["opt-level"].as_integer(),
            Some(1)
        );
        assert!(manifest["profile"].get("release").is_none());
        let packages = manifest["profile"]["dev"]["package"].as_table();
        let names: Vec<&str> = packages.unwrap().keys().map(String::as_str).collect();
        assert_eq!(names, ["sha2"]);
    }
}
