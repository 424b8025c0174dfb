//! The same scene on a finer mesh.

use sinew_mesh::RefineError;

use super::Simulation;
use crate::error::SceneError;

/// Reasons why there is no finer mesh for a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RefinementError {
    /// A scene without a mesh.
    #[error("an oscillator has no mesh")]
    NoMesh,
    /// A mesh that would become too large.
    #[error(transparent)]
    Mesh(#[from] RefineError),
    /// A scene that does not fit the finer mesh.
    #[error("on the refined mesh: {0}")]
    Scene(#[from] SceneError),
}

impl Simulation {
    /// The same scene on its mesh with each tetrahedron divided into eight. Groups of the mesh cover the same part of
    /// the body as before; parts that the scene selects by position (`where`) are selected again, and may fit the body
    /// more closely.
    ///
    /// # Errors
    /// [`RefinementError`] for an oscillator, and if the finer mesh cannot be made or used.
    pub fn refined(&self) -> Result<Self, RefinementError> {
        let body = self.model().body().ok_or(RefinementError::NoMesh)?;
        let mut mesh = body.mesh.refined()?;
        let is_selected = |name: &str| body.selected.iter().any(|part| part.name == name);
        mesh.groups.retain(|group| !is_selected(&group.name));
        Ok(self.scene().clone().build_on(mesh)?)
    }
}
