//! Reasons for which there are no curves.

use std::path::PathBuf;

use sinew_fem::homogeneous::HomogeneousError;
use sinew_scene::SceneError;

/// A reason for which the laws of a scene have no curves.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LawCurvesError {
    /// A scene that cannot be built, or a region for which there is no curve.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Data of the mesh that do not give a valid direction.
    #[error(transparent)]
    Data(#[from] sinew_mesh::TetDataError),
    /// An axis without direction.
    #[error("the axes of the pull: {0}")]
    Axis(#[from] HomogeneousError),
    /// A scene of an oscillator.
    #[error("{}: an oscillator has no law: its spring is the line `stiffness`", scene.display())]
    Oscillator {
        /// The scene file.
        scene: PathBuf,
    },
    /// A region that does not exist.
    #[error("{}: no region is `{name}`; there are {}", scene.display(), known.join(", "))]
    NoRegion {
        /// The scene file.
        scene: PathBuf,
        /// The number or name given.
        name: String,
        /// Numbers and names of all.
        known: Vec<String>,
    },
}
