//! Internal forces and the energy behind them.

use sinew_core::{Deformed, EvaluationError};
use sinew_sparse::simd::{InstructionSet, Number, WithDouble};

use super::chunks::Chunk;
use super::error::refused;
use super::found::Found;
use super::gather::{Gather, row_sum};
use super::region::HyperelasticRegion;
use super::scratch::{Kept, Rows, Scratch};
use crate::hyperelastic::{
    Deformation, HyperelasticLaw, LawVisitor, SMALLEST_VOLUME_RATIO, Tensor,
};

/// Writes the forces at the corners of a region's tetrahedra and their sums at the nodes that are complete with them, and tells what is found; without the energy unless it is asked for.
pub(super) fn evaluate(
    (region, gather): (&HyperelasticRegion, &Gather),
    scratch: &mut Scratch,
    set: InstructionSet,
    with_energy: bool,
) -> Result<Deformed, EvaluationError> {
    region.law.with_law(Forces {
        region,
        gather,
        scratch,
        set,
        with_energy,
    })
}

struct Forces<'a> {
    region: &'a HyperelasticRegion,
    gather: &'a Gather,
    scratch: &'a mut Scratch,
    set: InstructionSet,
    with_energy: bool,
}

impl LawVisitor for Forces<'_> {
    type Output = Result<Deformed, EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let Scratch {
            displacement,
            corners,
            sums,
            kept,
            ..
        } = self.scratch;
        self.set.with_vectors_or_numbers(Sweep {
            region: self.region,
            gather: self.gather,
            law,
            with_energy: self.with_energy,
            displacement,
            corners,
            sums,
            kept,
        })
    }
}

/// All loops over a region, for one law.
struct Sweep<'a, L> {
    region: &'a HyperelasticRegion,
    gather: &'a Gather,
    law: L,
    with_energy: bool,
    displacement: &'a [[f64; 4]],
    corners: &'a mut [[f64; 4]],
    sums: &'a mut [[f64; 4]],
    kept: &'a mut Kept,
}

impl<L: HyperelasticLaw> WithDouble for Sweep<'_, L> {
    type Output = Result<Deformed, EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(mut self) -> Self::Output {
        let region = self.region;
        let mut found = Found::<N>::none();
        for chunk in &region.chunks {
            if region.is_smoothed() {
                self.means(chunk, &mut found)?;
            }
            self.edges(chunk, &mut found)?;
            for chunk in &region.chunks[chunk.forces.clone()] {
                self.forces(chunk, &mut found)?;
                self.gather
                    .sum(chunk.nodes.clone(), self.corners, self.sums);
            }
        }
        Ok(found.over(&region.rest))
    }
}

impl<L: HyperelasticLaw> Sweep<'_, L> {
    /// Takes the mean dilation of each patch of a chunk, and keeps the gradients.
    #[inline(always)]
    fn means<N: Number<Real = f64>>(
        &mut self,
        chunk: &Chunk,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest) = (self.region, &self.region.rest);
        let keeps_rows = !region.edges_of.is_empty();
        for first in chunk.slots.clone().step_by(N::LANES) {
            let gradient = rest.gradient_of::<N>(first, self.displacement);
            let at = self.law.at(gradient);
            if !admits::<L, N>(&at.deformation) {
                return Err(refused_among::<L>(&lanes(at.volume_ratio), |lane| {
                    rest.tag(first + lane)
                }));
            }
            let volume = rest.volumes::<N>(first);
            let dilation = volume * self.law.dilation(&at);
            dilation.store(&mut self.kept.dilations[first..]);
            if keeps_rows {
                store(gradient.scaled(volume), &mut self.kept.gradients[first..]);
            } else {
                let to = &mut self.kept.chunk[9 * (first - chunk.slots.start)..];
                for (entry, to) in gradient
                    .0
                    .as_flattened()
                    .iter()
                    .zip(to.chunks_exact_mut(N::LANES))
                {
                    entry.store(to);
                }
            }
        }
        let lambda = self.law.lame().0;
        for patch in chunk.patches.clone() {
            let tets = region.patches.of(patch);
            let volume = region.patch_volumes[patch];
            // The tetrahedra of a patch are neighbours in memory.
            let first = tets.first().map_or(0, |tet| *tet as usize);
            let dilations = &mut self.kept.dilations[first..first + tets.len()];
            let mean = dilations.iter().sum::<f64>() / volume;
            dilations.fill(mean);
            found.energy_of_patches += 0.5 * volume * lambda * mean * mean;
        }
        Ok(())
    }

    /// Computes the stress at each edge that a chunk completes.
    #[inline(always)]
    fn edges<N: Number<Real = f64>>(
        &mut self,
        chunk: &Chunk,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest) = (self.region, &self.region.rest);
        let last = region.edges.count().saturating_sub(1);
        for first in chunk.edges.clone().step_by(N::LANES) {
            let mut sums = [[[0.0; 4]; 3]; LANES];
            for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
                // Room behind the last edge repeats it.
                *sum = rows_of(
                    &self.kept.gradients,
                    region.edges.of((first + lane).min(last)),
                );
            }
            let volume = N::load(&region.edge_volumes[first..]);
            let over = N::select_le(volume, N::of(0.0), N::of(0.0), volume.recip());
            let at = self.law.at(load::<N>(&sums).scaled(over));
            if !admits::<L, N>(&at.deformation) {
                return Err(refused_among::<L>(&lanes(at.volume_ratio), |lane| {
                    let tets = region.edges.of((first + lane).min(last));
                    tets.first().map_or(0, |tet| rest.tag(*tet as usize))
                }));
            }
            store(self.law.stress(&at), &mut self.kept.at_edges[first..]);
            if self.with_energy {
                let share = volume * N::of(region.edge_share / 6.0);
                found.energy = share.mul_add(self.law.energy(&at), found.energy);
            }
        }
        Ok(())
    }

    /// Computes the forces at the corners of the tetrahedra of a chunk.
    #[inline(always)]
    fn forces<N: Number<Real = f64>>(
        &mut self,
        chunk: &Chunk,
        found: &mut Found<N>,
    ) -> Result<(), EvaluationError> {
        let (region, rest) = (self.region, &self.region.rest);
        let (is_smoothed, has_edges) = (region.is_smoothed(), !region.edges_of.is_empty());
        let (lambda, own_share) = (self.law.lame().0, 1.0 - region.edge_share);
        for first in chunk.slots.clone().step_by(N::LANES) {
            let gradient = if is_smoothed && !has_edges {
                let from = &self.kept.chunk[9 * (first - chunk.slots.start)..];
                load_entries(from)
            } else {
                rest.gradient_of::<N>(first, self.displacement)
            };
            let at = self.law.at(gradient);
            if !admits::<L, N>(&at.deformation) {
                return Err(refused_among::<L>(&lanes(at.volume_ratio), |lane| {
                    rest.tag(first + lane)
                }));
            }
            let dilation = if is_smoothed {
                N::load(&self.kept.dilations[first..])
            } else {
                self.law.dilation(&at)
            };
            let bulk = N::of(lambda) * dilation;
            if self.with_energy {
                found.note(first, at.volume_ratio, rest);
                let mut density = N::of(own_share) * self.law.energy(&at);
                if !is_smoothed {
                    density = (N::of(0.5) * dilation).mul_add(bulk, density);
                }
                found.energy = rest.volumes::<N>(first).mul_add(density, found.energy);
            }
            let mut stress = self.law.stress(&at);
            if has_edges {
                let mut sums = [[[0.0; 4]; 3]; LANES];
                for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
                    *sum = rows_of(&self.kept.at_edges, &region.edges_of[first + lane]);
                }
                stress = stress.scaled(N::of(own_share));
                stress = stress.plus(N::of(region.edge_share / 6.0), load(&sums));
            }
            stress = stress.plus(bulk, self.law.dilation_gradient(&at));
            rest.forces(
                first,
                stress,
                &mut self.corners[4 * (region.first + first)..],
            );
        }
        Ok(())
    }
}

/// Lanes at most.
const LANES: usize = 8;

/// Whether a law is defined for a deformation, which is finite, in all lanes.
#[inline(always)]
fn admits<L: HyperelasticLaw, N: Number>(deformation: &Deformation<N>) -> bool {
    let ratio = deformation.volume_ratio;
    N::all_le(N::of(least::<L>()), ratio) && N::all_le(ratio, N::of(f64::MAX))
}

/// The smallest volume ratio that a law is defined for.
const fn least<L: HyperelasticLaw>() -> f64 {
    if L::DEFINED_WHEN_INVERTED {
        f64::MIN
    } else {
        SMALLEST_VOLUME_RATIO
    }
}

#[inline(always)]
fn lanes<N: Number<Real = f64>>(number: N) -> [f64; LANES] {
    let mut lanes = [1.0; LANES];
    number.store(&mut lanes);
    lanes
}

/// The error for the first lane that a law is not defined for.
#[cold]
#[inline(never)]
fn refused_among<L: HyperelasticLaw>(
    ratios: &[f64; LANES],
    tag: impl Fn(usize) -> u64,
) -> EvaluationError {
    let is_refused = |ratio: &f64| !(least::<L>()..=f64::MAX).contains(ratio);
    let lane = ratios.iter().position(is_refused).unwrap_or(0);
    refused::<L>(tag(lane), ratios[lane])
}

/// The sum of some tensors.
#[inline(always)]
fn rows_of(all: &[Rows], places: &[u32]) -> Rows {
    let [mut x, mut y, mut z] = [[0.0; 4]; 3];
    for place in places {
        let [other_x, other_y, other_z] = &all[*place as usize];
        x = row_sum(x, other_x);
        y = row_sum(y, other_y);
        z = row_sum(z, other_z);
    }
    [x, y, z]
}

#[inline(always)]
fn load<N: Number<Real = f64>>(from: &[Rows]) -> Tensor<N> {
    let rows = from.as_flattened();
    Tensor([
        N::load_rows(rows, 3),
        N::load_rows(&rows[1..], 3),
        N::load_rows(&rows[2..], 3),
    ])
}

#[inline(always)]
fn store<N: Number<Real = f64>>(tensor: Tensor<N>, to: &mut [Rows]) {
    let rows = to.as_flattened_mut();
    let [x, y, z] = tensor.0;
    N::store_rows(x, rows, 3);
    N::store_rows(y, &mut rows[1..], 3);
    N::store_rows(z, &mut rows[2..], 3);
}

/// The tensor whose entries stand one vector behind the other.
#[inline(always)]
fn load_entries<N: Number<Real = f64>>(from: &[f64]) -> Tensor<N> {
    let from = &from[..9 * N::LANES];
    let (first, rest) = from.split_at(3 * N::LANES);
    let (second, third) = rest.split_at(3 * N::LANES);
    Tensor([load_row(first), load_row(second), load_row(third)])
}

#[inline(always)]
fn load_row<N: Number<Real = f64>>(from: &[f64]) -> [N; 3] {
    [
        N::load(from),
        N::load(&from[N::LANES..]),
        N::load(&from[2 * N::LANES..]),
    ]
}
