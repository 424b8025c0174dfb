//! Frames of run folders.

use std::path::PathBuf;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew_mesh::{CellType, Mesh};

use crate::arrays::rows;
use crate::errors::scene_error;

/// The points, cells and fields of a .vtu file: {"points": (n, 3), "tets": (m, 4), "triangles": (k, 3), fields by their names}.
#[pyfunction(name = "_read_frame")]
pub(crate) fn read_frame(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let read = py.detach(|| sinew_mesh::read_mesh_file(path));
    let mesh = read.map_err(|error| scene_error(&error))?;
    let frame = PyDict::new(py);
    let count = mesh.points.len();
    for data in &mesh.point_data {
        let shaped = shaped(py, data.values.clone(), count)?;
        frame.set_item(&data.name, shaped)?;
    }
    let cells = mesh.cells.iter();
    let cells: usize = cells
        .map(|block| block.connectivity.len() / block.kind.node_count())
        .sum();
    for data in &mesh.cell_data {
        frame.set_item(&data.name, shaped(py, data.blocks.concat(), cells)?)?;
    }
    frame.set_item("tets", rows(py, cells_of::<4>(&mesh, CellType::Tetra))?)?;
    frame.set_item(
        "triangles",
        rows(py, cells_of::<3>(&mesh, CellType::Triangle))?,
    )?;
    frame.set_item("points", rows(py, mesh.points)?)?;
    Ok(frame)
}

fn cells_of<const N: usize>(mesh: &Mesh, kind: CellType) -> Vec<[u32; N]> {
    let blocks = mesh.cells.iter().filter(|block| block.kind == kind);
    let all: Vec<u32> = blocks
        .flat_map(|block| block.connectivity.iter().copied())
        .collect();
    all.as_chunks().0.to_vec()
}

/// One number for each row, or a row of several.
fn shaped(py: Python<'_>, values: Vec<f64>, rows: usize) -> PyResult<Bound<'_, PyAny>> {
    let components = values.len() / rows.max(1);
    let array = PyArray1::from_vec(py, values);
    match components {
        0 | 1 => Ok(array.into_any()),
        _ => Ok(array.reshape([rows, components])?.into_any()),
    }
}
