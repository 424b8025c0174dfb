//! Behaviour if a key is not given.

use crate::error::SceneError;

/// A key that must be given, if its conditions allow it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Required;

/// A key that may be left out, with a description of the behaviour in this case.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Optional(pub(crate) &'static str);

/// A key with a default.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Or<T>(pub(crate) T);

/// A table that may be left out, with the TOML that its reader uses instead.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Usual(pub(crate) &'static str);

/// Result of reading a key whose value is a `T` and which may be absent.
pub(crate) trait Presence<T> {
    /// The result: the value, or an optional value.
    type Read;

    /// The value given, or the one for its absence.
    fn settle(
        &self,
        given: Option<T>,
        missing: impl FnOnce() -> SceneError,
    ) -> Result<Self::Read, SceneError>;
}

impl<T> Presence<T> for Required {
    type Read = T;

    fn settle(
        &self,
        given: Option<T>,
        missing: impl FnOnce() -> SceneError,
    ) -> Result<T, SceneError> {
        given.ok_or_else(missing)
    }
}

impl<T> Presence<T> for Optional {
    type Read = Option<T>;

    fn settle(
        &self,
        given: Option<T>,
        _: impl FnOnce() -> SceneError,
    ) -> Result<Option<T>, SceneError> {
        Ok(given)
    }
}

impl<T> Presence<T> for Usual {
    type Read = Option<T>;

    fn settle(
        &self,
        given: Option<T>,
        _: impl FnOnce() -> SceneError,
    ) -> Result<Option<T>, SceneError> {
        Ok(given)
    }
}

impl<T: Copy> Presence<T> for Or<T> {
    type Read = T;

    fn settle(&self, given: Option<T>, _: impl FnOnce() -> SceneError) -> Result<T, SceneError> {
        Ok(given.unwrap_or(self.0))
    }
}
