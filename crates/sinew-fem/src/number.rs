//! Checks of single numbers.

use crate::error::{Cause, FemError, Item};

/// Refuses a number that is not finite, or that does not fit.
pub(crate) fn require(
    item: Item,
    quantity: &'static str,
    found: f64,
    expected: &'static str,
    fits: bool,
) -> Result<(), FemError> {
    if found.is_finite() && fits {
        return Ok(());
    }
    Err(FemError::new(
        item,
        Cause::Value {
            quantity,
            found,
            expected,
        },
    ))
}

/// Refuses numbers that are not finite.
pub(crate) fn require_finite(
    item: Item,
    quantity: &'static str,
    values: &[f64],
) -> Result<(), FemError> {
    for &found in values {
        require(item, quantity, found, "finite numbers", true)?;
    }
    Ok(())
}
