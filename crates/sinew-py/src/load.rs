//! Loads of a session.

use std::sync::Arc;

use pyo3::prelude::*;
use sinew_world::LoadId;

use crate::errors::of_command;
use crate::shared::Shared;

/// A load of a session: session.load(name).
#[pyclass(frozen, module = "sinew_sim")]
pub(crate) struct Load {
    pub(crate) world: Arc<Shared>,
    pub(crate) id: LoadId,
    /// Its name in the scene.
    #[pyo3(get)]
    pub(crate) name: String,
}

#[pymethods]
impl Load {
    /// Factor of the load from the next step on, in addition to its own course over time; 1 at the beginning.
    #[getter]
    fn factor(&self, py: Python<'_>) -> PyResult<f64> {
        let factor = self
            .world
            .with(py, |world| Ok(world.load_factor(self.id)))?;
        Ok(factor.unwrap_or(1.0))
    }

    #[setter]
    fn set_factor(&self, py: Python<'_>, factor: f64) -> PyResult<()> {
        self.world.with(py, |world| {
            world.scale_load(self.id, factor).map_err(of_command)
        })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Load(\"{}\", factor={})",
            self.name,
            self.factor(py)?
        ))
    }
}
