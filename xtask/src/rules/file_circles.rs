//! Rule: no two files of a crate, and no two modules at its top, import each other, directly or indirectly.

use std::path::Path;

use super::breach::{Breach, RuleError};
use super::components::{Edges, components, shortest_circle};
use super::files::{entries, shown};
use super::modules::Modules;

/// Finds the circles of files and of modules: two modules may need each other although none of their files does.
pub(super) fn check(root: &Path) -> Result<Vec<Breach>, RuleError> {
    let files = imports(root)?;
    let found = circles(&files);
    // Files in a circle put their modules in one.
    if found.is_empty() {
        return Ok(circles(&of_modules(&files)));
    }
    Ok(found)
}

fn circles(edges: &Edges<String>) -> Vec<Breach> {
    let breach = |files: Vec<String>| {
        let circles = files.iter().filter_map(|file| shortest_circle(edges, file));
        let shortest = circles.min_by_key(Vec::len).unwrap_or_default();
        Breach::FileCircle {
            files: files.join("\n    "),
            shortest: shortest.join(" -> "),
        }
    };
    components(edges).into_iter().map(breach).collect()
}

/// The imports between the modules at the top of each crate. Its root re-exports public items, and imports nothing.
fn of_modules(files: &Edges<String>) -> Edges<String> {
    let module = |file: &String| {
        let (above, rest) = file.split_once("/src/")?;
        let name = rest.split('/').next()?.trim_end_matches(".rs");
        (!["lib", "main"].contains(&name)).then(|| format!("{above}/src/{name}"))
    };
    let mut edges = Edges::new();
    for (from, to) in files {
        let Some(from) = module(from) else { continue };
        let others = to.iter().filter_map(module).filter(|to| *to != from);
        let entry: &mut std::collections::BTreeSet<String> = edges.entry(from.clone()).or_default();
        entry.extend(others);
    }
    edges
}

/// The imports between the files of each crate, by their paths below the root of the repository.
fn imports(root: &Path) -> Result<Edges<String>, RuleError> {
    let mut edges = Edges::new();
    let mut crates = entries(&root.join("crates"))?;
    crates.push(root.join("xtask"));
    for directory in crates {
        for name in ["src/lib.rs", "src/main.rs"] {
            let file = directory.join(name);
            if !file.exists() {
                continue;
            }
            for (from, to) in Modules::read(&file)?.imports_of_files() {
                let to = to.iter().map(|to| shown(root, to));
                let entry: &mut std::collections::BTreeSet<String> =
                    edges.entry(shown(root, &from)).or_default();
                entry.extend(to);
            }
        }
    }
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    /// The rule's findings in a crate with these files.
    fn said(files: &[(&str, &str)]) -> Vec<String> {
        let files: Vec<(String, &str)> = files
            .iter()
            .map(|(path, text)| (format!("crates/a/src/{path}"), *text))
            .collect();
        let tree = tree(files.iter().map(|(path, text)| (path.as_str(), *text)));
        let breaches = check(tree.path()).unwrap();
        breaches.iter().map(ToString::to_string).collect()
    }

    fn shortest(files: &[(&str, &str)]) -> Option<String> {
        let said = said(files);
        let way = said.first()?.lines().last()?.trim().to_owned();
        Some(way.replace("crates/a/src/", ""))
    }

    #[test]
    fn two_files_that_import_each_other_are_named() {
        let files = [
            ("lib.rs", "mod one; mod two;"),
            ("one.rs", "use crate::two::B; pub struct A(B);"),
            ("two.rs", "pub struct B; fn f(a: super::one::A) {}"),
        ];
        let said = said(&files);
        assert_eq!(
            said,
            [
                "these files import each other in a circle:\n    crates/a/src/one.rs\n    crates/a/src/two.rs\n  \
              the shortest way round: crates/a/src/one.rs -> crates/a/src/two.rs -> crates/a/src/one.rs"
            ]
        );
    }

    #[test]
    fn a_circle_of_three_is_found_through_groups_globs_renames_and_macros() {
        let files = [
            ("lib.rs", "mod one; mod two; pub mod deep;"),
            (
                "one.rs",
                "use super::{two::{self as second}, deep}; fn a() { second::b() }",
            ),
            ("two.rs", "use crate::deep::inner::*; pub fn b() { c() }"),
            ("deep/mod.rs", "pub mod inner;"),
            (
                "deep/inner.rs",
                "pub fn c() {} macro_rules! m { () => { $crate::one::a() } }",
            ),
        ];
        assert_eq!(
            shortest(&files).as_deref(),
            Some("the shortest way round: deep/inner.rs -> one.rs -> two.rs -> deep/inner.rs")
        );
    }

    #[test]
    fn a_parent_that_uses_its_child_and_is_used_by_it_is_a_circle() {
        let child = ("child.rs", "use super::A; pub struct B(A);");
        let uses = (
            "lib.rs",
            "mod child; pub use child::B; pub struct A; fn f(b: B) {}",
        );
        assert_eq!(
            shortest(&[uses, child]).as_deref(),
            Some("the shortest way round: child.rs -> lib.rs -> child.rs")
        );
        let only_shows = ("lib.rs", "mod child; pub use child::B; pub struct A;");
        assert_eq!(shortest(&[only_shows, child]), None);
    }

    #[test]
    fn a_name_belongs_to_the_file_that_defines_it_wherever_it_is_imported_from() {
        let files = [
            (
                "lib.rs",
                "mod one; mod two; pub use one::A; pub use two::*;",
            ),
            ("one.rs", "pub struct A; pub struct Own;"),
            ("two.rs", "use crate::A; pub struct B(A);"),
        ];
        assert_eq!(shortest(&files), None);
        let circle = [
            files[0],
            ("one.rs", "use crate::B; pub struct A;"),
            files[2],
        ];
        assert_eq!(
            shortest(&circle).as_deref(),
            Some("the shortest way round: one.rs -> two.rs -> one.rs")
        );
    }

    #[test]
    fn modules_that_need_each_other_are_named_though_no_two_files_do() {
        let files = [
            ("lib.rs", "mod error; mod scene;"),
            ("error/mod.rs", "mod fault; pub use fault::Fault;"),
            ("error/fault.rs", "pub struct Fault(crate::scene::Shape);"),
            ("scene/mod.rs", "mod read; mod shape; pub use shape::Shape;"),
            (
                "scene/read.rs",
                "fn read() -> crate::error::Fault { todo!() }",
            ),
            ("scene/shape.rs", "pub struct Shape;"),
        ];
        assert_eq!(
            shortest(&files).as_deref(),
            Some("the shortest way round: error -> scene -> error")
        );
        let apart = files.map(|(path, text)| match path {
            "scene/read.rs" => (path, "fn read() {}"),
            _ => (path, text),
        });
        assert_eq!(shortest(&apart), None);
    }

    #[test]
    fn tests_comments_and_strings_import_nothing() {
        let files = [
            ("lib.rs", "mod one; mod two;"),
            ("one.rs", "use crate::two::B; pub struct A(B);"),
            (
                "two.rs",
                "//! [crate::one::A]
                 pub struct B; const S: &str = \"crate::one::A\";
                 #[cfg(test)] mod tests { use crate::one::A; }",
            ),
        ];
        assert_eq!(shortest(&files), None);
    }
}
