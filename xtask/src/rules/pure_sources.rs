//! Sources that can run anywhere, and whose public signatures contain no third-party library.

use std::path::Path;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

use super::breach::{Breach, RuleError};
use super::code::{code, group, ident, imports, is_punct, path};
use super::files::{rust_files, shown, source};

/// Folders of sources that use no clock and no file.
pub(super) const PURE: &[&str] = &[
    "crates/sinew-sparse/src",
    "crates/sinew-core/src",
    "crates/sinew-fem/src",
    "crates/sinew-cnn/src",
    "crates/sinew-machines/src",
    "crates/sinew-integrators/src",
    "crates/sinew-tools/src",
    "crates/sinew-haptics/src",
    "crates/sinew-cutting/src",
    "crates/sinew-film/src",
];

/// Modules of the standard library that reach outside the program.
const IMPURE: &[&str] = &["fs", "net", "process", "time"];

/// The files that may read a clock: one measures the benefit of threads, the other runs a device and a simulation in
/// real time.
const CLOCKS: &[&str] = &[
    "crates/sinew-machines/src/crew/mod.rs",
    "crates/sinew-haptics/src/real_time.rs",
];

/// Libraries that must not appear in a public signature, so that their new major versions do not require a new major
/// version of ours.
const FOREIGN: &[&str] = &["faer", "nalgebra"];

/// Checks all files in `folders`.
pub(super) fn check(root: &Path, folders: &[&str]) -> Result<Vec<Breach>, RuleError> {
    let mut breaches = Vec::new();
    for folder in folders {
        for path in rust_files(&root.join(folder))? {
            let text = source(&path)?;
            let tokens = code(&text).map_err(|error| RuleError::NotRust {
                path: path.clone(),
                reason: error.to_string(),
            })?;
            let path = shown(root, &path);
            let mut seen = Seen::default();
            seen.scan(&tokens);
            let allowed =
                |module: &String| module == "std::time" && CLOCKS.contains(&path.as_str());
            let impure = seen.impure.iter().filter(|module| !allowed(module));
            breaches.extend(impure.map(|module| Breach::Impure {
                path: path.clone(),
                module: module.clone(),
            }));
            for signature in &seen.signatures {
                if let Some(word) = seen.foreign_word(signature) {
                    breaches.push(Breach::ForeignName {
                        path: path.clone(),
                        word,
                        signature: signature
                            .iter()
                            .cloned()
                            .collect::<TokenStream>()
                            .to_string(),
                    });
                }
            }
        }
    }
    Ok(breaches)
}

/// The names and signatures in a file to which the rule applies.
#[derive(Default)]
struct Seen {
    /// Impure modules that it names, e.g. `std::fs`.
    impure: Vec<String>,
    /// Names that come from a foreign library.
    foreign: Vec<String>,
    /// The tokens of each public item, from behind `pub` to the brace of a body or to the item's end.
    signatures: Vec<Vec<TokenTree>>,
}

impl Seen {
    fn scan(&mut self, tokens: &[TokenTree]) {
        let mut at = 0;
        while at < tokens.len() {
            let word = ident(tokens.get(at));
            match word.as_deref() {
                Some("use") => {
                    let (found, end) = imports(tokens, at);
                    for import in found {
                        self.name(&import.path);
                        let is_foreign = |first: &String| FOREIGN.contains(&first.as_str());
                        if import.path.first().is_some_and(is_foreign) {
                            self.foreign.extend(import.name);
                        }
                    }
                    at = end;
                    continue;
                }
                Some("pub") if group(tokens.get(at + 1), Delimiter::Parenthesis).is_none() => {
                    self.signatures.push(signature(&tokens[at + 1..]));
                }
                // A field of a tuple: `pub (A, B)` begins like `pub (crate)`.
                Some("pub") if !is_restriction(tokens.get(at + 1)) => {
                    self.signatures.push(signature(&tokens[at + 1..]));
                }
                Some(_) => self.name(&path(tokens, at).0),
                None => {}
            }
            if let TokenTree::Group(group) = &tokens[at] {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                self.scan(&inner);
            }
            at += 1;
        }
    }

    /// Records a path that leads to an impure module.
    fn name(&mut self, path: &[String]) {
        if let [first, second, ..] = path
            && first == "std"
            && IMPURE.contains(&second.as_str())
        {
            self.impure.push(format!("std::{second}"));
        }
    }

    /// The first word of a signature that comes from a foreign library.
    fn foreign_word(&self, signature: &[TokenTree]) -> Option<String> {
        signature.iter().find_map(|token| match token {
            TokenTree::Ident(_) => ident(Some(token))
                .filter(|word| FOREIGN.contains(&word.as_str()) || self.foreign.contains(word)),
            TokenTree::Group(group) => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                self.foreign_word(&inner)
            }
            _ => None,
        })
    }
}

fn is_restriction(token: Option<&TokenTree>) -> bool {
    let words = group(token, Delimiter::Parenthesis).map(|group| group.stream().into_iter());
    let first = words.and_then(|mut words| words.next());
    let first = ident(first.as_ref());
    matches!(first.as_deref(), Some("crate" | "super" | "self" | "in"))
}

/// The part of `tokens` up to the end of the declaration: a body's brace, `;`, or the comma behind a field.
///
/// The braces of traits and enums are part of it, without the bodies of provided methods.
fn signature(tokens: &[TokenTree]) -> Vec<TokenTree> {
    let keywords = [
        "fn", "struct", "enum", "union", "trait", "type", "const", "static", "use",
    ];
    let keywords = [&keywords[..], &["mod", "unsafe", "async", "extern"]].concat();
    let is_item = ident(tokens.first()).is_some_and(|word| keywords.contains(&word.as_str()));
    let is_struct = ident(tokens.first()).as_deref() == Some("struct");
    let is_shown = |word: &str| word == "trait" || word == "enum";
    let mut shows_inside = false;
    let mut angles = 0;
    let mut taken = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        shows_inside |= ident(Some(token)).is_some_and(|word| is_shown(&word));
        match token {
            TokenTree::Punct(punct) => match punct.as_char() {
                ';' => break,
                ',' if !is_item && angles == 0 => break,
                '<' => angles += 1,
                '>' if !is_punct(at.checked_sub(1).and_then(|at| tokens.get(at)), '-') => {
                    angles -= 1;
                }
                _ => {}
            },
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace && is_item => {
                if shows_inside {
                    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                    taken.extend(without_bodies(&inner));
                }
                break;
            }
            // Fields say themselves whether they are public.
            TokenTree::Group(group)
                if group.delimiter() == Delimiter::Parenthesis && is_struct && angles == 0 =>
            {
                break;
            }
            _ => {}
        }
        taken.push(token.clone());
    }
    taken
}

/// The declarations in a trait or an enum.
fn without_bodies(tokens: &[TokenTree]) -> Vec<TokenTree> {
    let mut is_function = false;
    let mut taken = Vec::new();
    for token in tokens {
        is_function |= ident(Some(token)).as_deref() == Some("fn");
        if is_punct(Some(token), ';') {
            is_function = false;
        }
        if is_function && group(Some(token), Delimiter::Brace).is_some() {
            is_function = false;
        } else {
            taken.push(token.clone());
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    fn said(text: &str) -> Vec<String> {
        let tree = tree([("src/deep/a.rs", text)]);
        let breaches = check(tree.path(), &["src"]).unwrap();
        breaches.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn clocks_and_files_are_found_in_paths_and_in_groups_of_imports() {
        assert_eq!(
            said("use std::{io, fs::{self, File}};"),
            ["src/deep/a.rs uses std::fs", "src/deep/a.rs uses std::fs"]
        );
        assert_eq!(
            said("fn f() { let t = std::time::Instant::now(); }"),
            ["src/deep/a.rs uses std::time"]
        );
        assert!(
            said("use std::fmt; #[cfg(test)] mod tests { use std::fs; } // std::fs").is_empty()
        );
    }

    #[test]
    fn a_foreign_name_is_found_on_every_line_of_a_signature() {
        let text = "
            use nalgebra::{Matrix3, Vector3 as Arrow};
            impl S {
                /// Several lines.
                pub fn long(
                    &self,
                    first: usize,
                ) -> Result<
                    Matrix3<f64>,
                    Error,
                > {
                    todo()
                }
            }";
        assert_eq!(
            said(text),
            [
                "src/deep/a.rs: `fn long (& self , first : usize ,) -> Result < Matrix3 < f64 >, Error , >` shows \
              Matrix3, which is private to the crate"
            ]
        );
        for shown in [
            "pub fn f<T>(x: T)\nwhere\n    T: Into<Arrow<f64>>,\n{ }",
            "pub struct S {\n    a: u8,\n    pub b: Vec<(u8, Arrow<f64>)>,\n}",
            "pub struct S(u8, pub Arrow<f64>);",
            "pub struct S(pub (u8, Arrow<f64>));",
            "pub enum E { A, B(Arrow<f64>) }",
            "pub trait T { fn f(&self) -> Arrow<f64>; }",
            "pub type A = faer::Mat<f64>;",
            "pub use nalgebra::Vector3;",
            "pub const C: Arrow<f64> = zero();",
        ] {
            let text = format!("use nalgebra::Vector3 as Arrow;\n{shown}");
            assert_eq!(said(&text).len(), 1, "{shown}");
        }
    }

    #[test]
    fn bodies_and_private_items_may_use_what_they_like() {
        let text = "
            use nalgebra::Vector3;
            pub fn f(x: [f64; 3]) -> f64 { Vector3::from(x).norm() }
            pub(crate) fn g(x: Vector3<f64>) {}
            pub struct S { pub a: HashMap<u8, u8>, b: Vector3<f64> }
            pub struct P(u8, Vector3<f64>);
            pub trait T { fn f(&self) { let v: Vector3<f64> = Vector3::zeros(); } }
        ";
        assert_eq!(said(text), Vec::<String>::new());
    }
}
