//! Degrees of freedom sampled at every step.

use crate::State;

/// Displacements of a few degrees of freedom after every step, sampled inside a batch, so that
/// watching every step does not cut the batch into single steps.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    dofs: Vec<u32>,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Watch {
    /// Watches these degrees of freedom, with capacity for `steps` samples before anything more is allocated.
    #[must_use]
    pub fn new(dofs: Vec<u32>, steps: usize) -> Self {
        Self {
            times: Vec::with_capacity(steps),
            values: Vec::with_capacity(steps * dofs.len()),
            dofs,
        }
    }

    /// True if no degree of freedom is watched.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// The degrees of freedom that it watches.
    #[must_use]
    pub fn dofs(&self) -> &[u32] {
        &self.dofs
    }

    /// Adds a sample.
    pub fn sample(&mut self, state: &State) {
        self.times.push(state.t());
        let values = self.dofs.iter().map(|dof| state.u[*dof as usize]);
        self.values.extend(values);
    }

    /// The samples since the last time they were cleared: time (s) and displacements (m), in the
    /// order in which the degrees of freedom were given.
    pub fn samples(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let count = self.dofs.len();
        let values = (0..self.times.len()).map(move |i| &self.values[i * count..(i + 1) * count]);
        self.times.iter().copied().zip(values)
    }

    /// Forgets the samples and keeps the capacity.
    pub fn clear(&mut self) {
        self.times.clear();
        self.values.clear();
    }
}
