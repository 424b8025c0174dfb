//! Readers of single values: numbers, texts, lists.

use std::ops::RangeInclusive;

use toml::de::{DeArray, DeValue};

/// The reason why a value does not fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Misfit {
    /// The type is wrong.
    Type,
    /// The type is right, the value is not.
    Value,
    /// A whole number is larger than the largest one of TOML.
    TooLarge,
    /// A text in the value is not a formula.
    Formula,
}

/// Description of the type of a value.
pub(crate) fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

pub(super) fn satisfying<T>(value: T, fits: impl FnOnce(&T) -> bool) -> Result<T, Misfit> {
    if fits(&value) {
        Ok(value)
    } else {
        Err(Misfit::Value)
    }
}

/// A number that is neither infinite nor NaN.
pub(crate) fn finite(value: &DeValue<'_>) -> Result<f64, Misfit> {
    let number = match value {
        DeValue::Float(float) => float.as_str().parse().map_err(|_| Misfit::Value)?,
        DeValue::Integer(_) => integer(value).map_err(|_| Misfit::TooLarge)? as f64,
        _ => return Err(Misfit::Type),
    };
    satisfying(number, |number: &f64| number.is_finite())
}

pub(crate) fn integer(value: &DeValue<'_>) -> Result<i64, Misfit> {
    let DeValue::Integer(integer) = value else {
        return Err(Misfit::Type);
    };
    i64::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| Misfit::Value)
}

/// Description of the whole numbers that are accepted as numbers.
pub(super) const WITHIN: &str = "whole numbers of at most 9223372036854775807 in size; write a larger number with a point or an exponent";

/// A whole number from 1 to `most`.
pub(crate) fn count_within(
    range: RangeInclusive<usize>,
) -> impl FnOnce(&DeValue<'_>) -> Result<usize, Misfit> {
    move |value| {
        let count = usize::try_from(integer(value)?).map_err(|_| Misfit::Value)?;
        satisfying(count, |count| range.contains(count))
    }
}

pub(crate) fn boolean(value: &DeValue<'_>) -> Result<bool, Misfit> {
    value.as_bool().ok_or(Misfit::Type)
}

/// A string that is not blank.
pub(crate) fn text(value: &DeValue<'_>) -> Result<String, Misfit> {
    let text = value.as_str().ok_or(Misfit::Type)?;
    satisfying(text.to_owned(), |text| !text.trim().is_empty())
}

/// A list in which every item can be read.
pub(crate) fn list<T>(
    value: &DeValue<'_>,
    item: impl Fn(&DeValue<'_>) -> Result<T, Misfit>,
) -> Result<Vec<T>, Misfit> {
    let items: &DeArray<'_> = value.as_array().ok_or(Misfit::Type)?;
    let items = items.iter().map(|value| item(value.get_ref()));
    items
        .collect::<Result<_, _>>()
        .map_err(|misfit| match misfit {
            Misfit::Type => Misfit::Value,
            other => other,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<T>(
        text: &str,
        read: impl FnOnce(&DeValue<'_>) -> Result<T, Misfit>,
    ) -> Result<T, Misfit> {
        read(DeValue::parse(text).unwrap().get_ref())
    }

    #[test]
    fn numbers_are_finite_whatever_their_notation() {
        assert_eq!(read("1_000", finite), Ok(1000.0));
        assert_eq!(read("0x10", finite), Ok(16.0));
        assert_eq!(read("-1.5e-3", finite), Ok(-1.5e-3));
        for not_finite in ["nan", "-inf", "1e400"] {
            assert_eq!(read(not_finite, finite), Err(Misfit::Value), "{not_finite}");
        }
        assert_eq!(read("99999999999999999999", finite), Err(Misfit::TooLarge));
        assert_eq!(read("\"1\"", finite), Err(Misfit::Type));
    }

    #[test]
    fn counts_are_whole_and_bounded() {
        assert_eq!(read("3", count_within(1..=3)), Ok(3));
        assert_eq!(read("4", count_within(1..=3)), Err(Misfit::Value));
        assert_eq!(read("0", count_within(1..=3)), Err(Misfit::Value));
        assert_eq!(read("-1", count_within(1..=3)), Err(Misfit::Value));
        assert_eq!(read("2.0", count_within(1..=3)), Err(Misfit::Type));
    }
}
