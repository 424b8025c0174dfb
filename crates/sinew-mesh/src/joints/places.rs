//! Positions of findings.

use std::fmt;

/// Number of examples that are kept of each finding.
const EXAMPLES: usize = 10;

/// Number of positions, and the first ten.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    /// Number of positions.
    pub total: usize,
    /// The first ten, in the unit of the mesh.
    pub first: Vec<[f64; 3]>,
}

impl Places {
    pub(super) fn add(&mut self, place: [f64; 3]) {
        self.total += 1;
        if self.first.len() < EXAMPLES {
            self.first.push(place);
        }
    }

    /// True if there are no positions.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }
}

impl fmt::Display for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.total)?;
        let Some([x, y, z]) = self.first.first().map(|place| place.map(rounded)) else {
            return Ok(());
        };
        let first = if self.total > 1 { "first " } else { "" };
        write!(f, " ({first}at {x}, {y}, {z})")
    }
}

/// A coordinate to six digits.
fn rounded(x: f64) -> f64 {
    let digits = 10f64.powf(5.0 - x.abs().log10().floor());
    match digits.is_finite() && digits > 0.0 {
        true => (x * digits).round() / digits,
        false => x,
    }
}
