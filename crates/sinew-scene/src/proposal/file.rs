//! The mesh file as a first scene reads it.

use std::path::Path;

use super::unit::Unit;

/// A mesh file and its keys in a scene.
pub(super) struct MeshFile<'a> {
    /// Its path as the scene names it.
    pub(super) path: &'a Path,
    /// Its unit of length.
    pub(super) unit: Unit,
    /// True if its cells have no nodes but corners.
    pub(super) is_linear: bool,
}
