//! The code of a Rust file as tokens, without code that is only for tests.

use proc_macro2::{Delimiter, Group, Spacing, TokenStream, TokenTree};

/// The tokens of a source text without comments, items under `#[cfg(test)]` and attributes.
///
/// A file that is only for tests gives no tokens. The attribute `#[path = ".."]` stays.
pub(super) fn code(text: &str) -> Result<Vec<TokenTree>, proc_macro2::LexError> {
    Ok(without_tests(text.parse()?))
}

fn without_tests(stream: TokenStream) -> Vec<TokenTree> {
    let tokens: Vec<TokenTree> = stream.into_iter().collect();
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let is_inner = is_punct(tokens.get(at + 1), '!');
        let attribute = is_punct(tokens.get(at), '#')
            .then(|| {
                group(
                    tokens.get(at + 1 + usize::from(is_inner)),
                    Delimiter::Bracket,
                )
            })
            .flatten();
        let Some(attribute) = attribute else {
            kept.push(match &tokens[at] {
                TokenTree::Group(group) => {
                    let inner = without_tests(group.stream()).into_iter().collect();
                    TokenTree::Group(Group::new(group.delimiter(), inner))
                }
                token => token.clone(),
            });
            at += 1;
            continue;
        };
        let after = at + 2 + usize::from(is_inner);
        if is_for_tests(attribute) {
            if is_inner {
                return Vec::new();
            }
            at = end_of_item(&tokens, after);
        } else {
            if path_attribute(attribute).is_some() {
                kept.extend_from_slice(&tokens[at..after]);
            }
            at = after;
        }
    }
    kept
}

/// True if an attribute is `cfg(test)` or `cfg(all(test, ..))`.
fn is_for_tests(attribute: &Group) -> bool {
    let words: Vec<TokenTree> = attribute.stream().into_iter().collect();
    let condition = (ident(words.first()).as_deref() == Some("cfg"))
        .then(|| group(words.get(1), Delimiter::Parenthesis))
        .flatten();
    let Some(condition) = condition else {
        return false;
    };
    let condition: Vec<TokenTree> = condition.stream().into_iter().collect();
    let is_test = |token: &TokenTree| ident(Some(token)).as_deref() == Some("test");
    match ident(condition.first()).as_deref() {
        Some("test") => true,
        Some("all") => group(condition.get(1), Delimiter::Parenthesis)
            .is_some_and(|all| all.stream().into_iter().any(|token| is_test(&token))),
        _ => false,
    }
}

/// The file in an attribute `path = "file"`.
pub(super) fn path_attribute(attribute: &Group) -> Option<String> {
    let words: Vec<TokenTree> = attribute.stream().into_iter().collect();
    let [name, equals, TokenTree::Literal(file)] = words.as_slice() else {
        return None;
    };
    let is_path = ident(Some(name)).as_deref() == Some("path") && is_punct(Some(equals), '=');
    is_path.then(|| file.to_string().trim_matches('"').to_owned())
}

/// The index behind the item that begins at `at`.
fn end_of_item(tokens: &[TokenTree], mut at: usize) -> usize {
    // The braces of these are part of a path, a value or a type.
    let mut ends_with_semicolon = false;
    while at < tokens.len() {
        match &tokens[at] {
            TokenTree::Ident(word) => {
                let word = word.to_string();
                let is_function = ident(tokens.get(at + 1)).as_deref() == Some("fn");
                ends_with_semicolon |= matches!(word.as_str(), "use" | "let" | "static" | "type")
                    || word == "const" && !is_function;
            }
            TokenTree::Group(group)
                if group.delimiter() == Delimiter::Brace && !ends_with_semicolon =>
            {
                return at + 1;
            }
            TokenTree::Punct(punct) if punct.as_char() == ';' => return at + 1,
            _ => {}
        }
        at += 1;
    }
    at
}

/// The word of an identifier, raw ones without `r#`.
pub(super) fn ident(token: Option<&TokenTree>) -> Option<String> {
    match token {
        Some(TokenTree::Ident(word)) => Some(word.to_string().trim_start_matches("r#").to_owned()),
        _ => None,
    }
}

pub(super) fn is_punct(token: Option<&TokenTree>, char: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == char)
}

pub(super) fn group(token: Option<&TokenTree>, delimiter: Delimiter) -> Option<&Group> {
    match token {
        Some(TokenTree::Group(group)) if group.delimiter() == delimiter => Some(group),
        _ => None,
    }
}

/// True if `::` begins at `at`.
pub(super) fn is_path_separator(tokens: &[TokenTree], at: usize) -> bool {
    let is_joint = matches!(tokens.get(at), Some(TokenTree::Punct(punct)) if punct.spacing() == Spacing::Joint);
    is_joint && is_punct(tokens.get(at), ':') && is_punct(tokens.get(at + 1), ':')
}

/// The segments of the path that begins at the identifier `at`, and the index behind them.
pub(super) fn path(tokens: &[TokenTree], mut at: usize) -> (Vec<String>, usize) {
    let mut segments = Vec::new();
    while let Some(segment) = ident(tokens.get(at)) {
        segments.push(segment);
        at += 1;
        if !is_path_separator(tokens, at) || ident(tokens.get(at + 2)).is_none() {
            break;
        }
        at += 2;
    }
    (segments, at)
}

/// One name that a `use` imports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Import {
    /// The imported path.
    pub(super) path: Vec<String>,
    /// Its new name; `None` for all names in `path` (`*`).
    pub(super) name: Option<String>,
    /// True if others may import it from here (`pub use`, of any visibility).
    pub(super) is_public: bool,
}

/// The imports of the `use` at `at`, and the index behind its semicolon.
pub(super) fn imports(tokens: &[TokenTree], at: usize) -> (Vec<Import>, usize) {
    let is_restricted = |at: usize| group(tokens.get(at), Delimiter::Parenthesis).is_some();
    let is_pub = |at: usize| ident(tokens.get(at)).as_deref() == Some("pub");
    let is_public = at >= 1 && is_pub(at - 1) || at >= 2 && is_restricted(at - 1) && is_pub(at - 2);
    let rest = &tokens[at + 1..];
    let end = rest.iter().position(|token| is_punct(Some(token), ';'));
    let end = end.unwrap_or(rest.len());
    let mut found = Vec::new();
    use_tree(&rest[..end], &[], is_public, &mut found);
    (found, at + 1 + end + 1)
}

fn use_tree(tokens: &[TokenTree], before: &[String], is_public: bool, found: &mut Vec<Import>) {
    let start = if is_path_separator(tokens, 0) { 2 } else { 0 };
    let (segments, end) = path(tokens, start);
    let mut full = [before, &segments].concat();
    let at = if is_path_separator(tokens, end) {
        end + 2
    } else {
        end
    };
    if let Some(braces) = group(tokens.get(at), Delimiter::Brace) {
        let inner: Vec<TokenTree> = braces.stream().into_iter().collect();
        for branch in inner.split(|token| is_punct(Some(token), ',')) {
            if !branch.is_empty() {
                use_tree(branch, &full, is_public, found);
            }
        }
        return;
    }
    let is_all = is_punct(tokens.get(at), '*');
    if !is_all && full.len() > 1 && full.last().is_some_and(|last| last == "self") {
        full.pop();
    }
    let renamed = (ident(tokens.get(at)).as_deref() == Some("as"))
        .then(|| ident(tokens.get(at + 1)))
        .flatten();
    let name = match (is_all, renamed) {
        (true, _) => None,
        (false, Some(name)) => Some(name),
        (false, None) => full.last().cloned(),
    };
    found.push(Import {
        path: full,
        name,
        is_public,
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_of(source: &str) -> String {
        let tokens: TokenStream = code(source).unwrap().into_iter().collect();
        tokens.to_string()
    }

    #[test]
    fn comments_strings_and_tests_are_no_code() {
        let source = r##"
            //! crate::inner
            #![allow(dead_code)]
            /// crate::doc
            fn kept() { let s = "crate::string"; } // crate::comment
            #[cfg(test)]
            use crate::{a::b, c};
            #[cfg(test)]
            const N: [u8; 2] = { [1, 2] };
            #[cfg(all(test, unix))]
            #[allow(unused)]
            pub(crate) mod tests { use crate::test; }
            #[cfg(not(test))]
            fn also_kept() {}
        "##;
        assert_eq!(
            text_of(source),
            r#"fn kept () { let s = "crate::string" ; } fn also_kept () { }"#
        );
        assert_eq!(text_of("#![cfg(test)]\nfn f() {}"), "");
    }

    #[test]
    fn a_use_is_taken_apart_into_its_names() {
        let tokens = code("pub(crate) use a::{self, b as c, d::{E, *}, super::x};").unwrap();
        let at = tokens
            .iter()
            .position(|t| ident(Some(t)).as_deref() == Some("use"));
        let (found, end) = imports(&tokens, at.unwrap());
        let shown: Vec<String> = found
            .iter()
            .map(|import| {
                let name = import.name.as_deref().unwrap_or("*");
                assert!(import.is_public);
                format!("{} = {name}", import.path.join("::"))
            })
            .collect();
        assert_eq!(
            shown,
            [
                "a = a",
                "a::b = c",
                "a::d::E = E",
                "a::d = *",
                "a::super::x = x"
            ]
        );
        assert_eq!(end, tokens.len());
    }
}
