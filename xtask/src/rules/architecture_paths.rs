//! Rule: the paths in ARCHITECTURE.md exist.

use std::path::Path;

use super::breach::{Breach, RuleError};
use super::files::source;

/// Checks every path in backticks in the file ARCHITECTURE.md of `root`.
pub(super) fn check(root: &Path) -> Result<Vec<Breach>, RuleError> {
    let text = source(&root.join("ARCHITECTURE.md"))?;
    let names = text.split('`').skip(1).step_by(2);
    let paths =
        names.filter(|name| name.contains('/') && !name.contains([' ', '(', '*', '<', '\n']));
    let missing = paths.filter(|name| !root.join(name).exists());
    let breaches = missing.map(|name| Breach::NoSuchPath {
        name: name.to_owned(),
    });
    Ok(breaches.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    #[test]
    fn a_path_that_is_gone_is_named() {
        let text = "`src/a.rs` holds `A`, `src/b.rs` holds `B::c()/2`, `src/*.rs` both";
        let tree = tree([("ARCHITECTURE.md", text), ("src/a.rs", "")]);
        let breaches = check(tree.path()).unwrap();
        let said: Vec<String> = breaches.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            ["ARCHITECTURE.md names src/b.rs, which does not exist"]
        );
    }
}
