//! Rigid motions of parts of a body within a step's potential.

use sinew_cnn::{Deflation, RigidMotions};
use sinew_core::FreePart;

use super::quadratic::Quadratic;

/// The parts that may move as rigid bodies. The potential of a rigid motion is that of its inertia alone, so that its
/// minimum is known; sweeps then continue with blocks on which rigid motions have no effect.
pub(super) struct Rigid {
    parts: Vec<RigidMotions>,
    pub(super) deflation: Deflation,
    /// Inverse blocks, row by row.
    pub(super) inverse: Vec<f64>,
    places: Vec<f64>,
    turned: Vec<f64>,
    pull: Vec<f64>,
}

impl Rigid {
    /// Scratch space for these parts; `None` without any.
    pub(super) fn new(parts: Vec<FreePart>, dofs: usize) -> Option<Self> {
        if parts.is_empty() {
            return None;
        }
        let zeros = || vec![0.0; dofs];
        Some(Self {
            parts: parts.iter().cloned().map(RigidMotions::new).collect(),
            deflation: Deflation::new(parts),
            inverse: vec![0.0; 3 * dofs],
            places: zeros(),
            turned: zeros(),
            pull: zeros(),
        })
    }

    /// Writes the rigid displacements (m) from `u` (m) on that minimise the potential without elastic energy; other
    /// cells are unchanged. For a quadratic law they are small displacements about rest.
    pub(super) fn lead(
        &mut self,
        u: &[f64],
        quadratic: &Quadratic<'_>,
        is_quadratic: bool,
        out: &mut [f64],
    ) {
        let Quadratic {
            masses,
            mass_weight,
            pull,
            ..
        } = quadratic;
        let inertia = |dof: usize| mass_weight * masses[dof];
        for part in &mut self.parts {
            if is_quadratic {
                part.clear(out);
                part.add_small(None, pull, inertia, (1.0, &mut *out));
            } else {
                part.lead(u, pull, inertia, (&mut *out, &mut self.places));
            }
        }
    }

    /// Replaces the rigid part of `way` (m), the displacement in a step from `u` (m) on by a velocity, with finite
    /// rotations.
    pub(super) fn turn(&mut self, u: &[f64], masses: &[f64], way: &mut [f64]) {
        for ((pull, mass), way) in self.pull.iter_mut().zip(masses).zip(&*way) {
            *pull = mass * way;
        }
        let inertia = |dof: usize| masses[dof];
        self.turned.fill(0.0);
        for part in &mut self.parts {
            part.lead(u, &self.pull, inertia, (&mut self.turned, &mut self.places));
            part.add_small(Some(u), &self.pull, inertia, (-1.0, &mut *way));
        }
        for (way, turned) in way.iter_mut().zip(&self.turned) {
            *way += turned;
        }
    }
}
