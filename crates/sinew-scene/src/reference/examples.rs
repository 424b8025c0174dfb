//! Values of keys, taken out of the examples of their tables.

use toml_edit::{DocumentMut, Item};

use crate::decode::TableDescription;

/// The value of a key in the first example that has it.
pub(super) fn of(table: &TableDescription, key: &str) -> Option<String> {
    table.all_examples().into_iter().find_map(|text| {
        let document: DocumentMut = toml(text).parse().ok()?;
        let value = in_document(document.as_item(), key)?.to_string();
        Some(value.trim().to_owned())
    })
}

/// An example as a document: an inner table gets a key.
pub(super) fn toml(example: &str) -> String {
    match example.starts_with('{') {
        true => format!("table = {example}"),
        false => example.to_owned(),
    }
}

/// The value of a key at the top of an example, or in its only table.
fn in_document<'a>(document: &'a Item, key: &str) -> Option<&'a Item> {
    if let Some(value) = document.get(key).filter(|value| value.is_value()) {
        return Some(value);
    }
    let (_, table) = document.as_table_like()?.iter().next()?;
    match table {
        Item::ArrayOfTables(tables) => tables.get(0)?.get(key),
        table => table.get(key),
    }
}
