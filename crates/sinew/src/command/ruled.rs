//! Tables on the terminal.

use comfy_table::{ContentArrangement, LineStyle, Table, TableStyle};

/// A table with a line beneath its head and nothing else, as wide as its content.
pub(crate) fn table() -> Table {
    const RULED_HEAD: TableStyle =
        TableStyle::new().header_separator(LineStyle::new('─', '─', '─', '─'));
    let mut table = Table::new();
    table
        .load_style(RULED_HEAD)
        .set_content_arrangement(ContentArrangement::Disabled);
    table
}
