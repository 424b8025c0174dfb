//! The material's axes in the tetrahedra of a region, for laws that have some.

use std::sync::Arc;

use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::Slot;
use crate::frame::Axes;
use crate::hyperelastic::{HyperelasticLaw, OwnAt, Tensor};

/// Perpendicular unit vectors at rest, by the rows of a tensor.
#[derive(Clone, Debug)]
pub(crate) enum RegionAxes<T = f64> {
    /// The same in all tetrahedra.
    Everywhere(Tensor<f64>),
    /// Axes of each tetrahedron, one array for each entry.
    Each(Arc<[Aligned<T>; 9]>),
}

impl RegionAxes {
    /// The axes in the tetrahedra at these places.
    pub(super) fn new(axes: &Axes, slots: &[Slot]) -> Self {
        match axes {
            Axes::Everywhere(axes) => Self::Everywhere(Tensor(**axes)),
            Axes::Each(all) => {
                let entries = std::array::from_fn(|entry| {
                    let of_slot = |slot: &Slot| all[slot.tet as usize][entry / 3][entry % 3];
                    let entries: Vec<f64> = slots.iter().map(of_slot).collect();
                    Aligned::from(&entries[..])
                });
                Self::Each(Arc::new(entries))
            }
        }
    }

    /// The same in another precision.
    pub(super) fn rounded<T: Real>(&self) -> RegionAxes<T> {
        match self {
            Self::Everywhere(axes) => RegionAxes::Everywhere(*axes),
            Self::Each(all) => RegionAxes::Each(Arc::new(all.each_ref().map(|values| {
                let values: Vec<T> = values.iter().map(|value| T::of(*value)).collect();
                Aligned::from(&values[..])
            }))),
        }
    }
}

impl<T: Real> RegionAxes<T> {
    /// The axes in tetrahedra side by side.
    #[inline(always)]
    fn of<N: Number<Real = T>>(&self, first: usize) -> Tensor<N> {
        match self {
            Self::Everywhere(axes) => Tensor::of(axes.0),
            Self::Each(all) => {
                let mut axes = Tensor::zero();
                for (entry, all) in axes.0.as_flattened_mut().iter_mut().zip(&**all) {
                    *entry = N::load(&all[first..]);
                }
                axes
            }
        }
    }
}

/// A place of a region's law.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    /// The tetrahedra side by side from one on.
    Tets(usize),
    /// The means over some tetrahedra: not for axes that differ between them.
    Means,
}

/// A law at the deformation of a place, as it is in a region with these axes.
#[inline(always)]
pub(super) fn at_place<'a, N: Number, L: HyperelasticLaw>(
    law: &'a L,
    displacement_gradient: Tensor<N>,
    axes: Option<&RegionAxes<N::Real>>,
    place: Place,
) -> OwnAt<'a, N, L> {
    let axes = match (axes.filter(|_| L::HAS_AXES), place) {
        (Some(axes), Place::Tets(first)) => Some(axes.of(first)),
        (Some(RegionAxes::Everywhere(axes)), Place::Means) => Some(Tensor::of(axes.0)),
        (None, _) | (Some(RegionAxes::Each(_)), Place::Means) => None,
    };
    let point = match axes {
        Some(axes) => law.at_in(displacement_gradient, &axes),
        None => law.at(displacement_gradient),
    };
    OwnAt { law, point }
}
