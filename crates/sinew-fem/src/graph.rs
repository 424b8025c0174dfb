//! The graph of a mesh.

use std::sync::Arc;

use sinew_core::Pattern;
use sinew_mesh::TetMesh;

use crate::error::{Cause, FemError, Item};

/// The nodes of a mesh that are joined by edges, fixed ones included. The graph is made at the first request and
/// dropped before matrices are made: it takes 12 bytes per tetrahedron.
pub(crate) struct Graph<'a> {
    mesh: &'a TetMesh,
    made: Option<Arc<Pattern>>,
}

impl<'a> Graph<'a> {
    pub(crate) fn of(mesh: &'a TetMesh) -> Self {
        Self { mesh, made: None }
    }

    /// The pattern in which two nodes are neighbours when a tetrahedron has both.
    pub(crate) fn pattern(&mut self) -> Result<&Arc<Pattern>, FemError> {
        let pattern = match self.made.take() {
            Some(pattern) => pattern,
            None => {
                let pattern = Pattern::from_elements(self.mesh.points.len(), &self.mesh.tets);
                Arc::new(pattern.map_err(|error| {
                    let cause = Cause::Operators(error.into());
                    FemError::new(Item::Mesh, cause)
                })?)
            }
        };
        Ok(self.made.insert(pattern))
    }
}
