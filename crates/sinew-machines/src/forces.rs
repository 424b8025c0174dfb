//! Loads in the order of a machine.

use sinew_cnn::{Loads, StepTime};
use sinew_core::{Inputs, LinearOperators, Load, Revision};
use sinew_sparse::sweep::{CHUNK, Fields, Numbering, Precision};

/// The forces of a sweep: rewritten only when a load's factor changes.
#[derive(Debug, Default)]
pub(crate) struct Forces {
    /// Address of each load that is in the field, and its factor. Loads do not move during a batch.
    present: Vec<(usize, f64)>,
    /// Identity of the loads in the field; `None` if some are not the system's.
    of: Option<[Revision; 2]>,
    wanted: Vec<(usize, f64)>,
    /// Positions and layers that are not 0.
    touched: Vec<(u32, u32)>,
    /// One flag per chunk: true if it has any of these positions.
    pub(crate) loaded: Vec<bool>,
}

impl Forces {
    /// Storage for the loads of a system.
    pub(crate) fn new<T: Precision>(operators: &LinearOperators, positions: usize) -> Self {
        let loads = operators.loads();
        let entries = loads.iter().map(|load| load.entries.len()).sum();
        Self {
            present: Vec::with_capacity(loads.len() + 1),
            of: None,
            wanted: Vec::with_capacity(loads.len() + 1),
            touched: Vec::with_capacity(entries),
            loaded: vec![false; positions.div_ceil(CHUNK * T::LANES)],
        }
    }

    /// Begins a batch. Marks the field as outdated, so that the next loads are written, unless they are the system's
    /// own and the same as in the previous batch.
    pub(crate) fn begin(&mut self, operators: &LinearOperators, inputs: &Inputs) {
        let revisions = [operators.revision(), operators.loads_revision()];
        let of = (inputs.forces().len() == 0).then_some(revisions);
        if of.is_none() || self.of != of {
            self.present.clear();
        }
        self.of = of;
    }

    /// Writes the loads of a sweep.
    pub(crate) fn set<T: Precision>(
        &mut self,
        (fields, field): (&mut Fields<T>, usize),
        numbering: &Numbering,
        operators: &LinearOperators,
        (loads, step): (Loads, StepTime<'_>),
    ) {
        self.wanted.clear();
        step.for_each_load(loads, operators, |load, factor| {
            self.wanted
                .push((std::ptr::from_ref::<Load>(load) as usize, factor));
        });
        // Without loads there may still be those of the batch before.
        if self.wanted == self.present && (!self.wanted.is_empty() || self.touched.is_empty()) {
            return;
        }
        for (position, layer) in self.touched.drain(..) {
            fields.layer(field, layer as usize)[position as usize] = T::default();
        }
        self.loaded.fill(false);
        let layers = fields.layers();
        step.for_each_load(loads, operators, |load, factor| {
            for &(dof, force) in &load.entries {
                let (cell, layer) = (dof as usize / layers, dof as usize % layers);
                if cell >= numbering.cells() {
                    continue;
                }
                let position = numbering.position(cell as u32);
                let value = &mut fields.layer(field, layer)[position];
                *value = *value + T::of(factor * force);
                self.touched.push((position as u32, layer as u32));
                self.loaded[position / (CHUNK * T::LANES)] = true;
            }
        });
        std::mem::swap(&mut self.present, &mut self.wanted);
    }
}
