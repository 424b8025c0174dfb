//! Whole runs of a scene into a folder.

use std::io;
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use sinew_core::OptionValue;
use sinew_record::{Request, RunFolder};
use sinew_scene::{Scene, Simulation, Warning, WarningKind};
use sinew_world::World;
use tempfile::TempDir;

use crate::errors::{of_run, of_scene, of_world, scene_error, value_error};
use crate::watch::Onlooker;

/// Changes to `[output]` for a run of which only tables are needed.
const TABLES_ALONE: [&str; 2] = [
    "output.fields={ frames = 1 }",
    "output.checkpoint={ every = 1e9 }",
];

/// Degrees of freedom from which on rows of energy come with frames, unless a scene says otherwise.
const LARGE: usize = 30_000;

/// Memory as a file system of Linux: results are safe there without waiting for a disk, which a temporary folder does
/// not need.
const MEMORY: &str = "/dev/shm";

/// A folder that is removed after use.
pub(crate) fn scratch() -> io::Result<TempDir> {
    tempfile::tempdir_in(MEMORY).or_else(|_| tempfile::tempdir())
}

/// A requested run.
pub(crate) struct Asked {
    pub(crate) threads: Option<OptionValue>,
    pub(crate) again: bool,
    /// False if the folder is read and deleted.
    pub(crate) keeps_fields: bool,
}

/// A number of threads, or "auto".
pub(crate) fn threads(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<OptionValue>> {
    let Some(value) = value else {
        return Ok(None);
    };
    let wrong = || value_error("threads: expected a whole number from 1 on, \"auto\" or None");
    if let Ok(text) = value.extract::<String>() {
        let is_auto = text == "auto";
        return is_auto
            .then_some(Some(OptionValue::Text(text)))
            .ok_or_else(wrong);
    }
    let count = value.extract::<u32>().map_err(|_| wrong())?;
    match count {
        0 => Err(wrong()),
        count => Ok(Some(OptionValue::Number(f64::from(count)))),
    }
}

/// A scene with the integrator of its run, in motion.
pub(crate) fn following(
    mut simulation: Simulation,
    threads: Option<&OptionValue>,
) -> PyResult<World> {
    if let Some(refused) = simulation.refused_load() {
        return Err(scene_error(&refused));
    }
    simulation.end_at_duration();
    let id = &simulation.settings().integrator;
    let options = sinew_integrators::with_threads(id, &simulation.options(), threads);
    let integrator = sinew_integrators::build(id, &options).map_err(|error| scene_error(&error))?;
    let mut world = World::following(simulation, integrator).map_err(of_world)?;
    world.set_up().map_err(|error| of_scene(&error))?;
    Ok(world)
}

/// Runs a scene into a folder; returns the warnings about the scene.
pub(crate) fn into_folder(
    scene: &Scene,
    folder: &Path,
    asked: &Asked,
    onlooker: &mut Onlooker,
) -> PyResult<Vec<Warning>> {
    let scene = match asked.keeps_fields {
        true => scene.clone(),
        false => with_tables_alone(scene)?,
    };
    let simulation = scene.build().map_err(|error| of_scene(&error))?;
    let mut warnings = simulation.warnings();
    warnings.retain(|warning| warning.kind != WarningKind::NoProbe);
    let request = Request {
        threads: asked.threads.as_ref().map(|threads| match threads {
            OptionValue::Number(count) => count.to_string(),
            _ => "auto".to_owned(),
        }),
        warnings: warnings.iter().map(ToString::to_string).collect(),
        values: Vec::new(),
        again: asked.again,
    };
    let mut world = following(simulation, asked.threads.as_ref())?;
    let folder = RunFolder::create(folder, world.scene(), &request).map_err(of_run)?;
    folder.run(&mut world, onlooker).map_err(of_run)?;
    Ok(warnings)
}

fn with_tables_alone(scene: &Scene) -> PyResult<Scene> {
    let mut values: Vec<String> = TABLES_ALONE.map(str::to_owned).to_vec();
    if scene.output().energy.is_none() {
        let meshed = scene
            .clone()
            .read_mesh()
            .map_err(|error| of_scene(&error))?;
        let nodes = meshed.mesh().map_or(0, |mesh| mesh.points.len());
        if 3 * nodes > LARGE {
            let frames = match scene.output().fields {
                sinew_scene::Instants::Every(every) => format!("{{ every = {every:?} }}"),
                sinew_scene::Instants::Frames(frames) => format!("{{ frames = {frames} }}"),
            };
            values.push(format!("output.energy={frames}"));
        }
    }
    Scene::parse_with(scene.source(), &values).map_err(|error| of_scene(&error))
}

/// The folder that a caller named.
pub(crate) fn named(out: Option<&Bound<'_, PyAny>>) -> PyResult<Option<PathBuf>> {
    let Some(out) = out else {
        return Ok(None);
    };
    let path = out.extract::<PathBuf>();
    let path = path.map_err(|_| value_error("out: expected the path of a folder, or None"))?;
    Ok(Some(path))
}
