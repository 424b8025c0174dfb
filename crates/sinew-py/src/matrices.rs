//! Matrices of a scene at rest.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew_core::{BlockMatrix, LinearOperators};
use sinew_scene::Simulation;

use crate::errors::scene_error;

/// M, D, K and F of small motions about rest, over the free degrees of freedom: a node that is not fixed in x, y and z
/// has three, one after the other.
///
/// K (N/m), D (N s/m): scipy.sparse.bsr_array with blocks of 3 x 3 if scipy is installed, else tuples (indptr, indices,
/// blocks). M (kg), F (N, all loads and gravity at their full value, without pressures that follow the surface):
/// (dofs,). nodes, axes: the node and the axis (0, 1, 2) of each degree of freedom. held: True for components that are
/// fixed although their node moves; their rows and columns are 0.
#[pyclass(frozen, get_all, module = "sinew_sim")]
pub(crate) struct Matrices {
    #[pyo3(name = "K")]
    stiffness: Py<PyAny>,
    #[pyo3(name = "D")]
    damping: Py<PyAny>,
    #[pyo3(name = "M")]
    mass: Py<PyAny>,
    #[pyo3(name = "F")]
    force: Py<PyAny>,
    nodes: Py<PyAny>,
    axes: Py<PyAny>,
    held: Py<PyAny>,
}

/// Numbers of the matrices, found without the interpreter.
pub(crate) struct Numbers {
    stiffness: Blocks,
    damping: Blocks,
    mass: Vec<f64>,
    force: Vec<f64>,
    nodes: Vec<u32>,
    axes: Vec<u32>,
    held: Vec<bool>,
}

/// Block sparse rows in the types of scipy.
struct Blocks {
    ends: Vec<i64>,
    columns: Vec<i64>,
    values: Vec<f64>,
    layers: usize,
}

impl Blocks {
    fn of(matrix: &BlockMatrix) -> Self {
        let rows = matrix.to_bsr();
        Self {
            ends: rows.indptr.iter().map(|end| *end as i64).collect(),
            columns: rows
                .indices
                .iter()
                .map(|column| i64::from(*column))
                .collect(),
            layers: rows.layers.count(),
            values: rows.blocks.into_owned(),
        }
    }

    fn into_python(self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let (rows, size) = ((self.ends.len() - 1) * self.layers, self.layers);
        let count = self.columns.len();
        let ends = PyArray1::from_vec(py, self.ends);
        let columns = PyArray1::from_vec(py, self.columns);
        let blocks = PyArray1::from_vec(py, self.values).reshape([count, size, size])?;
        let Ok(sparse) = py.import("scipy.sparse") else {
            return Ok((ends, columns, blocks)
                .into_pyobject(py)?
                .into_any()
                .unbind());
        };
        let shape = PyDict::new(py);
        shape.set_item("shape", (rows, rows))?;
        let parts = ((blocks, columns, ends),);
        Ok(sparse
            .call_method("bsr_array", parts, Some(&shape))?
            .unbind())
    }
}

impl Numbers {
    pub(crate) fn of(simulation: &Simulation) -> PyResult<Self> {
        let operators: LinearOperators = simulation
            .operators_at_rest()
            .map_err(|error| scene_error(&error))?;
        let mut force = vec![0.0; operators.dofs()];
        for (dof, value) in operators.loads().iter().flat_map(|load| &load.entries) {
            force[*dof as usize] += value;
        }
        let layers = operators.stiffness().layers().count();
        let dofs = 0..operators.dofs() as u32;
        let axes: Vec<u32> = dofs.clone().map(|dof| dof % layers as u32).collect();
        let body = simulation.model().body();
        let node = |dof: u32| match body {
            Some(body) => body.model.nodes()[dof as usize / layers],
            None => 0,
        };
        let held = match body {
            Some(body) => body.model.pinned().to_vec(),
            None => vec![false; operators.dofs()],
        };
        Ok(Self {
            stiffness: Blocks::of(operators.stiffness()),
            damping: Blocks::of(&operators.damping_matrix()),
            mass: operators.mass().to_vec(),
            force,
            nodes: dofs.map(node).collect(),
            axes,
            held,
        })
    }

    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Matrices> {
        let array = |values: Vec<f64>| PyArray1::from_vec(py, values).into_any().unbind();
        Ok(Matrices {
            stiffness: self.stiffness.into_python(py)?,
            damping: self.damping.into_python(py)?,
            mass: array(self.mass),
            force: array(self.force),
            nodes: PyArray1::from_vec(py, self.nodes).into_any().unbind(),
            axes: PyArray1::from_vec(py, self.axes).into_any().unbind(),
            held: PyArray1::from_vec(py, self.held).into_any().unbind(),
        })
    }
}
