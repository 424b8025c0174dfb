//! Stiffness of a region that differs from tetrahedron to tetrahedron.

use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::LANES;
use super::rest::Rest;
use crate::smoothing::Sets;

/// Factors of the energies of a region's law. Fibres have their own moduli. The history variables are stresses, which
/// contain the factor already.
#[derive(Debug)]
pub(super) struct Stiffness<T = f64> {
    /// Factor of each tetrahedron.
    tets: Aligned<T>,
    /// Factor of each edge, then zeros to fill a vector.
    edges: Aligned<T>,
    /// Factor of each patch.
    patches: Vec<T>,
}

impl Stiffness {
    /// Factors from the stiffness of each tetrahedron; the factor of a set is the mean by volume over its tetrahedra.
    pub(super) fn new(tets: &[f64], rest: &Rest, [edges, patches]: [&Sets; 2]) -> Self {
        let means = |sets: &Sets| -> Vec<f64> {
            let mean = |set| rest.mean(sets.of(set), |tet| tets[tet]);
            (0..sets.count()).map(mean).collect()
        };
        let mut of_edges = means(edges);
        of_edges.resize(edges.count().next_multiple_of(LANES), 0.0);
        Self {
            tets: Aligned::from(tets),
            edges: Aligned::from(&of_edges[..]),
            patches: means(patches),
        }
    }

    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> Stiffness<T> {
        let rounded = |values: &[f64]| -> Vec<T> { values.iter().map(|x| T::of(*x)).collect() };
        Stiffness {
            tets: Aligned::from(&rounded(&self.tets)[..]),
            edges: Aligned::from(&rounded(&self.edges)[..]),
            patches: rounded(&self.patches),
        }
    }
}

impl<T: Real> Stiffness<T> {
    /// The factors of tetrahedra side by side.
    #[inline(always)]
    pub(super) fn of_tets<N: Number<Real = T>>(&self, first: usize) -> N {
        N::load(&self.tets[first..])
    }

    /// The factors at edges side by side.
    #[inline(always)]
    pub(super) fn at_edges<N: Number<Real = T>>(&self, first: usize) -> N {
        N::load(&self.edges[first..])
    }

    /// The factor of a patch.
    #[inline(always)]
    pub(super) fn of_patch(&self, patch: usize) -> T {
        self.patches[patch]
    }
}
