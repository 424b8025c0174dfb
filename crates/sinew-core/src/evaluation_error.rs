//! Errors of force laws.

/// A force law was evaluated outside its domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("element {element}: {reason}")]
pub struct EvaluationError {
    /// Tag of the element in its mesh.
    pub element: u64,
    /// The reason, with the numbers.
    pub reason: String,
}
