//! The tables of a scene, each with its keys.

use crate::decode::{Described, Goes, Shape, TableDescription};

/// A table and the keys of which it is the value.
#[derive(Debug, Clone)]
pub(super) struct Section {
    pub(super) table: &'static TableDescription,
    /// The keys, and for each the heading of the table that has it; empty for the top of a scene.
    pub(super) holders: Vec<(String, &'static str)>,
    /// Its name in texts: `[mesh]`, `[[load]]`, or the keys of an inner table.
    pub(super) heading: String,
    /// True if it is a table of the document.
    pub(super) is_of_the_document: bool,
}

/// All tables below a document's, each once, after the first table that contains it.
pub(super) fn below(document: &'static TableDescription) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    collect(document, None, &mut sections);
    for section in &mut sections {
        if !section.is_of_the_document {
            section.heading = heading(&section.holders);
        }
    }
    sections
}

fn collect(table: &'static TableDescription, name: Option<&str>, sections: &mut Vec<Section>) {
    for key in table.all_keys().into_iter().filter(|key| !is_refused(*key)) {
        for (inner, several) in tables_in(&key.describe().shape) {
            let holder = (name.unwrap_or_default().to_owned(), key.name());
            let known = sections
                .iter_mut()
                .find(|known| known.table.name == inner.name);
            if let Some(known) = known {
                known.holders.push(holder);
                continue;
            }
            let own_name = match (name, several) {
                (None, true) => format!("[[{}]]", key.name()),
                (None, false) => format!("[{}]", key.name()),
                (Some(_), _) => key.name().to_owned(),
            };
            sections.push(Section {
                table: inner,
                holders: vec![holder],
                heading: format!("`{own_name}`"),
                is_of_the_document: name.is_none(),
            });
            collect(inner, Some(&own_name), sections);
        }
    }
}

/// True if a key is known only to be refused.
pub(super) fn is_refused(key: &dyn Described) -> bool {
    let mut conditions = key.conditions().iter();
    conditions.any(|condition| matches!(condition.goes, Goes::Never))
}

/// The tables that a value may be, each with a flag: true if there may be several.
pub(super) fn tables_in(shape: &Shape) -> Vec<(&'static TableDescription, bool)> {
    match shape {
        Shape::Table(table) => vec![(table, false)],
        Shape::Tables(table) => vec![(table, true)],
        Shape::Either(shapes) => shapes.iter().flat_map(tables_in).collect(),
        _ => Vec::new(),
    }
}

/// The heading of an inner table: its keys, and the tables that have them.
fn heading(holders: &[(String, &'static str)]) -> String {
    let mut keys: Vec<String> = Vec::new();
    let mut tables: Vec<String> = Vec::new();
    for (table, key) in holders {
        let (key, table) = (format!("`{key}`"), format!("`{table}`"));
        if !keys.contains(&key) {
            keys.push(key);
        }
        if !tables.contains(&table) {
            tables.push(table);
        }
    }
    format!("{} in {}", keys.join(", "), tables.join(", "))
}
