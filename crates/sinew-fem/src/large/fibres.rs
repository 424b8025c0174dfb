//! Fibres of a region.
//!
//! Their stress follows from the strain of each single tetrahedron, also if that of the law follows from averages.
//! Fibres resist a stretch along their own direction but no shear across it, and only such shear locks tetrahedra in
//! bending; and their direction may differ in each tetrahedron.

use std::sync::Arc;

use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::Slot;
use crate::hyperelastic::fibres::{FibrePoint, Fibres};
use crate::hyperelastic::{Deformation, SMALLEST_VOLUME_RATIO};
use crate::tissue::FibreFamily;

/// Fibres and their direction at rest.
#[derive(Clone, Debug)]
pub(super) struct RegionFibres {
    pub(super) fibres: Fibres,
    pub(super) directions: Directions,
}

/// The direction of fibres at rest as unit vectors.
#[derive(Clone, Debug)]
pub(super) enum Directions<T = f64> {
    /// The same in all tetrahedra.
    Same([f64; 3]),
    /// One direction for each tetrahedron, one array for each component.
    Each(Arc<[Aligned<T>; 3]>),
}

impl RegionFibres {
    /// Fibres whose moduli are those of a family times a factor, in the tetrahedra at these places; with a direction for each tetrahedron of
    /// the mesh, or that of the family.
    pub(super) fn new(
        family: &FibreFamily,
        factor: f64,
        slots: &[Slot],
        directions: Option<&[[f64; 3]]>,
    ) -> Self {
        let each = |all: &[[f64; 3]]| {
            let along = |axis: usize| -> Vec<f64> {
                let of_slot = |slot: &Slot| all[slot.tet as usize][axis];
                slots.iter().map(of_slot).collect()
            };
            let all = [0, 1, 2].map(|axis| Aligned::from(&along(axis)[..]));
            Directions::Each(Arc::new(all))
        };
        Self {
            fibres: family.fibres.scaled(factor),
            directions: match directions {
                Some(all) => each(all),
                None => Directions::Same(family.direction.unit()),
            },
        }
    }

    /// The fibres of tetrahedra side by side at their deformation.
    #[inline(always)]
    pub(super) fn at<N: Number<Real = f64>>(
        &self,
        first: usize,
        deformation: &Deformation<N>,
    ) -> FibrePoint<N> {
        self.fibres.at(deformation, self.directions.of(first))
    }

    /// True if the fibres are defined for a deformation, in all lanes.
    #[inline(always)]
    pub(super) fn admits<N: Number>(&self, deformation: &Deformation<N>) -> bool {
        let smallest = N::of(SMALLEST_VOLUME_RATIO);
        !self.fibres.is_split() || N::all_le(smallest, deformation.volume_ratio)
    }
}

impl Directions {
    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> Directions<T> {
        match self {
            Self::Same(direction) => Directions::Same(*direction),
            Self::Each(all) => Directions::Each(Arc::new(all.each_ref().map(|values| {
                let values: Vec<T> = values.iter().map(|value| T::of(*value)).collect();
                Aligned::from(&values[..])
            }))),
        }
    }
}

impl<T: Real> Directions<T> {
    /// The directions in tetrahedra side by side.
    #[inline(always)]
    pub(super) fn of<N: Number<Real = T>>(&self, first: usize) -> [N; 3] {
        match self {
            Self::Same([x, y, z]) => [N::of(*x), N::of(*y), N::of(*z)],
            Self::Each(all) => {
                let [x, y, z] = &**all;
                [
                    N::load(&x[first..]),
                    N::load(&y[first..]),
                    N::load(&z[first..]),
                ]
            }
        }
    }
}
