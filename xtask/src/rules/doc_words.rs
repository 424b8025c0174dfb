//! Rule: doc comments begin with a noun or a verb, and use the terms of the field.

use std::path::Path;

use super::breach::{Breach, RuleError};
use super::files::{entries, rust_files, shown, source};

/// First words that leave the subject of a doc comment open, with better beginnings.
const FIRST_WORDS: &[(&str, &str)] = &[
    ("What", "name it, as in `Result of ..` or `Values ..`"),
    ("Where", "`Position of ..`, or the fact followed by `if ..`"),
    ("How", "`Description of ..`, or a verb"),
    ("When", "`Time of ..`"),
    ("Why", "`Reason ..`"),
    ("Whether", "`True if ..`"),
    ("That", "repeat the noun"),
    ("Those", "repeat the noun"),
    ("Which", "name it"),
    ("Who", "name it"),
    ("Whose", "name the owner"),
    ("Of", "begin with the noun behind it"),
    ("As", "`Same as ..`"),
];

/// Phrases that are in no textbook, with the terms that replace them.
const PHRASES: &[(&str, &str)] = &[
    ("anew", "`again` or `rebuilt`"),
    ("goes on", "`continues`"),
    ("hang together", "`are joined`"),
    ("has hold of", "`grasps`"),
    ("have hold of", "`grasp`"),
    ("held fast", "`constant` or `fixed`"),
    ("in words", "`description`"),
    ("is told of", "`is notified of` or `receives`"),
    ("lips", "`cut faces`"),
    ("loose pieces", "`unsupported components`"),
    ("nothing holds", "`unsupported` or `without supports`"),
    ("so many times", "`count times`"),
    ("stands beside", "`is next to`"),
    ("stands in", "`is stored in` or `replaces`"),
    ("what it remembered", "`history variables`"),
    ("where there are none", "`without any` or `if absent`"),
    ("where there is none", "`without one` or `if absent`"),
];

/// Checks the doc comments of all crates and of xtask.
pub(super) fn check(root: &Path) -> Result<Vec<Breach>, RuleError> {
    let mut crates = entries(&root.join("crates"))?;
    crates.push(root.join("xtask"));
    let mut breaches = Vec::new();
    for folder in crates.iter().map(|directory| directory.join("src")) {
        if !folder.exists() {
            continue;
        }
        for path in rust_files(&folder)? {
            let text = source(&path)?;
            let path = shown(root, &path);
            breaches.extend(misfits(&text).into_iter().map(|misfit| Breach::DocWord {
                path: path.clone(),
                line: misfit.line,
                words: misfit.words,
                better: misfit.better,
            }));
        }
    }
    Ok(breaches)
}

/// A word or phrase of a doc comment that has a better one.
#[derive(Debug, PartialEq)]
struct Misfit {
    /// Line in the file, from 1 on.
    line: usize,
    words: &'static str,
    better: &'static str,
}

/// The misfits of a file's text, in order of lines.
fn misfits(text: &str) -> Vec<Misfit> {
    let mut found = Vec::new();
    let mut comment = Comment::default();
    for (line, text) in (1..).zip(text.lines()) {
        match doc(text) {
            Some((marker, text)) => {
                if comment.marker != marker {
                    comment.end(&mut found);
                }
                comment.marker = marker;
                comment.add(line, text);
            }
            None => comment.end(&mut found),
        }
    }
    comment.end(&mut found);
    found
}

/// The marker and the text of a line of a doc comment.
fn doc(line: &str) -> Option<(&'static str, &str)> {
    let line = line.trim_start();
    if line.starts_with("////") {
        return None;
    }
    let text = |marker: &'static str| line.strip_prefix(marker).map(|text| (marker, text));
    text("///").or_else(|| text("//!"))
}

/// A doc comment during its reading, line by line.
#[derive(Default)]
struct Comment {
    marker: &'static str,
    /// Its words outside of blocks of code, one space before and after each.
    words: String,
    /// The place in `words` at which each line begins, and its number.
    lines: Vec<(usize, usize)>,
    is_in_code: bool,
}

impl Comment {
    fn add(&mut self, line: usize, text: &str) {
        if text.trim_start().starts_with("```") {
            self.is_in_code = !self.is_in_code;
        } else if !self.is_in_code {
            self.lines.push((self.words.len(), line));
            for word in text.split_whitespace() {
                self.words.push(' ');
                self.words.push_str(word);
            }
        }
    }

    /// Adds the misfits of the comment, which is empty afterwards.
    fn end(&mut self, found: &mut Vec<Misfit>) {
        let before = found.len();
        let first = self.words.split_whitespace().next().unwrap_or_default();
        let first = first.trim_end_matches(|letter: char| !letter.is_alphanumeric());
        if let Some((words, better)) = FIRST_WORDS.iter().find(|(word, _)| *word == first) {
            found.push(self.misfit(0, words, better));
        }
        let words = self.words.to_ascii_lowercase();
        for (phrase, better) in PHRASES {
            for (at, _) in words.match_indices(phrase) {
                if is_apart(&words, at, phrase.len()) {
                    found.push(self.misfit(at, phrase, better));
                }
            }
        }
        found[before..].sort_by_key(|misfit| misfit.line);
        *self = Self::default();
    }

    fn misfit(&self, at: usize, words: &'static str, better: &'static str) -> Misfit {
        let begun = self.lines.partition_point(|(begin, _)| *begin <= at);
        let line = self.lines.get(begun.saturating_sub(1));
        Misfit {
            line: line.map_or(0, |(_, line)| *line),
            words,
            better,
        }
    }
}

/// True if no letter, digit or `_` continues the part of a text, of this length, on either side.
fn is_apart(text: &str, at: usize, length: usize) -> bool {
    let continues = |letter: char| letter.is_alphanumeric() || letter == '_';
    !text[..at].ends_with(continues) && !text[at + length..].starts_with(continues)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::tree;

    /// Lines and words that the rule finds in a text.
    fn found(text: &str) -> Vec<(usize, &'static str)> {
        let found = misfits(text).into_iter();
        found.map(|misfit| (misfit.line, misfit.words)).collect()
    }

    #[test]
    fn a_comment_must_not_begin_with_a_word_that_leaves_its_subject_open() {
        for (word, _) in FIRST_WORDS {
            assert_eq!(
                found(&format!("/// {word} it does.\nfn f() {{}}")),
                [(1, *word)]
            );
            assert_eq!(found(&format!("\n    //!  {word}.")), [(2, *word)]);
        }
        assert!(found("/// Whatever it does.\n/// What it does.").is_empty());
        assert!(found("/// `What` it does.\n\n// What it does.\n//// What.").is_empty());
        assert!(found("let text = \"/// What it does.\";").is_empty());
        assert_eq!(
            found("//! A file.\n/// What it does.\nfn f() {}\n///\n/// Why.\nfn g() {}"),
            [(2, "What"), (5, "Why")]
        );
    }

    #[test]
    fn a_phrase_is_found_on_its_line_and_over_two_lines() {
        for (phrase, _) in PHRASES {
            assert_eq!(
                found(&format!("/// A\n/// thing, {phrase}.")),
                [(2, *phrase)]
            );
            let broken = format!("/// A {}.", phrase.replace(' ', "\n    /// "));
            assert_eq!(found(&broken), [(1, *phrase)]);
            assert!(found(&format!("/// A x{phrase}, a {phrase}y, a _{phrase}.")).is_empty());
            assert!(
                found(&format!(
                    "/// A\n/// ```\n/// {phrase}\n/// ```\n// {phrase}"
                ))
                .is_empty()
            );
        }
        assert_eq!(
            found("/// As built anew, as\n/// it goes\n/// on.\nfn f() {}\n/// Cut, lips."),
            [(1, "As"), (1, "anew"), (2, "goes on"), (5, "lips")]
        );
        assert!(found("/// An ellipse that begin_anew draws.").is_empty());
        assert_eq!(found("/// Goes on."), [(1, "goes on")]);
    }

    #[test]
    fn breaches_name_file_line_and_a_better_word() {
        let tree = tree([
            ("crates/a/src/deep/b.rs", "\n/// Whether it is.\n"),
            ("crates/a/tests/b.rs", "/// Whether it is.\n"),
            ("xtask/src/c.rs", "//! A cut and its lips.\n"),
        ]);
        let breaches = check(tree.path()).unwrap();
        let said: Vec<String> = breaches.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "crates/a/src/deep/b.rs:2: a doc comment says \"Whether\"; better: `True if ..`",
                "xtask/src/c.rs:1: a doc comment says \"lips\"; better: `cut faces`",
            ]
        );
    }
}
