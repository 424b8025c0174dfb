//! The values of data, summed up.

use std::collections::BTreeSet;
use std::fmt;

/// The number and the range of the values of data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataRange {
    /// Number of values that are present.
    pub values: usize,
    /// Number of values that are missing.
    pub missing: usize,
    /// The least value; infinite without values.
    pub least: f64,
    /// The greatest value; infinite without values.
    pub greatest: f64,
    /// True if all values are whole numbers, as labels are.
    pub is_whole: bool,
    /// Number of different values, if all are whole and there are at most 4096.
    pub different: Option<usize>,
}

/// Number of different values up to which they are counted.
const COUNTED: usize = 4096;

impl DataRange {
    /// Range of values; NaN means that a value is missing.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> DataRange {
        let mut range = DataRange {
            values: 0,
            missing: 0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            is_whole: true,
            different: None,
        };
        let mut different = BTreeSet::new();
        let mut last = None;
        for value in values {
            if value.is_nan() {
                range.missing += 1;
                continue;
            }
            range.values += 1;
            range.least = range.least.min(value);
            range.greatest = range.greatest.max(value);
            range.is_whole &= value.fract() == 0.0 && value.abs() < 9e15;
            // Neighbours mostly have the same label.
            if range.is_whole && last != Some(value) && different.len() <= COUNTED {
                different.insert(value as i64);
            }
            last = Some(value);
        }
        range.is_whole &= range.values > 0;
        range.different = (range.is_whole && different.len() <= COUNTED).then_some(different.len());
        range
    }
}

impl fmt::Display for DataRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, greatest) = (self.least, self.greatest);
        match (self.values, self.is_whole) {
            (0, _) => return f.write_str("no values"),
            (_, true) => write!(f, "whole numbers from {least} to {greatest}")?,
            (_, false) => write!(f, "from {least:.6e} to {greatest:.6e}")?,
        }
        if let Some(different) = self.different {
            write!(f, ", {different} different")?;
        }
        match self.missing {
            0 => Ok(()),
            missing => write!(f, "; {missing} without a value"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_counted_and_other_numbers_are_not() {
        let said = |values: &[f64]| DataRange::of(values.iter().copied()).to_string();
        assert_eq!(
            said(&[2.0, f64::NAN, 1.0, 2.0, -3.0]),
            "whole numbers from -3 to 2, 3 different; 1 without a value"
        );
        assert_eq!(said(&[0.5, 2.0]), "from 5.000000e-1 to 2.000000e0");
        assert_eq!(said(&[f64::NAN]), "no values");
        let many = DataRange::of((0..5000).map(f64::from));
        assert_eq!((many.is_whole, many.different), (true, None));
    }
}
