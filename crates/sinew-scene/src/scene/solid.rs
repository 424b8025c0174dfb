//! Materials of a scene at a point.

use sinew_fem::Region;
use sinew_fem::homogeneous::Solid;

use super::Scene;
use super::model::MODEL;
use crate::error::SceneError;

impl Scene {
    /// The material of a region, which is the scene's region `index` (0-based) or derived from it.
    ///
    /// # Errors
    /// [`SceneError`] with the line of a region for which there are no curves.
    pub fn solid(&self, index: usize, region: &Region) -> Result<Solid, SceneError> {
        let places = self.places();
        let place = places.of(&places.regions, index);
        Solid::of(region).map_err(|error| place.value_fault(MODEL.name, error.into()))
    }
}
