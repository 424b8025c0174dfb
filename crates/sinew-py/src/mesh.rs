//! Meshes.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods, PyType};
use sha2::{Digest, Sha256};
use sinew_mesh::vtu::{VtuEncoding, write_vtu};
use sinew_mesh::{GroupMembers, MshEncoding, MshVersion, TetMesh, write_msh};
use sinew_scene::output::{Delivery, Destination};

use crate::arrays::{index_rows, indices, read_only, rows, rows_of};
use crate::errors::{scene_error, value_error};
use crate::guard::guarded;

/// A mesh of tetrahedra with named groups. Lengths are in metres unless a scene scales them.
///
/// Mesh(points, tets, groups={}, data={}): points (n, 3); tets (m, 4), indices of points, any orientation;
/// groups by name: an array (k,) of tetrahedra, (k, 3) of the nodes of triangles, or a Group; data by name: (m,) or
/// (m, c), values of tetrahedra that a scene may name. ValueError names the argument at fault.
#[pyclass(frozen, module = "sinew_sim")]
pub(crate) struct Mesh {
    pub(crate) mesh: Arc<TetMesh>,
}

/// A named part of a mesh: dim is 0 for nodes, 1 for lines, 2 for triangles, 3 for tetrahedra; members are indices of
/// nodes or tetrahedra (k,), or the nodes of lines (k, 2) or triangles (k, 3), uint32.
#[pyclass(frozen, get_all, module = "sinew_sim")]
pub(crate) struct Group {
    dim: u8,
    members: Py<PyAny>,
}

#[pymethods]
impl Group {
    #[new]
    fn new(dim: u8, members: Py<PyAny>) -> PyResult<Self> {
        match dim {
            0..=3 => Ok(Self { dim, members }),
            _ => Err(value_error(format!(
                "dim: {dim}: expected 0 (nodes), 1 (lines), 2 (triangles) or 3 (tetrahedra)"
            ))),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, (u8, Py<PyAny>)) {
        let own = slf.get();
        (slf.get_type(), (own.dim, own.members.clone_ref(slf.py())))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let count = self.members.bind(py).len()?;
        Ok(format!("Group(dim={}, {count} members)", self.dim))
    }
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (points, tets, groups = None, data = None))]
    fn new(
        points: &Bound<'_, PyAny>,
        tets: &Bound<'_, PyAny>,
        groups: Option<&Bound<'_, PyDict>>,
        data: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let points = rows_of::<3>(points, "points", "m")?;
        if let Some(node) = points
            .iter()
            .position(|at| !at.iter().all(|x| x.is_finite()))
        {
            return Err(value_error(format!(
                "points: node {node} is at {:?}: expected finite numbers",
                points[node]
            )));
        }
        let tets = index_rows::<4>(tets, "tets", ("node", points.len()))?;
        let mut mesh =
            TetMesh::new(points, tets).map_err(|error| value_error(format!("tets: {error}")))?;
        let volumes = mesh.signed_volumes();
        for (tet, volume) in mesh.tets.iter_mut().zip(volumes) {
            if volume < 0.0 {
                tet.swap(1, 2);
            }
        }
        for (name, members) in groups.into_iter().flat_map(PyDictMethods::iter) {
            let name: String = name.extract()?;
            let members = members_of(&mesh, &name, &members)?;
            let added = mesh.add_group(&name, members).map(drop);
            added.map_err(|error| value_error(format!("groups[\"{name}\"]: {error}")))?;
        }
        for (name, values) in data.into_iter().flat_map(PyDictMethods::iter) {
            let name: String = name.extract()?;
            data_of(&mut mesh, &name, &values)?;
        }
        Ok(Self {
            mesh: Arc::new(mesh),
        })
    }

    /// Reads a mesh file: .msh of gmsh, .vtu and .vtk of VTK, .mesh of Medit, .inp of Abaqus. SceneError names file and
    /// line.
    #[classmethod]
    fn read(_: &Bound<'_, PyType>, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let mesh = py.detach(|| {
            guarded(|| {
                let mesh =
                    sinew_mesh::read_mesh_file(&path).map_err(|error| scene_error(&error))?;
                let mesh = mesh.to_tet_mesh();
                mesh.map_err(|error| scene_error(&format!("{}: {error}", path.display())))
            })
        })?;
        Ok(Self {
            mesh: Arc::new(mesh),
        })
    }

    /// Writes the mesh with its groups: .msh (4.1) or .vtu, by the end of the name. If groups overlap, the order of
    /// tetrahedra in the file may differ.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let is_msh = match extension {
            Some("msh") => true,
            Some("vtu") => false,
            _ => {
                return Err(value_error(format!(
                    "path: {}: expected a name that ends in .msh or .vtu",
                    path.display()
                )));
            }
        };
        py.detach(|| {
            guarded(|| {
                let failed = |error: &dyn std::fmt::Display| {
                    PyOSError::new_err(format!("{}: {error}", path.display()))
                };
                let (mesh, mut bytes) = (self.mesh.to_mesh(), Vec::new());
                match is_msh {
                    true => write_msh(&mesh, MshVersion::V41, MshEncoding::Binary, &mut bytes)
                        .map_err(|error| failed(&error))?,
                    false => write_vtu(&mesh, VtuEncoding::RawAppended, &mut bytes)
                        .map_err(|error| failed(&error))?,
                }
                let destination = Destination::new(&path, &[]);
                let written = destination.and_then(|destination| destination.write(&bytes));
                let _whole: Delivery =
                    written.map_err(|error| PyOSError::new_err(error.to_string()))?;
                Ok(())
            })
        })
    }

    /// Positions of the nodes, (n, 3).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(read_only(rows(py, self.mesh.points.clone())?)?.into_any())
    }

    /// The four nodes of each tetrahedron, (m, 4) uint32.
    #[getter]
    fn tets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(read_only(rows(py, self.mesh.tets.clone())?)?.into_any())
    }

    /// The groups by name.
    #[getter]
    fn groups<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let groups = PyDict::new(py);
        for group in &self.mesh.groups {
            let members = match &group.members {
                GroupMembers::Tets(tets) => PyArray1::from_slice(py, tets).into_any(),
                GroupMembers::Nodes(nodes) => PyArray1::from_slice(py, nodes).into_any(),
                GroupMembers::Lines(lines) => rows(py, lines.clone())?.into_any(),
                GroupMembers::Triangles(triangles) => rows(py, triangles.clone())?.into_any(),
            };
            let dim = group.dim;
            let members = members.unbind();
            groups.set_item(&group.name, Py::new(py, Group { dim, members })?)?;
        }
        Ok(groups)
    }

    /// Values of tetrahedra by name, (m,) or (m, c).
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for data in &self.mesh.data {
            let values = PyArray1::from_slice(py, &data.values);
            let values = match data.components {
                1 => values.into_any(),
                components => {
                    let count = self.mesh.tets.len();
                    values.reshape([count, components])?.into_any()
                }
            };
            all.set_item(&data.name, values)?;
        }
        Ok(all)
    }

    /// Volume of all tetrahedra (m^3).
    #[getter]
    fn volume(&self) -> f64 {
        let tets = 0..self.mesh.tets.len();
        tets.map(|tet| self.mesh.volume(tet).abs()).sum()
    }

    fn __repr__(&self) -> String {
        let names: Vec<&str> = self.mesh.groups.iter().map(|group| &*group.name).collect();
        format!(
            "Mesh({} nodes, {} tetrahedra, groups {})",
            self.mesh.points.len(),
            self.mesh.tets.len(),
            match names.is_empty() {
                true => "none".to_owned(),
                false => names.join(", "),
            }
        )
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyAny>)> {
        let (py, own) = (slf.py(), slf.get());
        let groups = PyDict::new(py);
        for (name, group) in own.groups(py)? {
            let group = group.cast::<Group>()?.get();
            groups.set_item(name, (group.dim, group.members.bind(py)))?;
        }
        let rest = (own.points(py)?, own.tets(py)?, groups, own.data(py)?);
        Ok((slf.get_type(), rest.into_pyobject(py)?.into_any()))
    }
}

impl Mesh {
    /// Bytes that identify the mesh.
    pub(crate) fn content(&self) -> Vec<u8> {
        let mut sum = Sha256::new();
        for x in self.mesh.points.as_flattened() {
            sum.update(x.to_le_bytes());
        }
        for node in self.mesh.tets.as_flattened() {
            sum.update(node.to_le_bytes());
        }
        sum.update(format!("{:?}{:?}", self.mesh.groups, self.mesh.data));
        sum.finalize().to_vec()
    }
}

fn members_of(mesh: &TetMesh, name: &str, value: &Bound<'_, PyAny>) -> PyResult<GroupMembers> {
    let name = format!("groups[\"{name}\"]");
    let (nodes, tets) = (
        ("node", mesh.points.len()),
        ("tetrahedron", mesh.tets.len()),
    );
    // A pair of dimension and members, or a Group; else arrays tell by their shape.
    let pair = match value.cast::<Group>() {
        Ok(group) => Some((
            group.get().dim,
            group.get().members.bind(value.py()).clone(),
        )),
        Err(_) => match value.cast::<pyo3::types::PyTuple>() {
            Ok(tuple) if tuple.len() == 2 => tuple.extract::<(u8, Bound<'_, PyAny>)>().ok(),
            _ => None,
        },
    };
    let (dim, members) = match pair {
        Some((dim, members)) => (Some(dim), members),
        None => (None, value.clone()),
    };
    let numpy = value.py().import("numpy")?;
    let shape = numpy.call_method1("shape", (&members,))?;
    let width = shape.extract::<Vec<usize>>()?.get(1).copied();
    match (dim, width) {
        (Some(0), _) => Ok(GroupMembers::Nodes(indices(&members, &name, nodes)?)),
        (Some(1), _) => Ok(GroupMembers::Lines(index_rows(&members, &name, nodes)?)),
        (Some(2), _) | (None, Some(3)) => {
            Ok(GroupMembers::Triangles(index_rows(&members, &name, nodes)?))
        }
        (Some(3), _) | (None, None | Some(1)) => {
            Ok(GroupMembers::Tets(indices(&members, &name, tets)?))
        }
        (_, Some(width)) => Err(value_error(format!(
            "{name}: expected indices of tetrahedra (k,), nodes of triangles (k, 3) or a Group, got rows of {width}"
        ))),
        (Some(dim), None) => Err(value_error(format!(
            "{name}: no cells have the dimension {dim}"
        ))),
    }
}

fn data_of(mesh: &mut TetMesh, name: &str, values: &Bound<'_, PyAny>) -> PyResult<()> {
    let numpy = values.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (values, "float64"))?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    let tets = mesh.tets.len();
    let components = match *shape.as_slice() {
        [count] if count == tets => 1,
        [count, components] if count == tets && components > 0 => components,
        _ => {
            return Err(value_error(format!(
                "data[\"{name}\"]: expected a row for each of {tets} tetrahedra, got {}",
                crate::arrays::in_words(&shape)
            )));
        }
    };
    let values: Vec<f64> = array.call_method0("ravel")?.extract()?;
    mesh.data.push(sinew_mesh::TetData {
        name: name.to_owned(),
        step: 0,
        components,
        values,
    });
    Ok(())
}
