//! A subject of the verification: checks that belong together.

use serde::Serialize;

use crate::check::Check;

/// Checks that belong together, as one section of the page.
pub(crate) struct Subject {
    /// A short name, by which it is selected.
    pub(crate) id: &'static str,
    /// Its heading.
    pub(crate) title: &'static str,
    /// Method by which its figures are computed.
    pub(crate) says: &'static str,
    /// The checks.
    pub(crate) checks: fn() -> Vec<Check>,
    /// Figures of other elements or programs, for comparison.
    pub(crate) quoted: &'static [Quoted],
}

/// Figures that are shown for comparison and not computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Quoted {
    /// The element or program.
    pub what: &'static str,
    /// The case.
    pub case: &'static str,
    /// The figures, in the order of the rows above.
    pub figures: &'static str,
}

impl Quoted {
    /// Figures of an element or program on a case.
    pub(crate) const fn new(what: &'static str, case: &'static str, figures: &'static str) -> Self {
        Self {
            what,
            case,
            figures,
        }
    }
}
