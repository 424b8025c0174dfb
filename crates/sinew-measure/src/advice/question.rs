//! The question for the advice.

use serde::{Deserialize, Serialize};

use crate::cost::Cost;

/// Time for pilots (CPU s) unless another is given.
pub const DEFAULT_PILOT_SECONDS: f64 = 10.0;

/// A required error, a budget, or both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Question {
    /// Largest relative error (fraction); without it, the smallest error within the budget is requested.
    pub tolerance: Option<f64>,
    /// Largest CPU time per simulated second (s), without set-up.
    pub budget: Option<f64>,
    /// CPU time (s) after which no pilot starts.
    pub pilot_seconds: f64,
    /// Measure of the cost of a run.
    pub cost: Cost,
}

/// A question that has no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuestionError {
    /// The tolerance.
    #[error(
        "a tolerance of {0}: expected a fraction above 0 and below 1, such as 1e-2; returning zero has an error of 1"
    )]
    Tolerance(f64),
    /// The budget.
    #[error(
        "a budget of {0}: expected finite CPU seconds per simulated second above 0; 1 is real time"
    )]
    Budget(f64),
    /// Neither of them was given.
    #[error("neither a tolerance nor a budget is given; expected one of them, or both")]
    Nothing,
    /// The time for pilots.
    #[error("{0} s for pilots: expected a finite time above 0 s and up to 1e9 s, such as 10")]
    PilotSeconds(f64),
}

impl Question {
    /// An error at any cost.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance: Some(tolerance),
            budget: None,
            pilot_seconds: DEFAULT_PILOT_SECONDS,
            cost: Cost::default(),
        }
    }

    /// The smallest error for a cost (CPU s per simulated s).
    #[must_use]
    pub fn within(budget: f64) -> Self {
        Self {
            tolerance: None,
            budget: Some(budget),
            ..Self::new(f64::NAN)
        }
    }

    pub(super) fn check(self) -> Result<(), QuestionError> {
        if self.tolerance.is_none() && self.budget.is_none() {
            return Err(QuestionError::Nothing);
        }
        self.tolerance.map_or(Ok(()), check_tolerance)?;
        self.budget.map_or(Ok(()), check_budget)?;
        check_pilot_seconds(self.pilot_seconds)
    }
}

/// Checks that a tolerance can be requested.
///
/// # Errors
/// [`QuestionError::Tolerance`].
pub fn check_tolerance(tolerance: f64) -> Result<(), QuestionError> {
    if tolerance > 0.0 && tolerance < 1.0 {
        return Ok(());
    }
    Err(QuestionError::Tolerance(tolerance))
}

/// Checks that a budget (CPU s per simulated s) can be kept.
///
/// # Errors
/// [`QuestionError::Budget`].
pub fn check_budget(budget: f64) -> Result<(), QuestionError> {
    if budget > 0.0 && budget.is_finite() {
        return Ok(());
    }
    Err(QuestionError::Budget(budget))
}

/// Checks that a time (CPU s) can be given to pilots.
///
/// # Errors
/// [`QuestionError::PilotSeconds`].
pub fn check_pilot_seconds(seconds: f64) -> Result<(), QuestionError> {
    // A Duration holds it with a wide margin.
    if seconds > 0.0 && seconds <= 1e9 {
        return Ok(());
    }
    Err(QuestionError::PilotSeconds(seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_asked_is_refused_with_what_can() {
        for tolerance in [0.0, -1e-2, 1.0, 2.0, f64::NAN, f64::INFINITY] {
            let message = Question::new(tolerance).check().unwrap_err().to_string();
            assert!(message.contains("such as 1e-2"), "{message}");
        }
        for budget in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let budget = Some(budget);
            let question = Question {
                budget,
                ..Question::new(1e-2)
            };
            let message = question.check().unwrap_err().to_string();
            assert!(
                message.contains("CPU seconds per simulated second"),
                "{message}"
            );
        }
        for pilot_seconds in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let question = Question {
                pilot_seconds,
                ..Question::new(1e-2)
            };
            assert!(matches!(
                question.check(),
                Err(QuestionError::PilotSeconds(_))
            ));
        }
        let budget = Some(1e-3);
        let question = Question {
            budget,
            ..Question::new(0.99)
        };
        assert_eq!(question.check(), Ok(()));
        assert_eq!(Question::within(1e-3).check(), Ok(()));
        let nothing = Question {
            budget: None,
            ..Question::within(1e-3)
        };
        assert_eq!(nothing.check(), Err(QuestionError::Nothing));
    }
}
