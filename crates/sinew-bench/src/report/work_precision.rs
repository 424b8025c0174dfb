//! Work-precision plot: what a method's accuracy costs.

use sinew_draw::{Axis, Colour, Dash, Plot, Point, Series, Style};
use sinew_measure::{Row, RowOutcome};

use super::{missing::shown, number, verdict};
use crate::results::BenchResults;

/// Errors above this (fraction) are drawn in the lane of the unbounded runs.
const LARGEST_SHOWN_ERROR: f64 = 100.0;

/// Errors below this (fraction) are drawn at this: what matters lies above.
const LEAST_SHOWN_ERROR: f64 = 1e-8;

/// Error over CPU time of the runs of a case: a line per method over its steps, and the Pareto
/// front. A method looks the same in the plots of all cases.
#[must_use]
pub fn work_precision(results: &BenchResults, case: &str) -> Plot {
    let rows: Vec<&Row> = results.rows_of(case).collect();
    let title = format!("{case}: error over cost");
    let mut plot = Plot::new(
        title,
        Axis::log("CPU seconds per simulated second"),
        Axis::log("error [%]"),
    )
    .with_horizontal_rule(100.0, "returning\nzero");
    if rows.iter().any(|row| shown_error(row).is_infinite()) {
        plot.lane = Some("unbounded".to_owned());
    }
    if rows
        .iter()
        .any(|row| row.error.is_some_and(|error| error < LEAST_SHOWN_ERROR))
    {
        plot = plot.with_horizontal_rule(100.0 * LEAST_SHOWN_ERROR, "this\nor less");
    }
    plot.height = 400.0;
    if let Some(front) = front(&rows) {
        plot.series.push(front);
    }
    for method in methods(results) {
        let mut runs: Vec<&Row> = rows
            .iter()
            .copied()
            .filter(|row| row.label() == method.label)
            .collect();
        runs.sort_by(|a, b| a.dt.total_cmp(&b.dt));
        if !runs.is_empty() {
            let points = runs.into_iter().map(point).collect();
            plot.series
                .push(Series::new(method.label, method.style, points));
        }
    }
    plot
}

struct MethodChoice {
    label: String,
    style: Style,
}

/// The methods of all cases, one family per integrator.
fn methods(results: &BenchResults) -> Vec<MethodChoice> {
    let mut families: Vec<(&str, Vec<String>)> = Vec::new();
    for row in &results.rows {
        let family = match families.iter().position(|(id, _)| *id == row.integrator) {
            Some(family) => family,
            None => {
                families.push((&row.integrator, Vec::new()));
                families.len() - 1
            }
        };
        let members = &mut families[family].1;
        let label = row.label();
        if !members.contains(&label) {
            members.push(label);
        }
    }
    families
        .into_iter()
        .enumerate()
        .flat_map(|(family, (_, members))| {
            members.into_iter().enumerate().map(move |(member, label)| {
                let style = Style::of_family(family, member);
                MethodChoice { label, style }
            })
        })
        .collect()
}

fn point(row: &Row) -> Point {
    Point {
        x: row.cpu_s_per_s,
        y: 100.0 * shown_error(row),
        note: format!(
            "{}, dt = {} ms: error {}, {} CPU s per s ({})",
            row.label(),
            number::milliseconds(row.dt),
            verdict::error_with_unit(row),
            shown(row.cpu_s_per_s, number::three),
            row.verdict().word(),
        ),
        ringed: row.pareto,
    }
}

/// The error as drawn: infinite where it has no place in the frame.
fn shown_error(row: &Row) -> f64 {
    match (row.outcome, row.error_at_most()) {
        (RowOutcome::Finished, Some(error)) if row.bounded && error <= LARGEST_SHOWN_ERROR => {
            error.max(LEAST_SHOWN_ERROR)
        }
        _ => f64::INFINITY,
    }
}

/// The staircase of what can be had for a given cost.
fn front(rows: &[&Row]) -> Option<Series> {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.pareto)
        .map(|row| (row.cpu_s_per_s, 100.0 * shown_error(row)))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let style = Style {
        colour: Colour(0xb8, 0xb8, 0xb8),
        marker: None,
        dash: Dash::Solid,
        width: 6.0,
        steps: true,
    };
    (!points.is_empty()).then(|| Series::line("Pareto front (ringed)", style, points))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Machine;

    fn row(case: &str, integrator: &str, dt: f64, error: f64) -> Row {
        Row {
            case: case.into(),
            integrator: integrator.into(),
            dt,
            error: Some(error),
            bounded: true,
            cpu_s_per_s: 1e-3 / dt,
            ..Row::default()
        }
    }

    #[test]
    fn a_method_looks_the_same_in_every_case() {
        let mut results = BenchResults::new("r", Machine::default());
        results.rows = vec![
            row("a", "rk4", 0.02, 0.1),
            row("a", "cnn", 0.02, 0.1),
            row("b", "cnn", 0.02, 0.1),
        ];
        let style = |case, n: usize| work_precision(&results, case).series[n].style;
        assert_eq!(style("a", 1), style("b", 0));
        assert_ne!(style("a", 0), style("a", 1));
    }

    #[test]
    fn unbounded_runs_have_a_lane_and_runs_are_ordered_by_step() {
        let mut results = BenchResults::new("r", Machine::default());
        results.rows = vec![
            row("a", "cnn", 0.02, 0.1),
            row("a", "cnn", 0.01, 0.05),
            Row {
                bounded: false,
                ..row("a", "cnn", 0.03, 4e30)
            },
        ];
        let plot = work_precision(&results, "a");
        assert!(plot.lane.is_some());
        let errors: Vec<f64> = plot.series[0].points.iter().map(|p| p.y).collect();
        assert_eq!(errors, [5.0, 10.0, f64::INFINITY]);
    }
}
