//! Clamping the vectors of cells.

use sinew_core::{Acceleration, State, System};

/// A vector this much (relative) above its limit still counts as within: clamping rounds.
const ROUNDING: f64 = 1e-9;

/// A step's beginning, and how many components a cell has.
#[derive(Debug, Default)]
pub(super) struct Clamp {
    layers: usize,
    u: Vec<f64>,
    v: Vec<f64>,
    under_way: bool,
}

impl Clamp {
    pub(super) fn prepare(&mut self, system: &dyn System) {
        self.layers = system.layers().count();
        self.u.resize(system.dofs(), 0.0);
        self.v.resize(system.dofs(), 0.0);
    }

    /// Keeps what the step of `dt` (s) to come is measured by.
    pub(super) fn remember(&mut self, state: &State, dt: f64) {
        self.u.copy_from_slice(&state.u);
        self.under_way = state.is_staggered_by(dt);
    }

    /// Bounds each cell's velocity by its limit (m/s) and its displacement since the beginning by
    /// limit times `dt`; returns the degrees of freedom of the cells clamped.
    pub(super) fn apply(&mut self, limits: &[f64], state: &mut State, dt: f64) -> u64 {
        self.v.copy_from_slice(&state.v);
        let cells = state
            .u
            .chunks_exact_mut(self.layers)
            .zip(state.v.chunks_exact_mut(self.layers))
            .zip(self.u.chunks_exact(self.layers));
        let mut clamped = 0;
        for (((u, v), before), limit) in cells.zip(limits) {
            let slower = excess(v.iter().copied(), *limit);
            let nearer = excess(u.iter().zip(before).map(|(u, b)| u - b), limit * dt);
            if let Some(share) = slower {
                v.iter_mut().for_each(|v| *v *= share);
            }
            if let Some(share) = nearer {
                for (u, before) in u.iter_mut().zip(before) {
                    *u = before + (*u - before) * share;
                }
            }
            if slower.is_some() || nearer.is_some() {
                clamped += self.layers;
            }
        }
        if clamped > 0 {
            self.correct_acceleration(state, dt);
        }
        clamped as u64
    }

    /// A staggered method may keep the acceleration that led to its velocity
    /// ([`State::velocity_at_t`] asks for it): what the clamp took from the velocity it takes from
    /// this too, by the time between the step's two velocities.
    fn correct_acceleration(&self, state: &mut State, dt: f64) {
        if state.acceleration != Acceleration::Kick {
            return;
        }
        let time = if self.under_way { dt } else { dt / 2.0 };
        for ((a, v), unclamped) in state.a.iter_mut().zip(&state.v).zip(&self.v) {
            if v != unclamped {
                *a += (v - unclamped) / time;
            }
        }
    }
}

/// The factor that brings a vector's length to the limit; `None` where it is within, or no number.
fn excess(vector: impl Iterator<Item = f64> + Clone, limit: f64) -> Option<f64> {
    let square: f64 = vector.clone().map(|x| x * x).sum();
    let allowed = limit * (1.0 + ROUNDING);
    if square <= allowed * allowed {
        return None;
    }
    // Squares may overflow where lengths do not.
    let largest = vector.clone().fold(0.0, |max: f64, x| x.abs().max(max));
    let length = largest * vector.map(|x| (x / largest).powi(2)).sum::<f64>().sqrt();
    (length > allowed).then(|| limit / length)
}
