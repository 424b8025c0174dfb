//! A tool of a simulated body, steered by a device.

use std::sync::Arc;

use sinew_core::{EvaluationError, LoadTime, Trial};
use sinew_tools::Tools;
use sinew_tools::vector::{add, length, scaled, sub};
use sinew_world::{CommandError, ToolId, World, WorldStepError};

use crate::local_model::LocalModel;
use crate::published::{DeviceMotion, Published, Simulated};
use crate::stiffness::{Carried, Carry, LocalStiffness};

/// A world in which a device moves a tool, with cuts and a log like any other world.
///
/// A tool that is a dynamic body is pulled to the device by its coupling; any other tool is at the position of the
/// device. Each step is a command in the log of the world, which repeats the session without the device.
pub struct ToolSimulation {
    world: World,
    tool: ToolId,
    iterations: usize,
    steps: u64,
    stiffness: LocalStiffness,
    carried: Carried,
    at_rest: Vec<f64>,
    /// The result of the last step.
    last: Option<Published>,
}

/// A step under a device that cannot be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ToolStepError {
    /// A tool that the world does not have, or a position of the device that is not valid.
    #[error("the device cannot move the tool: {0}")]
    Device(#[from] CommandError),
    /// A step that cannot be taken.
    #[error(transparent)]
    Step(#[from] WorldStepError),
    /// A state at which there is no stiffness.
    #[error("the stiffness at the tool is unknown")]
    Stiffness(#[from] EvaluationError),
}

impl ToolSimulation {
    /// A world whose tool of this name follows the device.
    ///
    /// # Errors
    /// [`ToolStepError::Device`] for a tool that the world does not have.
    pub fn new(world: World, tool: &str) -> Result<Self, ToolStepError> {
        let tool = world.tool(tool)?;
        let dofs = world.state().u.len();
        Ok(Self {
            tool,
            iterations: 2,
            steps: 0,
            stiffness: LocalStiffness::new(dofs),
            carried: Carried::default(),
            at_rest: vec![0.0; dofs],
            last: None,
            world,
        })
    }

    /// Sets the number of iterations for the local stiffness in each step, initially 2; with 0 it is the stiffness of a
    /// tissue in which only the touched nodes yield.
    pub fn set_iterations(&mut self, iterations: usize) {
        self.iterations = iterations;
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, for further commands of its user, such as cuts.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The force (N) of the tissue at a position (m) of the tool that the user feels. A force that the tissue of the
    /// last step, taken as a spring, does not predict is transmitted through the tool's mass, within the time
    /// `sqrt(m/k)` of its coupling. A node that comes into contact with the tool loses its momentum within one step,
    /// with a force that is larger for shorter steps; a tool of mass m absorbs it before the coupling does.
    fn felt(&self, tools: &Tools, force: [f64; 3], at: [f64; 3]) -> [f64; 3] {
        let body = tools.tools()[self.tool.index()].body;
        match (&self.last, body) {
            (Some(last), Some(body)) if body.coupling > 0.0 => {
                let foreseen = LocalModel::of(last).force(at);
                let dt = self.world.dt();
                let share = dt / (dt + (body.mass / body.coupling).sqrt());
                add(foreseen, scaled(sub(force, foreseen), share))
            }
            _ => force,
        }
    }

    /// Lists the cells that the tool carries along.
    fn carry(&mut self, tools: &Tools) {
        let own = &tools.tools()[self.tool.index()];
        self.carried.clear();
        let forces = tools.forces(self.world.state());
        let pushed = tools.touched_cells().iter().zip(forces);
        let mut mine = own.cells.iter().peekable();
        for (place, (touched, force)) in (0..).zip(pushed) {
            if mine.peek().is_some_and(|mine| **mine == place) {
                mine.next();
            } else {
                continue;
            }
            let size = length(force);
            if size == 0.0 {
                continue;
            }
            let carry = if own.friction > 0.0 || own.grasp.is_some() {
                Carry::Fully
            } else {
                Carry::Along(scaled(force, 1.0 / size))
            };
            self.carried.push(touched.cell, touched.free, carry);
        }
    }

    /// Adjusts the buffers to a body that was cut.
    fn fit(&mut self) {
        let dofs = self.world.state().u.len();
        if dofs != self.at_rest.len() || self.world.change().is_some() {
            self.stiffness = LocalStiffness::new(dofs);
            self.at_rest = vec![0.0; dofs];
        }
    }
}

impl Simulated for ToolSimulation {
    type Error = ToolStepError;

    fn dt(&self) -> f64 {
        self.world.dt()
    }

    fn step(&mut self, device: &DeviceMotion) -> Result<Published, ToolStepError> {
        let dt = self.world.dt();
        let position = add(device.position, scaled(device.velocity, dt));
        self.world
            .steer(self.tool, position, device.rotation_vector)?;
        self.world.step()?;
        self.steps += 1;
        self.fit();
        let body = Arc::clone(self.world.body());
        let (Some(tools), Some(report)) = (body.model().tools(), self.world.tool_report(self.tool))
        else {
            return Ok(Published::free_at(device.position));
        };
        let pose = self.world.tool_pose(self.tool);
        self.carry(tools);
        let state = self.world.state();
        let trial = Trial {
            load: LoadTime::at(state.t()).under(self.world.inputs()),
            dt: 0.0,
            u: &state.u,
            v: &self.at_rest,
            internal: &state.internal,
        };
        let stiffness = match body.system().as_elastic() {
            Some(law) => self
                .stiffness
                .refine(law, &trial, &self.carried, self.iterations)?,
            None => [[0.0; 3]; 3],
        };
        let [velocity, spin] = report.body.map_or([device.velocity, [0.0; 3]], |body| {
            [body.velocity, body.spin]
        });
        let published = Published {
            t: state.t(),
            dt,
            steps: self.steps,
            position: pose.position(),
            rotation_vector: pose.rotation_vector(),
            velocity,
            spin,
            force: self.felt(tools, report.force, pose.position()),
            torque: report.torque,
            stiffness,
            may_pull: tools.tools()[self.tool.index()].grasp.is_some(),
        };
        self.last = Some(published);
        Ok(published)
    }
}
