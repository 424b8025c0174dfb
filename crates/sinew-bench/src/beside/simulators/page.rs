//! Runs of simulators as a page.

use sinew_draw::Page;
use sinew_draw::page::Table;

use crate::plain_table::{groups, table};

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
        let rows = self
            .rows
            .iter()
            .map(|row| ((&row.case, &row.law), cells(row)));
        table(&HEAD, 4, groups(rows))
    }
}
