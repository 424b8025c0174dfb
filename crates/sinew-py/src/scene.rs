//! Scenes.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyType};
use pythonize::pythonize;
use sinew::cli::memory_of;
use sinew_core::StableStep;
use sinew_scene::{SceneSource, Simulation};
use sinew_world::{FollowError, Log, Replay, ReplayError, World};

use crate::errors::{of_advance, of_scene, of_world, scene_error, value_error};
use crate::guard::guarded;
use crate::matrices::{Matrices, Numbers};
use crate::mesh::Mesh;
use crate::plan;
use crate::run::{self, Asked};
use crate::session::Session;
use crate::values::{assignments, from_json, to_toml};
use crate::watch::{Onlooker, Watch};

/// A scene: a body or an oscillator with all that acts on it, and how it is to be run. It does not change.
///
/// Scene.load(path), Scene.parse(text) and Scene.from_dict(values) read one; the keys are those of the scene reference.
/// Scenes pickle with the files that they read.
#[pyclass(frozen, module = "sinew_sim")]
pub(crate) struct Scene {
    scene: sinew_scene::Scene,
    built: OnceLock<Arc<Simulation>>,
}

/// A warning about a scene that runs, but perhaps not as its author intended: kind (str), text (str) and numbers (dict
/// of floats by names that end in their units).
#[pyclass(frozen, get_all, module = "sinew_sim")]
pub(crate) struct Warning {
    kind: String,
    text: String,
    numbers: Py<PyDict>,
}

impl Warning {
    fn of(py: Python<'_>, warning: &sinew_scene::Warning) -> PyResult<Self> {
        let numbers = PyDict::new(py);
        for (name, value) in &warning.numbers {
            numbers.set_item(name, value)?;
        }
        Ok(Self {
            kind: warning.kind.id().to_owned(),
            text: warning.to_string(),
            numbers: numbers.unbind(),
        })
    }
}

#[pymethods]
impl Warning {
    #[new]
    fn new(kind: String, text: String, numbers: Py<PyDict>) -> Self {
        Self {
            kind,
            text,
            numbers,
        }
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        format!("Warning(\"{}\", {:?})", self.kind, self.text)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> (Bound<'py, PyType>, (String, String, Py<PyDict>)) {
        let own = slf.get();
        let numbers = own.numbers.clone_ref(slf.py());
        (
            slf.get_type(),
            (own.kind.clone(), own.text.clone(), numbers),
        )
    }
}

impl From<sinew_scene::Scene> for Scene {
    fn from(scene: sinew_scene::Scene) -> Self {
        Self {
            scene,
            built: OnceLock::new(),
        }
    }
}

/// A source with the mesh in memory of which it is made, if there is one.
fn with_mesh(
    py: Python<'_>,
    source: SceneSource,
    mesh: Option<&Py<Mesh>>,
) -> PyResult<SceneSource> {
    let Some(mesh) = mesh.map(Py::get) else {
        return Ok(source);
    };
    let values = py.import("sinew_sim._values")?;
    let name: PathBuf = values.getattr("MESH_NAME")?.extract()?;
    let path = source.resolve(&name);
    Ok(source.with_mesh(path, Arc::clone(&mesh.mesh), mesh.content()))
}

/// The world at the end of a log.
fn repeated(scene: sinew_scene::Scene, log: Log) -> PyResult<World> {
    let mut replay = Replay::new(scene, log).map_err(|error| match error {
        ReplayError::World(error) => of_world(error),
        other => value_error(format!("log: {other}")),
    })?;
    let mut watch = Watch::new();
    let mut shown = replay.world().show(&mut watch);
    let ended = replay.advance(&mut shown);
    drop(shown);
    let t = replay.world().t();
    ended.map_err(|error| match error {
        FollowError::Record(error) => of_advance(error.into(), t),
        other => value_error(format!("log: {other}")),
    })?;
    match watch.raised {
        Some(raised) => Err(raised),
        None => Ok(replay.into_world()),
    }
}

/// Parses a source with values to set in it.
fn parsed(source: &SceneSource, values: &[String]) -> PyResult<Scene> {
    let scene = sinew_scene::Scene::parse_with(source, values);
    Ok(scene.map_err(|error| of_scene(&error))?.into())
}

impl Scene {
    fn built(&self, py: Python<'_>) -> PyResult<Arc<Simulation>> {
        if let Some(built) = self.built.get() {
            return Ok(Arc::clone(built));
        }
        let scene = self.scene.clone();
        let built = py.detach(|| {
            guarded(|| memory_of(&scene).within(|| scene.build().map_err(|error| of_scene(&error))))
        })?;
        Ok(Arc::clone(self.built.get_or_init(|| Arc::new(built))))
    }

    fn world(&self, py: Python<'_>) -> PyResult<World> {
        let scene = self.scene.clone();
        py.detach(|| guarded(|| memory_of(&scene).within(|| World::new(scene).map_err(of_world))))
    }
}

#[pymethods]
impl Scene {
    /// Reads a scene file. set: values of keys, such as {"region.1.youngs_modulus": 8000.0}, tables of a list by their
    /// numbers from 1 on. SceneError names file and line.
    #[classmethod]
    #[pyo3(signature = (path, *, set = None))]
    fn load(
        _: &Bound<'_, PyType>,
        path: PathBuf,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let scene = sinew_scene::Scene::load_with(path, &assignments(set)?);
        Ok(scene.map_err(|error| of_scene(&error))?.into())
    }

    /// Reads a scene from TOML; paths in it start at folder.
    #[classmethod]
    #[pyo3(signature = (text, *, folder = PathBuf::from("."), set = None))]
    fn parse(
        _: &Bound<'_, PyType>,
        text: String,
        folder: PathBuf,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let source = SceneSource::new(folder.join("scene.toml"), text);
        parsed(&source, &assignments(set)?)
    }

    /// Reads a scene from values by the keys of the scene reference; paths in it start at folder. "mesh", or its "file", may be
    /// a Mesh, a meshio.Mesh or a grid of pyvista. SceneError names the key.
    #[classmethod]
    #[pyo3(signature = (values, *, folder = PathBuf::from("."), set = None))]
    fn from_dict(
        class: &Bound<'_, PyType>,
        values: &Bound<'_, PyAny>,
        folder: PathBuf,
        set: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let helpers = class.py().import("sinew_sim._values")?;
        let apart = helpers.call_method1("scene", (values,))?;
        let (values, mesh): (Bound<'_, PyAny>, Option<Py<Mesh>>) = apart.extract()?;
        let source = SceneSource::from_value(&to_toml(&values)?, &folder);
        let source = source.map_err(|error| of_scene(&error))?;
        let source = with_mesh(class.py(), source, mesh.as_ref())?;
        parsed(&source, &assignments(set)?)
    }

    /// The same scene with other values, as set of load().
    fn with_values(&self, set: &Bound<'_, PyDict>) -> PyResult<Self> {
        parsed(self.scene.source(), &assignments(Some(set))?)
    }

    /// The title; the path of the file if the scene has none.
    #[getter]
    fn title(&self) -> String {
        self.scene.title_or_path().into_owned()
    }

    /// The whole scene as TOML, with the values that were set.
    #[getter]
    fn text(&self) -> &str {
        self.scene.source().text()
    }

    /// The path of the scene's file; paths in the scene start at its folder.
    #[getter]
    fn path(&self) -> &Path {
        self.scene.source().path()
    }

    /// The scene as values, which from_dict() reads.
    fn as_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let values = pythonize(py, &self.scene)?;
        if let Some(mesh) = self.given_mesh(py)? {
            values.get_item("mesh")?.set_item("file", mesh)?;
        }
        Ok(values)
    }

    /// Warnings about the scene: a list of Warning.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<Warning>> {
        let built = self.built(py)?;
        let warnings = py.detach(|| guarded(|| Ok(built.warnings())))?;
        warnings
            .iter()
            .map(|warning| Warning::of(py, warning))
            .collect()
    }

    /// The mesh of the body at rest, with the groups that the scene selects; None for an oscillator.
    #[getter]
    fn mesh(&self, py: Python<'_>) -> PyResult<Option<Mesh>> {
        if let Some(built) = self.built.get() {
            let body = built.model().body();
            return Ok(body.map(|body| Mesh {
                mesh: Arc::clone(&body.mesh),
            }));
        }
        let scene = self.scene.clone();
        py.detach(|| {
            guarded(|| {
                let meshed = scene.read_mesh().map_err(|error| of_scene(&error))?;
                let mesh = meshed.mesh().cloned();
                Ok(mesh.map(|mesh| Mesh {
                    mesh: Arc::new(mesh),
                }))
            })
        })
    }

    /// The scene's plan, with the cheapest method and step whose error is at most tolerance (relative), or the smallest
    /// error for a budget (CPU seconds per simulated second), found by short runs of seconds (CPU). Without both, the
    /// plan alone.
    #[pyo3(signature = (tolerance = None, budget = None, *, seconds = sinew_measure::advice::DEFAULT_PILOT_SECONDS))]
    fn plan<'py>(
        &self,
        py: Python<'py>,
        tolerance: Option<f64>,
        budget: Option<f64>,
        seconds: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let question = plan::question(tolerance, budget, seconds)?;
        let object = plan::planned(py, self.scene.clone(), question)?;
        let object = from_json(py, &object)?;
        py.import("sinew_sim._plan")?
            .call_method1("Plan", (object,))
    }

    /// The largest stable step (s) of the scene's integrator; inf if every step is stable or no limit is known.
    fn stable_step(&self, py: Python<'_>) -> PyResult<f64> {
        let built = self.built(py)?;
        let step =
            py.detach(|| guarded(|| built.stable_step().map_err(|error| scene_error(&error))))?;
        Ok(match step {
            StableStep::UpTo(limit) => limit,
            StableStep::Any | StableStep::Unknown => f64::INFINITY,
        })
    }

    /// M, D, K and F of small motions about rest.
    fn matrices(&self, py: Python<'_>) -> PyResult<Matrices> {
        let built = self.built(py)?;
        let numbers = py.detach(|| guarded(|| Numbers::of(&built)))?;
        numbers.into_python(py)
    }

    /// Runs the scene to its end and returns a Result. out: a folder for fields and tables, as the command writes it;
    /// None keeps only the tables, in memory. progress: a function of time and duration (s) that is called several
    /// times a second and may return False to end the run, or True for a line on standard error. threads: their largest
    /// number, or "auto". again: discards an unfinished run in the folder. KeyboardInterrupt has the result so far as
    /// its attribute result.
    #[pyo3(signature = (out = None, *, progress = None, threads = None, again = false))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        out: Option<&Bound<'py, PyAny>>,
        progress: Option<&Bound<'py, PyAny>>,
        threads: Option<&Bound<'py, PyAny>>,
        again: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let results = py.import("sinew_sim._result")?;
        let named = run::named(out)?;
        let asked = Asked {
            threads: run::threads(threads)?,
            again,
            keeps_fields: named.is_some(),
        };
        let progress = results.call_method1("_progress", (progress,))?;
        let progress = (!progress.is_none()).then(|| progress.unbind());
        let mut onlooker = Onlooker::new(progress, self.scene.settings().duration);
        let scratch = match named {
            Some(_) => None,
            None => Some(run::scratch().map_err(|error| PyOSError::new_err(error.to_string()))?),
        };
        let folder = match (&named, &scratch) {
            (Some(folder), _) => folder.clone(),
            (None, Some(scratch)) => scratch.path().join("run"),
            (None, None) => PathBuf::new(),
        };
        let scene = &self.scene;
        let warnings = py.detach(|| {
            guarded(|| {
                memory_of(scene).within(|| run::into_folder(scene, &folder, &asked, &mut onlooker))
            })
        })?;
        let warnings = warnings.iter().map(|warning| Warning::of(py, warning));
        let warnings: Vec<Warning> = warnings.collect::<PyResult<_>>()?;
        let result = results.call_method1("_of_run", (folder, named.is_some(), warnings))?;
        match onlooker.raised {
            None => Ok(result),
            Some(raised) => {
                raised.value(py).setattr("result", result)?;
                Err(raised)
            }
        }
    }

    /// A session: the scene step by step, with tools, loads, forces and cuts by command.
    fn session(slf: &Bound<'_, Self>) -> PyResult<Session> {
        let world = slf.get().world(slf.py())?;
        Ok(Session::new(world, slf.clone().into_any().unbind()))
    }

    /// Repeats the session of a log bit for bit, and returns it at its end.
    fn replay(slf: &Bound<'_, Self>, log: String) -> PyResult<Session> {
        let (py, own) = (slf.py(), slf.get());
        let log = Log::parse(Path::new("log"), &log);
        let log = log.map_err(|error| value_error(error.to_string()))?;
        let begun = own.world(py)?.save();
        let scene = own.scene.clone();
        let world = py.detach(|| guarded(|| memory_of(&scene).within(|| repeated(scene, log))))?;
        Ok(Session::begun_at(
            world,
            slf.clone().into_any().unbind(),
            begun,
        ))
    }

    fn __repr__(&self) -> String {
        format!("Scene({:?})", self.title())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (py, own) = (slf.py(), slf.get());
        let source = own.scene.source();
        let files = PyDict::new(py);
        for path in own.scene.input_files().into_iter().skip(1) {
            if source.given_mesh(&path).is_none() {
                let content = source
                    .read(&path)
                    .map_err(|error| PyOSError::new_err(format!("{}: {error}", path.display())))?;
                files.set_item(&path, PyBytes::new(py, &content))?;
            }
        }
        let parts = (
            source.path(),
            source.text(),
            source.is_of_values(),
            files,
            own.given_mesh(py)?,
        );
        let again = slf.get_type().getattr("_unpickled")?;
        Ok((again, parts.into_pyobject(py)?.into_any()))
    }

    #[staticmethod]
    fn _unpickled(
        path: PathBuf,
        text: String,
        is_of_values: bool,
        files: &Bound<'_, PyDict>,
        mesh: Option<Py<Mesh>>,
    ) -> PyResult<Self> {
        let mut source = match is_of_values {
            true => SceneSource::of_values(path, text),
            false => SceneSource::new(path, text),
        };
        for (path, content) in files {
            let content: Vec<u8> = content.extract()?;
            source = source.with_file(path.extract::<PathBuf>()?, content);
        }
        let source = with_mesh(files.py(), source, mesh.as_ref())?;
        parsed(&source, &[])
    }
}

impl Scene {
    /// The mesh in memory of which the scene was made.
    fn given_mesh<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, Mesh>>> {
        let source = self.scene.source();
        let paths = self.scene.input_files();
        let mesh = paths.iter().find_map(|path| source.given_mesh(path));
        let mesh = mesh.map(|mesh| {
            Bound::new(
                py,
                Mesh {
                    mesh: Arc::clone(mesh),
                },
            )
        });
        mesh.transpose()
    }
}
