//! Loads of a model at their full value, for bodies at rest.

use sinew_core::{BlockMatrix, EvaluationError, LoadTime, StaticLoad};

use super::Model;
use crate::following::{FollowingPressure, Part};

/// Some loads of a model at their full value, independent of their ramps; follower pressures follow the surface.
/// Supports are at their positions at t = 0.
#[derive(Clone, Debug)]
pub struct ModelLoads<'m> {
    model: &'m Model,
    /// Their sum (N) on the surface at rest.
    force: Vec<f64>,
    following: Vec<&'m FollowingPressure>,
}

impl Model {
    /// The loads at these places among those of [`Model::operators`](sinew_core::LinearSystem::operators): in the order of the problem,
    /// then gravity. Larger indices are ignored.
    #[must_use]
    pub fn full_loads(&self, places: &[usize]) -> ModelLoads<'_> {
        let mut force = vec![0.0; self.operators.dofs()];
        let loads = self.operators.loads();
        for load in places.iter().filter_map(|place| loads.get(*place)) {
            for (dof, value) in &load.entries {
                force[*dof as usize] += value;
            }
        }
        let following = self.following.iter();
        let following = following.filter(|pressure| places.contains(&pressure.load));
        ModelLoads {
            model: self,
            force,
            following: following.collect(),
        }
    }
}

impl StaticLoad for ModelLoads<'_> {
    fn force(&self, u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.force);
        let displacement = self.model.displacement_of(LoadTime::at(0.0), u);
        for pressure in &self.following {
            pressure.forces(1.0, &displacement, |node, force| {
                self.model.add_at_node((node, force), 1.0, out);
            });
        }
    }

    fn add_stiffness(
        &self,
        u: &[f64],
        factor: f64,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let displacement = self.model.displacement_of(LoadTime::at(0.0), u);
        let cells = &self.model.body.cells;
        let mut following = self.following.iter();
        following.try_for_each(|pressure| pressure.add_stiffness(factor, cells, &displacement, out))
    }

    fn skew_product(&self, u: &[f64], factor: f64, w: &[f64], out: &mut [f64]) -> bool {
        out.fill(0.0);
        let displacement = self.model.displacement_of(LoadTime::at(0.0), u);
        for &pressure in &self.following {
            let part = (pressure, Part::Skew, factor);
            self.model.add_product_of(part, &displacement, w, out);
        }
        !self.following.is_empty()
    }
}
