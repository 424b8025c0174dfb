//! Clamping the velocity vectors of cells.

use std::sync::Arc;

use crate::{Acceleration, State};

/// Relative excess over its limit at which a vector still counts as within: clamping rounds.
const ROUNDING: f64 = 1e-9;

/// A guard on the steps of a batch: limits, one for each cell, and the state at the beginning of
/// the step under way.
#[derive(Clone, Debug, Default)]
pub struct Guarding {
    limits: Arc<[f64]>,
    layers: usize,
    u: Vec<f64>,
    v: Vec<f64>,
    under_way: bool,
}

impl Guarding {
    /// Takes these limits (m/s), one for each cell of `layers` degrees of freedom.
    pub fn set(&mut self, limits: Arc<[f64]>, layers: usize) {
        if Arc::ptr_eq(&self.limits, &limits) {
            return;
        }
        let dofs = limits.len() * layers;
        self.limits = limits;
        self.layers = layers;
        self.u.resize(dofs, 0.0);
        self.v.resize(dofs, 0.0);
    }

    /// Limits (m/s), one for each cell.
    #[must_use]
    pub fn limits(&self) -> &Arc<[f64]> {
        &self.limits
    }

    /// Keeps the state from which the coming step of `dt` (s) is measured.
    pub(crate) fn remember(&mut self, state: &State, dt: f64) {
        self.u.copy_from_slice(&state.u);
        self.under_way = state.is_staggered_by(dt);
    }

    /// Bounds each cell's velocity by its limit and its displacement since the beginning by limit
    /// times `dt` (s); returns the degrees of freedom of the cells clamped.
    pub(crate) fn apply(&mut self, state: &mut State, dt: f64, kept: Acceleration) -> u64 {
        self.v.copy_from_slice(&state.v);
        let cells = state
            .u
            .chunks_exact_mut(self.layers)
            .zip(state.v.chunks_exact_mut(self.layers))
            .zip(self.u.chunks_exact(self.layers));
        let mut clamped = 0;
        for (((u, v), before), limit) in cells.zip(self.limits.iter()) {
            let slower = clamp_vector(v, None, *limit);
            let nearer = clamp_vector(u, Some(before), limit * dt);
            if slower || nearer {
                clamped += self.layers;
            }
        }
        if clamped > 0 && kept == Acceleration::Kick {
            self.correct_acceleration(state, dt);
        }
        clamped as u64
    }

    /// A staggered method may keep the acceleration that led to its velocity: what the clamp took
    /// from the velocity it takes from this too, by the time between the step's two velocities.
    fn correct_acceleration(&self, state: &mut State, dt: f64) {
        let time = if self.under_way { dt } else { dt / 2.0 };
        for ((a, v), unclamped) in state.a.iter_mut().zip(&state.v).zip(&self.v) {
            if v != unclamped {
                *a += (v - unclamped) / time;
            }
        }
    }
}

/// Shortens a cell's vector, measured from `from` or from 0, to `limit` where it is longer; whether
/// it was. A vector within the limit keeps its bits.
pub fn clamp_vector(vector: &mut [f64], from: Option<&[f64]>, limit: f64) -> bool {
    let at = |index: usize| from.map_or(0.0, |from| from[index]);
    let part = |index: usize, vector: &[f64]| vector[index] - at(index);
    let parts = 0..vector.len();
    let square: f64 = parts.clone().map(|i| part(i, vector).powi(2)).sum();
    let allowed = limit * (1.0 + ROUNDING);
    if square <= allowed * allowed {
        return false;
    }
    // Squares may overflow where lengths do not.
    let sizes = parts.clone().map(|i| part(i, vector).abs());
    let largest = sizes.fold(0.0, f64::max);
    let shares = parts.map(|i| (part(i, vector) / largest).powi(2));
    let length = largest * shares.sum::<f64>().sqrt();
    let longer = length > allowed;
    if longer {
        let share = limit / length;
        for (index, x) in vector.iter_mut().enumerate() {
            *x = at(index) + (*x - at(index)) * share;
        }
    }
    longer
}
