//! Tetrahedra at rest, in the format for loops over deformed ones.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::collections::HashMap;
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
    /// The place of each block's shapes in `shapes`: on lattices blocks share them, and loops read a tenth of the memory.
    shape_of: Arc<[u32]>,
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
    pub(super) fn of(mesh: &TetMesh, alike: &FirstAlike, slots: &[Slot]) -> Self {
        let count = slots.len() / LANES;
        let mut nodes = Aligned::filled([[0; LANES]; 4], count);
        let mut all = AllShapes::new(!alike.0.is_empty(), count);
        for (slots, nodes) in slots.chunks_exact(LANES).zip(nodes.iter_mut()) {
            let mut shapes = [[0.0; LANES]; 10];
            for (lane, slot) in slots.iter().enumerate() {
                for (nodes, node) in nodes.iter_mut().zip(mesh.tets[slot.tet as usize]) {
                    nodes[lane] = 4 * node;
                }
                let own = shape(mesh, alike.of(slot.tet));
                for (entries, entry) in shapes.iter_mut().zip(own) {
                    entries[lane] = entry;
                }
                if slot.is_padding {
                    shapes[VOLUMES][lane] = 0.0;
                }
            }
            all.add(shapes);
        }
        let tags = slots.iter().map(|slot| mesh.tet_tags[slot.tet as usize]);
        Self {
            nodes: Arc::new(Nodes {
                blocks: nodes,
                count: mesh.points.len(),
            }),
            shapes: Aligned::from(&all.shapes[..]),
            shape_of: all.of.into(),
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
            shape_of: Arc::clone(&self.shape_of),
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
        self.shapes_at(tet)[VOLUMES][tet % LANES]
    }

    /// The shapes of the block of a tetrahedron.
    #[inline(always)]
    fn shapes_at(&self, tet: usize) -> &Shapes<T> {
        &self.shapes[self.shape_of[tet / LANES] as usize]
    }

    /// The volumes (m^3) of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn volumes<N: Number<Real = T>>(&self, first: usize) -> N {
        N::load(&self.shapes_at(first)[VOLUMES][first % LANES..])
    }

    /// The gradients (1/m) of the shape functions of the last three vertices, of tetrahedra side by side.
    #[inline(always)]
    fn gradients<N: Number<Real = T>>(&self, first: usize) -> [[N; 3]; 3] {
        let (block, lane) = (self.shapes_at(first), first % LANES);
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

/// Gradients (1/m) of the shape functions of the last three vertices of a tetrahedron, and its volume (m^3).
fn shape(mesh: &TetMesh, tet: u32) -> [f64; 10] {
    let tet = tet as usize;
    let vertices = tetra::vertices(&mesh.points, mesh.tets[tet]);
    let [_, others @ ..] = tetra::gradients(&vertices).unwrap_or_default();
    let mut shape = [0.0; 10];
    for (entry, own) in shape.iter_mut().zip(others.as_flattened()) {
        *entry = *own;
    }
    shape[VOLUMES] = mesh.volume(tet);
    shape
}

/// Difference of shapes, as a share of the largest number of their kind, up to which they are the same: positions of a
/// lattice are rounded.
const ALIKE: f64 = 1e-12;

/// Least number of tetrahedra whose shapes are shared: those of smaller bodies stay in the second-level cache, and each cut
/// would find them again.
const LEAST_SHARED: usize = 16_384;

/// The first tetrahedron of the mesh that has the shape of each one: so equal ones have the same bits, in any region.
/// Empty for a mesh whose shapes are not shared.
#[derive(Debug)]
pub(super) struct FirstAlike(Vec<u32>);

impl FirstAlike {
    /// Finds them.
    pub(super) fn new(mesh: &TetMesh) -> Self {
        let all = 0..mesh.tets.len() as u32;
        if mesh.tets.len() < LEAST_SHARED {
            return Self(Vec::new());
        }
        let mut known: HashMap<u64, u32> = HashMap::new();
        let first = |tet: u32| {
            let own = shape(mesh, tet);
            let gradients = own[..VOLUMES].iter();
            let scale = gradients.fold(0.0, |most: f64, entry| most.max(entry.abs()));
            let size = (1e6 * scale.log2()).round() as i64;
            let rounded = own[..VOLUMES].iter();
            let rounded = rounded.map(|entry| (entry / (ALIKE * scale)).round() as i64);
            let first = *known.entry(mixed(size, rounded)).or_insert(tet);
            if first == tet {
                return tet;
            }
            let other = shape(mesh, first);
            let mut pairs = own.iter().zip(&other).enumerate();
            let are_alike = pairs.all(|(entry, (own, other))| {
                let scale = if entry == VOLUMES { *own } else { scale };
                (own - other).abs() <= 4.0 * ALIKE * scale.abs()
            });
            if are_alike { first } else { tet }
        };
        Self(all.map(first).collect())
    }

    /// The first tetrahedron with the shape of this one.
    fn of(&self, tet: u32) -> u32 {
        self.0.get(tet as usize).copied().unwrap_or(tet)
    }
}

/// A number that differs for most different numbers.
fn mixed(first: i64, others: impl Iterator<Item = i64>) -> u64 {
    others.fold(first as u64, |mixed, next| {
        (mixed.rotate_left(5) ^ next as u64).wrapping_mul(0x517c_c1b7_2722_0a95)
    })
}

/// The different shapes of blocks.
struct AllShapes {
    shapes: Vec<Shapes<f64>>,
    /// The place of the shapes of each block.
    of: Vec<u32>,
    /// Places of shapes by their bits; `None` if each block has its own.
    known: Option<HashMap<u64, u32>>,
}

impl AllShapes {
    /// No shapes yet of so many blocks, which may share them.
    fn new(shared: bool, blocks: usize) -> Self {
        Self {
            shapes: Vec::with_capacity(if shared { 0 } else { blocks }),
            of: Vec::with_capacity(blocks),
            known: shared.then(HashMap::new),
        }
    }

    /// Adds the shapes of the next block.
    fn add(&mut self, shapes: Shapes<f64>) {
        let next = self.shapes.len() as u32;
        let known = self.known.as_mut().map_or(next, |known| {
            let bits = shapes.as_flattened().iter();
            let mixed = mixed(0, bits.map(|entry| entry.to_bits() as i64));
            *known.entry(mixed).or_insert(next)
        });
        if self.shapes.get(known as usize) == Some(&shapes) {
            self.of.push(known);
        } else {
            self.of.push(next);
            self.shapes.push(shapes);
        }
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

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::super::chunks::chunks;
    use super::*;

    /// The tetrahedra of a mesh, and the number of blocks.
    fn at_rest(mesh: &TetMesh) -> (Rest, usize) {
        let all: Vec<u32> = (0..mesh.tets.len() as u32).collect();
        let (slots, _) = chunks(&all, |_| None);
        let rest = Rest::of(mesh, &FirstAlike::new(mesh), &slots);
        (rest, slots.len() / LANES)
    }

    #[test]
    fn blocks_of_a_lattice_share_their_shapes_and_those_of_other_meshes_have_their_own() {
        for edge in [1e-3, 0.1, 70.0] {
            let mut mesh = cube(15, edge, Split::Kuhn).unwrap();
            mesh.points
                .iter_mut()
                .for_each(|point| point[1] += 0.3 * edge);
            let (rest, blocks) = at_rest(&mesh);
            assert!(
                rest.shapes.len() < 10 && blocks > 1200,
                "{}",
                rest.shapes.len()
            );
            for (tet, nodes) in mesh.tets.iter().enumerate() {
                let exact = tetra::gradients(&tetra::vertices(&mesh.points, *nodes)).unwrap();
                let kept = rest.all_gradients::<f64>(tet);
                for (kept, exact) in kept.as_flattened().iter().zip(exact.as_flattened()) {
                    assert!((kept - exact).abs() < 1e-10 / edge, "{kept} {exact}");
                }
                assert!((rest.volume(tet) / mesh.volume(tet) - 1.0).abs() < 1e-10);
            }
            // A node that is moved a little changes the shapes around it alone.
            mesh.points[700][2] += 1e-6 * edge;
            let (moved, _) = at_rest(&mesh);
            assert!(moved.shapes.len() > rest.shapes.len());
            assert!(moved.shapes.len() < rest.shapes.len() + 24);
            let shift = |node: usize| 1e-3 * edge * (12.9 * node as f64).sin();
            for (node, point) in mesh.points.iter_mut().enumerate() {
                point[0] += shift(node);
            }
            let (irregular, blocks) = at_rest(&mesh);
            assert_eq!(irregular.shapes.len(), blocks);
        }
    }
}
