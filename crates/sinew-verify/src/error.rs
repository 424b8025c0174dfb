//! Reasons for which a figure cannot be computed.

use std::convert::Infallible;

use sinew_core::{EvaluationError, OperatorError, OptionError, StepError};
use sinew_fem::hyperelastic::LawError;
use sinew_fem::{CutModelError, FemError, FieldError};
use sinew_haptics::{CouplingError, ToolStepError};
use sinew_integrators::{FactorError, StaticError};
use sinew_measure::{CaseError, MeasureError};
use sinew_mesh::structured::StructuredError;
use sinew_mesh::{FindGroupError, MeshFileError, TetMeshError};
use sinew_scene::SceneError;
use sinew_sparse::AssemblyError;
use sinew_tools::{ShapeError, TableError, ToolsError};
use sinew_world::WorldError;

use crate::tissue::TissueError;

/// Reasons for which a figure cannot be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// A mesh file.
    #[error(transparent)]
    File(#[from] MeshFileError),
    /// A file without the tetrahedra that are needed.
    #[error(transparent)]
    Mesh(#[from] TetMeshError),
    /// A structured mesh.
    #[error(transparent)]
    Structured(#[from] StructuredError),
    /// A group that a mesh lacks.
    #[error(transparent)]
    Group(#[from] FindGroupError),
    /// A model.
    #[error(transparent)]
    Model(#[from] FemError),
    /// A cut.
    #[error(transparent)]
    Cut(#[from] CutModelError),
    /// A field on a model.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// A block of tissue.
    #[error(transparent)]
    Tissue(#[from] TissueError),
    /// A law that does not exist.
    #[error(transparent)]
    Law(#[from] LawError),
    /// A state that a law refuses.
    #[error(transparent)]
    Refused(#[from] EvaluationError),
    /// Matrices.
    #[error(transparent)]
    Operators(#[from] OperatorError),
    /// Tools that do not fit together.
    #[error(transparent)]
    Tools(#[from] ToolsError),
    /// The shape of a tool.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The motion of a tool.
    #[error(transparent)]
    Motion(#[from] TableError),
    /// A coupling that a device cannot render.
    #[error(transparent)]
    Coupling(#[from] CouplingError),
    /// A scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A step of a tool in the hand of a device.
    #[error(transparent)]
    ToolStep(#[from] ToolStepError),
    /// The assembly of a matrix.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// An equilibrium.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// A sparse factor.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// A method or an option that does not exist.
    #[error(transparent)]
    Options(#[from] OptionError),
    /// A step of a method.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A scene of the repository.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A run.
    #[error(transparent)]
    Run(#[from] MeasureError),
    /// A scene without tetrahedra.
    #[error("the scene has no body")]
    NoBody,
    /// A node that a mesh lacks.
    #[error("the mesh has no node at ({}, {}, {})", .place[0], .place[1], .place[2])]
    NoNode {
        /// Position of the missing node (m).
        place: [f64; 3],
    },
    /// A computation that gives another number of figures than it has names for.
    #[error("{computed} figures were computed, {asked} are asked for")]
    Count {
        /// Figures that were computed.
        computed: usize,
        /// Figures that are asked for.
        asked: usize,
    },
}

impl From<Infallible> for VerifyError {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}
