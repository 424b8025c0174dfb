//! Forces of hyperelastic regions for machines with threads and vectors.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;
use std::sync::Arc;

use sinew_core::{
    ElementForces, ElementPrecision, ElementSweep, EvaluationError, LinearOperators, LoadTime,
    SweepShape,
};
use sinew_sparse::simd::{Real, Shared};
use sinew_sparse::sweep::{Fields, Numbering};

use super::Model;
use super::field_error::require_inputs;
use crate::following::FollowingPressure;
use crate::large::{Precision, SharedForces};
use crate::motion::{Field, Motions};

/// Marks an absent entry.
const NONE: u32 = u32::MAX;

impl ElementForces for Model {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }

    /// Cells of hyperelastic regions first, then those of others.
    fn order(&self) -> Vec<u32> {
        let cells = &self.body.cells;
        let mut order = Vec::with_capacity(cells.nodes.len());
        let mut is_taken = vec![false; cells.nodes.len()];
        let large = self.large.iter();
        let nodes = large.flat_map(|large| large.nodes_in_order());
        for cell in nodes.filter_map(|node| cells.of_node(*node)) {
            is_taken[cell as usize] = true;
            order.push(cell);
        }
        let others = (0..).zip(&is_taken).filter(|(_, is_taken)| !**is_taken);
        order.extend(others.map(|(cell, _)| cell));
        order
    }

    fn elements(&self) -> usize {
        self.large.as_ref().map_or(0, |large| large.elements())
    }

    fn in_double(&self, shape: SweepShape<'_>) -> Box<dyn ElementSweep<f64>> {
        let forces = self.large.as_ref();
        let forces = forces.map(|large| large.in_double(shape.parts, shape.set));
        Box::new(Sweep::new(self, forces, shape))
    }

    fn in_single(&self, shape: SweepShape<'_>) -> Box<dyn ElementSweep<f32>> {
        let forces = self.large.as_ref();
        let forces = forces.map(|large| large.in_single(shape.parts, shape.set));
        Box::new(Sweep::new(self, forces, shape))
    }
}

/// A position of a machine's vectors.
#[derive(Clone, Copy, Debug)]
struct Position {
    /// The mesh node.
    node: u32,
    /// Its place among the sums of forces.
    sum: u32,
    /// Fixed components.
    pinned: [bool; 3],
}

/// The sweep over the tetrahedra of hyperelastic regions.
#[derive(Debug)]
struct Sweep<T> {
    /// `None` without such regions.
    forces: Option<SharedForces<T>>,
    parts: usize,
    positions: Vec<Position>,
    /// Displacement (m) of all mesh nodes, and a number to fill a row.
    displacement: Shared<[T; 4]>,
    motions: Motions,
    /// Nodes that are moved, with the position of those that are cells.
    moved: Vec<(u32, u32)>,
    /// Displacement of cells (m) that motions add, by position; empty if they add none.
    offsets: Vec<[T; 3]>,
    following: Following,
}

/// Pressures that follow the surface.
#[derive(Debug)]
struct Following {
    pressures: Arc<[FollowingPressure]>,
    /// Their factors at the time of the sweep.
    factors: Vec<f64>,
    /// The position of each mesh node; empty without pressures.
    position: Vec<u32>,
    /// Forces (N) by position, beyond those on the surface at rest.
    forces: Shared<[f64; 3]>,
}

impl Following {
    fn new(model: &Model, numbering: &Numbering) -> Self {
        let pressures = Arc::clone(&model.following);
        let (mut position, mut positions) = (Vec::new(), 0);
        if !pressures.is_empty() {
            let cell = |node| model.body.cells.of_node(node);
            let nodes = 0..model.mesh.points.len() as u32;
            let of = |node| cell(node).map_or(NONE, |cell| numbering.position(cell) as u32);
            position = nodes.map(of).collect();
            positions = numbering.positions();
        }
        Self {
            factors: vec![0.0; pressures.len()],
            pressures,
            position,
            forces: Shared::filled([0.0; 3], positions),
        }
    }

    fn is_empty(&self) -> bool {
        self.pressures.is_empty()
    }

    /// Computes the forces of the pressures.
    ///
    /// # Safety
    /// No other code uses them during the call.
    unsafe fn make(&self, displacement: impl Fn(u32) -> [f64; 3]) {
        let all = self.forces.slice();
        // SAFETY: the caller's promise.
        let forces = unsafe { all.write(0..all.count()) };
        forces.fill([0.0; 3]);
        for (pressure, factor) in self.pressures.iter().zip(&self.factors) {
            pressure.forces(*factor, &displacement, |node, force| {
                if let Some(sum) = forces.get_mut(self.position[node as usize] as usize) {
                    sum.iter_mut()
                        .zip(force)
                        .for_each(|(sum, force)| *sum += force);
                }
            });
        }
    }
}

impl<T: Precision> Sweep<T> {
    fn new(model: &Model, forces: Option<SharedForces<T>>, shape: SweepShape<'_>) -> Self {
        let numbering: &Numbering = shape.numbering;
        let cells = &model.body.cells;
        let mut sums = vec![NONE; model.mesh.points.len()];
        let nodes = model.large.iter().flat_map(|large| large.nodes_in_order());
        for (sum, node) in (0..).zip(nodes) {
            sums[*node as usize] = sum;
        }
        let position = |position: usize| {
            let cell = numbering.cell(position).map(|cell| cell as usize);
            let node = cell.map_or(NONE, |cell| cells.nodes[cell]);
            let pinned = |axis: usize| cell.is_some_and(|cell| cells.pinned[3 * cell + axis]);
            Position {
                node,
                sum: sums.get(node as usize).copied().unwrap_or(NONE),
                pinned: std::array::from_fn(pinned),
            }
        };
        let moved: Vec<(u32, u32)> = (0..model.mesh.points.len() as u32)
            .filter(|node| (0..3).any(|axis| model.motions.part_of(*node, axis).is_some()))
            .map(|node| {
                let cell = cells.of_node(node);
                let position = cell.map(|cell| numbering.position(cell) as u32);
                (node, position.unwrap_or(NONE))
            })
            .collect();
        let has_offsets = moved.iter().any(|(_, position)| *position != NONE);
        let offsets = if has_offsets {
            numbering.positions()
        } else {
            0
        };
        Self {
            forces,
            parts: shape.parts,
            positions: (0..numbering.positions()).map(position).collect(),
            displacement: Shared::filled([T::default(); 4], model.mesh.points.len()),
            motions: model.motions.clone(),
            moved,
            offsets: vec![[T::default(); 3]; offsets],
            following: Following::new(model, numbering),
        }
    }

    /// The displacement (m) of all mesh nodes.
    ///
    /// # Safety
    /// No other code writes it during the call.
    unsafe fn displacement(&self) -> &[[T; 4]] {
        let all = self.displacement.slice();
        // SAFETY: the caller's promise.
        unsafe { all.read(0..all.count()) }
    }
}

impl<T: Precision + ElementPrecision> ElementSweep<T> for Sweep<T> {
    fn passes(&self) -> usize {
        self.forces.as_ref().map_or(0, SharedForces::passes)
    }

    /// Number of parts of a pass; in the first pass pressures are a separate part.
    fn parts(&self, pass: usize) -> usize {
        self.parts + usize::from(pass == 0 && !self.following.is_empty())
    }

    fn begin(&mut self, when: LoadTime<'_>) -> Result<(), EvaluationError> {
        let Following {
            pressures, factors, ..
        } = &mut self.following;
        for (pressure, factor) in pressures.iter().zip(factors) {
            *factor = pressure.factor(when);
        }
        if self.moved.is_empty() {
            return Ok(());
        }
        require_inputs(self.motions.ramps(), when.inputs()).map_err(EvaluationError::of_body)?;
        let at = self.motions.at(when, Field::Displacement);
        for (node, position) in &self.moved {
            let [x, y, z] = self.motions.at_node(&at, *node).map(<T as Real>::of);
            match self.offsets.get_mut(*position as usize) {
                Some(offset) => *offset = [x, y, z],
                // SAFETY: `self` is borrowed for this call alone.
                None => unsafe {
                    let node = *node as usize;
                    let rows = self.displacement.slice().write(node..node + 1);
                    rows[0] = [x, y, z, T::default()];
                },
            }
        }
        Ok(())
    }

    unsafe fn take(&self, fields: &Fields<T>, source: usize, positions: Range<usize>) {
        // Products of smaller ones are numbers that processors compute with slowly.
        let tiny = <T as Real>::of(T::TINY.sqrt());
        let flushed = |value: T| {
            if value < tiny && T::default() - value < tiny {
                T::default()
            } else {
                value
            }
        };
        let rows = self.displacement.slice();
        // SAFETY: the caller's promise; each node is at one position.
        unsafe {
            let [x, y, z] = [0, 1, 2].map(|axis| fields.read(source, axis, positions.clone()));
            let values = x.iter().zip(y).zip(z);
            for (place, ((x, y), z)) in positions.zip(values) {
                let node = self.positions[place].node as usize;
                if node == NONE as usize {
                    continue;
                }
                let [x, y, z] = [*x, *y, *z].map(flushed);
                let [dx, dy, dz] = self.offsets.get(place).copied().unwrap_or_default();
                rows.write(node..node + 1)[0] = [x + dx, y + dy, z + dz, T::default()];
            }
        }
    }

    unsafe fn make(&self, pass: usize, part: usize) -> bool {
        let Some(forces) = &self.forces else {
            return true;
        };
        // SAFETY: the caller's promise.
        let displacement = unsafe { self.displacement() };
        if part == self.parts {
            let of = |node: u32| {
                let [x, y, z, _] = displacement[node as usize].map(Real::to_f64);
                [x, y, z]
            };
            // SAFETY: the caller's promise.
            unsafe { self.following.make(of) };
            return true;
        }
        // SAFETY: as above.
        unsafe { forces.make(displacement, pass, part) }.is_ok()
    }

    unsafe fn give(&self, fields: &Fields<T>, out: usize, positions: Range<usize>) {
        let Some(forces) = &self.forces else {
            return;
        };
        let sums = forces.sums();
        // SAFETY: the caller's promise.
        unsafe {
            let [x, y, z] = [0, 1, 2].map(|axis| fields.write(out, axis, positions.clone()));
            let values = x.iter_mut().zip(y).zip(z);
            for (place, ((x, y), z)) in positions.zip(values) {
                let Position { sum, pinned, .. } = self.positions[place];
                let [mut fx, mut fy, mut fz, _] = match sum {
                    NONE => [T::default(); 4],
                    sum => *sums.get(sum as usize),
                };
                if !self.following.is_empty() {
                    let pressure = self.following.forces.slice();
                    let [px, py, pz] = pressure.get(place).map(<T as Real>::of);
                    (fx, fy, fz) = (fx - px, fy - py, fz - pz);
                }
                let outs = [x, y, z].into_iter().zip([fx, fy, fz]);
                for ((out, force), pinned) in outs.zip(pinned) {
                    *out = if pinned { T::default() } else { force };
                }
            }
        }
    }

    fn refusal(&mut self) -> EvaluationError {
        let rows = self.displacement.slice();
        // SAFETY: `self` is borrowed for this call alone.
        let displacement = unsafe { rows.read(0..rows.count()) };
        let refused = self
            .forces
            .as_mut()
            .map(|forces| forces.make_alone(displacement));
        match refused {
            Some(Err(error)) => error,
            Some(Ok(())) | None => EvaluationError::of_body("its law has no meaning there"),
        }
    }
}
