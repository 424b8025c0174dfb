//! Values of data that are chosen, and their words.

use std::fmt;

/// Values of data that are chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum DataValues {
    /// One of these values exactly, as labels have.
    Equal(Vec<f64>),
    /// From the first value to the second, both among them.
    Between([f64; 2]),
}

impl DataValues {
    pub(super) fn has(&self, value: f64) -> bool {
        match self {
            Self::Equal(values) => values.contains(&value),
            Self::Between([low, high]) => (*low..=*high).contains(&value),
        }
    }
}

/// Values of the data of a name, in the words of a condition.
pub(super) struct WithData<'a>(pub(super) &'a str, pub(super) &'a DataValues);

impl fmt::Display for WithData<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(name, values) = self;
        match values {
            DataValues::Equal(values) => {
                let values: Vec<String> = values.iter().map(f64::to_string).collect();
                write!(f, "with {name} = {}", values.join(" or "))
            }
            DataValues::Between([low, high]) => write!(f, "with {low} <= {name} <= {high}"),
        }
    }
}
