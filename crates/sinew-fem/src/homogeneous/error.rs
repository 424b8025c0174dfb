//! Errors of homogeneous loads.

use crate::hyperelastic::LawError;

/// A material or an axis for which there are no curves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HomogeneousError {
    /// Springs, whose stress depends on the mesh.
    #[error(
        "springs have no law at a point: their stress follows from the edges of the mesh, so there is no curve"
    )]
    Springs,
    /// A law that does not exist, or whose parameters are not allowed.
    #[error(transparent)]
    Law(#[from] LawError),
    /// An axis without direction.
    #[error("expected an axis [x, y, z], all finite, that is not 0")]
    NoAxis,
    /// Two axes along one line.
    #[error("expected a second axis [x, y, z] that is not along the first")]
    NoSecondAxis,
}
