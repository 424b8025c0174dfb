//! Reasons for which a field cannot be written.

use sinew_core::{Inputs, Ramp};

use crate::error::Cause;

/// A reason for which a field over nodes, tetrahedra or degrees of freedom cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// A slice of the wrong length.
    #[error("{what} has {found} entries, expected {expected}")]
    Length {
        /// Name of the slice.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// A region without stress: a network of springs.
    #[error(
        "region {} is a network of springs, whose law gives forces along edges and no stress", region + 1
    )]
    NoStress {
        /// The region, by its place in the problem (0-based).
        region: usize,
    },
    /// A tetrahedron that does not exist.
    #[error("tetrahedron index {tet} is out of range: there are {tets}, counted from 0")]
    TetOutOfRange {
        /// The index (0-based).
        tet: usize,
        /// Tetrahedra of the mesh.
        tets: usize,
    },
    /// A motion or load that follows an input which the time does not contain.
    #[error(
        "the body follows input {channel}, which is not given: ask with `LoadTime::at(t).under(&inputs)`, with \
         the inputs of the step, not with a bare time"
    )]
    NoInput {
        /// The channel's number.
        channel: u32,
    },
    /// A part of the mesh that does not exist.
    #[error(transparent)]
    Place(#[from] Cause),
}

pub(super) fn require_length(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), FieldError> {
    if found == expected {
        return Ok(());
    }
    Err(FieldError::Length {
        what,
        found,
        expected,
    })
}

/// Refuses ramps that follow channels which the inputs do not have: the value of such a channel is unknown, not 0.
pub(super) fn require_inputs<'a>(
    mut ramps: impl Iterator<Item = &'a Ramp>,
    inputs: &Inputs,
) -> Result<(), FieldError> {
    match ramps.find_map(|ramp| ramp.missing_input(inputs)) {
        None => Ok(()),
        Some(channel) => Err(FieldError::NoInput { channel: channel.0 }),
    }
}
