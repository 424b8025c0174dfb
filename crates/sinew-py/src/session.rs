//! Sessions: scenes in motion, step by step.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::exceptions::{PyOverflowError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use sinew_core::Options;
use sinew_fem::stress::von_mises;
use sinew_scene::Reaction;
use sinew_world::{Command, Ended, ReportError, Saved, World};

use crate::arrays::{fill, filled_flat, indices, read_only, rows, rows_of, vector};
use crate::errors::{of_advance, of_advance_to, of_command, of_report, of_step, value_error};
use crate::load::Load;
use crate::mesh::Mesh;
use crate::shared::Shared;
use crate::tool::Tool;
use crate::values::options;
use crate::watch::Watch;

/// A scene in motion, from scene.session(). Units are SI; arrays are float64 and show the present moment.
///
/// Commands (tools, loads, forces, cuts, methods) take effect with the next step and are kept in log, which repeats the
/// motion bit for bit. Steps release the GIL: two sessions run side by side in two threads.
#[pyclass(frozen, module = "sinew_sim")]
pub(crate) struct Session {
    world: Arc<Shared>,
    scene: Py<PyAny>,
    /// The beginning of the motion.
    begun: Saved,
}

/// Steps that Session.advance took: steps (int), and shortened, their length (s) if it was less than dt, else None.
#[pyclass(frozen, get_all, module = "sinew_sim")]
pub(crate) struct Advanced {
    steps: usize,
    shortened: Option<f64>,
}

#[pymethods]
impl Advanced {
    fn __repr__(&self) -> String {
        match self.shortened {
            Some(last) => format!("Advanced(steps={}, shortened={last})", self.steps),
            None => format!("Advanced(steps={}, shortened=None)", self.steps),
        }
    }
}

impl Session {
    /// A session at the beginning of its motion.
    pub(crate) fn new(world: World, scene: Py<PyAny>) -> Self {
        let begun = world.save();
        Self::begun_at(world, scene, begun)
    }

    /// A field of N numbers per row: in a new array, found while other threads of Python run, or in that of the caller.
    fn field<'py, const N: usize>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
        count: fn(&World) -> usize,
        write: fn(&mut World, &mut [[f64; N]]) -> Result<(), ReportError>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if let Some(out) = out {
            self.world.with(py, |world| {
                fill(out, count(world), |out| {
                    write(world, out).map_err(of_report)
                })
            })?;
            return Ok(out.clone());
        }
        let values = self.world.work(py, |world| {
            let mut values = vec![[0.0; N]; count(world)];
            write(world, &mut values).map_err(of_report)?;
            Ok(values)
        })?;
        Ok(rows(py, values)?.into_any())
    }

    /// A session whose motion began earlier.
    pub(crate) fn begun_at(world: World, scene: Py<PyAny>, begun: Saved) -> Self {
        Self {
            world: Arc::new(Shared::new(world)),
            scene,
            begun,
        }
    }
}

fn nodes_of(world: &World) -> usize {
    let body = world.body().model().body();
    body.map_or(0, |body| body.mesh.points.len())
}

/// A number of steps.
struct Steps(usize);

impl<'py> FromPyObject<'_, 'py> for Steps {
    type Error = PyErr;

    fn extract(n: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let is_beyond = |error: &PyErr| error.is_instance_of::<PyOverflowError>(n.py());
        n.extract()
            .map(Self)
            .map_err(|error: PyErr| match is_beyond(&error) {
                true => value_error(format!(
                    "n: {}: expected a number of steps, 0 or above",
                    &*n
                )),
                false => error,
            })
    }
}

/// Displacements or velocities: of nodes, or of the mass of an oscillator.
enum Motion {
    Nodes(Vec<[f64; 3]>),
    Mass(f64),
}

impl Motion {
    fn into_array(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(match self {
            Self::Nodes(values) => read_only(rows(py, values)?)?.into_any(),
            Self::Mass(value) => read_only(rows(py, vec![[value]])?)?.into_any(),
        })
    }
}

/// The value of the mass, if the scene is an oscillator.
fn of_mass(world: &World, values: &[f64]) -> Option<f64> {
    let body = world.body().model().body();
    values.first().copied().filter(|_| body.is_none())
}

/// Velocities at the time of the state, which large bodies compute with several threads.
fn velocities(world: &mut World) -> PyResult<Motion> {
    let nodes = nodes_of(world);
    if nodes > 0 {
        let mut values = vec![[0.0; 3]; nodes];
        world.velocities(&mut values).map_err(of_report)?;
        return Ok(Motion::Nodes(values));
    }
    let mut v = vec![0.0; world.state().u.len()];
    let found = (world.state()).velocity_at_t(world.body().system(), world.inputs(), &mut v);
    found.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(Motion::Mass(of_mass(world, &v).unwrap_or(0.0)))
}

fn tets_of(world: &World) -> usize {
    let body = world.body().model().body();
    body.map_or(0, |body| body.mesh.tets.len())
}

/// The end of steps, as the result or exception for Python.
fn end_of(ended: &Ended, watch: Watch, world: &World) -> PyResult<()> {
    match (ended, watch.raised, world.failure()) {
        (Ended::Stopped, Some(raised), _) => Err(raised),
        (Ended::Diverged { t, .. }, _, Some(failure)) => Err(of_step(failure, *t)),
        _ => Ok(()),
    }
}

#[pymethods]
impl Session {
    /// Takes n steps of dt. Raises Diverged or Refused; after that only reset() or restore() continues. KeyboardInterrupt
    /// leaves the session after the last whole step.
    #[pyo3(signature = (n = Steps(1)), text_signature = "($self, n=1)")]
    fn step(&self, py: Python<'_>, n: Steps) -> PyResult<()> {
        let Steps(steps) = n;
        self.world.work(py, |world| {
            if steps == 1 {
                let taken = world.step().map(drop);
                return taken.map_err(|error| of_step(&error, world.t()));
            }
            let mut watch = Watch::new();
            let ended = world.advance(steps, &mut watch);
            let ended = ended.map_err(|error| of_advance(error, world.t()))?;
            end_of(&ended, watch, world)
        })
    }

    /// Takes the steps of dt that cover a time (s), and ends with it: if they do not fit, as many shorter ones of equal
    /// length are taken, as the returned Advanced shows. One short step among long ones would add energy.
    fn advance(&self, py: Python<'_>, by: f64) -> PyResult<Advanced> {
        if !(by >= 0.0 && by.is_finite()) {
            let text = format!("by: {by}: expected a finite time (s), 0 or above");
            return Err(value_error(text));
        }
        self.world.work(py, |world| {
            let mut watch = Watch::new();
            let advanced = world.advance_by(by, &mut watch);
            let advanced = advanced.map_err(|error| of_advance_to(error, world.t()))?;
            end_of(&advanced.ended, watch, world)?;
            Ok(Advanced {
                steps: advanced.steps,
                shortened: advanced.shortened,
            })
        })
    }

    /// Time (s).
    #[getter]
    fn t(&self, py: Python<'_>) -> PyResult<f64> {
        self.world.with(py, |world| Ok(world.t()))
    }

    /// The step (s).
    #[getter]
    fn dt(&self, py: Python<'_>) -> PyResult<f64> {
        self.world.with(py, |world| Ok(world.dt()))
    }

    /// Steps taken since the motion began.
    #[getter]
    fn steps(&self, py: Python<'_>) -> PyResult<usize> {
        self.world.with(py, |world| Ok(world.steps()))
    }

    /// The largest stable step (s) of the method on the body at rest; inf if every step is stable or no limit is known.
    #[getter]
    fn stable_step(&self, py: Python<'_>) -> PyResult<f64> {
        self.world
            .work(py, |world| Ok(world.stable_step().unwrap_or(f64::INFINITY)))
    }

    /// Name of the method.
    #[getter]
    fn integrator(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.world.with(py, |world| Ok(world.integrator().id()))
    }

    /// Number of meshes that the body has had: nodes and tetrahedra differ once it has grown.
    #[getter]
    fn topology_epoch(&self, py: Python<'_>) -> PyResult<u64> {
        self.world.with(py, |world| Ok(world.topology_epoch()))
    }

    /// The scene.
    #[getter]
    fn scene(&self, py: Python<'_>) -> Py<PyAny> {
        self.scene.clone_ref(py)
    }

    /// The mesh as it is now, at rest: another one after a cut. None for an oscillator.
    #[getter]
    fn mesh(&self, py: Python<'_>) -> PyResult<Option<Mesh>> {
        self.world.with(py, |world| {
            let body = world.body().model().body();
            Ok(body.map(|body| Mesh {
                mesh: body.mesh.clone(),
            }))
        })
    }

    /// Positions of the nodes (m), (nodes, 3).
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let values = self.world.with(py, |world| {
            let mut values = vec![[0.0; 3]; nodes_of(world)];
            world.positions(&mut values).map_err(of_report)?;
            Ok(values)
        })?;
        Ok(read_only(rows(py, values)?)?.into_any())
    }

    /// Displacements of the nodes from rest (m), (nodes, 3); of the mass of an oscillator, (1, 1).
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let motion = self.world.with(py, |world| {
            if let Some(u) = of_mass(world, &world.state().u) {
                return Ok(Motion::Mass(u));
            }
            let mut values = vec![[0.0; 3]; nodes_of(world)];
            world.displacements(&mut values).map_err(of_report)?;
            Ok(Motion::Nodes(values))
        })?;
        motion.into_array(py)
    }

    /// Velocities of the nodes (m/s) at the time t, (nodes, 3); of the mass of an oscillator, (1, 1).
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.world.work(py, velocities)?.into_array(py)
    }

    /// Writes positions, displacement and velocity into arrays of the caller, (nodes, 3) float64.
    #[pyo3(signature = (*, positions = None, displacement = None, velocity = None))]
    fn read_into(
        &self,
        py: Python<'_>,
        positions: Option<&Bound<'_, PyAny>>,
        displacement: Option<&Bound<'_, PyAny>>,
        velocity: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        if let Some(velocity) = velocity {
            let Motion::Nodes(values) = self.world.work(py, velocities)? else {
                return Err(value_error("velocity: an oscillator has no nodes"));
            };
            fill(velocity, values.len(), |out| {
                out.copy_from_slice(&values);
                Ok(())
            })?;
        }
        self.world.with(py, |world| {
            let nodes = nodes_of(world);
            if let Some(positions) = positions {
                fill(positions, nodes, |out| {
                    world.positions(out).map_err(of_report)
                })?;
            }
            if let Some(displacement) = displacement {
                fill(displacement, nodes, |out| {
                    world.displacements(out).map_err(of_report)
                })?;
            }
            Ok(())
        })
    }

    /// Stress of each tetrahedron (Pa), (tets, 6): xx, yy, zz, xy, yz, zx. Cauchy's if a law is one of large
    /// deformation.
    #[pyo3(signature = (out = None))]
    fn stress<'py>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.field::<6>(py, out, tets_of, |world, out| world.stress(out))
    }

    /// Von Mises' stress of each tetrahedron (Pa), (tets,).
    #[pyo3(signature = (out = None))]
    fn von_mises<'py>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let values = self.world.work(py, |world| {
            let mut stress = vec![[0.0; 6]; tets_of(world)];
            world.stress(&mut stress).map_err(of_report)?;
            Ok(stress.iter().map(von_mises).collect())
        })?;
        filled_flat(py, out, values)
    }

    /// Strain of each tetrahedron, (tets, 6): xx, yy, zz, xy, yz, zx, Green's if a law is one of large deformation;
    /// shears are half of the engineering ones.
    #[pyo3(signature = (out = None))]
    fn strain<'py>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.field::<6>(py, out, tets_of, |world, out| world.strain(out))
    }

    /// Forces on the nodes by tools, and by the other face of a cut, in the last step (N), (nodes, 3).
    #[pyo3(signature = (out = None))]
    fn contact_force<'py>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.field::<3>(py, out, nodes_of, World::contact_forces)
    }

    /// Energies (J): kinetic_J, elastic_J, work_of_tools_J since the motion began, and of_cuts_J if the body may be
    /// cut.
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (energy, tools, cuts) = self.world.work(py, |world| {
            let energy = world.energy().map_err(of_report)?;
            let cuts = world.cuts().map(sinew_scene::CutTotals::energy);
            Ok((energy, world.work_of_tools(), cuts))
        })?;
        let entries = PyDict::new(py);
        if let Some(energy) = energy {
            entries.set_item("kinetic_J", energy.kinetic)?;
            entries.set_item("elastic_J", energy.elastic)?;
        }
        entries.set_item("work_of_tools_J", tools)?;
        if let Some(cuts) = cuts {
            entries.set_item("of_cuts_J", cuts)?;
        }
        Ok(entries)
    }

    /// Forces (N) and moments (N m) of supports and moved parts by name, such as fixed_1_bottom: a pair of arrays (3,) each.
    /// Moments are about the mean of the part's nodes at rest.
    fn reactions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = self.world.with(py, |world| {
            let reactions = world.reactions().map_err(of_report)?;
            let parts = world.body().held_parts();
            let parts = parts.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
            let names: Vec<String> = parts.iter().map(sinew_record::column_name).collect();
            Ok(names
                .into_iter()
                .zip(reactions)
                .collect::<Vec<(String, Reaction)>>())
        })?;
        let entries = PyDict::new(py);
        for (name, Reaction { force, moment, .. }) in all {
            let pair = [force, moment].map(|vector| PyArray1::from_slice(py, &vector));
            entries.set_item(name, (&pair[0], &pair[1]))?;
        }
        Ok(entries)
    }

    /// Names of the tools.
    #[getter]
    fn tools(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.world.with(py, |world| {
            let tools = world.body().model().tools();
            let tools = tools.iter().flat_map(|tools| tools.tools());
            Ok(tools.map(|tool| tool.name.clone()).collect())
        })
    }

    /// Names of the loads.
    #[getter]
    fn loads(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.world
            .with(py, |world| Ok(world.scene().body().load_names()))
    }

    /// The tool of a name. KeyError lists the existing names.
    fn tool(slf: &Bound<'_, Self>, name: &str) -> PyResult<Tool> {
        let id = slf
            .get()
            .world
            .with(slf.py(), |world| world.tool(name).map_err(of_command))?;
        Ok(Tool {
            world: Arc::clone(&slf.get().world),
            id,
            name: name.to_owned(),
        })
    }

    /// The load of a name: that of the scene, "load 2" for the second if it has none, or "gravity". KeyError lists the
    /// existing names.
    fn load(slf: &Bound<'_, Self>, name: &str) -> PyResult<Load> {
        let id = slf
            .get()
            .world
            .with(slf.py(), |world| world.load(name).map_err(of_command))?;
        Ok(Load {
            world: Arc::clone(&slf.get().world),
            id,
            name: name.to_owned(),
        })
    }

    /// Forces (N) on nodes from the next step on, in addition to all loads; they replace those of the last call: nodes
    /// (k,), forces (k, 3), or (3,) for each. force([], []) ends them.
    fn force(
        &self,
        py: Python<'_>,
        nodes: &Bound<'_, PyAny>,
        forces: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let count = self.world.with(py, |world| Ok(nodes_of(world)))?;
        let nodes = indices(nodes, "nodes", ("node", count))?;
        let forces = match vector(forces, "forces", "N") {
            Ok(same) => vec![same; nodes.len()],
            Err(_) if nodes.is_empty() => Vec::new(),
            Err(_) => rows_of::<3>(forces, "forces", "N")?,
        };
        if forces.len() != nodes.len() {
            return Err(value_error(format!(
                "forces: expected a row for each of {} nodes, got {}",
                nodes.len(),
                forces.len()
            )));
        }
        let all = nodes.into_iter().zip(forces).collect();
        self.world.command(py, Command::Forces(all))
    }

    /// Continues with another method, and another step (s) if dt is given. Options are those of the scene reference.
    #[pyo3(signature = (integrator, dt = None, **options_of_it))]
    fn switch(
        &self,
        py: Python<'_>,
        integrator: String,
        dt: Option<f64>,
        options_of_it: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let options: Options = options(options_of_it)?;
        self.world.work(py, |world| {
            let saved = dt.map(|_| world.save());
            let method = Command::Integrator {
                id: integrator,
                options,
            };
            let step = dt.map(Command::Dt);
            let switched = world.command(method.clone());
            let switched =
                switched.and_then(|()| step.clone().map_or(Ok(()), |step| world.command(step)));
            let Err(error) = switched else {
                return Ok(());
            };
            // A method may be stable with its own step alone.
            if let (Some(saved), Some(step)) = (&saved, step) {
                let back = |world: &mut World| {
                    let restored = world.restore(saved);
                    restored.map_err(|error| PyRuntimeError::new_err(error.to_string()))
                };
                back(world)?;
                let other_way = world.command(step).and_then(|()| world.command(method));
                if other_way.is_ok() {
                    return Ok(());
                }
                back(world)?;
            }
            Err(of_command(error))
        })
    }

    /// Cuts by the sheet that a blade sweeps from one position to another: its two ends (m) before and after, (2, 3) each.
    /// The scene needs a table [cutting].
    fn cut(
        &self,
        py: Python<'_>,
        before: &Bound<'_, PyAny>,
        after: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let ends = |value: &Bound<'_, PyAny>, name: &str| {
            let rows = rows_of::<3>(value, name, "m")?;
            <[[f64; 3]; 2]>::try_from(rows).map_err(|rows| {
                value_error(format!(
                    "{name}: expected the two ends of the blade (m), shape (2, 3), got ({}, 3)",
                    rows.len()
                ))
            })
        };
        let (from, to) = (ends(before, "before")?, ends(after, "after")?);
        self.world.command(py, Command::Cut { from, to })
    }

    /// The full state of the motion, as bytes: the same on every machine.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.world.work(py, |world| {
            let bytes = world.save().to_bytes();
            bytes.map_err(|error| PyRuntimeError::new_err(error.to_string()))
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Continues from the result of save() of a session of the same scene, with the same bits. ValueError for other
    /// bytes; the session is then unchanged.
    fn restore(&self, py: Python<'_>, saved: &Bound<'_, PyAny>) -> PyResult<()> {
        let bytes = saved.cast::<PyBytes>().map_err(|_| {
            value_error(format!(
                "saved: expected the bytes of save(), got {}",
                crate::arrays::described(saved)
            ))
        })?;
        let bytes = bytes.as_bytes();
        self.world.work(py, |world| {
            let saved = Saved::from_bytes(bytes);
            let saved = saved.map_err(|error| value_error(format!("saved: {error}")))?;
            let restored = world.restore(&saved);
            restored.map_err(|error| value_error(format!("saved: {error}")))
        })
    }

    /// Begins again: the motion from here on has the bits of a new session, and log is empty.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.world.work(py, |world| {
            let restored = world.restore(&self.begun);
            restored.map_err(|error| PyRuntimeError::new_err(error.to_string()))
        })
    }

    /// The log of the session so far, as text: scene.replay(log) repeats it bit for bit.
    #[getter]
    fn log(&self, py: Python<'_>) -> PyResult<String> {
        self.world.with(py, |world| Ok(world.log().to_text()))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        self.world.with(py, |world| {
            Ok(format!(
                "Session(t={} s, {} steps, {} with dt={} s)",
                world.t(),
                world.steps(),
                world.integrator().id(),
                world.dt()
            ))
        })
    }
}
