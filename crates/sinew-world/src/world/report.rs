//! Fields and forces of a world at the time of its state.

use std::sync::Arc;

use sinew_core::{Contact, Energy, LoadTime};
use sinew_mesh::BoundarySurface;
use sinew_scene::{BodyModel, Overlap, OverlapWatch, Reaction};
use sinew_tools::{Depth, Pose, ToolReport, Tools};

use super::World;
use crate::command::ToolId;
use crate::error::ReportError;

/// Values over the mesh are written into slices with one entry for each node or tetrahedron of the current body.
impl World {
    /// Number of meshes that the body has had: surfaces, nodes and tetrahedra have changed if it has grown, by a cut, a
    /// reset or a restored state.
    #[must_use]
    pub fn topology_epoch(&self) -> u64 {
        self.topology_epoch
    }

    /// The surface of the body at rest; `None` for an oscillator.
    #[must_use]
    pub fn surface(&self) -> Option<&Arc<BoundarySurface>> {
        Some(self.body.model().body()?.surface())
    }

    /// Writes the displacement (m) of each node.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn displacements(&self, out: &mut [[f64; 3]]) -> Result<(), ReportError> {
        let model = &self.mesh_body()?.model;
        Ok(model.displacements_at(self.now(), &self.state.u, out)?)
    }

    /// Writes the position (m) of each node.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn positions(&self, out: &mut [[f64; 3]]) -> Result<(), ReportError> {
        let model = &self.mesh_body()?.model;
        Ok(model.positions(self.now(), &self.state.u, out)?)
    }

    /// Writes the velocity (m/s) of each node: also of a method whose velocities are those in the middle of steps.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn velocities(&mut self, out: &mut [[f64; 3]]) -> Result<(), ReportError> {
        self.take_velocity()?;
        let model = &self.mesh_body()?.model;
        Ok(model.velocities_at(self.now(), &self.field, out)?)
    }

    /// Writes the strain of each tetrahedron, see [`sinew_fem::Model::strain`].
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn strain(&self, out: &mut [[f64; 6]]) -> Result<(), ReportError> {
        let model = &self.mesh_body()?.model;
        Ok(model.strain(self.now(), &self.state.u, out)?)
    }

    /// Writes the stress (Pa) of each tetrahedron, with its history variables, see [`sinew_fem::Model::stress`];
    /// [`sinew_fem::stress::von_mises`] turns each into one number.
    ///
    /// # Errors
    /// [`ReportError`], also for a body with a network of springs, which has no stress.
    pub fn stress(&self, out: &mut [[f64; 6]]) -> Result<(), ReportError> {
        let body = self.mesh_body()?.model.with_memory(&self.state.internal);
        Ok(body.stress(self.now(), &self.state.u, out)?)
    }

    /// Writes the force (N) on each node by tools, and by the other face of a cut, in the last step.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn contact_forces(&mut self, out: &mut [[f64; 3]]) -> Result<(), ReportError> {
        self.field.clear();
        self.field.resize(self.state.u.len(), 0.0);
        if let Some(contact) = self.body.system().contact() {
            contact.add_forces(&self.state, true, &mut self.field);
        }
        let model = &self.mesh_body()?.model;
        Ok(model.to_nodes(&self.field, out)?)
    }

    /// Kinetic and elastic energy (J); `None` if the model has none.
    ///
    /// # Errors
    /// [`ReportError::State`].
    pub fn energy(&mut self) -> Result<Option<Energy>, ReportError> {
        self.take_velocity()?;
        let known = self.body.system().energy(&self.state.u, &self.field);
        let Some(body) = self.body.model().body().filter(|_| known.is_none()) else {
            return Ok(known);
        };
        // Where parts are moved, held and moved nodes have a share.
        let model = &body.model;
        let mut nodes = vec![[0.0; 3]; body.mesh.points.len()];
        model.velocities_at(self.now(), &self.field, &mut nodes)?;
        let squares = nodes.iter().map(|v| v.iter().map(|v| v * v).sum::<f64>());
        let kinetic = squares
            .zip(model.node_masses())
            .map(|(square, mass)| 0.5 * mass * square)
            .sum();
        model.displacements_at(self.now(), &self.state.u, &mut nodes)?;
        let elastic = model.elastic_energy(&nodes)?;
        Ok(elastic.is_finite().then_some(Energy { kinetic, elastic }))
    }

    /// Work (J) of all tools on the body since the motion began.
    #[must_use]
    pub fn work_of_tools(&self) -> f64 {
        let tools = self.body.model().tools();
        tools.map_or(0.0, |tools| tools.work(&self.state))
    }

    /// The forces of supports and moved parts, in the order of the scene.
    ///
    /// # Errors
    /// [`ReportError::Reaction`].
    pub fn reactions(&self) -> Result<Vec<Reaction>, ReportError> {
        Ok(self.body.reactions(&self.state, &self.inputs)?)
    }

    /// The tools of the scene.
    pub fn tools(&self) -> impl ExactSizeIterator<Item = ToolId> + use<> {
        let tools = self.body.model().tools();
        let scene = self.identity.key;
        (0..tools.map_or(0, |tools| tools.tools().len())).map(move |place| ToolId { scene, place })
    }

    /// The pose of a tool. Ids of a world of another scene give the identity.
    #[must_use]
    pub fn tool_pose(&self, tool: ToolId) -> Pose {
        let tools = self.tools_with(tool);
        tools.map_or(Pose::identity(), |tools| {
            tools.pose(&self.state, &self.inputs, tool.place)
        })
    }

    /// The pose to which a tool moves, or to which the user's coupling pulls it: that of the last command, otherwise
    /// the current one of its own path. Ids of a world of another scene give the identity.
    #[must_use]
    pub fn hand_pose(&self, tool: ToolId) -> Pose {
        let own = || {
            let tool = self.tools_with(tool)?.tools().get(tool.place)?;
            Some(tool.motion.at(self.state.t(), &self.inputs))
        };
        let hand = self.tools.get(tool.place);
        let target = hand
            .filter(|_| tool.scene == self.identity.key)
            .and_then(|hand| hand.target);
        let target = target.map(|(position, turn)| Pose::new(position, turn));
        target.or_else(own).unwrap_or(Pose::identity())
    }

    /// Forces, impulses and contacts of a tool after the last step; `None` for an id of a world of another scene.
    #[must_use]
    pub fn tool_report(&self, tool: ToolId) -> Option<ToolReport> {
        Some(self.tools_with(tool)?.report(&self.state, tool.place))
    }

    /// The signed distance (m) between a tool and the nearest cell or triangle, negative inside; `None` if it cannot
    /// touch any.
    #[must_use]
    pub fn tool_gap(&self, tool: ToolId) -> Option<Depth> {
        let pose = self.tool_pose(tool);
        self.tools_with(tool)?
            .deepest(&self.state.u, &pose, tool.place)
    }

    /// Deepest current overlap of parts or surfaces of the body without contact between them. A check costs some
    /// microseconds per triangle of the surface: a session makes none automatically.
    #[must_use]
    pub fn overlap(&self) -> Option<Overlap> {
        let mut watch = OverlapWatch::new(self.body.model().body()?);
        watch.look_at_state(&self.state).ok()?;
        watch.into_deepest()
    }

    fn now(&self) -> LoadTime<'_> {
        LoadTime::at(self.state.t()).under(&self.inputs)
    }

    fn mesh_body(&self) -> Result<&BodyModel, ReportError> {
        let body = self.body.model().body();
        body.map(|body| &**body).ok_or(ReportError::NoMesh)
    }

    fn tools_with(&self, tool: ToolId) -> Option<&Tools> {
        let tools = self.body.model().tools()?;
        let is_own = tool.scene == self.identity.key && tool.place < tools.tools().len();
        is_own.then_some(tools)
    }

    /// Computes the velocity (m/s) of the degrees of freedom at the time of the state.
    fn take_velocity(&mut self) -> Result<(), ReportError> {
        let Self {
            body,
            inputs,
            state,
            field,
            ..
        } = self;
        field.clear();
        field.resize(state.u.len(), 0.0);
        Ok(state.velocity_at_t(body.system(), inputs, field)?)
    }
}
