//! Reasons why there is no advice.

use super::question::QuestionError;
use crate::case::CaseError;
use crate::one_thread::ThreadError;

/// Reasons why there is no advice.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AdviceError {
    /// The question is not valid.
    #[error(transparent)]
    Question(#[from] QuestionError),
    /// The scene has no reference.
    #[error("no advice without a reference: {0}")]
    Case(#[from] CaseError),
    /// The scene moves too fast for the available time.
    #[error(
        "the scene moves too fast to be followed: {duration:e} s of it take {needed:.0e} s of CPU time; shorten [run] duration, look for a stiffness or mass in wrong units, or give --pilot-seconds more"
    )]
    TooFast {
        /// The shortest representative part (s).
        duration: f64,
        /// CPU time (s) it takes.
        needed: f64,
    },
    /// No time was left for pilots.
    #[error(
        "no run could be measured: set-up and the reference took {spent:.1} s of CPU time, and {given} s were given; give --pilot-seconds more, such as {:.0}",
        10.0 * .spent.max(*.given)
    )]
    NoTime {
        /// CPU time given (s).
        given: f64,
        /// CPU time taken (s).
        spent: f64,
    },
    /// Errors are relative to the motion, and nothing moves.
    #[error(
        "nothing moves in the first {duration} s of the scene, so that no error can be computed; {remedy}"
    )]
    NothingMoves {
        /// The part of the scene that was followed (s).
        duration: f64,
        /// Advice to the user.
        remedy: &'static str,
    },
    /// The reference is no better than the tolerance.
    #[error(
        "a tolerance of {tolerance:e} cannot be distinguished from the reference's own error, {reference:.1e}; ask for {least:e} or more"
    )]
    BeyondReference {
        /// The requested tolerance.
        tolerance: f64,
        /// The reference's error (fraction).
        reference: f64,
        /// The smallest tolerance of one digit that can be distinguished from it.
        least: f64,
    },
    /// No thread could be started for the measurement.
    #[error(transparent)]
    Thread(#[from] ThreadError),
}
