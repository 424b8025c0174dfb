//! A scene moves alike whatever its unit of length.

use std::path::PathBuf;

use sinew_core::{OptionValue, Run};
use sinew_measure::Method;
use sinew_scene::{Scene, Simulation};

use super::{at, largest_difference, trajectory};
use crate::hard::mark::{Asked, Mark, Worst};
use crate::hard::methods::block;
use crate::hard::pairs::in_units;
use crate::report::three;

/// Millimetres and micrometres a metre.
const UNITS: [f64; 2] = [1e3, 1e6];

/// The paper's network: a saturated one lets rounding grow, so that its scenes are moved by the
/// stabilised one.
const PAPER: &str = "cnn";

/// Most steps that are compared.
const MOST_STEPS: usize = 200;

/// The largest difference between the motion of a scene in metres and in other units, over the
/// largest displacement: of every scene in these folders by its own method, if that is not the
/// paper's, at its own step.
pub(crate) fn check(asked: Asked, folders: &[PathBuf]) -> Result<Mark, String> {
    let mut worst = Worst::default();
    let mut names = Vec::new();
    let mut papers = Vec::new();
    for path in scenes(folders)? {
        let scene = Scene::load(&path).map_err(|error| error.to_string())?;
        let simulation = scene.build().map_err(|error| error.to_string())?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let settings = simulation.settings();
        let own = Method {
            integrator: settings.integrator.clone(),
            options: settings.options.clone(),
        };
        let dt = simulation.dt();
        let mut method = own.clone();
        if own.integrator == PAPER {
            let difference = difference(&simulation, &own, dt, UNITS[0])?;
            papers.push(format!("{name} {}", three(difference)));
            method = block();
        }
        for per_metre in UNITS {
            let difference = difference(&simulation, &method, dt, per_metre)?;
            worst.include(difference, format!("{name}: {}", at(&method.label(), dt)));
        }
        names.push(name.into_owned());
    }
    let (count, names) = (names.len(), names.join(", "));
    let mut note = format!("largest of {count} scenes in mm and um: {names}");
    if !papers.is_empty() {
        let papers = papers.join(", ");
        note.push_str(&format!(
            "; the paper's network, beyond its stable step in its own scenes, lets rounding grow \
             there: {papers}"
        ));
    }
    Ok(asked.measured(worst.figure, three, worst.by).noting(note))
}

/// The scenes in the folders, sorted.
fn scenes(folders: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    let mut paths = Vec::new();
    for folder in folders {
        let unreadable = |error: std::io::Error| format!("{}: {error}", folder.display());
        for entry in std::fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if path
                .extension()
                .is_some_and(|extension| extension == "toml")
            {
                paths.push(path);
            }
        }
    }
    paths.sort();
    Ok(paths)
}

fn difference(
    simulation: &Simulation,
    method: &Method,
    dt: f64,
    per_metre: f64,
) -> Result<f64, String> {
    let duration = simulation.settings().duration;
    let steps = Run::covering(duration, dt).steps.min(MOST_STEPS);
    let (system, start) = (simulation.system(), simulation.initial_state());
    let metres = trajectory(system, start, method, dt, steps)?;
    let twin = in_units(simulation, per_metre)?;
    let method = scaled(method, per_metre);
    let mut path = trajectory(&*twin.system, &twin.start, &method, dt, steps)?;
    path.iter_mut().flatten().for_each(|u| *u /= per_metre);
    Ok(largest_difference(&path, &metres))
}

/// A saturation voltage is a velocity.
fn scaled(method: &Method, per_metre: f64) -> Method {
    const SATURATION: &str = "saturation";
    let mut method = method.clone();
    if let Some(OptionValue::Number(voltage)) = method.options.get(SATURATION) {
        let voltage = voltage * per_metre;
        method
            .options
            .insert(SATURATION, OptionValue::Number(voltage));
    }
    method
}
