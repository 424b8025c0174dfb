//! A case on the page of a bench.

use sinew_draw::Page;
use sinew_draw::page::{Cell, Table, TableRow};
use sinew_measure::{CaseInfo, Row, RowVerdict};

use super::columns::{Column, columns_of};
use super::missing::shown;
use super::{front, front_members, number, peers, strip, verdict, work_precision};
use crate::results::BenchResults;

/// Writes the section of a case.
pub(super) fn write(page: &mut Page, results: &BenchResults, id: &str, anchor: &str) {
    let info = results.case(id);
    let title = info.map_or(id, |info| info.title.as_str());
    page.section(anchor, &format!("{title} `{id}`"));
    if let Some(info) = info {
        facts(page, info);
        for remark in &info.remarks {
            page.paragraph(remark);
        }
    }
    let rows: Vec<&Row> = results.rows_of(id).collect();
    if rows.is_empty() {
        page.markup("<p class=\"none\">No run.</p>\n");
    } else {
        page.figure(&work_precision(results, id).svg(), "");
        front(page, results, id);
        if rows.iter().any(|row| row.dt != rows[0].dt) {
            page.figure(&strip(results, id), "");
        }
        page.heading("All runs");
        page.table(&runs(&rows));
        refusals(page, &rows);
        findings(page, &rows);
    }
    if id == crate::peers::CASE {
        peers::peers(page);
    }
}

fn facts(page: &mut Page, info: &CaseInfo) {
    let metres = |x: f64| shown(1e3 * x, |mm| format!("{} mm", number::three(mm)));
    let critical = info.critical_step_s.map(|dt| {
        shown(1e3 * dt, |dt| {
            let dt = number::three(dt);
            format!("{dt} ms (2/ω of the fastest mode at rest, undamped)")
        })
    });
    page.facts([
        ("free degrees of freedom", info.dofs.to_string()),
        (
            "simulated time",
            shown(info.duration_s, |s| format!("{} s", number::short(s))),
        ),
        ("critical step", critical.unwrap_or_default()),
        ("reference", info.reference.clone()),
        (
            "its own estimated error",
            shown(100.0 * info.reference_error, |x| {
                format!("{} %", number::three(x))
            }),
        ),
        ("largest |u| in it", metres(info.max_u_m)),
        (
            "its late amplitude",
            format!(
                "{} (half the range of the worst dof over the last fifth)",
                metres(info.late_amplitude_m)
            ),
        ),
    ]);
}

/// Writes the members of the Pareto front, with the reason for each.
fn front(page: &mut Page, results: &BenchResults, id: &str) {
    page.heading("The front");
    let members = front_members(results, id);
    page.list(
        members
            .iter()
            .map(|member| format!("{}: {} ({}).", member.label, member.says, member.summary)),
    );
    for sentence in front::sentences(results, id) {
        page.paragraph(&sentence);
    }
}

/// The reasons for which runs were refused, in a collapsed section.
fn refusals(page: &mut Page, rows: &[&Row]) {
    let refused = rows.iter().filter_map(|row| {
        let reason = row.refusal.as_ref()?;
        let dt = number::milliseconds(row.dt);
        Some(format!("{}, {dt} ms: {reason}", row.label()))
    });
    let refused: Vec<String> = refused.collect();
    if !refused.is_empty() {
        page.folded("Why steps were refused", |page| page.list(refused));
    }
}

/// The facts from the methods' set-ups, in a collapsed section.
fn findings(page: &mut Page, rows: &[&Row]) {
    let telling: Vec<&&Row> = rows.iter().filter(|row| !row.facts.is_empty()).collect();
    if telling.is_empty() {
        return;
    }
    page.folded("What methods found out at set-up", |page| {
        page.paragraph(
            "A certificate below 1 proves that a stabilised network cannot gain energy on this \
             case at this step. `left_out` is what a truncated method estimates it loses.",
        );
        page.list(telling.iter().map(|row| {
            let facts = row.facts.iter();
            let facts: Vec<String> = facts
                .map(|(name, value)| format!("{name} {}", shown(*value, number::short)))
                .collect();
            let dt = number::milliseconds(row.dt);
            format!("{}, {dt} ms: {}", row.label(), facts.join(", "))
        }));
    });
}

fn runs(rows: &[&Row]) -> Table {
    let columns = columns_of(rows);
    let mut last = None;
    let table_rows = rows.iter().map(|row| {
        let label = row.label();
        let begins_group = last.as_ref() != Some(&label);
        last = Some(label);
        TableRow {
            cells: columns.iter().map(|column| cell(column, row)).collect(),
            begins_group,
            is_strong: row.pareto,
        }
    });
    Table {
        rows: table_rows.collect(),
        columns: columns.iter().map(|column| column.on_page()).collect(),
        is_sortable: true,
        class: String::new(),
    }
}

fn cell(column: &Column, row: &Row) -> Cell {
    let text = (column.cell)(row);
    let cell = |text: String| match column.key {
        Some(key) => Cell::number(text, key(row)),
        None => Cell::text(text),
    };
    if column.head != "error" {
        return cell(text);
    }
    let verdict = row.verdict();
    let text = match verdict {
        // The cell says so as text.
        RowVerdict::Diverged | RowVerdict::Refused => text,
        verdict => format!("{text} {}", verdict.symbol()),
    };
    cell(text)
        .tinted(verdict::tint(verdict))
        .titled(verdict.word())
}
