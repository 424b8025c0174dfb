//! A scene with its runs.

use sinew_measure::MethodChoice;

use super::material::Material;

/// A scene with its runs.
pub(crate) struct PlannedCase {
    /// Id of the case.
    pub(crate) id: &'static str,
    /// The scene's file, from the folder of scenes.
    pub(crate) scene: &'static str,
    /// What the scene changes besides.
    pub(crate) values: &'static [&'static str],
    pub(crate) methods: Vec<MethodChoice>,
    /// Steps (s), which divide the time between the scene's instants.
    pub(crate) steps: &'static [f64],
    /// Laws and elements in the place of the scene's; empty for its own.
    pub(crate) materials: Vec<Material>,
    /// What is to be said of it besides.
    pub(crate) remarks: &'static [&'static str],
    /// Finer meshes by which the error of the scene's own is estimated.
    pub(crate) finer: Option<FinerMeshes>,
}

/// Two finer meshes of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FinerMeshes {
    /// What the scene changes to have them, the coarser one first.
    pub(crate) meshes: [&'static str; 2],
    /// Cells along an edge of the finer over those of the coarser.
    pub(crate) ratio: f64,
    /// Whether the motion is so violent that a method of order 4 is needed to follow it.
    pub(crate) is_violent: bool,
}
