//! An error to be reached with a limited number of sweeps a step.

use sinew_measure::Row;

use super::at;
use crate::hard::mark::Asked;
use crate::report::percent;
use crate::results::Mark;

/// Evaluates the rows without solves that take at most `sweeps_a_step` sweeps per step: the one with the least work
/// that passes, or otherwise the one with the smallest error.
pub(crate) fn check<'a>(
    asked: Asked,
    rows: impl IntoIterator<Item = &'a Row>,
    dt: f64,
    sweeps_a_step: u64,
) -> Mark {
    let rows: Vec<&Row> = rows.into_iter().filter(|row| row.dt == dt).collect();
    let candidates: Vec<&Row> = rows
        .iter()
        .copied()
        .filter(|row| {
            row.work.solves == 0 && row.work.sweeps <= sweeps_a_step.saturating_mul(row.steps)
        })
        .collect();
    let error = |row: &Row| match row.error {
        Some(error) if row.bounded => error,
        _ => f64::INFINITY,
    };
    let passing = candidates.iter().filter(|row| error(row) <= asked.limit);
    let best = passing
        .min_by(|a, b| a.sweeps_per_s.total_cmp(&b.sweeps_per_s))
        .or_else(|| {
            candidates
                .iter()
                .min_by(|a, b| error(a).total_cmp(&error(b)))
        });
    let Some(best) = best else {
        return asked.not_measured("no run at this step with so few sweeps");
    };
    let shown = |figure: f64| match figure.is_finite() {
        true => format!("{} %", percent(figure)),
        false => "unbounded".into(),
    };
    let others: Vec<String> = rows
        .iter()
        .filter(|row| row.label() != best.label())
        .map(|row| format!("{} {}", row.label(), shown(error(row))))
        .collect();
    asked
        .measured(error(best), shown, at(&best.label(), dt))
        .noting(others.join(", "))
}
