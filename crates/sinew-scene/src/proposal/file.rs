//! The mesh file of a first scene.

use std::path::Path;

use super::unit::Unit;

/// A mesh file and its keys in a scene.
pub(super) struct MeshFile<'a> {
    /// Its path in the scene.
    pub(super) path: &'a Path,
    /// Its unit of length.
    pub(super) unit: Unit,
    /// True if its cells have corner nodes only.
    pub(super) is_linear: bool,
}
