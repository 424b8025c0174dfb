//! The spatial error of a scene, estimated by the same scene on refined meshes, and its error in time.
//!
//! On each mesh the motion is solved twice: by the scene's method in its step, and with no or little error in time (the
//! reference, or half the step if the reference costs too much). The second solutions differ between meshes only by
//! errors in space, which [`richardson`] extrapolates; each differs from the first on its mesh by the error in time.

mod caveats;
mod error;
mod level;
mod observed;
mod prediction;
mod quantity;
mod richardson;
mod sizes;
mod step;
#[cfg(test)]
mod tests;

pub use caveats::Caveat;
pub use error::ConvergeError;
pub use level::Level;
pub use prediction::{LevelPrediction, Prediction, TimeCheck, predict};
pub use quantity::{Quantity, Subject, When};
pub use richardson::{Estimate, richardson};

use serde::{Deserialize, Serialize};
use sinew_core::vectors::norm;
use sinew_scene::Simulation;

use level::Solved;
use observed::{Observed, Places};

/// Smallest and largest number of meshes: the scene's, and its refinements.
pub const LEVELS: std::ops::RangeInclusive<usize> = 2..=4;

/// A scene on its mesh and on refined ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Convergence {
    /// The meshes, the scene's first, and the cost of the runs on them.
    pub levels: Vec<Level>,
    /// Method for errors in time.
    pub time_check: TimeCheck,
    /// Displacements, probes, forces on tools and energies.
    pub quantities: Vec<Quantity>,
    /// Errors that the estimates do not cover.
    pub caveats: Vec<Caveat>,
}

/// Runs a scene on its mesh and on refined ones, as [`predict`] states.
///
/// # Errors
/// [`ConvergeError`].
pub fn converge(
    simulation: &Simulation,
    prediction: &Prediction,
) -> Result<Convergence, ConvergeError> {
    let places = Places::of(simulation)?;
    let mut caveats = caveats::of_scene(simulation, prediction.levels.len());
    let mut solved: Vec<Solved> = Vec::new();
    let mut hits = Vec::new();
    let mut refined: Option<Simulation> = None;
    for number in 0..prediction.levels.len() {
        if number > 0 {
            refined = Some(refined.as_ref().unwrap_or(simulation).refined()?);
        }
        let here = refined.as_ref().unwrap_or(simulation);
        hits.push(caveats::hits(here));
        let ends_at_rest = solved.first().is_none_or(|first| first.rest.is_some());
        solved.push(level::solve(
            here,
            prediction,
            number,
            &places,
            ends_at_rest,
        )?);
    }
    let quantities = quantities(&places, &solved);
    caveats.extend(caveats::of_places(&hits));
    caveats.extend(places.outside());
    caveats.extend(caveats::of_estimates(&quantities));
    Ok(Convergence {
        levels: solved.into_iter().map(|solved| solved.level).collect(),
        time_check: prediction.time_check,
        quantities,
        caveats,
    })
}

/// Everything that was observed on all meshes.
fn quantities(places: &Places, solved: &[Solved]) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    let rests: Option<Vec<&Observed>> = solved.iter().map(|level| level.rest.as_ref()).collect();
    for (subject, of) in places.subjects() {
        let compared: Vec<&[f64]> = solved.iter().map(|level| of(&level.compared)).collect();
        let Some(finest) = compared.last() else {
            continue;
        };
        let size = norm(finest);
        let over = |difference: f64| share(difference, size);
        let in_time = solved.iter().map(|level| {
            let run = level.run.as_ref()?;
            Some(over(
                level.halving.error * distance(of(run), of(&level.compared)),
            ))
        });
        let left = solved.iter().map(|level| {
            let run = level.run.as_ref();
            let difference = run.map(|run| distance(of(run), of(&level.compared)));
            over(level.halving.left * difference.unwrap_or(0.0))
        });
        quantities.push(Quantity {
            errors_in_time: in_time.collect(),
            left_in_time: left.fold(0.0, f64::max),
            estimate: richardson(&differences(&compared, size)),
            size: root_mean_square(finest, subject == Subject::ElasticEnergy),
            subject: subject.clone(),
            when: When::Run,
        });
        if let Some(rests) = &rests {
            let rests: Vec<&[f64]> = rests.iter().map(|rest| of(rest)).collect();
            let Some(finest) = rests.last() else {
                continue;
            };
            let size = norm(finest);
            quantities.push(Quantity {
                errors_in_time: vec![None; solved.len()],
                left_in_time: 0.0,
                estimate: richardson(&differences(&rests, size)),
                size: root_mean_square(finest, subject == Subject::ElasticEnergy),
                subject,
                when: When::Rest,
            });
        }
    }
    quantities
}

/// The differences between neighbouring meshes over a size (fraction).
fn differences(levels: &[&[f64]], size: f64) -> Vec<f64> {
    let pairs = levels.windows(2);
    let pairs = pairs.map(|pair| share(distance(pair[0], pair[1]), size));
    pairs.collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&difference)
}

/// A difference over a size; 0 if nothing differs.
fn share(difference: f64, size: f64) -> f64 {
    match difference == 0.0 {
        true => 0.0,
        false => difference / size,
    }
}

/// The root mean square of numbers, or of the lengths of vectors.
fn root_mean_square(values: &[f64], are_numbers: bool) -> f64 {
    let entries = values.len() / if are_numbers { 1 } else { 3 };
    norm(values) / (entries.max(1) as f64).sqrt()
}
