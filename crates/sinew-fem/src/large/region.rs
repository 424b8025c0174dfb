//! A region of hyperelastic tetrahedra.

use std::sync::{Arc, OnceLock};

use sinew_mesh::TetMesh;
use sinew_sparse::simd::{Number, Real};

use super::axes::RegionAxes;
use super::chunks::{Chunk, LANES, Slot};
use super::fibres::{Directions, RegionFibres};
use super::memory::RegionMemory;
use super::rest::{FirstAlike, Rest};
use super::stiffness::Stiffness;
use crate::frame::{Axes, UnitVectors};
use crate::hyperelastic::{SingularValues, Tensor};
use crate::shares::Shares;
use crate::smoothing::{Average, Sets, Smoothing};
use crate::tissue::Tissue;

/// The properties of a region of hyperelastic tetrahedra that its material states in addition to the law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionLaw<'a> {
    /// Lame's second constant (Pa) of the stiffest tetrahedron.
    pub(crate) mu: f64,
    /// The least density (kg/m^3).
    pub(crate) density: f64,
    /// Share of the local energy that is averaged over edges.
    pub(crate) edge_share: f64,
    pub(crate) tissue: &'a Tissue,
    /// The stiffness of each tetrahedron of the mesh over that of the law.
    pub(crate) shares: &'a Shares,
    /// The direction of each family of fibres in each tetrahedron of the mesh; `None` if all have that of the tissue.
    pub(crate) directions: &'a [Option<UnitVectors>],
    /// The material's axes, if its law has some.
    pub(crate) axes: Option<&'a Axes>,
}

/// A region of hyperelastic tetrahedra, with its own numbering.
#[derive(Clone, Debug)]
pub(crate) struct HyperelasticRegion {
    /// Factors of its energies; `None` if all tetrahedra are equally stiff.
    stiffness: Option<Arc<Stiffness>>,
    /// Families of fibres.
    pub(super) fibres: Vec<RegionFibres>,
    /// The material's axes, if its law has some.
    pub(super) axes: Option<RegionAxes>,
    pub(super) memory: Option<RegionMemory>,
    pub(super) rest: Arc<Rest>,
    /// Place of its first tetrahedron among those of all such regions.
    pub(super) first: usize,
    /// First places of the region in arrays over the regions that need them.
    pub(super) kept: FirstPlaces,
    /// Its tetrahedra in the order in which they are processed.
    pub(super) chunks: Vec<Chunk>,
    /// Share of the local energy that is averaged over edges.
    pub(super) edge_share: f64,
    /// The tetrahedra at each edge; none if `edge_share` is 0.
    pub(super) edges: Sets,
    /// The volume (m^3) of the tetrahedra at each edge, then zeros to fill a vector.
    pub(super) edge_volumes: Arc<[f64]>,
    /// The six edges of each tetrahedron.
    pub(super) edges_of: Vec<[u32; 6]>,
    /// The tetrahedra of each patch; none if dilations are not averaged.
    pub(super) patches: Sets,
    /// The volume (m^3) of each patch.
    pub(super) patch_volumes: Arc<[f64]>,
    /// The patch of each tetrahedron.
    pub(super) patch_of: Vec<u32>,
    /// The mean gradients at each edge, made for the first tangent or own blocks: explicit runs need none.
    edge_averages: OnceLock<Vec<Average>>,
    density: f64,
    /// See [`Self::wave_numbers`].
    wave_numbers: OnceLock<Vec<f64>>,
}

impl HyperelasticRegion {
    /// The region of the tetrahedra at these places, with its sets from those of the body.
    pub(super) fn new(
        (mesh, alike): (&TetMesh, &FirstAlike),
        smoothing: &Smoothing,
        RegionLaw {
            mu,
            density,
            edge_share,
            tissue,
            shares,
            directions,
            axes,
        }: RegionLaw<'_>,
        (slots, chunks): (&[Slot], Vec<Chunk>),
        (first, kept): (usize, FirstPlaces),
    ) -> Self {
        let mut edges_of: Vec<[u32; 6]> = Vec::new();
        let mut patch_of = Vec::new();
        for slot in slots {
            let tet = slot.tet as usize;
            edges_of.extend(smoothing.edges_of(tet));
            patch_of.extend(smoothing.patch_of(tet).map(|patch| patch as u32));
        }
        let edges = order_edges(&mut edges_of, slots, &chunks);
        let patches = numbered_anew(patch_of.iter_mut());
        let taken = (0u32..).zip(slots).filter(|(_, slot)| !slot.is_padding);
        let taken = taken.map(|(place, _)| place);
        let of_edge = taken.clone().flat_map(|tet| {
            let edges = edges_of.get(tet as usize).into_iter().flatten();
            edges.map(move |edge| (*edge, tet))
        });
        let of_patch = taken.filter_map(|tet| Some((*patch_of.get(tet as usize)?, tet)));
        let edges = Sets::from_pairs(edges, of_edge);
        let patches = Sets::from_pairs(patches, of_patch);
        let rest = Rest::of(mesh, alike, slots);
        let volumes = |sets: &Sets| -> Vec<f64> {
            let volume = |set| sets.of(set).iter().map(|tet| rest.volume(*tet as usize));
            (0..sets.count()).map(|set| volume(set).sum()).collect()
        };
        let mut edge_volumes = volumes(&edges);
        edge_volumes.resize(edges.count().next_multiple_of(LANES), 0.0);
        let stiffness = shares.vary().then(|| {
            let of_slots = slots.iter().map(|slot| shares.of(slot.tet as usize));
            let of_slots: Vec<f64> = of_slots.collect();
            Arc::new(Stiffness::new(&of_slots, &rest, [&edges, &patches]))
        });
        Self {
            stiffness,
            fibres: {
                let factor = tissue.factor_of_fibres();
                let families = tissue.fibres.iter().zip(directions);
                let made = families
                    .map(|(family, all)| RegionFibres::new(family, factor, slots, all.as_deref()));
                made.collect()
            },
            axes: axes.map(|axes| RegionAxes::new(axes, slots)),
            memory: tissue.memory.as_ref().map(|memory| {
                let points = [rest.count(), edge_volumes.len()];
                RegionMemory::new(memory, mu, kept.variables, points)
            }),
            first,
            kept,
            chunks,
            edge_share,
            patch_volumes: volumes(&patches).into(),
            edge_volumes: edge_volumes.into(),
            edges,
            patches,
            rest: Arc::new(rest),
            edges_of,
            patch_of,
            edge_averages: OnceLock::new(),
            density,
            wave_numbers: OnceLock::new(),
        }
    }

    /// Data of the region that force loops read.
    pub(super) fn numbers(&self) -> Numbers<f64> {
        Numbers {
            rest: Arc::clone(&self.rest),
            edge_volumes: Arc::clone(&self.edge_volumes),
            patch_volumes: Arc::clone(&self.patch_volumes),
            stiffness: self.stiffness.clone(),
            directions: {
                let families = self.fibres.iter();
                families.map(|family| family.directions.clone()).collect()
            },
            axes: self.axes.clone(),
        }
    }

    /// Factors of the law's energies in tetrahedra side by side.
    #[inline(always)]
    pub(super) fn stiffness_of_tets<N: Number<Real = f64>>(&self, first: usize) -> N {
        let stiffness = self.stiffness.as_ref();
        stiffness.map_or(N::of(1.0), |stiffness| stiffness.of_tets(first))
    }

    /// [`Self::stiffness_of_tets`] at the mean deformation of edges side by side.
    #[inline(always)]
    pub(super) fn stiffness_at_edges<N: Number<Real = f64>>(&self, first: usize) -> N {
        let stiffness = self.stiffness.as_ref();
        stiffness.map_or(N::of(1.0), |stiffness| stiffness.at_edges(first))
    }

    /// [`Self::stiffness_of_tets`] at the mean dilation of a patch.
    #[inline(always)]
    pub(super) fn stiffness_of_patch(&self, patch: usize) -> f64 {
        let stiffness = self.stiffness.as_ref();
        stiffness.map_or(1.0, |stiffness| stiffness.of_patch(patch))
    }

    /// [`Self::stiffness_of_patch`] of the patches of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn stiffness_of_patches<N: Number<Real = f64>>(&self, first: usize) -> N {
        let Some(stiffness) = &self.stiffness else {
            return N::of(1.0);
        };
        N::from_lanes(|lane| stiffness.of_patch(self.patch_of[first + lane] as usize))
    }

    /// The first places after those of this region.
    pub(super) fn next_places(&self) -> FirstPlaces {
        let tets = if self.is_smoothed() {
            self.rest.count()
        } else {
            0
        };
        FirstPlaces {
            tets: self.kept.tets + tets,
            variables: self.kept.variables
                + self.memory.as_ref().map_or(0, RegionMemory::variables),
        }
    }

    /// Nodes, volume (m^3) and gradients (1/m) of a tetrahedron.
    pub(super) fn tet(&self, tet: usize) -> ([u32; 4], f64, [[f64; 3]; 4]) {
        let rest = &self.rest;
        (rest.nodes(tet), rest.volume(tet), rest.all_gradients(tet))
    }

    /// The mean gradients at each edge.
    pub(super) fn edge_averages(&self) -> &[Average] {
        self.edge_averages.get_or_init(|| {
            let average = |edge| {
                let mut average = Average::default();
                average.of(self
                    .edges
                    .of(edge)
                    .iter()
                    .map(|tet| self.tet(*tet as usize)));
                average
            };
            (0..self.edges.count()).map(average).collect()
        })
    }

    /// Squares (1/m^2) of the largest wave number of each tetrahedron, over the density: times a modulus (Pa), the
    /// square of a frequency (1/s^2), each node having a quarter of the mass. 0 for padding.
    pub(super) fn wave_numbers(&self) -> &[f64] {
        self.wave_numbers.get_or_init(|| {
            let of_tet = |tet| {
                if !self.rest.is_taken(tet) {
                    return 0.0;
                }
                let rows = self.rest.all_gradients::<f64>(tet);
                let outer = |sum, row| Tensor::plus(sum, 1.0, Tensor::outer(row, row));
                let squares = rows.into_iter().fold(Tensor::<f64>::zero(), outer);
                4.0 * SingularValues::of(squares).values[0] / self.density
            };
            (0..self.rest.count()).map(of_tet).collect()
        })
    }

    /// An edge by its place among vectors of edges: padding after the last one repeats it.
    #[inline(always)]
    pub(super) fn edge_at(&self, place: usize) -> usize {
        place.min(self.edges.count().saturating_sub(1))
    }

    /// True if loops need neither axes nor stress in addition to the law's.
    pub(super) fn is_plain(&self) -> bool {
        !self.has_beside() && self.axes.is_none()
    }

    /// True if there is stress in addition to the law's: that of fibres, or the remainder of earlier stress.
    pub(super) fn has_beside(&self) -> bool {
        !self.fibres.is_empty() || self.memory.is_some()
    }

    /// True if tetrahedra take any mean with others.
    pub(super) fn is_smoothed(&self) -> bool {
        !self.patch_of.is_empty()
    }

    /// The mean of tensors over a set by volume.
    #[inline(always)]
    pub(super) fn mean_tensor(
        &self,
        tets: &[u32],
        mut of: impl FnMut(usize) -> Tensor<f64>,
    ) -> Tensor<f64> {
        let (mut sum, mut volumes) = (Tensor::zero(), 0.0);
        for tet in tets {
            let volume = self.rest.volume(*tet as usize);
            sum = sum.plus(volume, of(*tet as usize));
            volumes += volume;
        }
        sum.scaled(volumes.recip())
    }
}

/// Places of a region among those of all regions that need them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FirstPlaces {
    /// Place of its first tetrahedron, if patches take means.
    pub(super) tets: usize,
    /// Place of its first internal variable.
    pub(super) variables: usize,
}

/// Data of a region that force loops read, in their own precision.
#[derive(Clone, Debug)]
pub(super) struct Numbers<T> {
    pub(super) rest: Arc<Rest<T>>,
    /// The volume (m^3) of the tetrahedra at each edge, then zeros to fill a vector.
    pub(super) edge_volumes: Arc<[T]>,
    /// The volume (m^3) of each patch.
    pub(super) patch_volumes: Arc<[T]>,
    /// Factors of the law's energies; `None` if all tetrahedra are equally stiff.
    pub(super) stiffness: Option<Arc<Stiffness<T>>>,
    /// The directions of each family of fibres.
    pub(super) directions: Vec<Directions<T>>,
    /// The material's axes, if its law has some.
    pub(super) axes: Option<RegionAxes<T>>,
}

impl Numbers<f64> {
    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> Numbers<T> {
        let rounded = |values: &[f64]| values.iter().map(|value| T::of(*value)).collect();
        Numbers {
            rest: Arc::new(self.rest.rounded()),
            edge_volumes: rounded(&self.edge_volumes),
            patch_volumes: rounded(&self.patch_volumes),
            stiffness: self.stiffness.as_ref().map(|own| Arc::new(own.rounded())),
            directions: self.directions.iter().map(Directions::rounded).collect(),
            axes: self.axes.as_ref().map(RegionAxes::rounded),
        }
    }
}

/// Numbers edges by the chunk of the last tetrahedron of each, those of one chunk by how many tetrahedra they have: so
/// they are completed in order, and loops over tetrahedra at edges have similar lengths for edges side by side. Returns
/// their number.
fn order_edges(edges_of: &mut [[u32; 6]], slots: &[Slot], chunks: &[Chunk]) -> usize {
    let count = numbered_anew(edges_of.as_flattened_mut().iter_mut());
    let mut keys = vec![(0, 0); count];
    for (number, chunk) in chunks.iter().enumerate() {
        for place in chunk
            .slots
            .clone()
            .filter(|place| !slots[*place].is_padding)
        {
            for edge in edges_of.get(place).into_iter().flatten() {
                let (last, tets) = &mut keys[*edge as usize];
                (*last, *tets) = (number, *tets + 1);
            }
        }
    }
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_by_key(|edge| keys[*edge as usize]);
    let mut place = vec![0; count];
    for (new, old) in (0..).zip(order) {
        place[old as usize] = new;
    }
    for edge in edges_of.as_flattened_mut() {
        *edge = place[*edge as usize];
    }
    count
}

/// Replaces numbers by 0, 1, .. in the order in which they first appear; returns the number of different ones.
fn numbered_anew<'a>(numbers: impl Iterator<Item = &'a mut u32>) -> usize {
    let mut known = std::collections::HashMap::new();
    for number in numbers {
        let next = known.len() as u32;
        *number = *known.entry(*number).or_insert(next);
    }
    known.len()
}
