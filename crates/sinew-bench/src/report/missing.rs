//! The list of missing results for readers.

use sinew_draw::Page;
use sinew_draw::page::{Cell, Column, Table, TableRow};

use crate::results::Missing;

/// A formatted number, or the text that replaces it.
pub(super) fn shown(x: f64, format: impl Fn(f64) -> String) -> String {
    if x.is_finite() {
        format(x)
    } else {
        format!("n/a ({x})")
    }
}

/// One line each, for terminal and Markdown.
pub(super) fn lines(missing: &[Missing]) -> String {
    let lines = missing.iter().map(|missing| format!("- {missing}\n"));
    lines.collect()
}

/// The section of the page; empty if nothing is missing.
pub(super) fn section(page: &mut Page, missing: &[Missing]) {
    if missing.is_empty() {
        return;
    }
    page.section("missing", "Missing");
    let row = |missing: &Missing| {
        TableRow::new([missing.place(), missing.what(), missing.reason.clone()].map(Cell::text))
    };
    page.table(&Table {
        columns: ["where", "what", "why"].map(Column::sentences).into(),
        rows: missing.iter().map(row).collect(),
        ..Table::default()
    });
}
