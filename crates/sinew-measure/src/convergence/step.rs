//! The step of the scene's method on a refined mesh.

use sinew_core::StableStep;
use sinew_scene::Simulation;

/// Largest share of the stable step on refined meshes: at the stable step itself a fastest mode of leapfrog methods
/// grows.
const WITHIN_STABLE: f64 = 0.9;

/// Number of parts into which the scene's step is divided on a refined mesh to be stable.
pub(super) fn parts(dt: f64, stable_step: Option<f64>) -> usize {
    match stable_step {
        Some(limit) if limit > 0.0 && dt > limit => (dt / (WITHIN_STABLE * limit)).ceil() as usize,
        _ => 1,
    }
}

/// The largest stable step (s) of the scene's integrator, if it exists and is known.
pub(super) fn stable_step(simulation: &Simulation) -> Option<f64> {
    match simulation.stable_step() {
        Ok(StableStep::UpTo(limit)) => Some(limit),
        _ => None,
    }
}
