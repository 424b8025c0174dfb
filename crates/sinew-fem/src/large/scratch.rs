//! Scratch space for evaluations.

use sinew_sparse::simd::{Aligned, Real, Shared, SharedSlice};

use super::kept::{Rows, load, no_rows};
use super::last_evaluation::LastEvaluation;
use super::region::HyperelasticRegion;
use super::rooms::Rooms;
use crate::hyperelastic::Tensor;

/// Scratch space for one evaluation, reused by the next.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// Displacement (m) of all mesh nodes, and a number to fill a row.
    pub(crate) displacement: Aligned<[f64; 4]>,
    /// Change of the displacement, for products.
    pub(crate) change: Vec<[f64; 4]>,
    /// Sums of forces (N) at each node that has corners, in the order of [`super::gather::Gather`].
    pub(super) sums: Vec<[f64; 4]>,
    /// The evaluation that `sums` are of.
    pub(super) last: LastEvaluation,
    /// Values that force loops keep.
    pub(super) kept: Kept<f64>,
    /// Values that products keep.
    pub(super) product: ProductRooms,
    /// Gradient of the displacement in each tetrahedron of a region, if means are taken.
    pub(super) gradients: Vec<Rows<f64>>,
    /// Dilation of each tetrahedron times its volume (m^3).
    pub(super) dilations_of_tets: Vec<f64>,
    /// Mean dilation of each patch.
    pub(super) dilations: Vec<f64>,
}

/// Values that the loops of products keep from one task to another (those of forces are in [`Kept`]); empty until a
/// product is made.
#[derive(Debug, Default)]
pub(super) struct ProductRooms {
    /// Gradients of the displacement, and of its change, times volumes, if edges take means.
    pub(super) gradients: [Vec<Rows<f64>>; 2],
    /// Changes of the stress (Pa) at edges.
    pub(super) at_edges: Vec<Rows<f64>>,
    /// The mean dilation of the patch of each tetrahedron, and its change times the patch's share of the stiffness.
    pub(super) dilations: [Vec<f64>; 2],
    /// Changes of the forces (N) at the corners of tetrahedra, each with 0 to fill a row.
    pub(super) corners: Vec<[f64; 4]>,
}

impl ProductRooms {
    /// Makes space for products with these regions.
    pub(super) fn reserve(&mut self, regions: &[HyperelasticRegion], rooms: &Rooms) {
        let smoothed = regions.iter().filter(|region| region.is_smoothed());
        let smoothed = smoothed.map(|region| region.rest.count()).sum();
        for gradients in &mut self.gradients {
            gradients.resize(rooms.gradients_count, no_rows());
        }
        self.at_edges.resize(rooms.edges_count, no_rows());
        for dilations in &mut self.dilations {
            dilations.resize(smoothed, 0.0);
        }
        self.corners.resize(rooms.corners_count, [0.0; 4]);
    }
}

/// The largest count over regions that take means.
fn most(regions: &[HyperelasticRegion], count: impl Fn(&HyperelasticRegion) -> usize) -> usize {
    let smoothed = regions.iter().filter(|region| region.is_smoothed());
    smoothed.map(count).max().unwrap_or(0)
}

/// Values that force loops keep from one task to another. The threads of an evaluation share it.
#[derive(Debug)]
pub(super) struct Kept<T> {
    /// The mean dilation of the patch of each tetrahedron.
    dilations: Shared<T>,
    /// The gradients of the displacement in the tetrahedra of a chunk, vector by vector, then the stress (Pa) in
    /// addition to the law's; for each part.
    chunks: Shared<T>,
    /// Numbers for one part, and those of gradients among them.
    chunk: usize,
    gradients_of_chunk: usize,
    /// Gradients of the displacement times volumes, by rows; if edges take means.
    gradients: Shared<Rows<T>>,
    /// Stresses (Pa) at edges by rows.
    at_edges: Shared<Rows<T>>,
    /// Forces (N) at the corners of tetrahedra, each with 0 to fill a row.
    corners: Shared<[T; 4]>,
}

/// Arrays through which the tasks of force loops exchange values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places<'a, T> {
    /// Displacement (m) of all mesh nodes.
    pub(super) displacement: &'a [[T; 4]],
    pub(super) corners: SharedSlice<'a, [T; 4]>,
    pub(super) sums: SharedSlice<'a, [T; 4]>,
    pub(super) dilations: SharedSlice<'a, T>,
    pub(super) chunks: SharedSlice<'a, T>,
    /// Numbers of `chunks` for one part.
    pub(super) chunk: usize,
    /// Numbers for gradients among them, before those for the stress in addition to the law's.
    pub(super) gradients_of_chunk: usize,
    pub(super) gradients: SharedSlice<'a, Rows<T>>,
    pub(super) at_edges: SharedSlice<'a, Rows<T>>,
}

impl<T: Copy> Places<'_, T> {
    /// True if all assigned blocks are within the arrays.
    pub(super) fn hold(&self, rooms: &Rooms) -> bool {
        rooms.corners.count() <= self.corners.count()
            && rooms.gradients_count <= self.gradients.count()
            && rooms.edges_count <= self.at_edges.count()
            && rooms.corners_count <= self.corners.count()
    }
}

impl<T: Real> Kept<T> {
    /// Arrays for regions that are processed in `parts` parts.
    pub(super) fn new(regions: &[HyperelasticRegion], rooms: &Rooms, parts: usize) -> Self {
        Self::filled(regions, rooms, parts, T::default())
    }

    /// Same as [`Kept::new`], with this number everywhere.
    pub(super) fn filled(
        regions: &[HyperelasticRegion],
        rooms: &Rooms,
        parts: usize,
        with: T,
    ) -> Self {
        let smoothed = || regions.iter().filter(|region| region.is_smoothed());
        let keep = regions
            .iter()
            .filter(|region| region.is_smoothed() || region.has_beside());
        let chunks = keep.flat_map(|region| &region.chunks);
        let gradients = 9 * chunks.map(|chunk| chunk.slots.len()).max().unwrap_or(0);
        let beside = if regions.iter().any(HyperelasticRegion::has_beside) {
            gradients
        } else {
            0
        };
        let chunk = gradients + beside;
        let zeros = |count| Shared::filled(with, count);
        let rows = |count| Shared::filled([[with; 4]; 3], count);
        Self {
            dilations: zeros(smoothed().map(|region| region.rest.count()).sum()),
            chunks: zeros(chunk * parts),
            chunk,
            gradients_of_chunk: gradients,
            gradients: rows(rooms.gradients_count),
            at_edges: rows(rooms.edges_count),
            corners: Shared::filled([with; 4], rooms.corners_count),
        }
    }

    /// All places of an evaluation, together with displacements and sums of forces.
    pub(super) fn places<'a>(
        &'a self,
        displacement: &'a [[T; 4]],
        sums: SharedSlice<'a, [T; 4]>,
    ) -> Places<'a, T> {
        Places {
            displacement,
            sums,
            corners: self.corners.slice(),
            dilations: self.dilations.slice(),
            chunks: self.chunks.slice(),
            chunk: self.chunk,
            gradients_of_chunk: self.gradients_of_chunk,
            gradients: self.gradients.slice(),
            at_edges: self.at_edges.slice(),
        }
    }
}

impl Scratch {
    /// Scratch space for `nodes` nodes of the mesh, `taken` of which are in regions.
    pub(super) fn new(
        [nodes, taken]: [usize; 2],
        regions: &[HyperelasticRegion],
        rooms: &Rooms,
    ) -> Self {
        let smoothed = most(regions, |region| region.rest.count());
        Self {
            displacement: Aligned::filled([0.0; 4], nodes),
            change: vec![[0.0; 4]; nodes],
            sums: vec![[0.0; 4]; taken],
            last: LastEvaluation::none(nodes),
            kept: Kept::new(regions, rooms, 1),
            gradients: vec![no_rows(); smoothed],
            product: ProductRooms::default(),
            dilations_of_tets: vec![0.0; smoothed],
            dilations: vec![0.0; most(regions, |region| region.patches.count())],
        }
    }

    /// The gradient of the displacement in a tetrahedron of a region, if means are taken.
    pub(super) fn gradient(&self, tet: usize) -> Tensor<f64> {
        load(&self.gradients[tet..])
    }

    /// The places of an evaluation in f64, which no other code uses during it.
    pub(super) fn places(&mut self) -> Places<'_, f64> {
        let sums = SharedSlice::of(&mut self.sums);
        self.kept.places(&self.displacement, sums)
    }
}

/// Writes a field over all nodes.
pub(crate) fn fill(out: &mut [[f64; 4]], field: impl Fn(u32) -> [f64; 3]) {
    for (node, out) in (0..).zip(out) {
        let [x, y, z] = field(node);
        *out = [x, y, z, 0.0];
    }
}
