//! Tetrahedra at rest, as loops over deformed ones read them.

use std::ops::Range;
use std::sync::Arc;

use sinew_mesh::TetMesh;
use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::Slot;
use crate::hyperelastic::Tensor;
use crate::tetra;

/// The tetrahedra of a region at rest, each quantity in an array of its own so that neighbours in memory fill a vector;
/// "side by side" are as many as the number has lanes.
#[derive(Debug)]
pub(crate) struct Rest<T = f64> {
    /// The four mesh nodes.
    nodes: Arc<[Vec<u32>; 4]>,
    /// Gradients (1/m) of the shape functions of the last three vertices; the first has minus their sum.
    gradients: [[Aligned<T>; 3]; 3],
    /// Volumes (m^3).
    volumes: Aligned<T>,
    /// Tags in the mesh, for messages.
    tags: Arc<Vec<u64>>,
}

impl Rest {
    /// The tetrahedra of a mesh at these places, none of which is flat.
    pub(super) fn of(mesh: &TetMesh, slots: &[Slot]) -> Self {
        let with_room = || Vec::with_capacity(slots.len());
        let mut nodes: [Vec<u32>; 4] = std::array::from_fn(|_| Vec::with_capacity(slots.len()));
        let mut gradients: [[Vec<f64>; 3]; 3] =
            std::array::from_fn(|_| std::array::from_fn(|_| with_room()));
        let (mut volumes, mut tags) = (with_room(), Vec::with_capacity(slots.len()));
        for slot in slots {
            let tet = slot.tet as usize;
            let of_tet = mesh.tets[tet];
            let vertices = tetra::vertices(&mesh.points, of_tet);
            let [_, others @ ..] = tetra::gradients(&vertices).unwrap_or_default();
            for (all, node) in nodes.iter_mut().zip(of_tet) {
                all.push(node);
            }
            for (all, gradient) in gradients.iter_mut().zip(others) {
                for (all, component) in all.iter_mut().zip(gradient) {
                    all.push(component);
                }
            }
            let volume = if slot.is_padding {
                0.0
            } else {
                mesh.volume(tet)
            };
            volumes.push(volume);
            tags.push(mesh.tet_tags[tet]);
        }
        Self {
            nodes: Arc::new(nodes),
            gradients: gradients.map(|of| of.map(|values| Aligned::from(&values[..]))),
            volumes: Aligned::from(&volumes[..]),
            tags: Arc::new(tags),
        }
    }

    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> Rest<T> {
        let rounded = |values: &Aligned<f64>| {
            let values: Vec<T> = values.iter().map(|value| T::of(*value)).collect();
            Aligned::from(&values[..])
        };
        Rest {
            nodes: Arc::clone(&self.nodes),
            gradients: self
                .gradients
                .each_ref()
                .map(|of| of.each_ref().map(rounded)),
            volumes: rounded(&self.volumes),
            tags: Arc::clone(&self.tags),
        }
    }

    /// The places of tetrahedra.
    pub(super) fn tets(&self) -> impl Iterator<Item = usize> {
        (0..self.count()).filter(|tet| self.is_taken(*tet))
    }

    /// The mean over some tetrahedra by volume.
    pub(super) fn mean(&self, tets: &[u32], of: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut volumes) = (0.0, 0.0);
        for tet in tets {
            let volume = self.volume(*tet as usize);
            sum += volume * of(*tet as usize);
            volumes += volume;
        }
        sum / volumes
    }

    /// [`Rest::gradient_of`] for a function of the node, in one tetrahedron.
    pub(super) fn gradient_by(&self, tet: usize, field: impl Fn(u32) -> [f64; 3]) -> Tensor<f64> {
        let [a, b, c, d] = self.nodes(tet).map(field);
        let edges = [b, c, d].map(|end| difference(end, a));
        Tensor::from_columns(edges) * Tensor(self.gradients(tet))
    }
}

impl<T: Real> Rest<T> {
    /// Number of places.
    pub(super) fn count(&self) -> usize {
        self.volumes.len()
    }

    /// Whether a place is taken by a tetrahedron, not by padding.
    pub(super) fn is_taken(&self, tet: usize) -> bool {
        self.volumes[tet] > T::default()
    }

    /// The four nodes of a tetrahedron.
    pub(super) fn nodes(&self, tet: usize) -> [u32; 4] {
        [0, 1, 2, 3].map(|vertex| self.nodes[vertex][tet])
    }

    pub(super) fn tag(&self, tet: usize) -> u64 {
        self.tags[tet]
    }

    /// The volume (m^3); 0 for padding.
    pub(super) fn volume(&self, tet: usize) -> T {
        self.volumes[tet]
    }

    /// The volumes (m^3) of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn volumes<N: Number<Real = T>>(&self, first: usize) -> N {
        N::load(&self.volumes[first..])
    }

    /// The gradients (1/m) of the shape functions of the last three vertices, of tetrahedra side by side.
    #[inline(always)]
    fn gradients<N: Number<Real = T>>(&self, first: usize) -> [[N; 3]; 3] {
        let [b, c, d] = &self.gradients;
        [
            side_by_side(b, first),
            side_by_side(c, first),
            side_by_side(d, first),
        ]
    }

    /// The gradients (1/m) of all four shape functions of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn all_gradients<N: Number<Real = T>>(&self, first: usize) -> [[N; 3]; 4] {
        let [b, c, d] = self.gradients(first);
        let none = [N::of(0.0); 3];
        let a = difference(difference(difference(none, b), c), d);
        [a, b, c, d]
    }

    /// One of the four nodes of some tetrahedra.
    pub(super) fn side_by_side(&self, vertex: usize, tets: Range<usize>) -> &[u32] {
        &self.nodes[vertex][tets]
    }

    /// The gradient, in tetrahedra side by side, of a field (m) that is given at all mesh nodes: row i, column j is the derivative of component
    /// i along j.
    #[inline(always)]
    pub(super) fn gradient_of<N: Number<Real = T>>(
        &self,
        first: usize,
        field: &[[T; 4]],
    ) -> Tensor<N> {
        let [a, b, c, d] = &*self.nodes;
        let a = N::gather_rows(field, &a[first..]);
        let b = N::gather_rows(field, &b[first..]);
        let c = N::gather_rows(field, &c[first..]);
        let d = N::gather_rows(field, &d[first..]);
        let edges = [difference(b, a), difference(c, a), difference(d, a)];
        Tensor::from_columns(edges) * Tensor(self.gradients(first))
    }

    /// Writes the forces (N) of a stress (Pa) on the four vertices of tetrahedra side by side, four rows for each.
    #[inline(always)]
    pub(super) fn forces<N: Number<Real = T>>(
        &self,
        first: usize,
        stress: Tensor<N>,
        out: &mut [[T; 4]],
    ) {
        let stress = stress.scaled(self.volumes(first));
        let [b, c, d] = self.gradients(first);
        let (b, c, d) = (stress.on(b), stress.on(c), stress.on(d));
        let none = [N::of(0.0); 3];
        let a = difference(difference(difference(none, b), c), d);
        N::store_rows(a, out, 4);
        N::store_rows(b, &mut out[1..], 4);
        N::store_rows(c, &mut out[2..], 4);
        N::store_rows(d, &mut out[3..], 4);
    }
}

// Functions, since a closure is not always inlined where vectors need it.

#[inline(always)]
fn side_by_side<N: Number>([x, y, z]: &[Aligned<N::Real>; 3], first: usize) -> [N; 3] {
    [
        N::load(&x[first..]),
        N::load(&y[first..]),
        N::load(&z[first..]),
    ]
}

#[inline(always)]
fn difference<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
