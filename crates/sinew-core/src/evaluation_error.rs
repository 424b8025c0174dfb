//! Errors of force laws.

use std::fmt;

use sinew_sparse::AssemblyError;

/// A force law that cannot be evaluated: outside its domain, or into a matrix that lacks its couplings.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluationError {
    /// Tag of the element in its mesh; 0 if no single element causes the error.
    pub element: u64,
    /// The reason, with the numbers.
    pub reason: String,
}

impl EvaluationError {
    /// An error of the whole body.
    #[must_use]
    pub fn of_body(reason: impl fmt::Display) -> Self {
        Self {
            element: 0,
            reason: reason.to_string(),
        }
    }
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.element != 0 {
            write!(f, "element {}: ", self.element)?;
        }
        f.write_str(&self.reason)
    }
}

impl std::error::Error for EvaluationError {}

/// A matrix on another pattern than [`crate::ElasticLaw::pattern`].
impl From<AssemblyError> for EvaluationError {
    fn from(error: AssemblyError) -> Self {
        Self::of_body(format_args!(
            "the pattern of the matrix lacks entries of the law's tangent: {error}; build the matrix with the law's pattern"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_its_element_where_there_is_one() {
        let of_one = EvaluationError {
            element: 7,
            reason: "inside out".to_owned(),
        };
        assert_eq!(of_one.to_string(), "element 7: inside out");
        assert_eq!(EvaluationError::of_body("no input").to_string(), "no input");
        let refused = AssemblyError::NotNeighbours { row: 1, column: 4 };
        assert_eq!(
            EvaluationError::from(refused).to_string(),
            "the pattern of the matrix lacks entries of the law's tangent: cells 1 and 4 are not neighbours in the \
             pattern; build the matrix with the law's pattern"
        );
    }
}
