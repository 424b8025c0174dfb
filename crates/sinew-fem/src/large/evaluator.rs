//! A law at one deformation after the other, for loops over tangents.

use std::ops::Deref;

use sinew_sparse::simd::Number;

use sinew_core::TangentKind;

use super::axes::{Place, RegionAxes, at_place};
use super::wanted::Wanted;
use crate::hyperelastic::{HyperelasticLaw, LawAt, OwnAt, Tensor};

/// A law that is evaluated at one deformation after the other.
pub(super) trait Evaluator<N: Number> {
    /// The law at a deformation.
    type At<'a>: LawAt<N> + ?Sized
    where
        Self: 'a;
    /// Its owner, or a reference.
    type Ref<'a>: Deref<Target = Self::At<'a>>
    where
        Self: 'a;

    /// The law at a gradient of the displacement, in a region with these axes.
    fn at(
        &mut self,
        h: Tensor<N>,
        axes: Option<&RegionAxes<N::Real>>,
        place: Place,
    ) -> Self::Ref<'_>;
}

/// An evaluator of a law whose type is known, for vectors: its results stay in registers as far as possible.
pub(super) struct Typed<'a, L>(pub(super) &'a L);

/// An owner.
pub(super) struct Owner<T>(T);

impl<T> Deref for Owner<T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<'l, N: Number, L: HyperelasticLaw> Evaluator<N> for Typed<'l, L> {
    type At<'a>
        = OwnAt<'l, N, L>
    where
        Self: 'a;
    type Ref<'a>
        = Owner<OwnAt<'l, N, L>>
    where
        Self: 'a;

    #[inline(always)]
    fn at(
        &mut self,
        h: Tensor<N>,
        axes: Option<&RegionAxes<N::Real>>,
        place: Place,
    ) -> Owner<OwnAt<'l, N, L>> {
        Owner(at_place(self.0, h, axes, place))
    }
}

/// [`Evaluator`] of plain numbers behind a pointer: loops that take it are compiled once for all laws.
pub(crate) trait Untyped {
    fn at_point(
        &mut self,
        h: Tensor<f64>,
        axes: Option<&RegionAxes>,
        place: Place,
    ) -> &dyn LawAt<f64>;

    /// Lame's constants (Pa) of the law.
    fn lame(&self) -> (f64, f64);

    /// theta and its derivative by F at a gradient of the displacement: all that a patch needs from its tetrahedra,
    /// without the stretches that some laws would compute.
    fn dilation(&self, h: Tensor<f64>) -> (f64, Tensor<f64>);
}

/// A law with its type, and the deformation at which it was last evaluated.
pub(super) struct Last<'a, L: HyperelasticLaw> {
    pub(super) law: &'a L,
    pub(super) at: Option<OwnAt<'a, f64, L>>,
}

impl<L: HyperelasticLaw> Untyped for Last<'_, L> {
    fn at_point(
        &mut self,
        h: Tensor<f64>,
        axes: Option<&RegionAxes>,
        place: Place,
    ) -> &dyn LawAt<f64> {
        self.at.insert(at_place(self.law, h, axes, place))
    }

    fn lame(&self) -> (f64, f64) {
        self.law.lame()
    }

    fn dilation(&self, h: Tensor<f64>) -> (f64, Tensor<f64>) {
        let at = self.law.at(h);
        (self.law.dilation(&at), self.law.dilation_gradient(&at))
    }
}

impl Evaluator<f64> for dyn Untyped + '_ {
    type At<'a>
        = dyn LawAt<f64> + 'a
    where
        Self: 'a;
    type Ref<'a>
        = &'a (dyn LawAt<f64> + 'a)
    where
        Self: 'a;

    fn at(
        &mut self,
        h: Tensor<f64>,
        axes: Option<&RegionAxes>,
        place: Place,
    ) -> &(dyn LawAt<f64> + '_) {
        self.at_point(h, axes, place)
    }
}

/// A law behind a pointer, for loops.
pub(crate) trait Asked {
    /// Calls `work` with the law, or with its viscosity.
    fn asked(&self, wanted: Wanted, work: &mut dyn FnMut(&mut (dyn Untyped + '_)));
}

impl dyn Asked + '_ {
    /// The result of work with the law, or with its viscosity: one call for a region, with loops inside that are compiled
    /// once for all laws.
    pub(crate) fn with<R>(
        &self,
        wanted: Wanted,
        without: R,
        mut work: impl FnMut(&mut (dyn Untyped + '_)) -> R,
    ) -> R {
        let mut result = without;
        self.asked(wanted, &mut |law| result = work(law));
        result
    }

    /// The result of work with the law at a gradient of the displacement, in the axes of coordinates.
    pub(crate) fn at<R>(
        &self,
        h: Tensor<f64>,
        without: R,
        mut work: impl FnMut(&dyn LawAt<f64>) -> R,
    ) -> R {
        self.with(Wanted::Kind(TangentKind::Exact), without, |law| {
            work(law.at_point(h, None, Place::Means))
        })
    }
}
