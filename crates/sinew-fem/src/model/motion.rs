//! Supports in motion: their loads on the body, and their positions.

use sinew_core::{Load, LoadTime, Ramp};

use super::Model;
use super::field_error::{FieldError, require_inputs};
use crate::error::{Cause, FemError, Item};
use crate::motion::Field;
use crate::{Course, SupportMotion};

impl Model {
    /// This model with the loads of its prescribed motions: for each course `d r(t)` the loads `-K_fp d r(t)`, from the
    /// position at the instant, and `-D_fp d r'(t)`. Mass damping acts on the velocity of the moved nodes alone, so it
    /// is part of their reactions only.
    pub(super) fn in_motion(mut self) -> Result<Self, FemError> {
        if self.motions.is_empty() {
            return Ok(self);
        }
        let mut loads = self.operators.loads().to_vec();
        for (index, part) in self.motions.parts().iter().enumerate() {
            let item = Item::Move(index);
            for course in &part.courses {
                let SupportMotion { stiffness, damping } = self
                    .support_motion(&part.pattern(course))
                    .map_err(FemError::at(item))?;
                let damps_large = self.large.is_some() && self.operators.damping().stiffness > 0.0;
                let is_damped = damps_large || !damping.is_empty();
                if let (Some(instant), true) = (course.ramp.first_jump(), is_damped) {
                    return Err(FemError::new(item, Cause::PositionJumps { instant }));
                }
                let mut pull = |ramp: Ramp, mut entries: Vec<(u32, f64)>| {
                    if !entries.is_empty() {
                        entries.iter_mut().for_each(|(_, force)| *force = -*force);
                        loads.push(Load { ramp, entries });
                        self.load_items.push(item);
                    }
                };
                pull(Ramp::Position(Box::new(course.ramp.clone())), stiffness);
                pull(course.ramp.rate(), damping);
            }
        }
        self.operators = self
            .operators
            .with_loads(loads)
            .map_err(|error| FemError::new(Item::Mesh, error.into()))?;
        Ok(self)
    }

    /// The courses of a component (0, 1, 2 for x, y, z) of a mesh node (0-based) that is moved, or a constant one if it
    /// was frozen; empty if the component is fixed at rest or free.
    #[must_use]
    pub fn courses(&self, node: u32, axis: usize) -> &[Course] {
        self.motions.courses(node, axis)
    }

    /// Writes the displacements (m) of all nodes of the mesh at a time (s), with the displacement `u` (m) of the degrees
    /// of freedom then: zero at fixed nodes, the prescribed motion at moved ones.
    ///
    /// # Errors
    /// Same as [`Model::to_nodes`], and [`FieldError::NoInput`] if a motion follows an input that the time does not
    /// contain.
    pub fn displacements_at<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.field_at(when.into(), Field::Displacement, u, out)
    }

    /// Writes the velocities (m/s) of all nodes of the mesh at a time (s), with the velocity `v` (m/s) of the degrees of
    /// freedom then (see [`sinew_core::State::velocity_at_t`]); as [`Model::displacements_at`].
    ///
    /// # Errors
    /// Same as [`Model::displacements_at`].
    pub fn velocities_at<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        v: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.field_at(when.into(), Field::Velocity, v, out)
    }

    /// Writes the accelerations (m/s^2) of all nodes of the mesh at a time (s), with the acceleration `a` (m/s^2) of the
    /// degrees of freedom then; as [`Model::displacements_at`].
    ///
    /// # Errors
    /// Same as [`Model::displacements_at`].
    pub fn accelerations_at<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        a: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.field_at(when.into(), Field::Acceleration, a, out)
    }

    /// Writes the positions (m) of all nodes of the mesh at a time (s), with the displacement `u` (m) of the degrees
    /// of freedom then; as [`Model::displacements_at`].
    ///
    /// # Errors
    /// Same as [`Model::displacements_at`].
    pub fn positions<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.field_at(when.into(), Field::Displacement, u, out)?;
        for (point, out) in self.mesh.points.iter().zip(out) {
            for (point, out) in point.iter().zip(out) {
                *out += point;
            }
        }
        Ok(())
    }

    /// The displacement (m) of a mesh node (0-based) at a time (s); as [`Model::displacements_at`].
    ///
    /// # Errors
    /// Same as [`Model::displacements_at`], and [`FieldError::Place`] for a node that does not exist.
    pub fn node_displacement<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        node: u32,
    ) -> Result<[f64; 3], FieldError> {
        self.require_dofs("the displacement", u)?;
        self.require_node(node)?;
        Ok(self.at_nodes(when.into(), Field::Displacement, Some(u))?(
            node,
        ))
    }

    /// A function that gives the velocity (m/s) of each mesh node (0-based) at a time (s), with the velocity `v` (m/s)
    /// of the degrees of freedom then: for use at a few nodes of a large mesh.
    ///
    /// # Errors
    /// Same as [`Model::displacements_at`].
    pub fn node_velocities<'a, 't>(
        &'a self,
        when: impl Into<LoadTime<'t>>,
        v: &'a [f64],
    ) -> Result<impl Fn(u32) -> [f64; 3] + 'a, FieldError> {
        self.require_dofs("the velocity", v)?;
        self.at_nodes(when.into(), Field::Velocity, Some(v))
    }

    /// A function that gives a field at each node, from the `values` of the degrees of freedom.
    pub(crate) fn at_nodes<'a>(
        &'a self,
        when: LoadTime<'_>,
        field: Field,
        values: Option<&'a [f64]>,
    ) -> Result<impl Fn(u32) -> [f64; 3] + 'a, FieldError> {
        require_inputs(self.motions.ramps(), when.inputs())?;
        let at = self.motions.at(when, field);
        Ok(move |node| {
            let own = values.map_or([0.0; 3], |values| self.body.cells.at_node(values, node));
            sum(own, self.motions.at_node(&at, node))
        })
    }

    fn field_at(
        &self,
        when: LoadTime<'_>,
        field: Field,
        values: &[f64],
        out: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.require_nodes("the output", out)?;
        out.fill([0.0; 3]);
        self.each_value(when, field, values, |node, value| {
            let out = &mut out[node as usize];
            *out = sum(*out, value);
        })
    }

    /// Adds the displacements (m) of all nodes of the mesh to places (m), one for each node; as
    /// [`Model::displacements_at`].
    pub(crate) fn displace(
        &self,
        when: LoadTime<'_>,
        u: &[f64],
        numbers: &[u32],
        places: &mut [[f64; 3]],
    ) -> Result<(), FieldError> {
        self.each_value(when, Field::Displacement, u, |node, displacement| {
            let place = &mut places[numbers[node as usize] as usize];
            *place = sum(*place, displacement);
        })
    }

    /// Calls `take` with the values of a field at nodes of the mesh: first those of free components, then prescribed
    /// ones.
    fn each_value(
        &self,
        when: LoadTime<'_>,
        field: Field,
        values: &[f64],
        mut take: impl FnMut(u32, [f64; 3]),
    ) -> Result<(), FieldError> {
        self.require_dofs("the vector", values)?;
        require_inputs(self.motions.ramps(), when.inputs())?;
        for (node, value) in self.body.cells.each_value(values) {
            take(node, value);
        }
        let at = self.motions.at(when, field);
        for node in self.motions.moved() {
            take(node, self.motions.at_node(&at, node));
        }
        Ok(())
    }
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}
