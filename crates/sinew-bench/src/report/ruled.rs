//! The look of tables on a terminal.

use comfy_table::{LineStyle, Table, TableStyle};

/// A rule beneath the head and no other line: lines cost width, which a terminal lacks.
pub(crate) const RULED_HEAD: TableStyle =
    TableStyle::new().header_separator(LineStyle::new('─', '─', '─', '─'));

/// The table with `gap` blanks between columns, and none at the end of a line.
pub(crate) fn lines(mut table: Table, gap: u16) -> String {
    for column in table.column_iter_mut() {
        column.set_padding((0, gap));
    }
    let lines = table.lines().map(|line| line.trim_end().to_owned());
    lines.collect::<Vec<_>>().join("\n")
}
