//! The cheapest run of a case that is good enough.

use sinew_measure::Row;

/// Errors (fraction) for which the cheapest run is shown.
pub(super) const GOOD_ENOUGH: [f64; 3] = [0.1, 0.01, 0.001];

/// The run that costs least among those, bounded and not saturated, with at most the given error (fraction).
pub(super) fn cheapest<'a>(
    rows: impl IntoIterator<Item = &'a Row>,
    largest_error: f64,
) -> Option<&'a Row> {
    rows.into_iter()
        .filter(|row| {
            row.sound_error()
                .is_some_and(|error| error <= largest_error)
        })
        .filter(|row| row.cpu_s_per_s.is_finite())
        .min_by(|a, b| a.cpu_s_per_s.total_cmp(&b.cpu_s_per_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guarded_run_is_never_the_cheapest() {
        let row = |cpu_s_per_s, error, saturated| Row {
            cpu_s_per_s,
            error: Some(error),
            saturated,
            bounded: true,
            ..Row::default()
        };
        let rows = [
            row(1.0, 0.01, 0.5),
            row(2.0, 0.04, 0.0),
            row(3.0, 0.01, 0.0),
            row(-f64::NAN, 0.001, 0.0),
        ];
        assert_eq!(cheapest(&rows, 0.05), Some(&rows[1]));
        assert_eq!(cheapest(&rows, 0.01), Some(&rows[2]));
        assert_eq!(cheapest(&rows, 0.001), None);
    }
}
