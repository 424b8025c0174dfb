//! Rule: the files to which documents link exist.

use std::path::Path;

use super::breach::{Breach, RuleError};
use super::files::{entries, shown, source};

/// Folders with documents, without their subfolders.
const FOLDERS: [&str; 3] = ["docs", "docs/book/src", "docs/decisions"];

/// Looks for the file of every relative link in the documents of `root` and of its crates.
pub(super) fn check(root: &Path) -> Result<Vec<Breach>, RuleError> {
    let mut folders = vec![root.to_owned()];
    folders.extend(FOLDERS.map(|folder| root.join(folder)));
    folders.extend(entries(&root.join("crates"))?);
    let mut breaches = Vec::new();
    for folder in folders.into_iter().filter(|folder| folder.is_dir()) {
        for path in entries(&folder)? {
            if path.extension().is_some_and(|extension| extension == "md") {
                let text = source(&path)?;
                let missing = links(&text).filter(|link| !folder.join(link).exists());
                breaches.extend(missing.map(|link| Breach::DeadLink {
                    path: shown(root, &path),
                    link: link.to_owned(),
                }));
            }
        }
    }
    Ok(breaches)
}

/// Targets of links in Markdown that are files, without their anchors; code is skipped.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let prose = text.split("```").step_by(2);
    let targets = prose.flat_map(|part| part.split("](").skip(1));
    let targets = targets.filter_map(|rest| rest.split([')', ' ']).next());
    targets
        .filter(|target| !target.contains(':') && !target.starts_with('#'))
        .filter_map(|target| target.split('#').next())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    #[test]
    fn a_link_to_a_file_that_is_gone_is_named_with_its_document() {
        let readme = "[a](docs/a.md#part), [b](docs/gone.md) and [c](https://d.e/f)\n```sh\n[g](h)\n```\n[i](#k)\n";
        let tree = tree([
            ("README.md", readme),
            ("docs/a.md", "[back](../README.md)"),
            ("crates/one/README.md", "![picture](one.png \"title\")"),
        ]);
        let breaches = check(tree.path()).unwrap();
        let told: Vec<String> = breaches.iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "README.md links to docs/gone.md, which does not exist",
                "crates/one/README.md links to one.png, which does not exist",
            ]
        );
    }
}
