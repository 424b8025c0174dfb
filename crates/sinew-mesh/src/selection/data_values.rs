//! Values of data that are chosen, and their description.

use std::fmt;

/// Values of data that are chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum DataValues {
    /// Exactly one of these values, for labels.
    Equal(Vec<f64>),
    /// A value from the first to the second, both included.
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

/// The description of values of the data with a name.
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
