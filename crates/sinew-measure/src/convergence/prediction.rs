//! Prediction of the cost of an estimate of the error in space, before it begins.

use std::time::Instant;

use serde::{Deserialize, Serialize};
use sinew_core::spectrum::Spectrum;
use sinew_scene::{RefinementError, Simulation};

use super::error::ConvergeError;
use super::sizes::Sizes;
use super::step::{parts, stable_step};
use crate::forecast::Forecast;

/// Methods to find errors in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TimeCheck {
    /// Comparison with a reference solution, whose own error is below 1e-6.
    Reference,
    /// Comparison with the same run with half the step.
    HalfStep,
}

/// Counts of an estimate, for every mesh, and the time it will take.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// The meshes, the scene's first.
    pub levels: Vec<LevelPrediction>,
    /// Method by which errors in time will be computed.
    pub time_check: TimeCheck,
    /// Time (s) by this computer's clock, from a few steps and products on the scene's mesh.
    pub seconds: f64,
    /// The scene's step (s) and the number of its steps.
    #[serde(skip)]
    pub(super) dt: f64,
    #[serde(skip)]
    pub(super) steps: usize,
    /// Steps from one compared instant to the next.
    #[serde(skip)]
    pub(super) stride: usize,
}

/// Counts on one mesh; on refined meshes, the expected ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelPrediction {
    /// Nodes.
    pub nodes: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Stored blocks of the stiffness matrix.
    pub blocks: usize,
    /// Steps of the scene's method, half steps included.
    pub steps: usize,
    /// Sweeps of these steps and of the reference.
    pub sweeps: f64,
    /// Memory (bytes) of matrices and compared motions.
    pub bytes: usize,
}

/// Largest number of compared instants.
const INSTANTS: usize = 50;

/// Sweeps of a reference by Faber series for each radian of the fastest motion, its check included.
const REFERENCE_SWEEPS: f64 = 3.0;

/// Number of multiplied blocks up to which a reference is used, some ten seconds; beyond it, a reference is used only
/// if half steps multiply at least as many.
const REFERENCE_BLOCKS: f64 = 5e9;

/// Time of a sweep of the reference over that of a product.
const SERIES: f64 = 2.0;

/// Growth factors of a factor's entries, and of its operations, when the edges of a mesh are halved: the 4/3rd power
/// and the square of the number of unknowns (George, SIAM J. Numer. Anal. 10, 1973, for bodies).
const FACTOR_ENTRIES: f64 = 16.0;
const FACTOR_OPERATIONS: f64 = 64.0;

/// Predicts [`converge`](super::converge) on `levels` meshes, without building the refined ones.
///
/// # Errors
/// [`ConvergeError`] for an oscillator, and if the scene's method does not run.
pub fn predict(simulation: &Simulation, levels: usize) -> Result<Prediction, ConvergeError> {
    let body = simulation.model().body();
    let body = body.ok_or(RefinementError::NoMesh)?;
    if simulation.is_cut() {
        return Err(ConvergeError::Cut);
    }
    let system = simulation.system();
    let steps = simulation.run().steps.max(1);
    let dt = simulation.settings().duration / steps as f64;
    let mut integrator = simulation.integrator()?;
    let forecast = Forecast::of(simulation, &mut *integrator)?;
    drop(integrator);
    let stable = stable_step(simulation);
    let linear = system.as_linear();
    let spectrum = linear.map(|linear| Spectrum::of(linear.operators()));
    let blocks = linear.map(|linear| linear.operators().stiffness().pattern().blocks());
    let product = product_seconds(simulation);
    let sizes: Vec<Sizes> =
        std::iter::successors(Some(Sizes::of(body)), |sizes| Some(sizes.refined()))
            .take(levels)
            .collect();
    let own = sizes[0];
    let built = blocks.unwrap_or(own.blocks());
    // Fixed nodes are in no matrix.
    let share_of = |count: usize, own: usize, of: usize| {
        (count as f64 * own as f64 / of.max(1) as f64).round() as usize
    };
    let cut = |level: usize| {
        let stable = stable.map(|stable| stable / f64::from(1_u32 << level));
        if level == 0 { 1 } else { parts(dt, stable) }
    };
    let reference = |level: usize| {
        spectrum.map_or(0.0, |spectrum| {
            let finer = f64::from(1_u32 << level);
            let fastest = finer * spectrum.omega_max + finer * finer * spectrum.damping_max;
            REFERENCE_SWEEPS * fastest * simulation.settings().duration
        })
    };
    let level_blocks = |level: usize| share_of(sizes[level].blocks(), built, own.blocks());
    let work = |sweeps: &dyn Fn(usize) -> f64| -> f64 {
        let works = (0..levels).map(|level| sweeps(level) * level_blocks(level) as f64);
        works.sum()
    };
    let solves = forecast.solves_per_step > 0.0;
    let run_sweeps = |level: usize| forecast.sweeps_per_step * (cut(level) * steps) as f64;
    let affordable = match solves {
        true => REFERENCE_BLOCKS,
        false => REFERENCE_BLOCKS.max(2.0 * work(&run_sweeps)),
    };
    let time_check = match linear.is_some() && work(&reference) <= affordable {
        true => TimeCheck::Reference,
        false => TimeCheck::HalfStep,
    };
    let mut seconds = 0.0;
    let levels = (0..levels).map(|level| {
        let growth = f64::from(8_u32.pow(level as u32));
        let power = |factor: f64| factor.powi(level as i32);
        let (of_setup, of_step) = match solves {
            true => (power(FACTOR_OPERATIONS), power(FACTOR_ENTRIES)),
            false => (growth, growth),
        };
        let runs = match time_check {
            TimeCheck::Reference => 1,
            // One run and one of twice the steps.
            TimeCheck::HalfStep => 3,
        };
        let steps = runs * cut(level) * steps;
        let sweeps = forecast.sweeps_per_step * steps as f64;
        let reference = match time_check {
            TimeCheck::Reference => reference(level),
            TimeCheck::HalfStep => 0.0,
        };
        seconds += of_setup * forecast.setup_s
            + of_step * forecast.step_s * steps as f64
            + SERIES * reference * product * growth;
        let dofs = share_of(3 * sizes[level].nodes, system.dofs(), 3 * own.nodes);
        let blocks = level_blocks(level);
        LevelPrediction {
            nodes: sizes[level].nodes,
            tets: sizes[level].tets,
            dofs,
            blocks,
            steps,
            sweeps: sweeps + reference,
            // The matrix is kept as it was assembled and as the machine reads it.
            bytes: blocks * 2 * 76 + INSTANTS * dofs * size_of::<f64>(),
        }
    });
    let levels = levels.collect();
    Ok(Prediction {
        levels,
        time_check,
        seconds,
        dt,
        steps,
        stride: steps.div_ceil(INSTANTS),
    })
}

impl Prediction {
    /// The instants (s) that are compared.
    pub(super) fn instants(&self) -> Vec<f64> {
        let steps = (1..)
            .map(|instant| instant * self.stride)
            .take_while(|step| *step < self.steps);
        let steps = steps.chain([self.steps]);
        steps.map(|step| step as f64 * self.dt).collect()
    }
}

/// Time (s) of a product with the stiffness matrix; 0 without one.
fn product_seconds(simulation: &Simulation) -> f64 {
    const REPEATS: u32 = 3;
    let Some(linear) = simulation.system().as_linear() else {
        return 0.0;
    };
    let stiffness = linear.operators().stiffness();
    let x = vec![1.0; stiffness.dofs()];
    let mut out = x.clone();
    stiffness.multiply(&x, &mut out);
    let begun = Instant::now();
    for _ in 0..REPEATS {
        stiffness.multiply(&x, &mut out);
    }
    begun.elapsed().as_secs_f64() / f64::from(REPEATS)
}
