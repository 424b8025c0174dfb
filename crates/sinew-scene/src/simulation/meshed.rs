//! A scene with its mesh, before its matrices are assembled.

use sinew_mesh::TetMesh;

use super::mesh::MeshAndWarnings;
use super::motion_table::read_factor;
use super::selected::{self, SelectedPart};
use super::{Footprint, Simulation, mesh};
use crate::error::SceneError;
use crate::scene::{Body, Places, Scene, Subject};

/// A scene whose mesh was read, before its matrices are assembled. The memory that they need is already known.
#[derive(Debug)]
pub struct MeshedScene {
    pub(super) scene: Scene,
    /// Empty for an oscillator.
    pub(super) mesh: SelectedMesh,
}

/// A mesh with the groups that a scene selected.
#[derive(Debug, Default)]
pub(super) struct SelectedMesh {
    pub(super) mesh: TetMesh,
    /// Warnings of the mesh's reader.
    pub(super) warnings: Vec<String>,
    pub(super) selected: Vec<SelectedPart>,
}

impl Scene {
    /// Reads or makes the mesh, and selects its parts.
    ///
    /// # Errors
    /// [`SceneError`] for a mesh that cannot be read or made, and for a selection without members.
    pub fn read_mesh(self) -> Result<MeshedScene, SceneError> {
        self.with_mesh(mesh::of_body)
    }

    /// Reads the mesh, assembles the matrices and finds the state at t = 0.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that cannot be fulfilled.
    pub fn build(self) -> Result<Simulation, SceneError> {
        self.read_mesh()?.build()
    }

    /// Same as [`Scene::build`], on the given mesh (m) instead of the one that `[mesh]` names. An oscillator ignores
    /// it.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that does not fit this mesh.
    pub fn build_on(self, mesh: TetMesh) -> Result<Simulation, SceneError> {
        self.with_mesh(|_, _| Ok((mesh, Vec::new())))?.build()
    }

    fn with_mesh(
        self,
        make: impl FnOnce(&Body, &Places) -> Result<MeshAndWarnings, SceneError>,
    ) -> Result<MeshedScene, SceneError> {
        let scene = self.with_factors(|scene, written| Ok(read_factor(scene, written)?))?;
        let mesh = match scene.subject() {
            Subject::Body(body) => {
                let (mut mesh, warnings) = make(body, scene.places())?;
                let selected = selected::add_to(&mut mesh, body, scene.places())?;
                SelectedMesh {
                    mesh,
                    warnings,
                    selected,
                }
            }
            Subject::Oscillator(_) => SelectedMesh::default(),
        };
        Ok(MeshedScene { scene, mesh })
    }
}

impl MeshedScene {
    /// The mesh (m), with the groups that the scene selects; `None` for an oscillator.
    #[must_use]
    pub fn mesh(&self) -> Option<&TetMesh> {
        matches!(self.scene.subject(), Subject::Body(_)).then_some(&self.mesh.mesh)
    }

    /// Counts of the body and the memory that the scene needs; `None` for an oscillator.
    #[must_use]
    pub fn footprint(&self) -> Option<Footprint> {
        match self.scene.subject() {
            Subject::Body(body) => Some(Footprint::of(body, &self.mesh.mesh)),
            Subject::Oscillator(_) => None,
        }
    }
}
