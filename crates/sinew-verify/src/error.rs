//! Reasons for which there is no figure.

use std::error::Error;
use std::fmt;

/// A reason for which there is no figure: the error of a call, or a sentence. Reasons are for readers; no code
/// distinguishes them.
pub struct LabError(Box<dyn Error + Send + Sync>);

impl LabError {
    /// A sentence.
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        Self(reason.into().into())
    }

    /// An error of an unknown kind.
    #[must_use]
    pub fn boxed(error: Box<dyn Error + Send + Sync>) -> Self {
        Self(error)
    }

    /// A scene or a system without the body that a computation needs.
    #[must_use]
    pub fn no_body() -> Self {
        Self::new("the scene has no body")
    }
}

impl<E: Error + Send + Sync + 'static> From<E> for LabError {
    fn from(error: E) -> Self {
        Self(Box::new(error))
    }
}

impl fmt::Display for LabError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Debug for LabError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}
