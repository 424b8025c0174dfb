//! Tables of pages from rows of text.

use sinew_draw::page::{Cell, Column, Table, TableRow};

/// A table of `texts` columns of text, followed by columns of numbers.
pub(crate) fn table(head: &[&str], texts: usize, rows: impl Iterator<Item = TableRow>) -> Table {
    let columns = head
        .iter()
        .enumerate()
        .map(|(index, head)| match index < texts {
            true => Column::text(*head),
            false => Column::number(*head, ""),
        });
    Table {
        rows: rows.collect(),
        columns: columns.collect(),
        ..Table::default()
    }
}

/// Rows with these cells.
pub(crate) fn rows<const N: usize>(
    rows: impl Iterator<Item = [String; N]>,
) -> impl Iterator<Item = TableRow> {
    rows.map(|cells| TableRow::new(cells.map(Cell::text)))
}

/// Rows with these keys and cells; a row whose key differs from the one before begins a group.
pub(crate) fn groups<K: PartialEq, const N: usize>(
    rows: impl Iterator<Item = (K, [String; N])>,
) -> impl Iterator<Item = TableRow> {
    let mut last = None;
    rows.map(move |(key, cells)| {
        let begins_group = last.as_ref() != Some(&key);
        last = Some(key);
        TableRow {
            begins_group,
            ..TableRow::new(cells.map(Cell::text))
        }
    })
}
