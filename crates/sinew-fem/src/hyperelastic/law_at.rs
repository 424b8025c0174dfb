//! A law at a deformation, for loops whose code is shared by all laws.

use std::ops::Deref;

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::law::{Bulk, HyperelasticLaw, Point};
use super::tensor::Tensor;

/// A law at a deformation, or at one in each lane, without the law's type: the methods of [`HyperelasticLaw`].
pub(crate) trait LawAt<N: Number> {
    fn id(&self) -> &'static str;

    fn lame(&self) -> (f64, f64);

    fn has_axes(&self) -> bool;

    fn is_defined_when_inverted(&self) -> bool;

    fn limit(&self) -> Option<&str>;

    fn margin(&self) -> N;

    fn is_within_limit(&self) -> bool;

    fn admits(&self) -> bool;

    fn deformation(&self) -> &Deformation<N>;

    fn dilation(&self) -> N;

    fn dilation_gradient(&self) -> Tensor<N>;

    fn dilation_tangent(&self, change: Tensor<N>) -> Tensor<N>;

    fn own_bulk(&self) -> Bulk<N>;

    fn whole_energy(&self) -> N;

    fn stress(&self) -> Tensor<N>;

    fn tangent_with(&self, bulk: Bulk<N>, change: Tensor<N>) -> Tensor<N>;

    fn frozen_tangent_with(&self, bulk: Bulk<N>, change: Tensor<N>) -> Option<Tensor<N>>;

    /// Replaces changes of F by changes of the stress, all with one call: [`HyperelasticLaw::tangent_with`], or the
    /// frozen one of a law that has it.
    fn tangents_with(&self, bulk: Bulk<N>, is_exact: bool, changes: &mut [Tensor<N>]);

    /// True if the law has a tangent at constant rotations.
    fn freezes(&self) -> bool;

    fn node_block(&self, bulk: Bulk<N>, gradient: [N; 3]) -> Tensor<N>;

    fn wave_moduli(&self, bulk: Bulk<N>) -> Tensor<N>;
}

/// A law with its type at a deformation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OwnAt<'a, N: Number, L: HyperelasticLaw> {
    pub(crate) law: &'a L,
    pub(crate) point: Point<N, L::Own<N>>,
}

impl<N: Number, L: HyperelasticLaw> Deref for OwnAt<'_, N, L> {
    type Target = Point<N, L::Own<N>>;

    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.point
    }
}

impl<N: Number, L: HyperelasticLaw> LawAt<N> for OwnAt<'_, N, L> {
    #[inline(always)]
    fn id(&self) -> &'static str {
        self.law.id()
    }

    #[inline(always)]
    fn lame(&self) -> (f64, f64) {
        self.law.lame()
    }

    #[inline(always)]
    fn has_axes(&self) -> bool {
        L::HAS_AXES
    }

    #[inline(always)]
    fn is_defined_when_inverted(&self) -> bool {
        L::DEFINED_WHEN_INVERTED
    }

    #[inline(always)]
    fn limit(&self) -> Option<&str> {
        self.law.limit()
    }

    #[inline(always)]
    fn margin(&self) -> N {
        self.law.margin(self)
    }

    #[inline(always)]
    fn is_within_limit(&self) -> bool {
        self.law.is_within_limit(self)
    }

    #[inline(always)]
    fn admits(&self) -> bool {
        self.law.admits(self)
    }

    #[inline(always)]
    fn deformation(&self) -> &Deformation<N> {
        &self.point.deformation
    }

    #[inline(always)]
    fn dilation(&self) -> N {
        self.law.dilation(self)
    }

    #[inline(always)]
    fn dilation_gradient(&self) -> Tensor<N> {
        self.law.dilation_gradient(self)
    }

    #[inline(always)]
    fn dilation_tangent(&self, change: Tensor<N>) -> Tensor<N> {
        self.law.dilation_tangent(self, change)
    }

    #[inline(always)]
    fn own_bulk(&self) -> Bulk<N> {
        self.law.own_bulk(self)
    }

    #[inline(always)]
    fn whole_energy(&self) -> N {
        self.law.whole_energy(self)
    }

    #[inline(always)]
    fn stress(&self) -> Tensor<N> {
        self.law.stress(self)
    }

    #[inline(always)]
    fn tangent_with(&self, bulk: Bulk<N>, change: Tensor<N>) -> Tensor<N> {
        self.law.tangent_with(self, bulk, change)
    }

    #[inline(always)]
    fn frozen_tangent_with(&self, bulk: Bulk<N>, change: Tensor<N>) -> Option<Tensor<N>> {
        self.law.frozen_tangent_with(self, bulk, change)
    }

    #[inline(always)]
    fn tangents_with(&self, bulk: Bulk<N>, is_exact: bool, changes: &mut [Tensor<N>]) {
        for change in changes {
            let frozen = match is_exact {
                true => None,
                false => self.frozen_tangent_with(bulk, *change),
            };
            *change = frozen.unwrap_or_else(|| self.tangent_with(bulk, *change));
        }
    }

    #[inline(always)]
    fn freezes(&self) -> bool {
        self.law.frozen_tangent(self, Tensor::zero()).is_some()
    }

    #[inline(always)]
    fn wave_moduli(&self, bulk: Bulk<N>) -> Tensor<N> {
        self.law.wave_moduli(self, bulk)
    }

    #[inline(always)]
    fn node_block(&self, bulk: Bulk<N>, gradient: [N; 3]) -> Tensor<N> {
        self.law.node_block(self, bulk, gradient)
    }
}
