//! Summary in few lines for a terminal: the cheapest runs that are good enough, and marks.

use sinew_measure::Row;

use super::summary::{GOOD_ENOUGH, cheapest};
use super::{marks, number, verdict};
use crate::results::{BenchResults, Skipped};
use sinew_verify::ruled;

/// Largest number of rows of a table.
const MOST_ROWS: usize = 18;
/// Largest number of marks, and of scenes, that fit side by side.
const FEW: usize = 8;
/// Largest number of lines of a list.
const MOST_ITEMS: usize = 4;

const HEAD: [&str; 6] = ["scene", "error at most", "cheapest", "dt", "error", "CPU"];
const UNITS: [&str; 6] = ["", "[%]", "", "[ms]", "[%]", "[s/s]"];

/// The summary of a bench for a terminal, at most 35 lines: the marks, if any; the cheapest run of each scene for
/// errors of at most 10, 1 and 0.1 %, without marks or with few; then skipped runs, and missing results.
#[must_use]
pub fn brief(results: &BenchResults) -> String {
    let mut parts = Vec::new();
    let has_room = results.marks.len() <= FEW && results.case_ids().len() <= FEW;
    if !results.marks.is_empty() {
        parts.push(marks::brief(&results.marks, MOST_ROWS));
    }
    if results.marks.is_empty() {
        parts.extend(cheapest_runs(results, MOST_ROWS));
    } else if has_room {
        parts.extend(cheapest_runs(results, FEW));
    }
    parts.extend(list("not run", skipped(&results.skipped)));
    let missing = results.all_missing();
    parts.extend(list(
        "missing",
        missing.iter().map(ToString::to_string).collect(),
    ));
    parts.join("\n\n")
}

/// The cheapest runs as a Markdown table.
#[must_use]
pub fn markdown_cheapest(results: &BenchResults) -> String {
    let head = std::array::from_fn(|i| format!("{} {}", HEAD[i], UNITS[i]).trim().to_owned());
    let rows = std::iter::once(head).chain(answers(results, &GOOD_ENOUGH));
    let mut lines: Vec<String> = rows
        .map(|row: [String; 6]| format!("| {} |", row.join(" | ")))
        .collect();
    lines.insert(1.min(lines.len()), "|---|--:|---|--:|--:|--:|".to_owned());
    lines.join("\n")
}

fn cheapest_runs(results: &BenchResults, most: usize) -> Option<String> {
    let cases = results.case_ids();
    if cases.is_empty() {
        return None;
    }
    let mut rows = answers(results, &GOOD_ENOUGH);
    if rows.len() > most {
        // One line for each scene is better than some scenes without any.
        rows = answers(results, &GOOD_ENOUGH[1..2]);
    }
    let left_out = rows.len().saturating_sub(most);
    rows.truncate(most);
    let head: [String; 6] = std::array::from_fn(|i| format!("{}\n{}", HEAD[i], UNITS[i]));
    let head = head.each_ref().map(|head| head.trim_end());
    let table = ruled::table(head, rows.into_iter(), 3);
    let mut text = ruled::lines(table, 2);
    if left_out > 0 {
        text.push_str(&format!("\nand {left_out} more"));
    }
    Some(text)
}

/// A line for each scene and run; limits that the same run meets share a line.
fn answers(results: &BenchResults, limits: &[f64]) -> Vec<[String; 6]> {
    let mut answers = Vec::new();
    for id in results.case_ids() {
        let mut groups: Vec<(Vec<String>, Option<&Row>)> = Vec::new();
        for limit in limits {
            let row = cheapest(results.rows_of(id), *limit);
            let limit = number::short(100.0 * limit);
            match groups.last_mut() {
                Some((limits, other)) if same(*other, row) => limits.push(limit),
                _ => groups.push((vec![limit], row)),
            }
        }
        let lines = groups.into_iter().enumerate();
        answers.extend(lines.map(|(index, (limits, row))| {
            let case = if index == 0 { id } else { "" };
            line(case, &limits.join(", "), row)
        }));
    }
    answers
}

fn same(a: Option<&Row>, b: Option<&Row>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => std::ptr::eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

fn line(case: &str, limits: &str, row: Option<&Row>) -> [String; 6] {
    let cells = match row {
        Some(row) => [
            row.label(),
            number::milliseconds(row.dt),
            verdict::error(row),
            number::three(row.cpu_s_per_s),
        ],
        None => ["none of the runs", "", "", ""].map(str::to_owned),
    };
    let [label, dt, error, cpu] = cells;
    [case.to_owned(), limits.to_owned(), label, dt, error, cpu]
}

/// A line for each method that did not run on a scene, with its steps.
fn skipped(runs: &[Skipped]) -> Vec<String> {
    let alike = |a: &Skipped, b: &Skipped| {
        (&a.case, &a.integrator, &a.reason) == (&b.case, &b.integrator, &b.reason)
    };
    let groups = runs.chunk_by(alike).filter_map(|group| {
        let first = group.first()?;
        let steps: Vec<String> = group
            .iter()
            .map(|run| number::milliseconds(run.dt))
            .collect();
        let steps = steps.join(", ");
        Some(format!(
            "{}, {}, {steps} ms: {}",
            first.case, first.integrator, first.reason
        ))
    });
    groups.collect()
}

/// The first few items of a long list.
fn list(head: &str, things: Vec<String>) -> Option<String> {
    if things.is_empty() {
        return None;
    }
    let mut lines = vec![head.to_owned()];
    let shown = match things.len() {
        count if count <= MOST_ITEMS => count,
        _ => MOST_ITEMS - 1,
    };
    lines.extend(things.iter().take(shown).map(|thing| format!("- {thing}")));
    if things.len() > shown {
        lines.push(format!("- and {} more", things.len() - shown));
    }
    Some(lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Mark, Missing};
    use sinew_measure::CaseInfo;
    use sinew_verify::{Machine, MarkVerdict};

    fn row(case: usize, integrator: &str, cpu_s_per_s: f64, error: f64) -> Row {
        Row {
            case: format!("case-{case}"),
            integrator: integrator.into(),
            dt: 0.02,
            cpu_s_per_s,
            error: Some(error),
            bounded: true,
            max_u: Some(0.1),
            late_amplitude: Some(0.1),
            ..Row::default()
        }
    }

    fn results(cases: usize) -> BenchResults {
        let mut results = BenchResults::new("r", Machine::default());
        for case in 0..cases {
            results.cases.push(CaseInfo {
                id: format!("case-{case}"),
                ..CaseInfo::default()
            });
            results.rows.extend([
                row(case, "newmark", 1.0, 0.08),
                row(case, "symplectic-euler", 2.0, 0.2),
                row(case, "rk4", 3.0, 0.0005),
            ]);
        }
        results
    }

    #[test]
    fn the_cheapest_run_for_each_error_is_named_once() {
        let text = brief(&results(1));
        let rows: Vec<Vec<&str>> = text
            .lines()
            .skip(3)
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(
            rows,
            [
                vec!["case-0", "10", "newmark", "20", "8.00", "1.00"],
                vec!["1,", "0.1", "rk4", "20", "0.0500", "3.00"],
            ]
        );
        let markdown = markdown_cheapest(&results(1));
        assert_eq!(
            markdown,
            "| scene | error at most [%] | cheapest | dt [ms] | error [%] | CPU [s/s] |\n\
             |---|--:|---|--:|--:|--:|\n\
             | case-0 | 10 | newmark | 20 | 8.00 | 1.00 |\n\
             |  | 1, 0.1 | rk4 | 20 | 0.0500 | 3.00 |"
        );
    }

    #[test]
    fn an_error_that_no_run_reaches_says_so() {
        let mut results = results(1);
        results.rows.pop();
        assert!(brief(&results).contains("none of the runs"));
    }

    #[test]
    fn no_bench_takes_more_than_35_lines() {
        for cases in [0, 1, 4, 8, 9, 10, 18, 19, 200] {
            for marks in [0, 1, 8, 9, 18, 300] {
                let mut results = results(cases);
                results.marks = vec![Mark::default(); marks];
                let skipped = |n: u32| Skipped {
                    integrator: format!("method-{n}"),
                    ..Skipped::default()
                };
                results.skipped = (0..50).map(skipped).collect();
                results.missing = (0..50).map(|_| Missing::scene("a.toml", "gone")).collect();
                let text = brief(&results);
                let lines = text.lines().count();
                assert!(lines <= 35, "{cases} cases, {marks} marks: {lines}\n{text}");
            }
        }
    }

    #[test]
    fn what_did_not_run_for_one_reason_takes_one_line() {
        let mut results = results(1);
        let skipped = |dt, reason: &str| Skipped {
            case: "case-0".into(),
            integrator: "modal".into(),
            dt,
            reason: reason.into(),
        };
        results.skipped = vec![
            skipped(0.02, "too many modes"),
            skipped(0.01, "too many modes"),
            skipped(0.005, "another"),
        ];
        let text = brief(&results);
        assert!(
            text.contains("\n- case-0, modal, 20, 10 ms: too many modes\n"),
            "{text}"
        );
        assert!(text.contains("\n- case-0, modal, 5 ms: another"), "{text}");
    }

    #[test]
    fn many_scenes_have_a_line_each() {
        let text = brief(&results(18));
        for case in 0..18 {
            let name = format!("case-{case} ");
            let line = text.lines().find(|line| line.contains(&name));
            assert!(line.unwrap().contains("rk4"), "{name}");
        }
        assert!(!text.contains("newmark"));
    }

    #[test]
    fn failed_marks_come_first_and_are_never_left_out_for_passed_ones() {
        let mut results = results(3);
        results.marks = vec![Mark::default(); 60];
        for mark in &mut results.marks {
            mark.verdict = MarkVerdict::Pass;
        }
        results.marks.push(Mark {
            case: "the last one".into(),
            measured: "7.31 %".into(),
            verdict: MarkVerdict::Fail,
            ..Mark::default()
        });
        let text = brief(&results);
        let line = text.lines().find(|line| line.contains("the last one"));
        assert!(line.unwrap().contains("7.31 %"));
        assert!(text.contains("60 passed, 1 failed"), "{text}");
    }
}
