//! Tetrahedra at rest, in the format for loops over deformed ones.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::sync::Arc;

use sinew_mesh::TetMesh;
use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::{LANES, Slot};
use crate::hyperelastic::Tensor;
use crate::tetra;

/// The tetrahedra of a region at rest, in blocks of as many as the widest vector has lanes, so that a loop reads few
/// streams of memory; "side by side" are as many as the number has lanes, all in one block.
#[derive(Debug)]
pub(crate) struct Rest<T = f64> {
    nodes: Arc<Nodes>,
    shapes: Aligned<Shapes<T>>,
    /// Tags in the mesh, for messages.
    tags: Arc<Vec<u64>>,
}

/// The mesh nodes of all tetrahedra.
#[derive(Debug)]
struct Nodes {
    /// Four times the four nodes, vertex by vertex, of each block: their places among the numbers of a field in rows of four.
    blocks: Aligned<[[u32; LANES]; 4]>,
    /// Number of mesh nodes: all nodes are below.
    count: usize,
}

/// Gradients (1/m) of the shape functions of the last three vertices, component by component, and the volumes (m^3), of a block. The first shape function has
/// minus the sum of the others' gradients.
type Shapes<T> = [[T; LANES]; 10];

/// Place of the volumes among [`Shapes`].
const VOLUMES: usize = 9;

impl Rest {
    /// The tetrahedra of a mesh at these places, none of which is flat: places for whole blocks.
    pub(super) fn of(mesh: &TetMesh, slots: &[Slot]) -> Self {
        let count = slots.len() / LANES;
        let mut nodes = Aligned::filled([[0; LANES]; 4], count);
        let mut shapes = Aligned::filled([[0.0; LANES]; 10], count);
        let blocks = slots.chunks_exact(LANES);
        for ((slots, nodes), shapes) in blocks.zip(nodes.iter_mut()).zip(shapes.iter_mut()) {
            for (lane, slot) in slots.iter().enumerate() {
                let tet = slot.tet as usize;
                let of_tet = mesh.tets[tet];
                for (nodes, node) in nodes.iter_mut().zip(of_tet) {
                    nodes[lane] = 4 * node;
                }
                let vertices = tetra::vertices(&mesh.points, of_tet);
                let [_, others @ ..] = tetra::gradients(&vertices).unwrap_or_default();
                for (entries, entry) in shapes.iter_mut().zip(others.as_flattened()) {
                    entries[lane] = *entry;
                }
                if !slot.is_padding {
                    shapes[VOLUMES][lane] = mesh.volume(tet);
                }
            }
        }
        let tags = slots.iter().map(|slot| mesh.tet_tags[slot.tet as usize]);
        Self {
            nodes: Arc::new(Nodes {
                blocks: nodes,
                count: mesh.points.len(),
            }),
            shapes,
            tags: Arc::new(tags.collect()),
        }
    }

    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> Rest<T> {
        let rounded = |shapes: &Shapes<f64>| shapes.map(|entries| entries.map(T::of));
        let shapes: Vec<Shapes<T>> = self.shapes.iter().map(rounded).collect();
        Rest {
            nodes: Arc::clone(&self.nodes),
            shapes: Aligned::from(&shapes[..]),
            tags: Arc::clone(&self.tags),
        }
    }

    /// The places of tetrahedra.
    pub(super) fn tets(&self) -> impl Iterator<Item = usize> {
        (0..self.count()).filter(|tet| self.is_taken(*tet))
    }

    /// The mean over some tetrahedra by volume.
    pub(super) fn mean(&self, tets: &[u32], mut of: impl FnMut(usize) -> f64) -> f64 {
        let (mut sum, mut volumes) = (0.0, 0.0);
        for tet in tets {
            let volume = self.volume(*tet as usize);
            sum += volume * of(*tet as usize);
            volumes += volume;
        }
        sum / volumes
    }

    /// Same as [`Rest::gradient_of`], for a function of the node, in one tetrahedron.
    pub(super) fn gradient_by(&self, tet: usize, field: impl Fn(u32) -> [f64; 3]) -> Tensor<f64> {
        let [a, b, c, d] = self.nodes(tet).map(field);
        let edges = [b, c, d].map(|end| difference(end, a));
        Tensor::from_columns(edges) * Tensor(self.gradients(tet))
    }
}

impl<T: Real> Rest<T> {
    /// Number of places.
    pub(super) fn count(&self) -> usize {
        self.tags.len()
    }

    /// True if a place contains a tetrahedron, not padding.
    pub(super) fn is_taken(&self, tet: usize) -> bool {
        self.volume(tet) > T::default()
    }

    /// The four nodes of a tetrahedron.
    pub(super) fn nodes(&self, tet: usize) -> [u32; 4] {
        self.nodes.blocks[tet / LANES].map(|nodes| nodes[tet % LANES] / 4)
    }

    pub(super) fn tag(&self, tet: usize) -> u64 {
        self.tags[tet]
    }

    /// The volume (m^3); 0 for padding.
    pub(super) fn volume(&self, tet: usize) -> T {
        self.shapes[tet / LANES][VOLUMES][tet % LANES]
    }

    /// The volumes (m^3) of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn volumes<N: Number<Real = T>>(&self, first: usize) -> N {
        N::load(&self.shapes[first / LANES][VOLUMES][first % LANES..])
    }

    /// The gradients (1/m) of the shape functions of the last three vertices, of tetrahedra side by side.
    #[inline(always)]
    fn gradients<N: Number<Real = T>>(&self, first: usize) -> [[N; 3]; 3] {
        let (block, lane) = (&self.shapes[first / LANES], first % LANES);
        [
            gradient(block, 0, lane),
            gradient(block, 3, lane),
            gradient(block, 6, lane),
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

    /// One of the four nodes of the tetrahedra from one to the end of its block.
    pub(super) fn nodes_from(&self, vertex: usize, first: usize) -> impl Iterator<Item = u32> {
        let places = &self.nodes.blocks[first / LANES][vertex][first % LANES..];
        places.iter().map(|place| place / 4)
    }

    /// The gradient, in tetrahedra side by side, of a field (m) that is given at all mesh nodes: row i, column j is the derivative of component
    /// i along j.
    #[inline(always)]
    pub(super) fn gradient_of<N: Number<Real = T>>(
        &self,
        first: usize,
        field: &[[T; 4]],
    ) -> Tensor<N> {
        assert!(self.nodes.count <= field.len());
        let [a, b, c, d] = &self.nodes.blocks[first / LANES];
        let lane = first % LANES;
        // SAFETY: all nodes, a fourth of these, are below the number of mesh nodes.
        let [a, b, c, d] = unsafe {
            [
                N::gather_rows(field, &a[lane..]),
                N::gather_rows(field, &b[lane..]),
                N::gather_rows(field, &c[lane..]),
                N::gather_rows(field, &d[lane..]),
            ]
        };
        let edges = [difference(b, a), difference(c, a), difference(d, a)];
        Tensor::from_columns(edges) * Tensor(self.gradients(first))
    }

    /// Writes the forces (N) of a stress times the volume (J) on the four vertices of tetrahedra side by side, at their places ([`corner`]) in `out`, which begins
    /// with the first of their block.
    #[inline(always)]
    pub(super) fn forces<N: Number<Real = T>>(
        &self,
        first: usize,
        stress: Tensor<N>,
        out: &mut [[T; 4]],
    ) {
        let [b, c, d] = self.gradients(first);
        let (b, c, d) = (stress.on(b), stress.on(c), stress.on(d));
        let none = [N::of(0.0); 3];
        let a = difference(difference(difference(none, b), c), d);
        let out = &mut out[first % LANES..];
        N::store_rows(a, out, 1);
        N::store_rows(b, &mut out[LANES..], 1);
        N::store_rows(c, &mut out[2 * LANES..], 1);
        N::store_rows(d, &mut out[3 * LANES..], 1);
    }
}

// Functions, since a closure is not always inlined where vectors need it.

/// A gradient whose components begin at an entry of a block.
#[inline(always)]
fn gradient<N: Number>(block: &Shapes<N::Real>, entry: usize, lane: usize) -> [N; 3] {
    [
        N::load(&block[entry][lane..]),
        N::load(&block[entry + 1][lane..]),
        N::load(&block[entry + 2][lane..]),
    ]
}

#[inline(always)]
fn difference<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
