//! Fibres of a region.
//!
//! They see the strain of each tetrahedron by itself, also where the law sees averages: fibres resist a stretch along their own
//! direction and no shear across it, which is what locks tetrahedra in bending, and their direction may be another in each.

use sinew_sparse::simd::Number;

use crate::hyperelastic::fibres::{FibrePoint, Fibres};
use crate::hyperelastic::{Deformation, SMALLEST_VOLUME_RATIO};
use crate::tissue::FibreFamily;

/// Fibres and their direction at rest.
#[derive(Clone, Debug)]
pub(super) struct RegionFibres {
    pub(super) fibres: Fibres,
    direction: [f64; 3],
}

impl RegionFibres {
    /// Fibres whose moduli are those of a family times a factor.
    pub(super) fn new(family: &FibreFamily, factor: f64) -> Self {
        Self {
            fibres: family.fibres.scaled(factor),
            direction: family.unit_direction(),
        }
    }

    /// The directions in tetrahedra side by side.
    #[inline(always)]
    pub(super) fn directions<N: Number>(&self, _first: usize) -> [N; 3] {
        let [x, y, z] = self.direction;
        [N::of(x), N::of(y), N::of(z)]
    }

    /// The fibres of a tetrahedron at its deformation.
    pub(super) fn at(&self, tet: usize, deformation: &Deformation<f64>) -> FibrePoint<f64> {
        self.fibres.at(deformation, self.directions(tet))
    }

    /// Whether they are defined for a deformation.
    pub(super) fn admits(&self, deformation: &Deformation<f64>) -> bool {
        !self.fibres.is_split() || deformation.volume_ratio >= SMALLEST_VOLUME_RATIO
    }
}
