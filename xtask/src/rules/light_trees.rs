//! Crates that must remain cheap as dependencies.

use std::path::Path;

use super::breach::{Breach, RuleError};
use super::workspace::cargo;

/// A crate whose dependency tree is kept small.
pub(super) struct Light {
    name: &'static str,
    /// True if its default features are enabled.
    with_features: bool,
    /// Libraries, and features of any crate, that are not allowed in its tree.
    banned: &'static [&'static str],
    /// The largest number of crates in its tree, itself included, if limited.
    most: Option<usize>,
}

pub(super) const LIGHT: &[Light] = &[
    Light {
        name: "sinew-core",
        with_features: true,
        banned: HEAVY,
        most: None,
    },
    Light {
        name: "sinew-mesh",
        with_features: true,
        banned: HEAVY,
        most: Some(9),
    },
    Light {
        name: "sinew",
        with_features: false,
        banned: COMMAND,
        most: None,
    },
    Light {
        name: "sinew",
        with_features: true,
        banned: CHECKS,
        most: None,
    },
];

const HEAVY: &[&str] = &["faer", "nalgebra", "rayon"];

/// Libraries of the `sinew` command, on which the library of that name must not depend.
const COMMAND: &[&str] = &["clap", "comfy-table", "annotate-snippets", "axum", "tokio"];

/// Checks for tests, which a release does not need.
const CHECKS: &[&str] = &["\"conformance\"", "sinew-testkit", "proptest"];

/// Checks the trees of the light crates, without dependencies of their tests.
pub(super) fn check(root: &Path, crates: &[Light]) -> Result<Vec<Breach>, RuleError> {
    let mut breaches = Vec::new();
    for light in crates {
        let edges = "normal,features";
        let mut arguments = vec!["tree", "-p", light.name, "-e", edges, "--prefix", "none"];
        if !light.with_features {
            arguments.push("--no-default-features");
        }
        breaches.extend(check_tree(light, &cargo(root, &arguments)?));
    }
    Ok(breaches)
}

/// Checks a tree as `cargo tree --prefix none` prints it, with features in lines such as `sinew-cnn feature
/// "conformance"`.
fn check_tree(light: &Light, tree: &str) -> Vec<Breach> {
    let first_words = tree
        .lines()
        .filter_map(|line| line.split_whitespace().next());
    let mut names: Vec<&str> = first_words.collect();
    names.sort_unstable();
    names.dedup();
    let features = tree
        .lines()
        .filter_map(|line| line.split_whitespace().nth(2));
    let features: Vec<&str> = features.filter(|word| word.starts_with('"')).collect();
    let is_there = |banned: &&&str| names.contains(*banned) || features.contains(*banned);
    let heavy = light.banned.iter().filter(is_there);
    let mut breaches: Vec<Breach> = heavy
        .map(|library| Breach::Heavy {
            name: light.name,
            library,
        })
        .collect();
    let count = names.len();
    if let Some(most) = light.most.filter(|most| count > *most) {
        breaches.push(Breach::ManyCrates {
            name: light.name,
            count,
            most,
        });
    }
    breaches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    fn said(tree: &str) -> Vec<String> {
        let light = Light {
            name: "a",
            with_features: true,
            banned: HEAVY,
            most: Some(2),
        };
        let breaches = check_tree(&light, tree);
        breaches.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_heavy_library_and_a_crate_too_many_are_named() {
        assert!(said("a v0.1.0 (/a)\nb v1.0.0\nb v1.0.0 (*)\n").is_empty());
        assert_eq!(
            said("a v0.1.0 (/a)\nrayon v1.0.0\nb v1.0.0\n"),
            [
                "`a` pulls in rayon",
                "`a` pulls in 3 crates, itself included; at most 2 are allowed"
            ]
        );
    }

    #[test]
    fn a_feature_that_has_no_place_is_named() {
        let light = Light {
            name: "a",
            with_features: true,
            banned: CHECKS,
            most: None,
        };
        let said = |tree: &str| -> Vec<String> {
            let breaches = check_tree(&light, tree);
            breaches.iter().map(ToString::to_string).collect()
        };
        assert!(said("a v0.1.0 (/a)\nb feature \"default\"\nb v1.0.0\n").is_empty());
        assert_eq!(
            said("a v0.1.0 (/a)\nb feature \"conformance\"\nb v1.0.0\n"),
            ["`a` pulls in \"conformance\""]
        );
    }

    #[test]
    fn what_only_tests_need_does_not_count() {
        let package = |name: &str, more: &str| {
            format!("[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n{more}")
        };
        let needs_rayon = |table: &str| {
            let rayon = package("rayon", "");
            let a = package(
                "a",
                &format!("[{table}]\nrayon = {{ path = \"../rayon\" }}\n"),
            );
            let tree = tree([
                (
                    "Cargo.toml",
                    "[workspace]\nresolver = \"3\"\nmembers = [\"a\", \"rayon\"]\n",
                ),
                ("a/Cargo.toml", &a),
                ("a/src/lib.rs", ""),
                ("rayon/Cargo.toml", &rayon),
                ("rayon/src/lib.rs", ""),
            ]);
            let light = Light {
                name: "a",
                with_features: true,
                banned: HEAVY,
                most: None,
            };
            check(tree.path(), &[light]).unwrap().len()
        };
        assert_eq!(needs_rayon("dev-dependencies"), 0);
        assert_eq!(needs_rayon("dependencies"), 1);
    }
}
