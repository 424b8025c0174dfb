//! Internal forces and the elastic energy.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use sinew_core::{Deformed, EvaluationError};
use sinew_sparse::simd::{InstructionSet, Number, Real, SharedSlice, Vectors, WithReal};

use super::axes::{Place, RegionAxes, at_place};
use super::beside::{StressBeside, carried_energy};
use super::chunks::LANES;
use super::defined::{require_law, require_memory};
use super::found::Found;
use super::gather::{CornerPlaces, Gather};
use super::kept::{Rows, load, load_entries, no_rows, store, store_entries};
use super::memory::{Past, Points, Relaxing, Remembered, Remembering};
use super::region::{HyperelasticRegion, Numbers};
use super::rooms::{RegionRooms, Rooms};
use super::schedule::{Piece, Task};
use super::scratch::Places;
use super::stiffness::Stiffness;
use crate::hyperelastic::HyperelasticLaw;
use crate::hyperelastic::prony::{deviatoric, first_piola};

/// An evaluation of forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Evaluation<'a, T> {
    pub(super) regions: &'a [HyperelasticRegion],
    /// Data of each region that the loops read.
    pub(super) numbers: &'a [Numbers<T>],
    pub(super) gather: &'a Gather,
    /// Positions in `places` of the values that tasks exchange.
    pub(super) rooms: &'a Rooms,
    pub(super) places: Places<'a, T>,
    pub(super) past: Past<'a, T>,
    /// History variables to update, in which case no forces are computed; used by one thread only.
    pub(super) remembered: Option<Remembered<'a, T>>,
    pub(super) set: InstructionSet,
    /// True to compute the energy and the other findings.
    pub(super) with_energy: bool,
}

/// The tasks of a piece of a part.
pub(crate) struct Forces<'a, T> {
    evaluation: &'a Evaluation<'a, T>,
    part: usize,
    piece: &'a Piece,
}

impl<'a, T: Vectors> Forces<'a, T> {
    /// The tasks of a piece; `None` if it has nothing to do.
    ///
    /// # Safety
    /// The parts of a schedule of these regions are done pass by pass; other users of the places wait until they are
    /// done.
    pub(super) unsafe fn of(
        evaluation: &'a Evaluation<'a, T>,
        part: usize,
        piece: &'a Piece,
    ) -> Option<Self> {
        let region = &evaluation.regions[piece.region];
        let is_idle = evaluation.remembered.is_some() && region.memory.is_none();
        (!is_idle).then_some(Self {
            evaluation,
            part,
            piece,
        })
    }

    /// Does them for the law of the region, and returns their findings.
    pub(super) fn run<L: HyperelasticLaw>(self, law: L) -> Result<Deformed, EvaluationError> {
        let Evaluation {
            regions,
            numbers,
            remembered,
            with_energy,
            ..
        } = self.evaluation;
        let region = self.piece.region;
        let has_shares = numbers[region].stiffness.is_some();
        let is_plain = regions[region].is_plain() && !has_shares;
        if L::IS_COMMON && is_plain && remembered.is_none() && !with_energy {
            self.sweep::<true, L>(law)
        } else {
            self.sweep::<false, L>(law)
        }
    }

    /// Same as [`Self::run`]; `PLAIN` is true if only the law's own forces are requested.
    fn sweep<const PLAIN: bool, L: HyperelasticLaw>(
        self,
        law: L,
    ) -> Result<Deformed, EvaluationError> {
        let Evaluation {
            regions,
            numbers,
            gather,
            rooms,
            places,
            past,
            remembered,
            set,
            with_energy,
        } = *self.evaluation;
        assert!(places.hold(rooms));
        let of_part = self.part * places.chunk..(self.part + 1) * places.chunk;
        let region = &regions[self.piece.region];
        let relaxing = match remembered {
            Some(_) => Relaxing::none(),
            None => Relaxing::of(region.memory.as_ref(), past),
        };
        let sweep = Sweep::<T, L, PLAIN> {
            region,
            relaxing,
            remembered,
            set,
            numbers: &numbers[self.piece.region],
            gather,
            rooms: &rooms.regions[self.piece.region],
            corners: &rooms.corners,
            law,
            with_energy,
            places,
            of_part,
            tasks: &self.piece.tasks,
        };
        T::with_vectors_or_numbers(set, sweep)
    }
}

/// All loops over a region, for one law. `PLAIN` loops compute no energy, memory, fibres, axes or shares of the
/// stiffness: without these branches vectors stay in registers.
///
/// The proof of all blocks below is the schedule: a task reads only results of its own part or of an earlier pass, and
/// no part writes values that another part of the same pass reads ([`super::schedule::Schedule`]). Places of gradients,
/// edges and corners are within assigned blocks, and these within the arrays ([`Places::hold`]).
struct Sweep<'a, T, L, const PLAIN: bool> {
    region: &'a HyperelasticRegion,
    numbers: &'a Numbers<T>,
    gather: &'a Gather,
    rooms: &'a RegionRooms,
    corners: &'a CornerPlaces,
    law: L,
    relaxing: Relaxing<'a, T>,
    remembered: Option<Remembered<'a, T>>,
    set: InstructionSet,
    with_energy: bool,
    places: Places<'a, T>,
    /// The numbers of `places.chunks` that are this part's.
    of_part: Range<usize>,
    tasks: &'a [Task],
}

impl<T: Vectors, L: HyperelasticLaw, const PLAIN: bool> WithReal<T> for Sweep<'_, T, L, PLAIN> {
    type Output = Result<Deformed, EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = T>>(self) -> Self::Output {
        let mut found = Found::<N>::none();
        for task in self.tasks {
            match task {
                Task::Means(chunk) => self.means(*chunk, &mut found)?,
                Task::Edges(edges) => self.edges(edges.clone(), &mut found)?,
                Task::Forces(chunk) => self.forces(*chunk, &mut found)?,
                Task::Nodes(_) if self.remembered.is_some() => {}
                // SAFETY: see `Sweep`.
                Task::Nodes(nodes) => unsafe {
                    let places = &self.places;
                    self.gather
                        .sum(nodes.clone(), self.corners, places.corners, places.sums);
                },
            }
        }
        Ok(found.over(&self.numbers.rest))
    }
}

impl<T: Vectors, L: HyperelasticLaw, const PLAIN: bool> Sweep<'_, T, L, PLAIN> {
    /// Takes the mean dilation of each patch of a chunk, times its share of the stiffness, and keeps the gradients.
    #[inline(always)]
    fn means<N: Number<Real = T>>(
        &self,
        number: usize,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest, places) = (self.region, &*self.numbers.rest, &self.places);
        let chunk = &region.chunks[number];
        let keeps_rows = !region.edges_of.is_empty();
        // SAFETY: see `Sweep`.
        let (dilations, kept) = unsafe {
            (
                places.dilations.write(from(region.kept.tets, &chunk.slots)),
                places.chunks.write(self.of_part.clone()),
            )
        };
        for first in chunk.slots.clone().step_by(N::LANES) {
            let own = first - chunk.slots.start;
            let gradient = rest.gradient_of::<N>(first, places.displacement);
            let axes = self.axes();
            let at = at_place(&self.law, gradient, axes, Place::Tets(first));
            require_law(&at, |lane| rest.tag(first + lane))?;
            let volume = rest.volumes::<N>(first);
            let dilation = volume * self.law.dilation(&at);
            dilation.store(&mut dilations[own..]);
            if keeps_rows {
                let rows = self.rooms.gradients[number] as usize + own;
                // SAFETY: see `Sweep`.
                let rows = unsafe { places.gradients.write(rows..rows + N::LANES) };
                store(gradient.scaled(volume), rows);
            } else {
                store_entries(gradient, &mut kept[9 * own..]);
            }
        }
        let lambda = self.relaxing.factor_of_dilation() * self.law.lame().0;
        for patch in chunk.patches.clone() {
            let tets = region.patches.of(patch);
            let volume = self.numbers.patch_volumes[patch];
            // The tetrahedra of a patch are neighbours in memory.
            let first = tets
                .first()
                .map_or(0, |tet| *tet as usize - chunk.slots.start);
            let dilations = &mut dilations[first..first + tets.len()];
            let sum = dilations
                .iter()
                .fold(T::default(), |sum, of_tet| sum + *of_tet);
            let mean = sum / volume;
            let stressing = match &self.numbers.stiffness {
                Some(stiffness) => mean * stiffness.of_patch(patch),
                None => mean,
            };
            dilations.fill(stressing);
            let (mean, stressing) = (mean.to_f64(), stressing.to_f64());
            found.energy_of_sets += 0.5 * volume.to_f64() * lambda * stressing * mean;
        }
        Ok(())
    }

    /// Computes the stress at some edges.
    #[inline(always)]
    fn edges<N: Number<Real = T>>(
        &self,
        edges: Range<usize>,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest, places) = (self.region, &*self.numbers.rest, &self.places);
        let stiffness = self.stiffness();
        let mut remembering = self.remembering();
        let mut sums = [no_rows(); LANES];
        for first in edges.step_by(N::LANES) {
            let starts = &self.rooms.starts_at[first..=first + N::LANES];
            for (sum, range) in sums.iter_mut().zip(starts.windows(2)) {
                let tets = range[0] as usize..range[1] as usize;
                *sum = rows_of(places.gradients, &self.rooms.gradients_at[tets]);
            }
            let volume = N::load(&self.numbers.edge_volumes[first..]);
            let over = N::select_le(volume, N::of(0.0), N::of(0.0), volume.recip());
            let gradient = load::<N>(&sums).scaled(over);
            let axes = self.axes();
            let at = at_place(&self.law, gradient, axes, Place::Means);
            let tag = |lane: usize| {
                let tets = region.edges.of(region.edge_at(first + lane));
                tets.first().map_or(0, |tet| rest.tag(*tet as usize))
            };
            require_law(&at, tag)?;
            let mut stress = self.law.stress(&at);
            if let Some(stiffness) = stiffness {
                stress = stress.scaled(stiffness.at_edges(first));
            }
            if let Some(remembering) = &mut remembering {
                if remembering.is_deviatoric() {
                    stress = deviatoric(&at.deformation, stress);
                }
                remembering.take(Points::Edges, first, &at.deformation, stress);
                continue;
            }
            let mut density = N::of(0.0);
            if !PLAIN && self.with_energy {
                density = self.law.energy(&at);
                if let Some(stiffness) = stiffness {
                    density = stiffness.at_edges::<N>(first) * density;
                }
            }
            if !PLAIN && self.relaxing.is_there() {
                require_memory(&self.relaxing, &at.deformation, tag)?;
                let factor = N::of(self.relaxing.factor);
                let half = N::of(0.5) * self.law.dilation(&at);
                let mut left = N::of(self.relaxing.bulk_left()) * self.law.dilation(&at);
                if let Some(stiffness) = stiffness {
                    left = stiffness.at_edges::<N>(first) * left;
                }
                let gradient = self.law.dilation_gradient(&at);
                stress = stress.scaled(factor).plus(left, gradient);
                density = half.mul_add(left, factor * density);
                if let Some(carried) = self.relaxing.carried::<N>(Points::Edges, first) {
                    stress = stress + first_piola(&at.deformation, carried);
                    density = density + carried_energy(&at.deformation, carried);
                }
            }
            let own = self.rooms.edges[first / LANES] as usize + first % LANES;
            // SAFETY: see `Sweep`.
            let to = unsafe { places.at_edges.write(own..own + N::LANES) };
            store(stress, to);
            if !PLAIN && self.with_energy {
                let share = volume * N::of(region.edge_share / 6.0);
                found.energy = share.mul_add(density, found.energy);
            }
        }
        Ok(())
    }

    /// The material's axes, if its law has some.
    #[inline(always)]
    fn axes(&self) -> Option<&RegionAxes<T>> {
        self.numbers.axes.as_ref().filter(|_| !PLAIN)
    }

    /// Factors of the law's energies, if they differ.
    #[inline(always)]
    fn stiffness(&self) -> Option<&Stiffness<T>> {
        self.numbers.stiffness.as_deref().filter(|_| !PLAIN)
    }

    /// The memory that is updated, if it is.
    #[inline(always)]
    fn remembering(&self) -> Option<Remembering<'_, T>> {
        if PLAIN {
            return None;
        }
        let (memory, remembered) = (self.region.memory.as_ref()?, self.remembered?);
        let variables = remembered.internal;
        // SAFETY: one thread updates the history variables (`Evaluation::remembered`), and no two tasks at a time do.
        let internal = unsafe { variables.write(memory.range()) };
        Some(Remembering::of(memory, remembered.dt, internal))
    }

    /// Computes the stress in addition to the law's in the tetrahedra of a chunk, and keeps the gradients; returns the
    /// energy if it is requested.
    fn beside(&self, slots: &Range<usize>) -> Result<f64, EvaluationError> {
        // SAFETY: see `Sweep`.
        let kept = unsafe { self.places.chunks.write(self.of_part.clone()) };
        let (gradients, stress) = kept.split_at_mut(self.places.gradients_of_chunk);
        let work = StressBeside {
            region: self.region,
            rest: &self.numbers.rest,
            directions: &self.numbers.directions,
            relaxing: &self.relaxing,
            slots,
            displacement: self.places.displacement,
            gradients,
            gradients_are_known: self.region.is_smoothed() && self.region.edges_of.is_empty(),
            stress,
            with_energy: self.with_energy,
        };
        T::with_vectors_or_numbers(self.set, work)
    }

    /// Computes the forces at the corners of the tetrahedra of a chunk.
    #[inline(always)]
    fn forces<N: Number<Real = T>>(
        &self,
        chunk: usize,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest, places) = (self.region, &*self.numbers.rest, &self.places);
        let slots = region.chunks[chunk].slots.clone();
        let (is_smoothed, has_edges) = (region.is_smoothed(), !region.edges_of.is_empty());
        let is_relaxing = !PLAIN && self.relaxing.is_there();
        let has_beside = !PLAIN && (!region.fibres.is_empty() || is_relaxing);
        let with_energy = !PLAIN && self.with_energy;
        if has_beside {
            found.energy_of_sets += self.beside(&slots)?;
        }
        let own_share = 1.0 - region.edge_share;
        let lambda = self.relaxing.factor_of_dilation() * self.law.lame().0;
        let mut remembering = self.remembering();
        // SAFETY: see `Sweep`.
        let (dilations, kept, corners) = unsafe {
            let dilations = from(region.kept.tets, &slots);
            let corners = self.rooms.corners[chunk] as usize;
            (
                places
                    .dilations
                    .read(if is_smoothed { dilations } else { 0..0 }),
                places.chunks.read(self.of_part.clone()),
                places.corners.write(corners..corners + 4 * slots.len()),
            )
        };
        let (kept, beside) = kept.split_at(places.gradients_of_chunk);
        let stiffness = self.stiffness();
        let mut sums = [no_rows(); LANES];
        for first in slots.clone().step_by(N::LANES) {
            let own = first - slots.start;
            let gradient = if has_beside || is_smoothed && !has_edges {
                load_entries(&kept[9 * own..])
            } else {
                rest.gradient_of::<N>(first, places.displacement)
            };
            let axes = self.axes();
            let at = at_place(&self.law, gradient, axes, Place::Tets(first));
            require_law(&at, |lane| rest.tag(first + lane))?;
            let dilation = if is_smoothed {
                N::load(&dilations[own..])
            } else {
                self.law.dilation(&at)
            };
            let mut bulk = N::of(lambda) * dilation;
            if with_energy {
                found.note(first, at.volume_ratio, rest);
                let mut density = N::of(own_share) * self.law.energy(&at);
                if is_relaxing {
                    let half = N::of(0.5) * self.law.dilation(&at) * self.law.dilation(&at);
                    let left = N::of(own_share * self.relaxing.bulk_left());
                    density = left.mul_add(half, N::of(self.relaxing.factor) * density);
                }
                if !is_smoothed {
                    density = (N::of(0.5) * dilation).mul_add(bulk, density);
                }
                if let Some(stiffness) = stiffness {
                    density = stiffness.of_tets::<N>(first) * density;
                }
                found.energy = rest.volumes::<N>(first).mul_add(density, found.energy);
            }
            let mut share = N::of(own_share);
            if let Some(stiffness) = stiffness {
                let of_tets = stiffness.of_tets::<N>(first);
                share = of_tets * share;
                if !is_smoothed {
                    bulk = of_tets * bulk;
                }
            }
            if let Some(remembering) = &mut remembering {
                let stress = if remembering.is_deviatoric() {
                    deviatoric(&at.deformation, self.law.stress(&at).scaled(share))
                } else {
                    let own_stress = self.law.stress_of(&at, share, bulk);
                    match has_beside {
                        true => own_stress + load_entries(&beside[9 * own..]),
                        false => own_stress,
                    }
                };
                remembering.take(Points::Tets, first, &at.deformation, stress);
                continue;
            }
            if is_relaxing {
                let left = share * N::of(self.relaxing.bulk_left());
                bulk = left.mul_add(self.law.dilation(&at), bulk);
                share = share * N::of(self.relaxing.factor);
            }
            let volume = rest.volumes::<N>(first);
            let mut stress = self.law.stress_of(&at, volume * share, volume * bulk);
            if has_edges {
                for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
                    *sum = rows_of(places.at_edges, &self.rooms.edges_of[first + lane]);
                }
                let share = volume * N::of(region.edge_share / 6.0);
                stress = stress.plus(share, load(&sums));
            }
            if has_beside {
                stress = stress.plus(volume, load_entries(&beside[9 * own..]));
            }
            rest.forces(first, stress, &mut corners[4 * (own - own % LANES)..]);
        }
        Ok(())
    }
}

/// A range of a region as a range among all regions, in which the region begins at `first`.
fn from(first: usize, range: &Range<usize>) -> Range<usize> {
    first + range.start..first + range.end
}

/// The sum of some tensors, all of whose entries are added as one row.
#[inline(always)]
fn rows_of<T: Real>(all: SharedSlice<'_, Rows<T>>, places: &[u32]) -> Rows<T> {
    let mut sums = no_rows();
    for place in places {
        // SAFETY: see `Sweep`, which alone calls it.
        let other = unsafe { all.get(*place as usize) };
        let entries = sums.as_flattened_mut().iter_mut();
        for (sum, entry) in entries.zip(other.as_flattened()) {
            *sum = *sum + *entry;
        }
    }
    sums
}
