//! Tables.

use std::fmt::{self, Display};

use crate::markup::{attribute, escape, prose};
use crate::style::Colour;

/// A table, which scrolls within the page if it is wider.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows.
    pub rows: Vec<TableRow>,
    /// True if a click on a head sorts the rows.
    pub is_sortable: bool,
    /// A name for rules of style; none if it is empty.
    pub class: String,
}

/// A column of a table.
#[derive(Clone, Debug, Default)]
pub struct Column {
    head: String,
    unit: String,
    explained: String,
    is_number: bool,
    wraps: bool,
}

impl Column {
    /// A column of words that stay in one line.
    #[must_use]
    pub fn text(head: impl Into<String>) -> Self {
        Self {
            head: head.into(),
            ..Self::default()
        }
    }

    /// A column of sentences.
    #[must_use]
    pub fn sentences(head: impl Into<String>) -> Self {
        Self {
            wraps: true,
            ..Self::text(head)
        }
    }

    /// A column of numbers with their unit, which end at the same place.
    #[must_use]
    pub fn number(head: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            unit: unit.into(),
            is_number: true,
            ..Self::text(head)
        }
    }

    /// The column with a text shown when the pointer is over its head.
    #[must_use]
    pub fn explained(self, explained: impl Into<String>) -> Self {
        Self {
            explained: explained.into(),
            ..self
        }
    }

    fn class(&self) -> &'static str {
        match (self.is_number, self.wraps) {
            (true, _) => "n",
            (false, true) => "t",
            (false, false) => "",
        }
    }
}

/// A row of a table.
#[derive(Clone, Debug, Default)]
pub struct TableRow {
    /// Its cells, one for each column.
    pub cells: Vec<Cell>,
    /// True if a line separates it from the row before.
    pub begins_group: bool,
    /// True if its first cell is bold.
    pub is_strong: bool,
}

impl TableRow {
    /// An ordinary row.
    #[must_use]
    pub fn new(cells: impl IntoIterator<Item = Cell>) -> Self {
        Self {
            cells: cells.into_iter().collect(),
            ..Self::default()
        }
    }
}

/// A cell of a table.
#[derive(Clone, Debug, Default)]
pub struct Cell {
    text: String,
    note: String,
    title: String,
    anchor: String,
    key: Option<f64>,
    tint: Option<Colour>,
}

impl Cell {
    /// A cell with prose.
    #[must_use]
    pub fn text(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            ..Self::default()
        }
    }

    /// A cell with the text of a number, and its value for sorting.
    #[must_use]
    pub fn number(text: impl Into<String>, key: f64) -> Self {
        Self {
            key: Some(key),
            ..Self::text(text)
        }
    }

    /// The cell with prose in small letters beneath.
    #[must_use]
    pub fn noted(self, note: impl Into<String>) -> Self {
        Self {
            note: note.into(),
            ..self
        }
    }

    /// The cell with a text shown when the pointer is over it.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }

    /// The cell as a link to an anchor of the page.
    #[must_use]
    pub fn linked(self, anchor: impl Into<String>) -> Self {
        Self {
            anchor: anchor.into(),
            ..self
        }
    }

    /// The cell on a light colour, on which black text is readable.
    #[must_use]
    pub fn tinted(self, tint: Colour) -> Self {
        Self {
            tint: Some(tint),
            ..self
        }
    }

    fn write(&self, column: &Column, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let key = match self.key {
            // As scripts write it.
            Some(key) if !key.is_finite() => "Infinity".to_owned(),
            Some(key) => key.to_string(),
            None => String::new(),
        };
        let (tint, style) = match self.tint {
            Some(tint) => (" tint", format!("background:{tint}")),
            None => ("", String::new()),
        };
        let class = format!("{}{tint}", column.class());
        let text = match self.anchor.as_str() {
            "" => prose(&self.text),
            anchor => format!("<a href=\"#{}\">{}</a>", escape(anchor), prose(&self.text)),
        };
        let note = match self.note.as_str() {
            "" => String::new(),
            note => format!("<small>{}</small>", prose(note)),
        };
        write!(
            f,
            "<td{}{}{}{}>{text}{note}</td>",
            attribute("class", class.trim()),
            attribute("style", &style),
            attribute("title", &self.title),
            attribute("data-k", &key),
        )
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sorted = if self.is_sortable { "sortable " } else { "" };
        let class = format!("{sorted}{}", self.class);
        write!(
            f,
            "<div class=\"wide\"><table{}>\n<thead><tr>",
            attribute("class", class.trim())
        )?;
        for column in &self.columns {
            let unit = match column.unit.as_str() {
                "" => String::new(),
                unit => format!("<small>{}</small>", escape(unit)),
            };
            write!(
                f,
                "<th{}{}>{}{unit}</th>",
                attribute("class", column.class()),
                attribute("title", &column.explained),
                escape(&column.head)
            )?;
        }
        f.write_str("</tr></thead>\n<tbody>\n")?;
        for row in &self.rows {
            let class = match (row.begins_group, row.is_strong) {
                (true, true) => "new strong",
                (true, false) => "new",
                (false, true) => "strong",
                (false, false) => "",
            };
            write!(f, "<tr{}>", attribute("class", class))?;
            for (column, cell) in self.columns.iter().zip(&row.cells) {
                cell.write(column, f)?;
            }
            f.write_str("</tr>\n")?;
        }
        f.write_str("</tbody>\n</table></div>\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_carries_the_number_that_rows_are_sorted_by() {
        let table = Table {
            columns: vec![Column::text("method"), Column::number("error", "%")],
            rows: [0.0123, f64::INFINITY]
                .map(|error| TableRow::new([Cell::text("rk4"), Cell::number("1.2", error)]))
                .into(),
            is_sortable: true,
            ..Table::default()
        };
        let html = table.to_string();
        assert!(html.contains("<table class=\"sortable\">"));
        assert!(html.contains("<th class=\"n\">error<small>%</small></th>"));
        assert!(html.contains("<td class=\"n\" data-k=\"0.0123\">1.2</td>"));
        assert!(html.contains("data-k=\"Infinity\""));
    }

    #[test]
    fn looks_are_classes_and_colours() {
        let row = TableRow {
            begins_group: true,
            is_strong: true,
            ..TableRow::new([Cell::text("a `b`")
                .noted("c")
                .linked("d")
                .tinted(Colour(1, 2, 3))])
        };
        let table = Table {
            columns: vec![Column::sentences("h")],
            rows: vec![row],
            ..Table::default()
        };
        let html = table.to_string();
        assert!(html.contains("<tr class=\"new strong\">"));
        assert!(html.contains(
            "<td class=\"t tint\" style=\"background:#010203\">\
             <a href=\"#d\">a <code>b</code></a><small>c</small></td>"
        ));
    }
}
