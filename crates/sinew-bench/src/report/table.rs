//! Tables for the terminal and for Markdown.

use comfy_table::{CellAlignment, ContentArrangement, Table, TableStyle, presets};

use super::{
    columns::{Column, columns_of},
    front,
    marks::{markdown_marks, terminal_marks},
    missing::{self, shown},
    number,
};

use crate::results::{BenchResults, Mark};
use sinew_measure::Row;
use sinew_verify::ruled::{self, RULED_HEAD};

/// The rows by case, the skipped runs and the missing results, for a terminal.
#[must_use]
pub fn terminal(results: &BenchResults) -> String {
    by_case(results, "", terminal_rows, terminal_marks)
}

/// The rows by case, the skipped runs and the missing results, as Markdown.
#[must_use]
pub fn markdown(results: &BenchResults) -> String {
    by_case(results, "### ", markdown_rows, markdown_marks)
}

/// Some rows for a terminal.
#[must_use]
pub fn terminal_rows<'a>(rows: impl IntoIterator<Item = &'a Row>) -> String {
    let rows: Vec<&Row> = rows.into_iter().collect();
    let table = table(&rows, RULED_HEAD, |column| column.title("\n"), |cell| cell);
    ruled::lines(table, 1)
}

/// Some rows as a Markdown table.
#[must_use]
pub fn markdown_rows<'a>(rows: impl IntoIterator<Item = &'a Row>) -> String {
    let escape = |cell: String| cell.replace('|', "\\|").replace('\n', " ");
    let style = presets::ASCII_MARKDOWN;
    let rows: Vec<&Row> = rows.into_iter().collect();
    let table = table(&rows, style, |column| column.title(" "), escape);
    align_right(&table.to_string(), &columns_of(&rows))
}

fn by_case<'a>(
    results: &'a BenchResults,
    heading: &str,
    table: impl Fn(Vec<&'a Row>) -> String,
    marks: impl Fn(&[Mark]) -> String,
) -> String {
    let mut out = String::new();
    for id in results.case_ids() {
        out.push_str(&format!("{heading}{id}"));
        if let Some(case) = results.case(id) {
            let error = shown(100.0 * case.reference_error, |x| {
                format!("{} %", number::three(x))
            });
            out.push_str(&format!(
                ": {} (free dofs: {}, time: {} s; reference: {}, itself within {error})",
                case.title,
                case.dofs,
                number::short(case.duration_s),
                case.reference,
            ));
        }
        let rows = results.rows.iter().filter(|row| row.case == id).collect();
        out.push_str(&format!("\n\n{}\n\n", table(rows)));
        for line in front::lines(results, id) {
            out.push_str(&format!("* {line}\n"));
        }
        out.push('\n');
    }
    if !results.marks.is_empty() {
        out.push_str(&format!("{heading}marks\n\n{}\n\n", marks(&results.marks)));
    }
    if !results.skipped.is_empty() {
        out.push_str(&format!("{heading}not run\n\n"));
    }
    for run in &results.skipped {
        out.push_str(&format!(
            "- {}, {}, dt = {} ms: {}\n",
            run.case,
            run.integrator,
            number::milliseconds(run.dt),
            run.reason
        ));
    }
    let missing = results.all_missing();
    if !missing.is_empty() {
        out.push_str(&format!(
            "\n{heading}missing\n\n{}",
            missing::lines(&missing)
        ));
    }
    out
}

fn table(
    rows: &[&Row],
    style: TableStyle,
    title: fn(&Column) -> String,
    escape: fn(String) -> String,
) -> Table {
    let columns = columns_of(rows);
    let mut table = Table::new();
    table
        .load_style(style)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(columns.iter().map(|column| title(column)));
    for row in rows {
        table.add_row(columns.iter().map(|column| escape((column.cell)(row))));
    }
    for (column, described) in table.column_iter_mut().zip(columns) {
        if described.key.is_some() {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// Adds colons to the rule below a Markdown header.
fn align_right(table: &str, columns: &[&Column]) -> String {
    let mut lines: Vec<String> = table.lines().map(str::to_owned).collect();
    if let Some(rule) = lines.get_mut(1) {
        let cells: Vec<String> = rule
            .trim_matches('|')
            .split('|')
            .zip(columns)
            .map(|(dashes, column)| match column.key {
                Some(_) => format!("{}:", dashes.get(1..).unwrap_or("--")),
                None => dashes.to_owned(),
            })
            .collect();
        *rule = format!("|{}|", cells.join("|"));
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Missing, Skipped};
    use sinew_measure::RowOutcome;
    use sinew_verify::Machine;

    fn results() -> BenchResults {
        let mut results = BenchResults::new("r", Machine::default());
        let row = Row {
            case: "cube".into(),
            integrator: "a|b".into(),
            dt: 0.02,
            steps: 50,
            bounded: true,
            settles: true,
            error: Some(0.0123),
            cpu_s_per_s: 0.004,
            us_per_step: 80.0,
            pareto: true,
            ..Row::default()
        };
        results.rows = vec![
            row.clone(),
            Row {
                outcome: RowOutcome::Diverged,
                diverged_at_s: Some(0.34),
                error: None,
                bounded: false,
                pareto: false,
                ..row
            },
        ];
        results.skipped.push(Skipped {
            case: "cube".into(),
            integrator: "modal".into(),
            dt: 0.02,
            reason: "needs modes".into(),
        });
        results
    }

    #[test]
    fn terminal_shows_error_beside_speed() {
        let text = terminal(&results());
        let run = text.lines().find(|line| line.contains("a|b")).unwrap();
        let cells: Vec<&str> = run.split_whitespace().collect();
        let error = cells.iter().position(|&cell| cell == "1.23").unwrap();
        assert_eq!(cells[error + 1], "0.00400");
        assert!(text.contains("diverged at t=0.34 s"));
        assert!(text.contains("- cube, modal, dt = 20 ms: needs modes"));
    }

    #[test]
    fn what_is_missing_stands_in_its_place_and_in_a_list() {
        let mut results = results();
        results.rows[0].cpu_s_per_s = f64::NAN;
        results
            .missing
            .push(Missing::scene("gone.toml", "no such file"));
        let text = terminal(&results);
        let run = text.lines().find(|line| line.contains("a|b")).unwrap();
        assert!(run.contains("n/a (NaN)"), "{run}");
        assert!(
            text.contains("- gone.toml: all of it: no such file"),
            "{text}"
        );
        assert!(
            text.contains("- cube, a|b, dt = 0.02 s: cpu_s_per_s = NaN: it is not"),
            "{text}"
        );
    }

    #[test]
    fn markdown_is_a_table() {
        let text = markdown(&results());
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
        assert_eq!(lines.len(), 4);
        let bars = |line: &str| line.replace("\\|", "").matches('|').count();
        assert!(lines.iter().all(|l| bars(l) == 13 + 1), "{text}");
        assert!(lines[1].contains("-:|"));
        assert!(lines[2].contains("a\\|b"));
    }
}
