//! Bodies under tools.

use std::sync::Arc;

use sinew_core::{
    Inputs, Integrator, Options, Run, SimulateError, StableStep, State, StepError, System,
    simulate_under,
};
use sinew_fem::{Model, Problem};
use sinew_mesh::TetMesh;
use sinew_tools::{
    Convex, Corner, Motion, Row, Shape, Table, Tool, Tools, TouchedCell, TouchedTriangle,
};

use crate::error::LabError;

/// A body under one tool, and its motion.
pub(crate) struct Pressed {
    pub(crate) model: Model,
    pub(crate) tools: Arc<Tools>,
    pub(crate) state: State,
}

impl Pressed {
    /// The body of a problem under a tool that touches the nodes for which `may_touch` is true.
    pub(crate) fn new(
        mesh: &TetMesh,
        problem: &Problem,
        tool: Tool,
        may_touch: impl Fn([f64; 3]) -> bool,
    ) -> Result<Self, LabError> {
        let model = Model::build(mesh, problem)?;
        let held = model.pinned().as_chunks::<3>().0;
        let cells = (0..).zip(model.nodes()).zip(held);
        let cells = cells.map(|((cell, node), held)| TouchedCell {
            cell,
            rest: mesh.points[*node as usize],
            free: held.map(|held| !held),
        });
        let cells: Vec<TouchedCell> = cells.filter(|cell| may_touch(cell.rest)).collect();
        let tool = Tool {
            cells: (0..cells.len() as u32).collect(),
            ..tool
        };
        let tools = Arc::new(Tools::new(vec![tool], cells)?);
        let model = model.with_contact(tools.clone());
        Ok(Self {
            state: State::at_rest(model.dofs()),
            model,
            tools,
        })
    }

    /// The body of a problem under a tool that touches all nodes, and also the triangles of the surface.
    pub(crate) fn with_triangles(
        mesh: &TetMesh,
        problem: &Problem,
        tool: Tool,
    ) -> Result<Self, LabError> {
        let pressed = Self::new(mesh, problem, tool, |_| true)?;
        let corner = |node: u32| match pressed.model.cell_of_node(node) {
            Some(cell) => Corner::Cell(cell),
            None => Corner::Held(mesh.points[node as usize]),
        };
        let triangles = mesh.boundary(None).into_iter();
        let triangles = triangles.map(|nodes| TouchedTriangle {
            corners: nodes.map(corner),
        });
        let triangles: Vec<TouchedTriangle> = triangles.collect();
        let all: Vec<u32> = (0..triangles.len() as u32).collect();
        let tools = pressed.tools.tools().iter().cloned();
        let tools = tools.map(|tool| Tool {
            triangles: all.clone(),
            ..tool
        });
        let cells = pressed.tools.touched_cells().to_vec();
        let tools = Arc::new(Tools::with_triangles(tools.collect(), cells, triangles)?);
        Ok(Self {
            model: pressed.model.with_contact(tools.clone()),
            tools,
            state: pressed.state,
        })
    }

    /// The largest stable step (s) of central difference.
    pub(crate) fn stable_step(&self) -> Result<f64, LabError> {
        let integrator = method("central-difference", &Options::new())?;
        match integrator
            .stable_step(&self.model)
            .map_err(StepError::from)?
        {
            StableStep::UpTo(step) => Ok(step),
            StableStep::Any | StableStep::Unknown => Err(LabError::no_body()),
        }
    }

    /// Takes steps of `dt` (s).
    pub(crate) fn run(
        &mut self,
        integrator: &mut dyn Integrator,
        dt: f64,
        steps: usize,
    ) -> Result<(), LabError> {
        let run = Run {
            dt,
            steps,
            divergence_limit: f64::INFINITY,
        };
        let (model, inputs) = (&self.model, Inputs::none());
        match simulate_under(model, inputs, integrator, &mut self.state, &run, &mut ()) {
            Ok(_) => Ok(()),
            Err(SimulateError::Step(error)) => Err(error.into()),
            Err(_) => Err(LabError::no_body()),
        }
    }

    /// The force (N) on the tool in the last step.
    pub(crate) fn force(&self) -> [f64; 3] {
        self.tools.report(&self.state, 0).force
    }

    /// The mean velocity (m/s) of the body along an axis, and its mass (kg).
    pub(crate) fn mean_velocity(&self, axis: usize) -> (f64, f64) {
        let all = self.state.v.iter().zip(self.model.mass());
        let along = all.skip(axis).step_by(3);
        let (momentum, mass) = along.fold((0.0, 0.0), |(p, m), (v, of)| (p + v * of, m + of));
        (momentum / mass, mass)
    }

    /// Kinetic and elastic energy (J) of a linear body with its velocity at the displacement's time.
    pub(crate) fn energy(&self) -> Result<f64, LabError> {
        let energy = self.model.energy(&self.state.u, &self.state.v);
        Ok(energy.ok_or_else(LabError::no_body)?.total())
    }

    /// Distance of the deepest node from the tool (m), negative inside.
    pub(crate) fn gap(&self) -> f64 {
        let pose = self.tools.pose(&self.state, Inputs::none(), 0);
        let deepest = self.tools.deepest(&self.state.u, &pose, 0);
        deepest.map_or(f64::INFINITY, |depth| depth.gap)
    }
}

/// `cnn-energy` with the potential of implicit Euler's step and this number of sweeps.
pub(crate) fn energy_sweeps(sweeps: u32) -> (&'static str, Options) {
    let options = Options::new().with_text("kind", "ie");
    (
        "cnn-energy",
        options.with_number("sweeps", f64::from(sweeps)),
    )
}

/// An integrator by its id.
pub(crate) fn method(id: &str, options: &Options) -> Result<Box<dyn Integrator>, LabError> {
    Ok(sinew_integrators::build(id, options)?)
}

/// A tool of one shape.
pub(crate) fn tool(convex: Convex, motion: Motion, friction: f64) -> Tool {
    Tool {
        name: "tool".to_owned(),
        shape: Shape::of(convex),
        motion,
        friction,
        cells: Vec::new(),
        grasp: None,
        body: None,
        triangles: Vec::new(),
    }
}

/// A motion through positions (m) at times (s), with a constant rotation vector (rad).
pub(crate) fn through(
    rows: &[(f64, [f64; 3])],
    rotation_vector: [f64; 3],
) -> Result<Motion, LabError> {
    let rows = rows.iter().map(|(t, position)| Row {
        t: *t,
        position: *position,
        rotation_vector,
    });
    Ok(Motion::Table(Table::new(rows.collect())?))
}
