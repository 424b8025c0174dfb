//! Why the paper could not be reproduced.

use sinew_measure::MeasureError;

/// Why the paper could not be reproduced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// A run failed.
    #[error("{run}: {source}")]
    Run {
        /// Name of the run.
        run: String,
        /// Why.
        source: MeasureError,
    },
    /// A case of the wrong kind.
    #[error("{case}: expected {expected}")]
    Case {
        /// Its id.
        case: String,
        /// The kind of case that fits.
        expected: &'static str,
    },
}
