//! Pass marks as tables.

use comfy_table::{ContentArrangement, TableStyle, presets};
use sinew_draw::page::{Cell, Column, Table, TableRow};
use sinew_draw::{Colour, Page};
use sinew_measure::RowVerdict;

use super::verdict::tint;
use crate::results::Mark;
use sinew_verify::MarkVerdict;
use sinew_verify::ruled::{self, RULED_HEAD};

const HEADS: [&str; 5] = ["case", "asked", "measured", "by", "verdict"];

fn cells(mark: &Mark) -> [&str; 5] {
    let verdict = mark.verdict.word();
    [&mark.case, &mark.asked, &mark.measured, &mark.by, verdict]
}

/// The marks for a terminal.
#[must_use]
pub fn terminal_marks(marks: &[Mark]) -> String {
    ruled::lines(table(marks, RULED_HEAD, str::to_owned), 1)
}

/// Table of the required and measured figures, failed marks first, in at most `most` rows, followed by the number of
/// marks.
pub(super) fn brief(marks: &[Mark], most: usize) -> String {
    let mut sorted: Vec<&Mark> = marks.iter().collect();
    sorted.sort_by_key(|mark| mark.verdict == MarkVerdict::Pass);
    let rows = sorted.iter().take(most).map(|mark| {
        let [case, asked, measured, _, verdict] = cells(mark);
        [verdict, case, asked, measured].map(str::to_owned)
    });
    let table = ruled::table(["verdict", "case", "asked", "measured"], rows, 4);
    format!("{}\n{}", ruled::lines(table, 2), counted(marks))
}

fn counted(marks: &[Mark]) -> String {
    let count = |verdict| marks.iter().filter(|mark| mark.verdict == verdict).count();
    let (pass, fail) = (count(MarkVerdict::Pass), count(MarkVerdict::Fail));
    format!("{pass} passed, {fail} failed")
}

/// The marks as a Markdown table.
#[must_use]
pub fn markdown_marks(marks: &[Mark]) -> String {
    let escape = |cell: &str| cell.replace('|', "\\|").replace('\n', " ");
    table(marks, presets::ASCII_MARKDOWN, escape).to_string()
}

fn table(marks: &[Mark], style: TableStyle, escape: impl Fn(&str) -> String) -> comfy_table::Table {
    let mut table = comfy_table::Table::new();
    table
        .load_style(style)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(HEADS);
    for mark in marks {
        table.add_row(cells(mark).map(&escape));
    }
    table
}

/// The marks as a section of the page; nothing without marks.
pub(super) fn section(page: &mut Page, marks: &[Mark]) {
    if marks.is_empty() {
        return;
    }
    page.section("marks", "Pass marks");
    page.paragraph(&format!(
        "{}. Figures are measured in this run; limits were set before it.",
        counted(marks)
    ));
    page.table(&Table {
        columns: HEADS.map(Column::sentences).into(),
        rows: marks.iter().map(row).collect(),
        ..Table::default()
    });
}

fn row(mark: &Mark) -> TableRow {
    let [case, asked, measured, by, _] = cells(mark).map(Cell::text);
    let (symbol, tint) = look(mark.verdict);
    let verdict = Cell::text(format!("{symbol} {}", mark.verdict.word())).tinted(tint);
    TableRow::new([case, asked, measured, by.noted(mark.note.as_str()), verdict])
}

fn look(verdict: MarkVerdict) -> (&'static str, Colour) {
    match verdict {
        MarkVerdict::Pass => ("✓", tint(RowVerdict::Accurate)),
        MarkVerdict::Fail => ("✗", tint(RowVerdict::Unbounded)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marks() -> Vec<Mark> {
        let mark = |verdict, measured: &str| Mark {
            case: "a <case>".into(),
            asked: "at most 10 %".into(),
            measured: measured.into(),
            by: "rk4 | 20 ms".into(),
            note: "newmark 1 %".into(),
            verdict,
            ..Mark::default()
        };
        vec![
            mark(MarkVerdict::Pass, "5.92 %"),
            mark(MarkVerdict::Fail, "12.5 %"),
        ]
    }

    #[test]
    fn a_failed_mark_is_seen_with_its_figure_everywhere() {
        for text in [terminal_marks(&marks()), markdown_marks(&marks())] {
            let line = text.lines().find(|line| line.contains("12.5 %")).unwrap();
            assert!(line.contains("FAIL") && !line.contains("pass"), "{line}");
            assert_eq!(text.matches("FAIL").count(), 1);
        }
        let mut page = Page::new("");
        section(&mut page, &marks());
        let page = page.finish();
        let mut rows = page.split("<tr>").filter(|row| row.contains("12.5 %"));
        assert!(rows.next().unwrap().contains(">✗ FAIL<"));
        assert!(page.contains("1 passed, 1 failed"));
        assert!(!page.contains("<case>"));
    }

    #[test]
    fn no_marks_are_no_section() {
        let mut page = Page::new("");
        section(&mut page, &[]);
        assert_eq!(page.finish(), Page::new("").finish());
    }
}
