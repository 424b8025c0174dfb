//! A closed form, and tables of them.

use sinew_fem::hyperelastic::LawError;
use sinew_fem::hyperelastic::ParameterError;

/// Young's modulus (Pa) of all cases.
pub(super) const YOUNGS_MODULUS: f64 = 3500.0;
/// A figure that is known from elsewhere.
#[derive(Clone, Debug)]
pub struct ClosedForm {
    /// The deformation and the quantity, with its unit.
    pub case: String,
    /// The law's id, or what else it is about.
    pub law: &'static str,
    /// Expected value.
    pub asked: f64,
    /// Computed value.
    pub got: f64,
    /// The error that is allowed, relative to `scale`.
    pub tolerance: f64,
    /// The size of what is asked, or what it is small against where that is 0.
    pub scale: f64,
    /// Source of the expected value.
    pub source: &'static str,
}

/// Why a figure could not be computed.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ClosedFormError {
    /// A law that the tables name is not there.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Fibres or terms of the tables are refused.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

impl ClosedForm {
    /// The error relative to `scale`.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.got - self.asked).abs() / self.scale
    }

    /// True if the error is within its tolerance.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.error() <= self.tolerance
    }
}

/// A law's figures of a table, with one tolerance and source.
pub(super) struct Table<'a> {
    pub(super) list: &'a mut Vec<ClosedForm>,
    pub(super) tolerance: f64,
    pub(super) source: &'static str,
}

impl Table<'_> {
    pub(super) fn add(&mut self, law: &'static str, case: String, asked: f64, got: f64) {
        let scale = if asked == 0.0 {
            YOUNGS_MODULUS
        } else {
            asked.abs()
        };
        self.list.push(ClosedForm {
            case,
            law,
            asked,
            got,
            tolerance: self.tolerance,
            scale,
            source: self.source,
        });
    }
}

pub(super) fn table<'a>(
    list: &'a mut Vec<ClosedForm>,
    tolerance: f64,
    source: &'static str,
) -> Table<'a> {
    Table {
        list,
        tolerance,
        source,
    }
}
