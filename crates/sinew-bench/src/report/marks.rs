//! Pass marks as tables.

use std::fmt::Write;

use comfy_table::{ContentArrangement, Table, TableStyle, presets};

use super::{
    markup::escape,
    ruled::{self, RULED_HEAD},
};
use crate::results::{Mark, MarkVerdict};

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

/// The marks as a Markdown table.
#[must_use]
pub fn markdown_marks(marks: &[Mark]) -> String {
    let escape = |cell: &str| cell.replace('|', "\\|").replace('\n', " ");
    table(marks, presets::ASCII_MARKDOWN, escape).to_string()
}

fn table(marks: &[Mark], style: TableStyle, escape: impl Fn(&str) -> String) -> Table {
    let mut table = Table::new();
    table
        .load_style(style)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(HEADS);
    for mark in marks {
        table.add_row(cells(mark).map(&escape));
    }
    table
}

/// The marks as a section of the page; nothing where there are none.
pub(super) fn section(marks: &[Mark]) -> String {
    if marks.is_empty() {
        return String::new();
    }
    let count = |verdict| marks.iter().filter(|mark| mark.verdict == verdict).count();
    let mut out = format!(
        "<section>\n<h2 id=\"marks\">Pass marks of the hard cases</h2>\n\
         <p>{} passed, {} failed. Figures are measured in this run; limits were \
         set before it.</p>\n<div class=\"wide\"><table class=\"marks\">\n<thead><tr>",
        count(MarkVerdict::Pass),
        count(MarkVerdict::Fail),
    );
    for head in HEADS {
        // Writing into a String cannot fail.
        let _ = write!(out, "<th>{head}</th>");
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for mark in marks {
        let _ = write!(out, "<tr class=\"{}\">", class(mark.verdict));
        for (head, cell) in HEADS.iter().zip(cells(mark)) {
            let _ = match *head {
                "by" if !mark.note.is_empty() => write!(
                    out,
                    "<td>{}<small>{}</small></td>",
                    escape(cell),
                    escape(&mark.note)
                ),
                "verdict" => write!(
                    out,
                    "<td class=\"verdict\">{} {}</td>",
                    symbol(mark.verdict),
                    escape(cell)
                ),
                _ => write!(out, "<td>{}</td>", escape(cell)),
            };
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table></div>\n</section>\n");
    out
}

fn class(verdict: MarkVerdict) -> &'static str {
    match verdict {
        MarkVerdict::Pass => "pass",
        MarkVerdict::Fail => "fail",
    }
}

fn symbol(verdict: MarkVerdict) -> &'static str {
    match verdict {
        MarkVerdict::Pass => "✓",
        MarkVerdict::Fail => "✗",
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
        let page = section(&marks());
        let row = page.lines().find(|line| line.contains("12.5 %")).unwrap();
        assert!(row.contains("class=\"fail\"") && row.contains("✗ FAIL"));
        assert!(page.contains("1 passed, 1 failed"));
        assert!(!page.contains("<case>"));
    }

    #[test]
    fn no_marks_are_no_section() {
        assert_eq!(section(&[]), "");
    }
}
