//! The origin of a body that was cut.

use std::sync::Arc;

use sinew_mesh::{CutMesh, TetMesh};

/// Where the parts of a body that was cut come from.
#[derive(Debug)]
pub struct CutFrom {
    /// The mesh of the body before all cuts.
    pub uncut: Arc<TetMesh>,
    /// The mesh of what is left, and where its parts come from.
    pub cut: CutMesh,
    /// The places, among the loads of the scene, of those that still act on something.
    pub(super) loads: Vec<usize>,
}
