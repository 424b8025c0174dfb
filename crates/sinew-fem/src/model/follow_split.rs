//! Updates of a model in place after splits of its body.

use std::sync::Arc;

use sinew_core::{Acceleration, Energy, State};
use sinew_cutting::{CuttableBody, Stroke, spare_nodes};

use super::Model;
use super::field_error::FieldError;
use crate::error::FemError;
use crate::in_place::{InMotion, InPlace, ModelParts};

impl Model {
    /// True if the model can be updated in place after splits: for linear bodies of plain tetrahedra with resting
    /// supports. Models with springs, hyperelastic regions, elements that average strain or prescribed motions are
    /// rebuilt.
    pub(crate) fn can_follow_splits(&self) -> bool {
        let mut tets = self.region_of.iter().enumerate();
        self.large.is_none()
            && self.is_without_averages()
            && self.motions.is_empty()
            && self.following.is_empty()
            && self.operators.damping().extra.is_none()
            && tets.all(|(tet, region)| {
                let material = &self.materials[*region as usize];
                material.lame_of_plain(tet).is_some()
            })
    }

    /// Reserves space for [`spare_nodes`], so that updates after splits allocate nothing until it is used up.
    pub(crate) fn make_room_for_splits(&mut self) {
        let spare = spare_nodes(self.mesh.points.len());
        Arc::make_mut(&mut self.mesh).reserve(spare);
        self.masses.reserve(spare);
        let cells = self.operators.stiffness().pattern().cells();
        self.operators.make_room_for_cuts(spare_nodes(cells));
        self.operators
            .change_loads(|_, entries| entries.reserve(3 * spare));
        for load in &mut self.supports.loads {
            load.forces.reserve(spare);
        }
        let body = Arc::make_mut(&mut self.body);
        body.cells.reserve(spare);
        body.cell_size.reserve(spare);
        body.pattern = Arc::clone(self.operators.stiffness().pattern());
        body.linear_pattern = Arc::clone(&body.pattern);
    }

    /// Updates the model after the last stroke of the body, after [`InPlace::look`]. Returns true if all rows were laid
    /// out again.
    pub(crate) fn follow_split(
        &mut self,
        in_place: &mut InPlace,
        body: &CuttableBody,
    ) -> Result<bool, FemError> {
        let parts = ModelParts {
            mesh: &mut self.mesh,
            body: &mut self.body,
            operators: &mut self.operators,
            region_of: &self.region_of,
            materials: &self.materials,
            masses: &mut self.masses,
            supports: &mut self.supports,
            report: &mut self.report,
        };
        in_place.follow(parts, body)
    }

    /// The energy (J) of the tetrahedra that the last stroke touched.
    pub(crate) fn energy_of_touched(
        &self,
        in_place: &InPlace,
        body: &CuttableBody,
        state: &State,
    ) -> Energy {
        let motion = InMotion {
            mesh: &self.mesh,
            cells: &self.body.cells,
            region_of: &self.region_of,
            materials: &self.materials,
            masses: &self.masses,
            u: &state.u,
            v: &state.v,
        };
        in_place.energy(&motion, body)
    }

    /// Checks that a state is one of this model.
    pub(crate) fn require_state(&self, state: &State) -> Result<(), FieldError> {
        self.require_dofs("the displacement", &state.u)?;
        self.require_dofs("the velocity", &state.v)?;
        match state.acceleration {
            Acceleration::Kick => self.require_dofs("the acceleration", &state.a),
            _ => Ok(()),
        }
    }

    /// Transfers a state of the model before the last stroke to this one, as [`Model::state_after_cut`] does; the body
    /// had `nodes_before` nodes before.
    pub(crate) fn carry_over_split(&self, state: &mut State, stroke: &Stroke, nodes_before: usize) {
        self.carry_values(&mut state.u, stroke, nodes_before);
        self.carry_values(&mut state.v, stroke, nodes_before);
        if state.acceleration == Acceleration::Kick {
            self.carry_values(&mut state.a, stroke, nodes_before);
        } else {
            state.acceleration = Acceleration::None;
            state.a.clear();
        }
        state.contact.clear();
        state.loads = None;
    }

    fn carry_values(&self, values: &mut Vec<f64>, stroke: &Stroke, nodes_before: usize) {
        let cells = &self.body.cells;
        for moved in &stroke.moved {
            let parts = moved.nodes.map(|node| cells.at_node(values, node));
            for axis in 0..3 {
                if let Some(dof) = cells.free_dof(moved.node, axis) {
                    let terms = parts.iter().zip(moved.shares);
                    values[dof as usize] = terms.map(|(part, share)| share * part[axis]).sum();
                }
            }
        }
        for (copy, node) in (nodes_before as u32..).zip(&stroke.copied) {
            if cells.of_node(copy).is_some() {
                let value = cells.at_node(values, *node);
                values.extend(value);
            }
        }
    }
}
