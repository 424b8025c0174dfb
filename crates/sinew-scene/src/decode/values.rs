//! The kinds of values that keys take.

use std::ops::{Bound, RangeBounds};

use toml::de::DeValue;

use super::description::{Shape, TableDescription};
use super::value::{Misfit, boolean, count_within, finite, list, satisfying, text};

/// A kind of values, as a description and as data.
pub(crate) trait Kind: Copy + Sync {
    /// Description of the values that fit, to follow "expected".
    fn expected(&self) -> String;

    /// The values that fit, as data.
    fn shape(&self) -> Shape;

    /// The end of the meaning of a key with such values, if it follows from them.
    fn details(&self) -> String {
        String::new()
    }
}

/// A kind of values that can be read.
pub(crate) trait Values: Kind {
    /// The value after reading.
    type Read;

    /// Reads a value.
    fn read(&self, value: &DeValue<'_>) -> Result<Self::Read, Misfit>;
}

/// A kind of values that may be defaults.
pub(crate) trait Written: Values {
    /// The TOML text of a value.
    fn written(&self, value: &Self::Read) -> String;
}

/// A finite number within bounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Number {
    expected: &'static str,
    low: Bound<f64>,
    high: Bound<f64>,
}

impl Number {
    /// A number between two bounds, which `expected` describes.
    pub(crate) const fn between(expected: &'static str, low: Bound<f64>, high: Bound<f64>) -> Self {
        Self {
            expected,
            low,
            high,
        }
    }

    /// Any finite number.
    pub(crate) const fn finite(expected: &'static str) -> Self {
        Self::between(expected, Bound::Unbounded, Bound::Unbounded)
    }

    /// A number above 0.
    pub(crate) const fn above_zero(expected: &'static str) -> Self {
        Self::between(expected, Bound::Excluded(0.0), Bound::Unbounded)
    }

    /// A number that is 0 or above.
    pub(crate) const fn zero_or_above(expected: &'static str) -> Self {
        Self::between(expected, Bound::Included(0.0), Bound::Unbounded)
    }
}

impl Kind for Number {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::Number(self.low, self.high)
    }
}

impl Values for Number {
    type Read = f64;

    fn read(&self, value: &DeValue<'_>) -> Result<f64, Misfit> {
        let fits = |number: &f64| (self.low, self.high).contains(number);
        satisfying(finite(value)?, fits)
    }
}

impl Written for Number {
    fn written(&self, value: &f64) -> String {
        format!("{value:?}")
    }
}

/// A whole number from a least to a largest one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Count {
    pub(crate) least: usize,
    pub(crate) most: usize,
}

impl Kind for Count {
    fn expected(&self) -> String {
        format!("a whole number from {} to {}", self.least, self.most)
    }

    fn shape(&self) -> Shape {
        Shape::Whole(self.least as u64, Some(self.most as u64))
    }
}

impl Values for Count {
    type Read = usize;

    fn read(&self, value: &DeValue<'_>) -> Result<usize, Misfit> {
        count_within(self.least..=self.most)(value)
    }
}

impl Written for Count {
    fn written(&self, value: &usize) -> String {
        value.to_string()
    }
}

/// true or false.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flag;

impl Kind for Flag {
    fn expected(&self) -> String {
        "true or false".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::Flag
    }
}

impl Values for Flag {
    type Read = bool;

    fn read(&self, value: &DeValue<'_>) -> Result<bool, Misfit> {
        boolean(value)
    }
}

impl Written for Flag {
    fn written(&self, value: &bool) -> String {
        value.to_string()
    }
}

/// A string that is not blank.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Text {
    /// Description of the strings that fit.
    pub(crate) expected: &'static str,
    /// A regular expression for them.
    pub(crate) pattern: Option<&'static str>,
    /// The one string that does not fit.
    pub(crate) except: Option<&'static str>,
    /// True for a string that fits, among those that are not blank.
    pub(crate) fits: fn(&str) -> bool,
}

impl Text {
    /// Any string that is not blank.
    pub(crate) const fn any(expected: &'static str) -> Self {
        Self {
            expected,
            pattern: Some("\\S"),
            except: None,
            fits: |_| true,
        }
    }
}

impl Kind for Text {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        let Self {
            pattern, except, ..
        } = *self;
        Shape::Text { pattern, except }
    }
}

impl Values for Text {
    type Read = String;

    fn read(&self, value: &DeValue<'_>) -> Result<String, Misfit> {
        satisfying(text(value)?, |text: &String| {
            self.except != Some(text) && (self.fits)(text)
        })
    }
}

/// One of a few words, each with its meaning.
#[derive(Debug)]
pub(crate) struct Words<T: 'static>(pub(crate) &'static [(&'static str, T)]);

impl<T> Clone for Words<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Words<T> {}

impl<T: Sync> Kind for Words<T> {
    fn expected(&self) -> String {
        let words: Vec<String> = self.0.iter().map(|(word, _)| quoted(word)).collect();
        match words.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => words.concat(),
        }
    }

    fn shape(&self) -> Shape {
        Shape::Words(self.0.iter().map(|(word, _)| *word).collect())
    }
}

impl<T: Copy + PartialEq + Sync> Values for Words<T> {
    type Read = T;

    fn read(&self, value: &DeValue<'_>) -> Result<T, Misfit> {
        let given = text(value)?;
        let meaning = self.0.iter().find(|(word, _)| *word == given);
        meaning.map(|(_, meaning)| *meaning).ok_or(Misfit::Value)
    }
}

impl<T: Copy + PartialEq + Sync> Written for Words<T> {
    fn written(&self, value: &T) -> String {
        let word = self.0.iter().find(|(_, meaning)| meaning == value);
        word.map_or_else(String::new, |(word, _)| quoted(word))
    }
}

/// A list of any length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct List<V> {
    /// Description of the lists that fit.
    pub(crate) expected: &'static str,
    /// Each item.
    pub(crate) of: V,
    /// The least number of items.
    pub(crate) least: usize,
}

impl<V: Kind> Kind for List<V> {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::List {
            of: Box::new(self.of.shape()),
            least: self.least,
            most: None,
        }
    }
}

impl<V: Values> Values for List<V> {
    type Read = Vec<V::Read>;

    fn read(&self, value: &DeValue<'_>) -> Result<Vec<V::Read>, Misfit> {
        let items = list(value, |item| self.of.read(item))?;
        satisfying(items, |items: &Vec<_>| items.len() >= self.least)
    }
}

/// A list of pairs of numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pairs {
    /// Description of the lists that fit.
    pub(crate) expected: &'static str,
    /// Each number of a pair.
    pub(crate) of: Number,
    /// True for pairs that fit together, after each of them fits on its own.
    pub(crate) fits: fn(&Vec<[f64; 2]>) -> bool,
}

impl Kind for Pairs {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        let pair = Shape::List {
            of: Box::new(self.of.shape()),
            least: 2,
            most: Some(2),
        };
        Shape::List {
            of: Box::new(pair),
            least: 1,
            most: None,
        }
    }
}

impl Values for Pairs {
    type Read = Vec<[f64; 2]>;

    fn read(&self, value: &DeValue<'_>) -> Result<Vec<[f64; 2]>, Misfit> {
        let pairs = list(value, |pair| {
            let numbers = list(pair, |number| self.of.read(number))?;
            <[f64; 2]>::try_from(numbers).map_err(|_| Misfit::Value)
        })?;
        satisfying(pairs, self.fits)
    }
}

/// Three values, along x, y and z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vector<V = Number, T = f64> {
    /// Description of the triples that fit.
    pub(crate) expected: &'static str,
    /// Each value.
    pub(crate) of: V,
    /// True for three values that fit together, after each of them fits on its own.
    pub(crate) fits: fn(&[T; 3]) -> bool,
}

impl Vector {
    /// Three finite numbers.
    pub(crate) const fn finite(expected: &'static str) -> Self {
        Self {
            expected,
            of: Number::finite(expected),
            fits: |_| true,
        }
    }
}

impl<V: Kind, T: Copy> Kind for Vector<V, T> {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::List {
            of: Box::new(self.of.shape()),
            least: 3,
            most: Some(3),
        }
    }
}

impl<V: Values<Read = T>, T: Copy> Values for Vector<V, T> {
    type Read = [T; 3];

    fn read(&self, value: &DeValue<'_>) -> Result<[T; 3], Misfit> {
        let items = list(value, |item| self.of.read(item))?;
        let three = <[T; 3]>::try_from(items).map_err(|_| Misfit::Value)?;
        satisfying(three, self.fits)
    }
}

impl<V: Written<Read = T>, T: Copy> Written for Vector<V, T> {
    fn written(&self, value: &[T; 3]) -> String {
        bracketed(value.iter().map(|item| self.of.written(item)))
    }
}

/// A table, or the tables of a list, of one description.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inner {
    /// The tables that fit, for a message about a missing one.
    pub(crate) expected: &'static str,
    /// The table.
    pub(crate) table: &'static TableDescription,
    /// Number of tables that a key may have.
    pub(crate) tables: Tables,
}

/// A number of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tables {
    /// One.
    One,
    /// Any number, each under its own `[[..]]`.
    Several,
    /// One, or a list of some.
    OneOrList,
}

impl Inner {
    /// One table.
    pub(crate) const fn one(expected: &'static str, table: &'static TableDescription) -> Self {
        Self {
            expected,
            table,
            tables: Tables::One,
        }
    }

    /// Any number of tables.
    pub(crate) const fn several(expected: &'static str, table: &'static TableDescription) -> Self {
        Self {
            expected,
            table,
            tables: Tables::Several,
        }
    }

    /// One table, or a list of tables.
    pub(crate) const fn one_or_list(
        expected: &'static str,
        table: &'static TableDescription,
    ) -> Self {
        Self {
            expected,
            table,
            tables: Tables::OneOrList,
        }
    }
}

impl Kind for Inner {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        match self.tables {
            Tables::One => Shape::Table(self.table),
            Tables::Several => Shape::Tables(self.table),
            Tables::OneOrList => {
                Shape::Either(vec![Shape::Table(self.table), Shape::Tables(self.table)])
            }
        }
    }
}

fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

fn bracketed(items: impl Iterator<Item = String>) -> String {
    format!("[{}]", items.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<V: Values>(values: V, text: &str) -> Result<V::Read, Misfit> {
        values.read(DeValue::parse(text).unwrap().get_ref())
    }

    #[test]
    fn bounds_are_open_or_closed() {
        let above = Number::above_zero("a number above 0");
        let from = Number::zero_or_above("a number, 0 or above");
        assert_eq!(read(above, "0"), Err(Misfit::Value));
        assert_eq!(read(from, "0"), Ok(0.0));
        assert_eq!(read(from, "-1e-300"), Err(Misfit::Value));
        assert_eq!(read(Number::finite("a number"), "inf"), Err(Misfit::Value));
    }

    #[test]
    fn a_vector_has_three_numbers() {
        let vector = Vector::finite("[x, y, z]");
        assert_eq!(read(vector, "[1, 2.5, -3]"), Ok([1.0, 2.5, -3.0]));
        for wrong in ["[1, 2]", "[1, 2, 3, 4]", "[1, 2, \"z\"]", "[1, 2, inf]"] {
            assert_eq!(read(vector, wrong), Err(Misfit::Value), "{wrong}");
        }
        assert_eq!(read(vector, "1.0"), Err(Misfit::Type));
    }
}
