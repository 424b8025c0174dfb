//! The material's axes in the tetrahedra of a region, for laws that have some.

use std::sync::Arc;

use sinew_sparse::simd::{Aligned, Number, Real};

use super::chunks::Slot;
use crate::frame::Axes;
use crate::hyperelastic::{HyperelasticLaw, Point, Tensor};

/// Perpendicular unit vectors at rest, by the rows of a tensor.
#[derive(Clone, Debug)]
pub(super) enum RegionAxes<T = f64> {
    /// The same in all tetrahedra.
    Everywhere(Tensor<f64>),
    /// Others in each tetrahedron, one array for each entry.
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
                let entry = |place: usize| N::load(&all[place][first..]);
                let row = |row: usize| [entry(3 * row), entry(3 * row + 1), entry(3 * row + 2)];
                Tensor([row(0), row(1), row(2)])
            }
        }
    }
}

/// The mean deformation at edges side by side as a law of their region sees it: axes that differ do not go with edges.
#[inline(always)]
pub(super) fn point_at_edges<N: Number, L: HyperelasticLaw>(
    law: &L,
    displacement_gradient: Tensor<N>,
    axes: Option<&RegionAxes<N::Real>>,
) -> Point<N, L::Own<N>> {
    match axes {
        Some(RegionAxes::Everywhere(axes)) if L::HAS_AXES => {
            law.at_in(displacement_gradient, &Tensor::of(axes.0))
        }
        _ => law.at(displacement_gradient),
    }
}

/// The deformation of tetrahedra side by side as a law of their region sees it.
#[inline(always)]
pub(super) fn point<N: Number, L: HyperelasticLaw>(
    law: &L,
    displacement_gradient: Tensor<N>,
    axes: Option<&RegionAxes<N::Real>>,
    first: usize,
) -> Point<N, L::Own<N>> {
    match axes {
        Some(axes) if L::HAS_AXES => law.at_in(displacement_gradient, &axes.of(first)),
        _ => law.at(displacement_gradient),
    }
}
