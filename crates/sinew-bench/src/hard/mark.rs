//! Marks during their evaluation: the requirement, and the figure compared with it.

use crate::results::Mark;
use sinew_verify::MarkVerdict;

/// A mark before it is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) case: &'static str,
    pub(crate) asked: &'static str,
    pub(crate) limit: f64,
}

impl Asked {
    /// The mark with its figure, which passes up to the limit; NaN fails.
    pub(crate) fn measured(
        self,
        figure: f64,
        shown: impl Fn(f64) -> String,
        by: impl Into<String>,
    ) -> Mark {
        Mark {
            case: self.case.into(),
            asked: self.asked.into(),
            measured: shown(figure),
            figure: figure.is_finite().then_some(figure),
            limit: Some(self.limit),
            by: by.into(),
            verdict: if figure <= self.limit {
                MarkVerdict::Pass
            } else {
                MarkVerdict::Fail
            },
            note: String::new(),
        }
    }

    /// The mark, failed because no figure is available.
    pub(crate) fn not_measured(self, reason: impl Into<String>) -> Mark {
        Mark {
            case: self.case.into(),
            asked: self.asked.into(),
            measured: reason.into(),
            limit: Some(self.limit),
            ..Mark::default()
        }
    }
}

impl Mark {
    /// Adds a remark.
    pub(crate) fn noting(self, note: impl Into<String>) -> Self {
        let note = note.into();
        Self { note, ..self }
    }

    /// The mark, failed also if another condition is not met.
    pub(crate) fn and(self, condition: bool) -> Self {
        let verdict = if condition {
            self.verdict
        } else {
            MarkVerdict::Fail
        };
        Self { verdict, ..self }
    }
}

/// The largest of several figures and its origin; NaN counts as the largest.
#[derive(Debug, Default)]
pub(crate) struct Worst {
    pub(crate) figure: f64,
    pub(crate) by: String,
}

impl Worst {
    pub(crate) fn include(&mut self, figure: f64, by: String) {
        let figure = if figure.is_nan() {
            f64::INFINITY
        } else {
            figure
        };
        if figure > self.figure || self.by.is_empty() {
            *self = Self { figure, by };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::three;

    #[test]
    fn what_is_not_a_number_is_worst() {
        let mut worst = Worst::default();
        for (figure, by) in [(0.0, "a"), (2.0, "b"), (1.0, "c")] {
            worst.include(figure, by.into());
        }
        assert_eq!((worst.figure, worst.by.as_str()), (2.0, "b"));
        worst.include(f64::NAN, "d".into());
        worst.include(3.0, "e".into());
        assert_eq!((worst.figure, worst.by.as_str()), (f64::INFINITY, "d"));
    }

    #[test]
    fn a_figure_passes_up_to_its_limit_and_nan_never_does() {
        let asked = Asked {
            case: "a case",
            asked: "at most 0.1",
            limit: 0.1,
        };
        let verdict = |figure| asked.measured(figure, three, "rk4").verdict;
        assert_eq!(verdict(0.1), MarkVerdict::Pass);
        assert_eq!(verdict(0.100001), MarkVerdict::Fail);
        assert_eq!(verdict(f64::NAN), MarkVerdict::Fail);
        assert_eq!(verdict(f64::INFINITY), MarkVerdict::Fail);
        assert_eq!(
            asked.measured(0.05, three, "rk4").and(false).verdict,
            MarkVerdict::Fail
        );
        assert_eq!(asked.not_measured("no run").verdict, MarkVerdict::Fail);
    }
}
