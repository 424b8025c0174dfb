//! Errors of the lookup of laws by their ids.

use super::parameters::ParameterError;

/// A law that does not exist, or cannot have its parameters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// No law has this id.
    #[error("no law is called `{id}`; there are {}", known.join(", "))]
    Unknown {
        /// The id.
        id: String,
        /// The ids that are known.
        known: Vec<&'static str>,
    },
    /// The law cannot have these parameters.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}
