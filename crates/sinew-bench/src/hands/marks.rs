//! Pass marks of scenes with tools.

use sinew_measure::{CaseInfo, Row};

use super::cases::{SIZES, Sizes};
use crate::planned::{is_yardstick, yardstick};
use crate::report::{number, percent};
use crate::results::Mark;
use sinew_verify::MarkVerdict;

/// Largest error (fraction) of a reference with which errors of some per cent can be measured.
const OF_REFERENCE: f64 = 1e-3;

/// Largest error (fraction) of motion and of forces in steps that follow the stiffness.
const OF_METHOD: f64 = 0.05;

/// All marks.
pub(super) fn all(cases: &[CaseInfo], rows: &[Row], quick: bool) -> Vec<Mark> {
    let mut marks = vec![references(cases)];
    marks.extend(steps_that_follow(rows));
    if !quick {
        marks.extend(SIZES.iter().map(|sizes| real_time(sizes, rows)));
    }
    marks
}

/// A mark for the largest of some shares.
fn largest<'a>(
    case: &str,
    asked: &str,
    limit: f64,
    figures: impl Iterator<Item = (f64, String)> + 'a,
) -> Mark {
    let worst = figures.max_by(|a, b| a.0.total_cmp(&b.0));
    let (figure, by) = worst.unwrap_or((f64::INFINITY, "nothing was measured".to_owned()));
    Mark {
        case: case.to_owned(),
        asked: format!("{asked} at most {} %", percent(limit)),
        measured: format!("{} %", percent(figure)),
        figure: figure.is_finite().then_some(figure),
        limit: Some(limit),
        by,
        verdict: MarkVerdict::of(figure <= limit),
        ..Mark::default()
    }
}

fn references(cases: &[CaseInfo]) -> Mark {
    largest(
        "references with tools",
        "difference from a second solution",
        OF_REFERENCE,
        cases
            .iter()
            .map(|case| (case.reference_error, case.id.clone())),
    )
}

/// Central difference in substeps that follow the stiffness, for every step: since contact is exact at the end of each
/// substep, there is no other error.
fn steps_that_follow(rows: &[Row]) -> [Mark; 2] {
    let own: Vec<&Row> = rows.iter().filter(|row| is_yardstick(row)).collect();
    let figures = |error: fn(&Row) -> Option<f64>| {
        own.iter().map(move |row| {
            let dt = number::milliseconds(row.dt);
            let by = format!("{}: {}, {dt} ms", row.case, row.label());
            (error(row).unwrap_or(f64::INFINITY), by)
        })
    };
    [
        largest(
            "steps by the current stiffness, pushed by tools",
            "error of motion",
            OF_METHOD,
            figures(Row::error_at_most),
        ),
        largest(
            "forces on tools, in the same steps",
            "error of their means between instants",
            OF_METHOD,
            figures(|row| row.force_error),
        ),
    ]
}

/// The CPU time of a pressed cube, and the size at which it would be simulated time.
fn real_time(sizes: &Sizes, rows: &[Row]) -> Mark {
    let cost = |case: &str| {
        let mut own = rows.iter().filter(|row| row.case == case);
        own.next().map(|row| row.cpu_s_per_s)
    };
    let figure = cost(sizes.asked).unwrap_or(f64::INFINITY);
    let costs: Vec<(f64, f64)> = sizes
        .cases
        .iter()
        .filter_map(|case| Some((cells(case), cost(case)?)))
        .collect();
    let note = match largest_in_real_time(&costs) {
        Some((cells, is_beyond)) => format!(
            "in real time up to {cells:.0} cells a side, {:.0} tetrahedra{}",
            6.0 * cells.powi(3),
            match is_beyond {
                true => ", beyond the sizes measured",
                false => "",
            }
        ),
        None => String::new(),
    };
    Mark {
        case: format!(
            "a pressed cube of {} cells a side, {}",
            cells(sizes.asked),
            sizes.tissue
        ),
        asked: "CPU time at most 1 s per simulated second, on one thread".to_owned(),
        measured: format!("{} s", number::three(figure)),
        figure: figure.is_finite().then_some(figure),
        limit: Some(1.0),
        by: format!("{}, 10 ms", yardstick().label()),
        verdict: MarkVerdict::of(figure <= 1.0),
        note,
    }
}

/// Cells along an edge, from the end of an id; ten by default.
fn cells(case: &str) -> f64 {
    let last = case.rsplit('-').next();
    last.and_then(|last| last.parse().ok()).unwrap_or(10.0)
}

/// Size at which the cost is 1, on the straight line through the logarithms of the two sizes that enclose it, or of the
/// last two sizes; and true if that size is larger than all measured ones.
fn largest_in_real_time(costs: &[(f64, f64)]) -> Option<(f64, bool)> {
    let about = costs.windows(2).find(|pair| pair[1].1 > 1.0);
    let is_beyond = about.is_none();
    let pair = about.or_else(|| costs.windows(2).last())?;
    let [(small, cheap), (large, dear)] = [pair[0], pair[1]].map(|(n, cost)| (n.ln(), cost.ln()));
    let at = small - cheap * (large - small) / (dear - cheap);
    at.is_finite().then(|| (at.exp(), is_beyond))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_cube_in_real_time_lies_between_two_or_beyond_all() {
        let costs = [(10.0, 0.1), (20.0, 1.6), (40.0, 25.6)];
        let (cells, is_beyond) = largest_in_real_time(&costs).unwrap();
        assert!((cells - 10.0 * 10_f64.powf(0.25)).abs() < 1e-9 && !is_beyond);
        let (cells, is_beyond) = largest_in_real_time(&[(10.0, 0.01), (20.0, 0.08)]).unwrap();
        assert!((cells - 10.0 * 100_f64.powf(1.0 / 3.0)).abs() < 1e-9 && is_beyond);
        assert_eq!(largest_in_real_time(&[(10.0, 0.01)]), None);
    }
}
