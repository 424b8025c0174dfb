//! The values that an option takes.

use std::ops::{Bound, RangeBounds};

use sinew_core::OptionValue;

/// The kinds of values that an option takes, each checked without other options.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OptionKind {
    /// A finite number between two bounds.
    Number(Bound<f64>, Bound<f64>),
    /// A whole number from 1 to this one.
    Count(u32),
    /// One of these words.
    Words(&'static [&'static str]),
    /// A table with these keys and the values of each. The first must be given.
    Table(&'static [(&'static str, OptionKind)]),
    /// A value of one of several kinds.
    Either(&'static [OptionKind]),
}

impl OptionKind {
    /// A number above 0.
    pub const ABOVE_ZERO: Self = Self::Number(Bound::Excluded(0.0), Bound::Unbounded);

    /// A number from 0 to 1.
    pub const SHARE: Self = Self::Number(Bound::Included(0.0), Bound::Included(1.0));

    /// A number above 0 and below 1.
    pub const PART: Self = Self::Number(Bound::Excluded(0.0), Bound::Excluded(1.0));

    /// True if a value is of this kind.
    #[must_use]
    pub fn fits(&self, value: &OptionValue) -> bool {
        match *self {
            Self::Number(low, high) => value
                .number()
                .is_some_and(|number| (low, high).contains(&number)),
            Self::Count(most) => value.count(most).is_some(),
            Self::Words(words) => value.word().is_some_and(|word| words.contains(&word)),
            Self::Table(keys) => {
                let OptionValue::Table(entries) = value else {
                    return false;
                };
                let first = keys
                    .first()
                    .is_none_or(|(key, _)| entries.contains_key(*key));
                let is_known = |(given, value): (&String, &OptionValue)| {
                    let known = keys.iter().find(|(key, _)| key == given);
                    known.is_some_and(|(_, kind)| kind.fits(value))
                };
                first && entries.iter().all(is_known)
            }
            Self::Either(kinds) => kinds.iter().any(|kind| kind.fits(value)),
        }
    }
}
