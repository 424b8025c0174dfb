//! Tetrahedra at rest, as loops over deformed ones read them.

use sinew_mesh::TetMesh;
use sinew_sparse::simd::Number;

use crate::hyperelastic::Tensor;
use crate::tetra;

/// The tetrahedra of a region at rest, each quantity in an array of its own so that neighbours in memory fill a vector.
#[derive(Clone, Debug)]
pub(crate) struct Rest {
    /// The four mesh nodes.
    nodes: [Vec<u32>; 4],
    /// Gradients (1/m) of the shape functions of the last three vertices; the first has minus their sum.
    gradients: [[Vec<f64>; 3]; 3],
    /// Volumes (m^3).
    volumes: Vec<f64>,
    /// Tags in the mesh, for messages.
    tags: Vec<u64>,
}

impl Rest {
    /// Some tetrahedra of a mesh, none of which is flat.
    pub(super) fn of(mesh: &TetMesh, tets: &[u32]) -> Self {
        let with_room = || Vec::with_capacity(tets.len());
        let mut rest = Self {
            nodes: std::array::from_fn(|_| Vec::with_capacity(tets.len())),
            gradients: std::array::from_fn(|_| std::array::from_fn(|_| with_room())),
            volumes: with_room(),
            tags: Vec::with_capacity(tets.len()),
        };
        for tet in tets {
            let tet = *tet as usize;
            let nodes = mesh.tets[tet];
            let vertices = tetra::vertices(&mesh.points, nodes);
            let [_, others @ ..] = tetra::gradients(&vertices).unwrap_or_default();
            for (all, node) in rest.nodes.iter_mut().zip(nodes) {
                all.push(node);
            }
            for (all, gradient) in rest.gradients.iter_mut().zip(others) {
                for (all, component) in all.iter_mut().zip(gradient) {
                    all.push(component);
                }
            }
            rest.volumes.push(mesh.volume(tet));
            rest.tags.push(mesh.tet_tags[tet]);
        }
        rest
    }

    /// Number of tetrahedra.
    pub(super) fn count(&self) -> usize {
        self.volumes.len()
    }

    /// The four nodes of a tetrahedron.
    pub(super) fn nodes(&self, tet: usize) -> [u32; 4] {
        [0, 1, 2, 3].map(|vertex| self.nodes[vertex][tet])
    }

    pub(super) fn tag(&self, tet: usize) -> u64 {
        self.tags[tet]
    }

    /// The volume (m^3).
    #[inline(always)]
    pub(super) fn volume(&self, tet: usize) -> f64 {
        self.volumes[tet]
    }

    /// The gradients (1/m) of the shape functions of the last three vertices.
    #[inline(always)]
    pub(super) fn gradients<N: Number>(&self, tet: usize) -> [[N; 3]; 3] {
        std::array::from_fn(|vertex| {
            std::array::from_fn(|axis| N::of(self.gradients[vertex][axis][tet]))
        })
    }

    /// The gradients (1/m) of all four shape functions.
    pub(super) fn all_gradients(&self, tet: usize) -> [[f64; 3]; 4] {
        let [b, c, d] = self.gradients::<f64>(tet);
        let first = std::array::from_fn(|axis| -(b[axis] + c[axis] + d[axis]));
        [first, b, c, d]
    }

    /// The gradient of a field (m) that is given at all mesh nodes: row i, column j is the derivative of component i along j.
    #[inline(always)]
    pub(super) fn gradient_of<N: Number>(&self, tet: usize, field: &[[f64; 3]]) -> Tensor<N> {
        self.gradient_by(tet, |node| field[node as usize])
    }

    /// [`Rest::gradient_of`] for a function of the node.
    #[inline(always)]
    pub(super) fn gradient_by<N: Number>(
        &self,
        tet: usize,
        field: impl Fn(u32) -> [f64; 3],
    ) -> Tensor<N> {
        let [a, b, c, d] = self.nodes(tet).map(field);
        let gradients = self.gradients::<N>(tet);
        let edges = [b, c, d].map(|end| {
            let along = |axis: usize| N::of(end[axis] - a[axis]);
            [along(0), along(1), along(2)]
        });
        let mut sum = Tensor::zero();
        for (edge, gradient) in edges.into_iter().zip(gradients) {
            sum = sum + Tensor::outer(edge, gradient);
        }
        sum
    }

    /// Writes the forces (N) of a stress (Pa) on the four vertices.
    #[inline(always)]
    pub(super) fn forces<N: Number>(&self, tet: usize, stress: Tensor<N>, out: &mut [f64; 12]) {
        let stress = stress.scaled(N::of(self.volumes[tet]));
        let mut first = [0.0; 3];
        for (vertex, gradient) in (1..).zip(self.gradients::<N>(tet)) {
            for (axis, force) in stress.on(gradient).into_iter().enumerate() {
                let force = force.lane(0);
                out[3 * vertex + axis] = force;
                first[axis] -= force;
            }
        }
        out[..3].copy_from_slice(&first);
    }
}
