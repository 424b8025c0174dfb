//! A tool of a simulated body in the hand of a device.

use std::sync::Arc;

use sinew_core::{
    EvaluationError, InputError, Inputs, Integrator, LoadTime, State, StepError, System, Trial,
};
use sinew_tools::vector::{add, length, scaled, sub};
use sinew_tools::{Steering, Tools};

use crate::local_model::LocalModel;
use crate::published::{DeviceMotion, Published, Simulated};
use crate::stiffness::{Carried, Carry, LocalStiffness};

/// A body whose tool a device moves.
///
/// The tool follows a motion of [`sinew_tools::Motion::Steered`]: where it is a body of its own, its coupling draws it to the device; else it is where the device is.
pub struct ToolSimulation {
    body: Body,
    integrator: Box<dyn Integrator>,
    dt: f64,
    iterations: usize,
    steps: u64,
    state: State,
    inputs: Inputs,
    stiffness: LocalStiffness,
    carried: Carried,
    at_rest: Vec<f64>,
    /// What was published last.
    last: Option<Published>,
}

/// What a device moves in a simulation.
pub struct Body {
    /// The body, with its tools in contact.
    pub system: Arc<dyn System>,
    /// These tools.
    pub tools: Arc<Tools>,
    /// The number of the tool that the device moves.
    pub tool: usize,
    /// The channels by which it is moved.
    pub steering: Steering,
    /// Inputs with these channels.
    pub inputs: Inputs,
}

/// A step under a device that cannot be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ToolStepError {
    /// A position of the device that is none.
    #[error("the device cannot move the tool")]
    Device(#[from] InputError),
    /// A step that cannot be taken.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A state at which there is no stiffness.
    #[error("the stiffness at the tool is unknown")]
    Stiffness(#[from] EvaluationError),
}

impl ToolSimulation {
    /// A simulation in steps of `dt` (s), from a body at rest on.
    #[must_use]
    pub fn new(body: Body, integrator: Box<dyn Integrator>, dt: f64) -> Self {
        let dofs = body.system.dofs();
        Self {
            integrator,
            dt,
            iterations: 2,
            steps: 0,
            state: State::at_rest(dofs),
            inputs: body.inputs.clone(),
            stiffness: LocalStiffness::new(dofs),
            carried: Carried::default(),
            at_rest: vec![0.0; dofs],
            last: None,
            body,
        }
    }

    /// Takes this many iterations for the local stiffness in each step from now on, 2 at first; with 0 it is that of a tissue whose touched nodes alone give way.
    pub fn set_iterations(&mut self, iterations: usize) {
        self.iterations = iterations;
    }

    /// The state after the last step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The force (N) of the tissue at a place (m) of the tool, as the hand feels it: what the last step's tissue as a spring does not foresee comes through the tool's mass, within
    /// the time `sqrt(m/k)` of its coupling. A node that meets the tool gives up its momentum within one step, a push that is the harder the shorter the step; a tool of
    /// mass m takes it up before the coupling does.
    fn felt(&self, force: [f64; 3], at: [f64; 3]) -> [f64; 3] {
        let body = self.body.tools.tools()[self.body.tool].body;
        match (&self.last, body) {
            (Some(last), Some(body)) if body.coupling > 0.0 => {
                let foreseen = LocalModel::of(last).force(at);
                let share = self.dt / (self.dt + (body.mass / body.coupling).sqrt());
                add(foreseen, scaled(sub(force, foreseen), share))
            }
            _ => force,
        }
    }

    /// Lists the cells that the tool moves along.
    fn carry(&mut self) {
        let Body { tools, tool, .. } = &self.body;
        let own = &tools.tools()[*tool];
        self.carried.clear();
        let pushed = tools.touched_cells().iter().zip(tools.forces(&self.state));
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
}

impl Simulated for ToolSimulation {
    type Error = ToolStepError;

    fn dt(&self) -> f64 {
        self.dt
    }

    fn step(&mut self, device: &DeviceMotion) -> Result<Published, ToolStepError> {
        let dt = self.dt;
        let Body {
            system,
            tools,
            tool,
            steering,
            ..
        } = &self.body;
        let mut clock = self.state.clock;
        if self.steps == 0 {
            let at = (device.position, device.rotation_vector);
            steering.set(&mut self.inputs, clock.time(), at.0, at.1)?;
        }
        clock.advance(dt);
        let end = add(device.position, scaled(device.velocity, dt));
        steering.set(&mut self.inputs, clock.time(), end, device.rotation_vector)?;
        self.integrator
            .step_under(system.as_ref(), &self.inputs, &mut self.state, dt)?;
        self.inputs.forget_before(self.state.t() - 2.0 * dt);
        self.steps += 1;

        let (tool, tools) = (*tool, tools.clone());
        let pose = tools.pose(&self.state, &self.inputs, tool);
        let report = tools.report(&self.state, tool);
        self.carry();
        let trial = Trial {
            load: LoadTime::at(self.state.t()).under(&self.inputs),
            dt: 0.0,
            u: &self.state.u,
            v: &self.at_rest,
            internal: &self.state.internal,
        };
        let stiffness = match self.body.system.as_ref().as_elastic() {
            Some(law) => self
                .stiffness
                .refine(law, &trial, &self.carried, self.iterations)?,
            None => [[0.0; 3]; 3],
        };
        let [velocity, spin] = report.body.map_or([device.velocity, [0.0; 3]], |body| {
            [body.velocity, body.spin]
        });
        let published = Published {
            t: self.state.t(),
            dt,
            steps: self.steps,
            position: pose.position(),
            rotation_vector: pose.rotation_vector(),
            velocity,
            spin,
            force: self.felt(report.force, pose.position()),
            torque: report.torque,
            stiffness,
            may_pull: tools.tools()[tool].grasp.is_some(),
        };
        self.last = Some(published);
        Ok(published)
    }
}
