//! Runs of simulators as a page.

use sinew_draw::Page;
use sinew_draw::page::{Cell, Column, Table, TableRow};

use super::results::SimulatorResults;
use super::table::{HEAD, MEANING, cells};

impl SimulatorResults {
    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut page = Page::new("sinew next to other simulators");
        page.facts([
            ("revision", &self.revision),
            ("processor", &self.machine.cpu),
        ]);
        page.paragraph(&self.body());
        page.paragraph(MEANING);
        page.list(&self.versions);
        page.section("rows", "Runs");
        page.table(&self.rows_on_page());
        page.section("ratios", "Errors and costs over ours");
        page.list(self.ratios());
        if !self.missing.is_empty() {
            page.section("missing", "Missing");
            page.list(&self.missing);
        }
        page.finish()
    }

    fn rows_on_page(&self) -> Table {
        let columns = HEAD.iter().enumerate().map(|(index, head)| match index {
            0..=3 => Column::text(*head),
            _ => Column::number(*head, ""),
        });
        let mut last = ("", "");
        let rows = self.rows.iter().map(|row| {
            let group = (row.case.as_str(), row.law.as_str());
            let begins_group = std::mem::replace(&mut last, group) != group;
            TableRow {
                begins_group,
                ..TableRow::new(cells(row).map(Cell::text))
            }
        });
        Table {
            rows: rows.collect(),
            columns: columns.collect(),
            ..Table::default()
        }
    }
}
