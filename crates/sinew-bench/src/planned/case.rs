//! A scene with its runs.

use sinew_measure::MethodChoice;

use super::material::Material;

/// A scene with its runs.
pub(crate) struct PlannedCase {
    /// Id of the case.
    pub(crate) id: &'static str,
    /// The scene's file, from the folder of scenes.
    pub(crate) scene: &'static str,
    /// Further changes to values of the scene.
    pub(crate) values: &'static [&'static str],
    pub(crate) methods: Vec<MethodChoice>,
    /// Steps (s), which divide the time between the scene's instants.
    pub(crate) steps: &'static [f64],
    /// Laws and elements in place of those of the scene; empty for its own.
    pub(crate) materials: Vec<Material>,
    /// Further remarks about the case.
    pub(crate) remarks: &'static [&'static str],
    /// Finer meshes for the error estimate of the scene's own mesh.
    pub(crate) finer: Option<FinerMeshes>,
}

/// Two finer meshes of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FinerMeshes {
    /// Changes to the scene that give these meshes, the coarser one first.
    pub(crate) meshes: [&'static str; 2],
    /// Cells along an edge of the finer over those of the coarser.
    pub(crate) ratio: f64,
    /// True if the motion is so violent that only a method of order 4 can follow it.
    pub(crate) is_violent: bool,
}
