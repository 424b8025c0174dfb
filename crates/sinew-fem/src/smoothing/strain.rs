//! The strain that determines a tetrahedron's stress.

use sinew_mesh::TetMesh;

use super::Smoothing;

/// Mean strains of all edges and patches, each times its share of stiffness.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeanStrains {
    edges: Vec<[f64; 6]>,
    patches: Vec<[f64; 6]>,
}

/// The averaged strain that gives a tetrahedron's stress: the strains it averages, times shares of the stiffness of
/// its region's law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SmoothedStrain {
    /// The strain that shear resists, in the order of [`crate::stress`].
    pub(crate) shear: [f64; 6],
    /// The relative change of volume.
    pub(crate) dilation: f64,
}

impl SmoothedStrain {
    /// The strain of a tetrahedron without averages.
    fn plain(strain: [f64; 6]) -> Self {
        Self {
            shear: strain,
            dilation: trace(&strain),
        }
    }
}

impl Smoothing {
    /// The mean strains of all sets, with the strain of each tetrahedron and the share of stiffness of each set.
    pub(crate) fn mean_strains(
        &self,
        mesh: &TetMesh,
        strain: impl Fn(usize) -> [f64; 6],
        share: impl Fn(&[u32]) -> f64,
    ) -> MeanStrains {
        let edges = (0..self.edges.tets.count()).map(|edge| self.edges.tets.of(edge));
        let patches = (0..self.patches.count()).map(|patch| self.patches.of(patch));
        let of = |tets: &[u32]| mean(mesh, tets, &strain, &share);
        MeanStrains {
            edges: edges.map(of).collect(),
            patches: patches.map(of).collect(),
        }
    }

    /// The strain of a tetrahedron of `own` strain, times its share of stiffness, in a region that averages a share of shear over edges.
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

    /// [`Smoothing::strain_among`] for a single tetrahedron, with the strain of each of its neighbours and the shares of sets.
    pub(crate) fn strain_at(
        &self,
        mesh: &TetMesh,
        tet: usize,
        edge_share: f64,
        strain: impl Fn(usize) -> [f64; 6],
        share: impl Fn(&[u32]) -> f64,
    ) -> SmoothedStrain {
        let edge = |edge| mean(mesh, self.edges.tets.of(edge), &strain, &share);
        let patch = |patch| mean(mesh, self.patches.of(patch), &strain, &share);
        let own = scaled(strain(tet), share(&[tet as u32]));
        self.smoothed(tet, edge_share, own, edge, patch)
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

/// A strain times a share of stiffness.
pub(crate) fn scaled(strain: [f64; 6], share: f64) -> [f64; 6] {
    strain.map(|component| share * component)
}

/// The mean strain of some tetrahedra by volume, times their share of stiffness.
fn mean(
    mesh: &TetMesh,
    tets: &[u32],
    strain: &impl Fn(usize) -> [f64; 6],
    share: &impl Fn(&[u32]) -> f64,
) -> [f64; 6] {
    let (mut sum, mut all) = ([0.0; 6], 0.0);
    for tet in tets {
        let volume = mesh.volume(*tet as usize);
        for (sum, strain) in sum.iter_mut().zip(strain(*tet as usize)) {
            *sum += volume * strain;
        }
        all += volume;
    }
    scaled(sum.map(|sum| sum / all), share(tets))
}

fn trace([xx, yy, zz, ..]: &[f64; 6]) -> f64 {
    xx + yy + zz
}
