//! The reference of scenes as Markdown.

use std::fmt::Write;

use sinew_integrators::OptionDefault;

use super::examples;
use super::options::{self, SharedOption};
use super::sections::{self, Section, is_refused, tables_in};
use crate::decode::{Goes, KeyDescription, Needs, Shape, Stated, TableDescription};
use crate::scene::RUN;

const INTRODUCTION: &str = "\
# Scenes

<!-- Written by `cargo xtask reference`. -->

";

const COLUMNS: &str = "\
| key | values | unit | default | meaning | example |
| --- | --- | --- | --- | --- | --- |
";

/// The reference of a document.
pub(super) fn of(document: &'static TableDescription) -> String {
    let sections = sections::below(document);
    let mut text = INTRODUCTION.to_owned();
    push_table(&mut text, document, &sections);
    push_examples(&mut text, document, "");
    for section in &sections {
        let level = if section.is_of_the_document {
            "##"
        } else {
            "###"
        };
        let _ = write!(text, "\n{level} {}\n\n", section.heading);
        push_table(&mut text, section.table, &sections);
        let key = section.holders.first().map_or("", |(_, key)| key);
        push_examples(&mut text, section.table, key);
        if section.table.name == RUN.name {
            push_options(&mut text);
        }
    }
    text
}

fn push_table(text: &mut String, table: &TableDescription, sections: &[Section]) {
    let _ = write!(text, "{}{}\n\n{COLUMNS}", table.meaning, needs(table));
    for key in table.all_keys().into_iter().filter(|key| !is_refused(*key)) {
        let key = key.describe();
        let example = match tables_in(&key.shape)[..] {
            [(inner, _)] if table_of(sections, inner).is_some_and(|s| s.is_of_the_document) => {
                "see there".to_owned()
            }
            _ => examples::of(table, key.name).map_or_else(String::new, |value| code(&value)),
        };
        push_row(
            text,
            &[
                code(key.name),
                values(&key, sections),
                key.unit.to_owned(),
                otherwise(&key, table),
                key.meaning.clone(),
                example,
            ],
        );
    }
}

/// Sentence about the number of keys that must be given.
fn needs(table: &TableDescription) -> String {
    match table.needs {
        Needs::Any => String::new(),
        Needs::Some => " At least one key must be given.".to_owned(),
        Needs::OneOf(keys) => format!(" Exactly one of {} must be given.", codes(keys)),
    }
}

fn table_of<'a>(sections: &'a [Section], table: &TableDescription) -> Option<&'a Section> {
    sections.iter().find(|known| known.table.name == table.name)
}

/// The values that fit, with a link to the table if they are one.
fn values(key: &KeyDescription, sections: &[Section]) -> String {
    let inner = tables_in(&key.shape);
    let inner = inner
        .first()
        .and_then(|(table, _)| table_of(sections, table));
    match inner {
        None => key.expected.clone(),
        Some(section) => {
            let link = format!("[{}](#{})", section.heading, anchor(&section.heading));
            match key.shape {
                Shape::Either(_) => format!("{}: {link}", key.expected),
                _ => link,
            }
        }
    }
}

/// The anchor that a heading gets.
fn anchor(heading: &str) -> String {
    let kept = heading
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Behaviour if a key is not given, and its conditions on other keys.
fn otherwise(key: &KeyDescription, table: &TableDescription) -> String {
    let stated = match &key.otherwise {
        Stated::Required => match table.needs {
            Needs::OneOf(keys) if keys.contains(&key.name) => "one of several".to_owned(),
            _ => "required".to_owned(),
        },
        Stated::RequiredWith(other, words) => format!("required with {}", settings(other, words)),
        Stated::InWords(words) => (*words).to_owned(),
        Stated::Default(value) => code(value),
    };
    let goes = key
        .conditions
        .iter()
        .filter_map(|condition| match condition.goes {
            Goes::With(other) => Some(format!("only with `{other}`")),
            Goes::Without(other) => Some(format!("not with `{other}`")),
            Goes::If(..) | Goes::Among(..) => {
                let (other, words) = condition.goes.words()?;
                Some(format!("only with {}", settings(other, words)))
            }
            Goes::Never => None,
        });
    let mut parts: Vec<String> = std::iter::once(stated).chain(goes).collect();
    // Conditions with different reasons may have the same words.
    parts.dedup();
    parts.join("; ")
}

/// The settings of a key to some words.
fn settings(key: &str, words: &[&str]) -> String {
    let words: Vec<String> = words
        .iter()
        .map(|word| format!("`{key} = \"{word}\"`"))
        .collect();
    words.join(" or ")
}

fn push_examples(text: &mut String, table: &TableDescription, key: &str) {
    let all = table.all_examples();
    let examples = all.iter();
    let blocks: Vec<String> = match &all[..] {
        [first, ..] if first.starts_with('{') => {
            let lines: Vec<String> = examples
                .map(|example| format!("{key} = {example}\n"))
                .collect();
            vec![lines.join("# or\n")]
        }
        // Several of them would not be one TOML.
        [first, ..] if !first.starts_with("[[") => examples.map(ToString::to_string).collect(),
        tables => vec![tables.join("\n")],
    };
    for block in blocks {
        let _ = write!(text, "\n```toml\n{block}```\n");
    }
}

const OPTION_COLUMNS: &str = "\
| option | values | default | meaning | example | integrators |
| --- | --- | --- | --- | --- | --- |
";

/// The options of all integrators.
fn push_options(text: &mut String) {
    let entries = sinew_integrators::entries();
    text.push_str("\n### Integrators and their options in `[run]`\n\n");
    for entry in &entries {
        let keys: Vec<&str> = entry
            .all_options()
            .iter()
            .map(|option| option.key)
            .collect();
        let takes = match keys[..] {
            [] => "no options".to_owned(),
            _ => format!("options {}", codes(&keys)),
        };
        let _ = writeln!(text, "* `{}`: {}; {takes}", entry.id, entry.summary);
    }
    let _ = write!(text, "\n{OPTION_COLUMNS}");
    for SharedOption {
        option,
        integrators,
    } in options::shared()
    {
        let default = match option.default {
            OptionDefault::Value(value) => code(value),
            OptionDefault::InWords(words) => words.to_owned(),
        };
        push_row(
            text,
            &[
                code(option.key),
                option.expected.to_owned(),
                default,
                option.help.to_owned(),
                code(&option.example.replace('\n', ", ")),
                codes(&integrators),
            ],
        );
    }
}

fn push_row(text: &mut String, cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    let _ = writeln!(text, "| {} |", cells.join(" | "));
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

fn codes(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| code(name)).collect();
    names.join(", ")
}
