//! Work-precision plot: the cost of a method's accuracy.

use sinew_draw::{Axis, Colour, Dash, Plot, Point, Series, Style};
use sinew_measure::{Row, RowOutcome};

use super::{missing::shown, number, verdict};
use crate::results::BenchResults;

/// Errors above this (fraction) are drawn in the lane of the unbounded runs.
const LARGEST_SHOWN_ERROR: f64 = 100.0;

/// Errors below this (fraction) are drawn in a separate lane: relevant errors are larger.
pub(super) const LEAST_SHOWN_ERROR: f64 = 1e-8;

/// Error over CPU time of the runs of a case: a line per method over its steps, and the Pareto front down to the first
/// run below all shown errors. A method has the same style in the plots of all cases, laws and elements, and no two
/// methods share one.
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
    let has = |lane: f64| rows.iter().any(|row| shown_error(row) == lane);
    if has(f64::INFINITY) {
        plot.lane_above = Some("unbounded".to_owned());
    }
    if has(f64::NEG_INFINITY) {
        let least = (100.0 * LEAST_SHOWN_ERROR).log10();
        plot.lane_below = Some(format!("below 10^{{−{:.0}}}", -least));
    }
    plot.width = 900.0;
    plot.height = 460.0;
    let front = front(&rows);
    if !front.is_empty() {
        plot.series.push(staircase(&front));
    }
    for (index, label) in methods(results).into_iter().enumerate() {
        let mut runs: Vec<&Row> = rows
            .iter()
            .copied()
            .filter(|row| row.method() == label)
            .collect();
        runs.sort_by(|a, b| a.dt.total_cmp(&b.dt));
        if !runs.is_empty() {
            let is_ringed = |run: &Row| front.iter().any(|row| std::ptr::eq(*row, run));
            let points = runs.into_iter().map(|run| point(run, is_ringed(run)));
            let points = points.collect();
            plot.series
                .push(Series::new(label, Style::nth(index), points));
        }
    }
    plot
}

/// The methods of all cases.
fn methods(results: &BenchResults) -> Vec<String> {
    let mut methods: Vec<String> = Vec::new();
    for row in &results.rows {
        let method = row.method();
        if !methods.contains(&method) {
            methods.push(method);
        }
    }
    methods
}

fn point(row: &Row, ringed: bool) -> Point {
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
        ringed,
    }
}

/// The error for the drawing: infinite if it is above the frame, minus infinity if it is below.
fn shown_error(row: &Row) -> f64 {
    match (row.outcome, row.error_at_most()) {
        (RowOutcome::Finished, Some(error)) if row.bounded && error <= LARGEST_SHOWN_ERROR => {
            if error < LEAST_SHOWN_ERROR {
                f64::NEG_INFINITY
            } else {
                error
            }
        }
        _ => f64::INFINITY,
    }
}

/// The runs on the front, the cheapest first, down to the first run below all shown errors.
fn front<'a>(rows: &[&'a Row]) -> Vec<&'a Row> {
    let mut front: Vec<&Row> = rows.iter().copied().filter(|row| row.pareto).collect();
    front.sort_by(|a, b| a.cpu_s_per_s.total_cmp(&b.cpu_s_per_s));
    let is_below = |row: &&Row| shown_error(row) == f64::NEG_INFINITY;
    if let Some(last) = front.iter().position(is_below) {
        front.truncate(last + 1);
    }
    front
}

/// Smallest error at a given cost, as a staircase.
fn staircase(front: &[&Row]) -> Series {
    let points = front
        .iter()
        .map(|row| (row.cpu_s_per_s, 100.0 * shown_error(row)));
    let style = Style {
        colour: Colour(0xb8, 0xb8, 0xb8),
        marker: None,
        dash: Dash::Solid,
        width: 6.0,
        steps: true,
    };
    Series::line("Pareto front (ringed)", style, points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_verify::Machine;

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
        assert!(plot.lane_above.is_some() && plot.lane_below.is_none());
        let errors: Vec<f64> = plot.series[0].points.iter().map(|p| p.y).collect();
        assert_eq!(errors, [5.0, 10.0, f64::INFINITY]);
    }

    #[test]
    fn many_methods_look_different() {
        let mut results = BenchResults::new("r", Machine::default());
        results.rows = (0..24)
            .map(|n| row("a", &format!("method-{n}"), 0.02, 0.1))
            .collect();
        let plot = work_precision(&results, "a");
        let looks: Vec<_> = plot
            .series
            .iter()
            .map(|series| (series.style.colour, series.style.marker))
            .collect();
        assert_eq!(looks.len(), 24);
        for (i, look) in looks.iter().enumerate() {
            assert!(!looks[i + 1..].contains(look), "{i}");
        }
    }

    #[test]
    fn only_the_cheapest_of_the_smallest_errors_is_ringed() {
        let mut results = BenchResults::new("r", Machine::default());
        results.rows = vec![
            row("a", "rk4", 0.02, 0.1),
            row("a", "rk4", 0.01, 1e-10),
            row("a", "rk4", 0.005, 1e-11),
        ];
        sinew_measure::mark_pareto(&mut results.rows);
        assert!(results.rows.iter().all(|row| row.pareto));
        let plot = work_precision(&results, "a");
        assert_eq!(plot.lane_below.as_deref(), Some("below 10^{−6}"));
        let rings: Vec<bool> = plot.series[1].points.iter().map(|p| p.ringed).collect();
        assert_eq!(rings, [false, true, true]);
        assert_eq!(plot.series[0].points.len(), 2);
    }
}
