//! The strain that a tetrahedron's stress follows from.

use sinew_mesh::TetMesh;

use super::Smoothing;

/// Mean strains of all edges and patches.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeanStrains {
    edges: Vec<[f64; 6]>,
    patches: Vec<[f64; 6]>,
}

/// The strain of a tetrahedron as its stress sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SmoothedStrain {
    /// The strain that shear resists, in the order of [`crate::stress`].
    pub(crate) shear: [f64; 6],
    /// The relative change of volume.
    pub(crate) dilation: f64,
}

impl SmoothedStrain {
    /// The strain of a tetrahedron by itself.
    pub(crate) fn plain(strain: [f64; 6]) -> Self {
        Self {
            shear: strain,
            dilation: trace(&strain),
        }
    }
}

impl Smoothing {
    /// The mean strains of all sets, with the strain of each tetrahedron.
    pub(crate) fn mean_strains(
        &self,
        mesh: &TetMesh,
        strain: impl Fn(usize) -> [f64; 6],
    ) -> MeanStrains {
        let edges = (0..self.edges.tets.count()).map(|edge| self.edges.tets.of(edge));
        let patches = (0..self.patches.count()).map(|patch| self.patches.of(patch));
        MeanStrains {
            edges: edges.map(|tets| mean(mesh, tets, &strain)).collect(),
            patches: patches.map(|tets| mean(mesh, tets, &strain)).collect(),
        }
    }

    /// The strain of a tetrahedron of `own` strain in a region that averages a share of shear over edges.
    pub(crate) fn strain_among(
        &self,
        means: &MeanStrains,
        tet: usize,
        edge_share: f64,
        own: [f64; 6],
    ) -> SmoothedStrain {
        let edge = |edge: usize| means.edges[edge];
        self.smoothed(tet, edge_share, own, edge, |patch| means.patches[patch])
    }

    /// [`Smoothing::strain_among`] for a single tetrahedron, with the strain of each of its neighbours.
    pub(crate) fn strain_at(
        &self,
        mesh: &TetMesh,
        tet: usize,
        edge_share: f64,
        strain: impl Fn(usize) -> [f64; 6],
    ) -> SmoothedStrain {
        let edge = |edge| mean(mesh, self.edges.tets.of(edge), &strain);
        let patch = |patch| mean(mesh, self.patches.of(patch), &strain);
        self.smoothed(tet, edge_share, strain(tet), edge, patch)
    }

    fn smoothed(
        &self,
        tet: usize,
        edge_share: f64,
        own: [f64; 6],
        edge: impl Fn(usize) -> [f64; 6],
        patch: impl Fn(usize) -> [f64; 6],
    ) -> SmoothedStrain {
        let mut strain = SmoothedStrain::plain(own);
        if let Some(edges) = self.edges_of(tet) {
            strain.shear = own.map(|own| (1.0 - edge_share) * own);
            for mean in edges.map(|number| edge(number as usize)) {
                for (sum, mean) in strain.shear.iter_mut().zip(mean) {
                    *sum += edge_share / 6.0 * mean;
                }
            }
        }
        if let Some(number) = self.patch_of(tet) {
            strain.dilation = trace(&patch(number));
        }
        strain
    }
}

/// The mean strain of some tetrahedra by volume.
fn mean(mesh: &TetMesh, tets: &[u32], strain: &impl Fn(usize) -> [f64; 6]) -> [f64; 6] {
    let (mut sum, mut all) = ([0.0; 6], 0.0);
    for tet in tets {
        let volume = mesh.volume(*tet as usize);
        for (sum, strain) in sum.iter_mut().zip(strain(*tet as usize)) {
            *sum += volume * strain;
        }
        all += volume;
    }
    sum.map(|sum| sum / all)
}

fn trace([xx, yy, zz, ..]: &[f64; 6]) -> f64 {
    xx + yy + zz
}
