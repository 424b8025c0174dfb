//! The appearance of verdicts: a symbol and a word with every colour.

use sinew_draw::Colour;
use sinew_measure::{Row, RowOutcome, RowVerdict};

use super::{missing::shown, number};

/// Description of the meaning of a verdict.
pub(super) fn meaning(verdict: RowVerdict) -> &'static str {
    match verdict {
        RowVerdict::Accurate => "error ≤ 5 %",
        RowVerdict::Wrong => "bounded, error > 5 %",
        RowVerdict::Guarded => "cells saturated",
        RowVerdict::Unbounded => "|u| > 10× the reference's",
        RowVerdict::Diverged => "given up early",
        RowVerdict::Refused => "a step was refused, by the law or by the method",
    }
}

/// Colour of a verdict, light enough for black text: tints of the Okabe-Ito colours.
pub(super) fn tint(verdict: RowVerdict) -> Colour {
    match verdict {
        RowVerdict::Accurate => Colour(0xb8, 0xe6, 0xd4),
        RowVerdict::Wrong => Colour(0xfb, 0xe3, 0xad),
        RowVerdict::Guarded => Colour(0xec, 0xcf, 0xe0),
        RowVerdict::Unbounded => Colour(0xf6, 0xb9, 0x8d),
        RowVerdict::Diverged => Colour(0xd9, 0xd9, 0xd9),
        RowVerdict::Refused => Colour(0xc9, 0xdd, 0xf0),
    }
}

/// The error in per cent without the sign, or the text that replaces it.
pub(super) fn error(row: &Row) -> String {
    match (row.outcome, row.error) {
        (RowOutcome::Diverged, _) => match row.diverged_at_s {
            Some(t) => format!("diverged at t={} s", number::short(t)),
            None => "diverged".to_owned(),
        },
        (RowOutcome::Refused, _) => match row.diverged_at_s {
            Some(t) => format!("refused at t={} s", number::short(t)),
            None => "refused".to_owned(),
        },
        (RowOutcome::Finished, Some(error)) if row.bounded => match row.error_is_below {
            Some(_) => row.error_in_percent().unwrap_or_default(),
            None => shown(error, number::percent),
        },
        (RowOutcome::Finished, Some(error)) => {
            format!("unbounded ({})", shown(error, number::percent))
        }
        (RowOutcome::Finished, None) => "n/a".to_owned(),
    }
}

/// The error with its unit, if it is a number.
pub(super) fn error_with_unit(row: &Row) -> String {
    match (row.outcome, row.bounded) {
        (RowOutcome::Finished, _) if row.error.is_none_or(|error| !error.is_finite()) => error(row),
        (RowOutcome::Finished, true) => format!("{} %", error(row)),
        (RowOutcome::Finished, false) => error(row).replace(')', " %)"),
        (RowOutcome::Diverged | RowOutcome::Refused, _) => error(row),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_and_what_stands_for_them() {
        let row = |outcome, bounded, error, diverged_at_s| Row {
            outcome,
            bounded,
            error,
            diverged_at_s,
            ..Row::default()
        };
        let fine = row(RowOutcome::Finished, true, Some(25.2), None);
        assert_eq!(error(&fine), "2520");
        assert_eq!(error_with_unit(&fine), "2520 %");
        let tiny = Row {
            error_is_below: Some(2e-9),
            ..row(RowOutcome::Finished, true, Some(1e-12), None)
        };
        assert_eq!(error(&tiny), "< 2.00e-7");
        assert_eq!(error_with_unit(&tiny), "< 2.00e-7 %");
        let unbounded = row(RowOutcome::Finished, false, Some(4e30), None);
        assert_eq!(error(&unbounded), "unbounded (4.00e32)");
        assert_eq!(error_with_unit(&unbounded), "unbounded (4.00e32 %)");
        let nothing = row(RowOutcome::Finished, true, None, None);
        assert_eq!(error_with_unit(&nothing), "n/a");
        let infinite = row(RowOutcome::Finished, true, Some(f64::INFINITY), None);
        assert_eq!(error_with_unit(&infinite), "n/a (inf)");
        let diverged = row(RowOutcome::Diverged, false, None, Some(0.34));
        assert_eq!(error(&diverged), "diverged at t=0.34 s");
        assert_eq!(error_with_unit(&diverged), "diverged at t=0.34 s");
    }
}
