//! Tools of a session.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use sinew_world::{Command, ToolId, World};

use crate::arrays::vector;
use crate::errors::of_command;
use crate::shared::Shared;

/// A tool of a session: session.tool(name). Vectors are arrays (3,) in world axes.
#[pyclass(frozen, module = "sinew_sim")]
pub(crate) struct Tool {
    pub(crate) world: Arc<Shared>,
    pub(crate) id: ToolId,
    /// Its name in the scene.
    #[pyo3(get)]
    pub(crate) name: String,
}

impl Tool {
    fn with<T>(&self, py: Python<'_>, ask: impl FnOnce(&mut World) -> PyResult<T>) -> PyResult<T> {
        self.world.with(py, ask)
    }

    fn report<'py>(
        &self,
        py: Python<'py>,
        part: impl FnOnce(sinew_tools::ToolReport) -> [f64; 3],
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let report = self.with(py, |world| Ok(world.tool_report(self.id)))?;
        let part = report.map_or([0.0; 3], part);
        Ok(PyArray1::from_slice(py, &part))
    }
}

#[pymethods]
impl Tool {
    /// Moves the tool to a position (m) at the end of the next step, in a straight line within that step; it stays
    /// there until it is moved again. rotation_vector (rad): axis times angle; None keeps the present one.
    #[pyo3(signature = (position, rotation_vector = None))]
    fn move_to(
        &self,
        py: Python<'_>,
        position: &Bound<'_, PyAny>,
        rotation_vector: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let position = vector(position, "position", "m")?;
        let turn = rotation_vector.map(|turn| vector(turn, "rotation_vector", "rad"));
        let turn = turn.transpose()?;
        self.with(py, |world| {
            let turn = turn.unwrap_or_else(|| world.hand_pose(self.id).rotation_vector());
            let steered = world.steer(self.id, position, turn);
            steered.map_err(of_command)
        })
    }

    /// Closes the jaws: nodes that the tool touches in a step move with it until release().
    fn grasp(&self, py: Python<'_>) -> PyResult<()> {
        let tool = self.name.as_str().into();
        self.world.command(py, Command::Grasp { tool })
    }

    /// Opens the jaws.
    fn release(&self, py: Python<'_>) -> PyResult<()> {
        let tool = self.name.as_str().into();
        self.world.command(py, Command::Release { tool })
    }

    /// Position of its own origin (m).
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let pose = self.with(py, |world| Ok(world.tool_pose(self.id)))?;
        Ok(PyArray1::from_slice(py, &pose.position()))
    }

    /// Rotation vector (rad): axis times angle.
    #[getter]
    fn rotation_vector<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let pose = self.with(py, |world| Ok(world.tool_pose(self.id)))?;
        Ok(PyArray1::from_slice(py, &pose.rotation_vector()))
    }

    /// Force on the tool (N), friction included: the mean over the last step.
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.report(py, |report| report.force)
    }

    /// Torque on the tool about its origin (N m).
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.report(py, |report| report.torque)
    }

    /// Impulse (N s) that the tool has received since the motion began: its growth over any time is the mean force then.
    #[getter]
    fn impulse<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.report(py, |report| report.impulse)
    }

    /// Work (J) of the tool on the body since the motion began.
    #[getter]
    fn work(&self, py: Python<'_>) -> PyResult<f64> {
        let report = self.with(py, |world| Ok(world.tool_report(self.id)))?;
        Ok(report.map_or(0.0, |report| report.work))
    }

    /// Number of contacts in which the tool pushed or held in the last step.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> PyResult<usize> {
        let report = self.with(py, |world| Ok(world.tool_report(self.id)))?;
        Ok(report.map_or(0, |report| report.contacts))
    }

    /// Distance (m) to the nearest node or triangle that it may touch, negative inside; inf if there is none.
    #[getter]
    fn gap(&self, py: Python<'_>) -> PyResult<f64> {
        let depth = self.with(py, |world| Ok(world.tool_gap(self.id)))?;
        Ok(depth.map_or(f64::INFINITY, |depth| depth.gap))
    }

    fn __repr__(&self) -> String {
        format!("Tool(\"{}\")", self.name)
    }
}
