//! Rule: no crate's tests need a crate that needs, for any purpose, the tested crate.

use std::collections::BTreeSet;

use super::breach::Breach;
use super::components::{Edges, shortest_circle};
use super::workspace::Package;

/// Finds dev-dependencies that close a circle.
///
/// A crate in such a circle is compiled twice for its own unit tests, as two crates with different types.
pub(super) fn check(packages: &[Package]) -> Vec<Breach> {
    let is_ours = |name: &&String| packages.iter().any(|package| package.name == **name);
    let mut edges = Edges::new();
    for package in packages {
        let others = package.needs.iter().chain(&package.tests_need);
        let others: BTreeSet<String> = others.filter(is_ours).cloned().collect();
        edges.insert(package.name.clone(), others);
    }
    let mut breaches = Vec::new();
    for Package {
        name, tests_need, ..
    } in packages
    {
        for other in tests_need.iter().filter(is_ours) {
            // From the other crate on, so that the way begins with the dependency in question.
            let mut from_other = edges.clone();
            from_other.insert(name.clone(), BTreeSet::from([other.clone()]));
            if let Some(way) = shortest_circle(&from_other, name) {
                breaches.push(Breach::DevCycle {
                    name: name.clone(),
                    other: other.clone(),
                    way: way.join(" -> "),
                });
            }
        }
    }
    breaches
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;
    use crate::rules::workspace::packages;

    fn manifest(name: &str, needs: &str, tests_need: &str) -> String {
        format!(
            "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n[dependencies]\n{needs}\n\
             [dev-dependencies]\n{tests_need}\n"
        )
    }

    /// The rule's findings in a workspace in which b needs a, c needs nothing, and the tests of a need the given
    /// crates.
    fn said(tests_of_a_need: &str) -> Vec<String> {
        let a = manifest("a", "", tests_of_a_need);
        let b = manifest("b", "a = { path = \"../a\" }", "");
        let c = manifest("c", "", "");
        let tree = tree([
            (
                "Cargo.toml",
                "[workspace]\nresolver = \"3\"\nmembers = [\"a\", \"b\", \"c\"]\n",
            ),
            ("a/Cargo.toml", &a),
            ("a/src/lib.rs", ""),
            ("b/Cargo.toml", &b),
            ("b/src/lib.rs", ""),
            ("c/Cargo.toml", &c),
            ("c/src/lib.rs", ""),
        ]);
        let packages = packages(tree.path()).unwrap();
        check(&packages).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_dev_dependency_on_a_crate_above_is_a_cycle() {
        assert_eq!(
            said("b = { path = \"../b\" }"),
            ["the tests of `a` need `b`, which closes a circle: a -> b -> a"]
        );
    }

    #[test]
    fn other_dev_dependencies_are_none() {
        assert!(said("").is_empty());
        assert!(said("c = { path = \"../c\" }").is_empty());
    }
}
