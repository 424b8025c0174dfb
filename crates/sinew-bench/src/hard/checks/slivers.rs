//! The cost of one thin element in accuracy.

use sinew_measure::Row;

use super::at;
use crate::hard::mark::Asked;
use crate::report::{short, three};
use crate::results::Mark;

/// The error with a sliver over that without, for the method with the least work among those that pass, or otherwise
/// for the one with the smallest ratio.
pub(crate) fn check(asked: Asked, uniform: &[&Row], sliver: &[&Row]) -> Mark {
    let mut found: Vec<(&Row, f64)> = Vec::new();
    for row in sliver {
        let twin = uniform
            .iter()
            .find(|twin| twin.label() == row.label() && twin.dt == row.dt);
        let errors = twin.map(|twin| (row.error, twin.error));
        let ratio = match errors {
            Some((Some(with), Some(without))) if row.bounded => with / without,
            Some(_) => f64::INFINITY,
            None => continue,
        };
        found.push((row, ratio));
    }
    let passing = found.iter().filter(|(_, ratio)| *ratio <= asked.limit);
    // Where the whole body is solved for, work is no question of sweeps.
    let factorises =
        |row: &Row| sinew_integrators::entry(&row.integrator).is_some_and(|e| e.factorises);
    let explicit = passing.filter(|(row, _)| !factorises(row));
    let best = explicit
        .min_by(|a, b| a.0.sweeps_per_s.total_cmp(&b.0.sweeps_per_s))
        .or_else(|| found.iter().min_by(|a, b| a.1.total_cmp(&b.1)));
    let Some((row, ratio)) = best else {
        return asked.not_measured("no run on both meshes");
    };
    let shown = |ratio: f64| match ratio.is_finite() {
        true => format!("{} times", three(ratio)),
        false => "unbounded".into(),
    };
    let work = |row: &Row| format!("{} sweeps/s", short(row.sweeps_per_s));
    let others = found
        .iter()
        .filter(|(other, _)| other.label() != row.label());
    let others: Vec<String> = others
        .map(|(other, ratio)| format!("{} {} ({})", other.label(), shown(*ratio), work(other)))
        .collect();
    asked
        .measured(
            *ratio,
            shown,
            format!("{} ({})", at(&row.label(), row.dt), work(row)),
        )
        .noting(others.join(", "))
}
