//! Errors of the lookup of laws by their ids.

use super::parameters::ParameterError;

/// A law that does not exist, or whose parameters are not allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// An id that no law has.
    #[error("no law is called `{id}`; there are {}", known.join(", "))]
    Unknown {
        /// The id.
        id: String,
        /// The ids that are known.
        known: Vec<&'static str>,
    },
    /// Parameters that the law does not allow.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}
