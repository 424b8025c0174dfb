//! Conditions of a key on other keys.

/// A condition that must be met if a key is given.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Condition {
    /// Requirement for the other keys.
    pub(crate) goes: Goes,
    /// The reason for the error message if the condition is not met: the end of a sentence that begins with the key.
    pub(crate) reason: &'static str,
    /// Remedy, if there is one.
    pub(crate) help: Option<&'static str>,
    /// Another key and those of its words with which a required key must be given, if the key may be left out with
    /// other words.
    pub(crate) required: Option<(&'static str, AllWords)>,
}

/// Words that are known at run time.
pub(crate) type AllWords = fn() -> &'static [&'static str];

/// Requirement for another key of a table.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Goes {
    /// This key must be given.
    With(&'static str),
    /// This key must not be given.
    Without(&'static str),
    /// This key must be one of these words.
    If(&'static str, &'static [&'static str]),
    /// This key must be one of these words, which are known at run time.
    Among(&'static str, AllWords),
    /// A requirement that cannot be met: the key is described only to be refused with a reason.
    Never,
}

impl Goes {
    /// The other key and the words that it may be; `None` for a condition of another kind.
    pub(crate) fn words(self) -> Option<(&'static str, &'static [&'static str])> {
        match self {
            Self::If(other, words) => Some((other, words)),
            Self::Among(other, words) => Some((other, words())),
            Self::With(_) | Self::Without(_) | Self::Never => None,
        }
    }
}

impl Condition {
    const fn new(goes: Goes, reason: &'static str) -> Self {
        Self {
            goes,
            reason,
            help: None,
            required: None,
        }
    }

    /// Condition that the other key is given.
    pub(crate) const fn with(other: &'static str, reason: &'static str) -> Self {
        Self::new(Goes::With(other), reason)
    }

    /// Condition that the other key is not given.
    pub(crate) const fn without(other: &'static str, reason: &'static str) -> Self {
        Self::new(Goes::Without(other), reason)
    }

    /// Condition that the other key is one of these words.
    pub(crate) const fn where_is(
        other: &'static str,
        words: &'static [&'static str],
        reason: &'static str,
    ) -> Self {
        Self::new(Goes::If(other, words), reason)
    }

    /// Condition that the other key is one of the words that are known at run time.
    pub(crate) const fn among(other: &'static str, words: AllWords, reason: &'static str) -> Self {
        Self::new(Goes::Among(other, words), reason)
    }

    /// The words of the other key with which a required key must be given.
    pub(crate) const fn required_with(self, other: &'static str, words: AllWords) -> Self {
        Self {
            required: Some((other, words)),
            ..self
        }
    }

    /// Condition that is never met: the key is refused.
    pub(crate) const fn never(reason: &'static str) -> Self {
        Self::new(Goes::Never, reason)
    }

    /// Adds a remedy for a condition that is not met.
    pub(crate) const fn help(self, help: &'static str) -> Self {
        Self {
            help: Some(help),
            ..self
        }
    }
}
