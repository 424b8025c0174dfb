//! The mean strain of a set of tetrahedra as a function of displacements.

use sinew_mesh::TetMesh;

use crate::tetra;

/// The mean gradient of displacement over a set of tetrahedra: `sum_a u_a g_a` over its nodes a.
#[derive(Clone, Debug, Default)]
pub(crate) struct Average {
    /// Nodes of the set, in the order in which its tetrahedra name them.
    pub(crate) nodes: Vec<u32>,
    /// Mean gradient (1/m) of each node's shape function.
    pub(crate) gradients: Vec<[f64; 3]>,
    /// Volume (m^3) of the set.
    pub(crate) volume: f64,
}

impl Average {
    /// Takes the mean over some tetrahedra of a mesh by volume.
    pub(crate) fn over(&mut self, mesh: &TetMesh, tets: &[u32]) {
        self.of(tets.iter().map(|tet| {
            let (nodes, volume) = (mesh.tets[*tet as usize], mesh.volume(*tet as usize));
            // A model has no flat tetrahedra.
            let vertices = tetra::vertices(&mesh.points, nodes);
            (
                nodes,
                volume,
                tetra::gradients(&vertices).unwrap_or_default(),
            )
        }));
    }

    /// Takes the mean by volume over tetrahedra, given by nodes, volume (m^3) and gradients (1/m).
    pub(crate) fn of(&mut self, tets: impl Iterator<Item = ([u32; 4], f64, [[f64; 3]; 4])>) {
        self.nodes.clear();
        self.gradients.clear();
        self.volume = 0.0;
        for (nodes, volume, gradients) in tets {
            for (node, gradient) in nodes.into_iter().zip(gradients) {
                let place = self.place_of(node);
                for (sum, g) in self.gradients[place].iter_mut().zip(gradient) {
                    *sum += volume * g;
                }
            }
            self.volume += volume;
        }
        for g in self.gradients.as_flattened_mut() {
            *g /= self.volume;
        }
    }

    fn place_of(&mut self, node: u32) -> usize {
        let known = self.nodes.iter().position(|known| *known == node);
        known.unwrap_or_else(|| {
            self.nodes.push(node);
            self.gradients.push([0.0; 3]);
            self.nodes.len() - 1
        })
    }

    /// Writes the stiffness matrix (N/m) of linear elasticity at the mean strain, row-major and node-major, for a part of
    /// the volume: the blocks of [`tetra::stiffness`] with mean gradients.
    pub(crate) fn stiffness(
        &self,
        share_of_volume: f64,
        [lambda, mu]: [f64; 2],
        out: &mut Vec<f64>,
    ) {
        let volume = share_of_volume * self.volume;
        let columns = 3 * self.nodes.len();
        out.clear();
        out.resize(columns * columns, 0.0);
        for (ga, rows) in self.gradients.iter().zip(out.chunks_exact_mut(3 * columns)) {
            tetra::stiffness_rows(volume, [lambda, mu], ga, &self.gradients, rows);
        }
    }
}
