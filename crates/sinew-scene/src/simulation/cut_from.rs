//! The origin of a body that was cut.

use std::sync::Arc;

use sinew_mesh::{CutMesh, TetMesh};

/// Origin of the parts of a body that was cut.
#[derive(Debug)]
pub struct CutFrom {
    /// The mesh of the body before all cuts.
    pub uncut: Arc<TetMesh>,
    /// The mesh of the remaining body, and the origin of its parts.
    pub cut: CutMesh,
    /// Indices, among the loads of the scene, of those that still act on the body.
    pub(super) loads: Vec<usize>,
}
