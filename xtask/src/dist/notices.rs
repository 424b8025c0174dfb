//! The licences of all packages that the command links, for the archive.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::programs::text_of;
use crate::failure::Failure;
use crate::repository::root;

/// Beginnings of the names of files that contain licences and notices.
const FILES: [&str; 5] = ["license", "licence", "copying", "copyright", "notice"];

/// Name of the file with the notices in the archive.
pub(super) const NAME: &str = "THIRD-PARTY-LICENSES.txt";

/// The C library, if it is part of the command.
const LIBC: &str = "the GNU C library, linked statically: LGPL-2.1-or-later, https://www.gnu.org/software/libc; the sources of sinew build the command with any \
                    other version of it\n";

/// A package that is linked.
#[derive(Debug, Default, PartialEq)]
struct Package {
    name: String,
    version: String,
    license: String,
    folder: String,
}

/// The text of all notices for a target, with or without the C library, and the number of packages: each licence text
/// once, with the packages that use it.
///
/// # Errors
/// [`Failure::Chore`] if cargo fails, and for a package without any licence.
pub(super) fn of(target: &str, has_libc: bool) -> Result<(String, usize), Failure> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .args([
            "metadata",
            "--format-version=1",
            "--locked",
            "--filter-platform",
            target,
        ])
        .current_dir(root());
    let metadata: Value = serde_json::from_str(&text_of(&mut cargo)?).map_err(Failure::chore)?;
    let packages = linked(&metadata, "sinew");
    let mut by_text: BTreeMap<String, Vec<&Package>> = BTreeMap::new();
    let mut list = String::new();
    for package in &packages {
        let Package {
            name,
            version,
            license,
            folder,
        } = package;
        if license.is_empty() {
            return Err(Failure::Chore(format!("{name} {version} names no licence")));
        }
        list.push_str(&format!("{name} {version}: {license}\n"));
        for text in texts(Path::new(folder))? {
            by_text.entry(text).or_default().push(package);
        }
    }
    if has_libc && target.contains("-gnu") {
        list.push_str(LIBC);
    }
    let page = root().join("crates/sinew-live/page/THREE-LICENSE");
    let page = fs::read_to_string(page).map_err(Failure::chore)?;
    let mut notices = format!(
        "sinew links the packages below, and its page holds three.js. Their licences follow.\n\n{list}\n{}\nthree.js, in the page of `sinew live`\n\n{page}\n",
        "-".repeat(80)
    );
    for (text, packages) in by_text {
        let names: Vec<String> = packages
            .iter()
            .map(|package| format!("{} {}", package.name, package.version))
            .collect();
        notices.push_str(&format!(
            "{}\n{}\n\n{}\n",
            "-".repeat(80),
            names.join(", "),
            text.trim_end()
        ));
    }
    Ok((notices, packages.len()))
}

/// The packages that a package links, from cargo's metadata: those of the registry that it reaches without development
/// and build dependencies, and procedural macros, whose generated code is part of it.
fn linked(metadata: &Value, from: &str) -> Vec<Package> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages = list(&metadata["packages"]);
    let nodes: BTreeMap<String, Value> = list(&metadata["resolve"]["nodes"])
        .into_iter()
        .map(|node| (text(&node["id"]), node))
        .collect();
    let first = packages.iter().find(|package| package["name"] == from);
    let mut waiting: Vec<String> = first.iter().map(|package| text(&package["id"])).collect();
    let mut reached = BTreeSet::new();
    while let Some(id) = waiting.pop() {
        if !reached.insert(id.clone()) {
            continue;
        }
        for dependency in nodes
            .get(&id)
            .map_or_else(Vec::new, |node| list(&node["deps"]))
        {
            let kinds = list(&dependency["dep_kinds"]);
            if kinds.iter().any(|kind| kind["kind"].is_null()) {
                waiting.push(text(&dependency["pkg"]));
            }
        }
    }
    let mut linked: Vec<Package> = packages
        .iter()
        .filter(|package| reached.contains(&text(&package["id"])) && !package["source"].is_null())
        .map(|package| Package {
            name: text(&package["name"]),
            version: text(&package["version"]),
            license: text(&package["license"]),
            folder: Path::new(&text(&package["manifest_path"]))
                .parent()
                .map_or_else(String::new, |folder| folder.display().to_string()),
        })
        .collect();
    linked.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    linked
}

/// Licences and notices in the folder of a package.
fn texts(folder: &Path) -> Result<BTreeSet<String>, Failure> {
    let mut texts = BTreeSet::new();
    for entry in fs::read_dir(folder).map_err(Failure::chore)? {
        let path = entry.map_err(Failure::chore)?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        if path.is_file() && FILES.iter().any(|begin| name.starts_with(begin)) {
            let text = fs::read(&path).map_err(Failure::chore)?;
            texts.insert(String::from_utf8_lossy(&text).replace("\r\n", "\n"));
        }
    }
    Ok(texts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_linked_is_found_and_what_tests_and_builds_need_is_not() {
        let metadata = serde_json::json!({
            "packages": [
                { "id": "own", "name": "own", "source": null },
                { "id": "a", "name": "a", "version": "1.0.0", "license": "MIT", "source": "r", "manifest_path": "/r/a/Cargo.toml" },
                { "id": "b", "name": "b", "version": "2.0.0", "license": "MIT", "source": "r", "manifest_path": "/r/b/Cargo.toml" },
                { "id": "c", "name": "c", "version": "3.0.0", "license": "MIT", "source": "r", "manifest_path": "/r/c/Cargo.toml" },
            ],
            "resolve": { "nodes": [
                { "id": "own", "deps": [
                    { "pkg": "a", "dep_kinds": [{ "kind": null }] },
                    { "pkg": "c", "dep_kinds": [{ "kind": "dev" }, { "kind": "build" }] },
                ] },
                { "id": "a", "deps": [{ "pkg": "b", "dep_kinds": [{ "kind": "build" }, { "kind": null }] }] },
                { "id": "b", "deps": [] },
                { "id": "c", "deps": [] },
            ] },
        });
        let linked = linked(&metadata, "own");
        let names: Vec<&str> = linked.iter().map(|package| package.name.as_str()).collect();
        assert_eq!(names, ["a", "b"]);
        assert_eq!(linked[0].folder, "/r/a");
    }
}
