//! Independence of a scene's motion from its unit of length.

use std::path::PathBuf;

use sinew_core::{OptionValue, Run};
use sinew_integrators::explicit::GuardOption;
use sinew_measure::MethodChoice;
use sinew_scene::{Scene, Simulation};

use super::{at, largest_difference, trajectory};
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::block;
use crate::hard::pairs::in_units;
use crate::report::three;
use crate::results::Mark;
use sinew_verify::LabError;

/// Number of millimetres and of micrometres in a metre.
const UNITS: [f64; 2] = [1e3, 1e6];

/// Largest number of compared steps.
const MOST_STEPS: usize = 200;

/// The largest difference between the motion of a scene in metres and in other units, over the largest displacement:
/// for every scene in these folders with its own method and step. A method that saturates amplifies rounding errors, so
/// that its scenes use the stabilised network.
pub(crate) fn check(asked: Asked, folders: &[PathBuf]) -> Result<Mark, LabError> {
    let mut worst = Worst::default();
    let mut names = Vec::new();
    let mut saturating = Vec::new();
    for path in scenes(folders)? {
        let scene = Scene::load(&path)?;
        let simulation = scene.build()?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let settings = simulation.settings();
        let own = MethodChoice {
            integrator: settings.integrator.clone(),
            options: settings.options.clone(),
        };
        let dt = simulation.dt();
        let mut method = own.clone();
        let entry = sinew_integrators::entry(&own.integrator);
        if entry.is_some_and(|entry| entry.guard == GuardOption::OwnOrAuto) {
            let difference = difference(&simulation, &own, dt, UNITS[0])?;
            saturating.push(format!("{name} {}", three(difference)));
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
    if !saturating.is_empty() {
        let saturating = saturating.join(", ");
        note.push_str(&format!(
            "; in scenes of a network that saturates, which lets rounding grow, its own difference \
             is: {saturating}"
        ));
    }
    Ok(asked.measured(worst.figure, three, worst.by).noting(note))
}

/// The scenes in the folders, sorted.
fn scenes(folders: &[PathBuf]) -> Result<Vec<PathBuf>, LabError> {
    let mut paths = Vec::new();
    for folder in folders {
        let unreadable = |source| LabError::new(format!("{}: {source}", folder.display()));
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
    method: &MethodChoice,
    dt: f64,
    per_metre: f64,
) -> Result<f64, LabError> {
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

/// The method with its saturation voltage, a velocity, in other units.
fn scaled(method: &MethodChoice, per_metre: f64) -> MethodChoice {
    let mut method = method.clone();
    if let Some(OptionValue::Number(voltage)) = method.options.get(GuardOption::KEY) {
        let voltage = voltage * per_metre;
        method
            .options
            .insert(GuardOption::KEY, OptionValue::Number(voltage));
    }
    method
}
