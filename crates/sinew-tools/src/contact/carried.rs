//! Transfer of the contact history of tools to other cells.

use std::collections::HashMap;

use sinew_core::{Meeting, State};

use super::meet::way_of;
use super::record::{OF_CELL, OF_HELD, OF_PAIR, OF_VELOCITY};
use super::tool::Corner;
use super::tools::Tools;
use crate::vector::sub;

impl Tools {
    /// Contact history ([`sinew_core::State::contact`]) of these tools after a cut. `before` are the same tools on the
    /// cells before the cut, and `contact` is their history. For a touched cell, `of` gives the index among the old
    /// cells: of the cell itself, or of its original if it is a copy; `None` for a cell that could not be touched.
    ///
    /// Forces of the last step stay with the first of several copies, and a tool that grasps a cell grasps all of its
    /// copies.
    #[must_use]
    pub fn carried(
        &self,
        before: &Self,
        contact: &[f64],
        of: impl Fn(usize) -> Option<usize>,
    ) -> Vec<f64> {
        let is_theirs = contact.len() == before.counts.numbers();
        if !is_theirs || self.counts.of_bodies() != before.counts.of_bodies() {
            return Vec::new();
        }
        let mut carried = vec![0.0; self.counts.numbers()];
        let cells = before.counts.of_cells();
        carried[..cells.start].copy_from_slice(&contact[..cells.start]);
        let velocities = &contact[before.counts.of_velocities()];
        let held = &contact[before.counts.of_held()];
        let lips = &contact[before.counts.of_lips()];
        if let (Some(own), false) = (carried.get_mut(self.counts.of_lips()), lips.is_empty()) {
            let kept = own.len().min(lips.len());
            own[..kept].copy_from_slice(&lips[..kept]);
        }
        let forces = &contact[cells];
        let mut is_taken = vec![false; before.cells.len()];
        let own = self.counts.of_cells();
        let (own_forces, others) = carried[own.start..].split_at_mut(own.len());
        let (own_velocities, others) = others.split_at_mut(self.counts.of_velocities().len());
        let own_held = &mut others[..self.counts.of_held().len()];
        for place in 0..self.cells.len() {
            let Some(from) = of(place).filter(|from| *from < before.cells.len()) else {
                continue;
            };
            if !std::mem::replace(&mut is_taken[from], true) {
                copy::<OF_CELL>(forces, from, own_forces, place);
            }
            copy::<OF_VELOCITY>(velocities, from, own_velocities, place);
            copy::<OF_HELD>(held, from, own_held, place);
        }
        self.list_carried(&mut carried);
        // Both nodes of a pair that is new go the same way.
        let pairs = carried[self.counts.of_pairs()].as_chunks_mut().0;
        let kept = contact[before.counts.of_pairs()].as_chunks().0;
        let mut known = HashMap::new();
        for (pair, kept) in before.lips.pairs.iter().zip(kept) {
            known.insert(pair.nodes.map(Corner::place), *kept);
        }
        for (pair, own) in self.lips.pairs.iter().zip(pairs) {
            let [one, other] = pair
                .nodes
                .map(|node| node.place().and_then(|place| of(place as usize)));
            let [one, other] = [one, other].map(|place| place.map(|place| place as u32));
            *own = match (known.get(&[one, other]), known.get(&[other, one])) {
                (Some(kept), _) => *kept,
                (None, Some(kept)) => kept.map(|along| -along),
                (None, None) => [0.0; 3],
            };
        }
        carried
    }

    /// Lists the cells that have a force or a velocity.
    fn list_carried(&self, carried: &mut [f64]) {
        let cells = carried[self.counts.of_cells()].as_chunks::<OF_CELL>().0;
        let velocities = &carried[self.counts.of_velocities()];
        let velocities = velocities.as_chunks::<OF_VELOCITY>().0;
        let has_any = |place: &usize| {
            let is_some = |row: Option<&[f64; 3]>| row.is_some_and(|row| *row != [0.0; 3]);
            is_some(cells.get(*place)) || is_some(velocities.get(*place))
        };
        let listed: Vec<f64> = (0..self.cells.len())
            .filter(has_any)
            .map(|place| place as f64)
            .collect();
        let own = &mut carried[self.counts.of_listed()];
        own[0] = listed.len() as f64;
        own[1..=listed.len()].copy_from_slice(&listed);
    }

    /// Stores for each pair of cut-face nodes the vector (m) from the first to the second at the beginning of the step
    /// that ended in the state.
    pub(super) fn keep_pairs(
        &self,
        state: &State,
        meeting: &Meeting<'_>,
        pairs: &mut [[f64; OF_PAIR]],
    ) {
        let began = |place: u32| {
            let touched = &self.cells[place as usize];
            sub(touched.at(&state.u), way_of(meeting, state, touched.cell))
        };
        for (pair, kept) in self.lips.pairs.iter().zip(pairs) {
            let [one, other] = pair.nodes.map(|node| node.at(began));
            *kept = sub(other, one);
        }
    }
}

/// Copies a row of `N` numbers, if both lists have it.
fn copy<const N: usize>(source: &[f64], from: usize, target: &mut [f64], to: usize) {
    let source = source.get(N * from..N * (from + 1));
    let target = target.get_mut(N * to..N * (to + 1));
    if let (Some(source), Some(target)) = (source, target) {
        target.copy_from_slice(source);
    }
}
