//! Clamping the velocity vectors of cells.

use std::sync::Arc;

use sinew_sparse::clamp_vector;

use crate::{Acceleration, State};

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

    /// Corrects the acceleration that a staggered method may keep: by the change of velocity that the clamp made,
    /// over the time between the step's two velocities.
    fn correct_acceleration(&self, state: &mut State, dt: f64) {
        let time = if self.under_way { dt } else { dt / 2.0 };
        for ((a, v), unclamped) in state.a.iter_mut().zip(&state.v).zip(&self.v) {
            if v != unclamped {
                *a += (v - unclamped) / time;
            }
        }
    }
}
