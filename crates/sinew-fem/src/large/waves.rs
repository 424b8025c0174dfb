//! The fastest plane waves through deformed tetrahedra.

use sinew_core::EvaluationError;
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::Place;
use super::beside::block_beside;
use super::evaluator::{Asked, Evaluator, Typed, Untyped};
use super::means::require;
use super::memory::Relaxing;
use super::product::left_of_tets;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawAt, Tensor};

/// The square (1/s^2) of the largest frequency of plane waves as short as a tetrahedron, over all tetrahedra of a region.
///
/// A wave along g that moves tissue along a has the modulus `a_i g_J A_iJkL a_k g_L`, A being the tangent of the
/// tetrahedron's own deformation (Marsden and Hughes, Mathematical Foundations of Elasticity, 1983, section 3.4). Over
/// all g it is at most the largest eigenvalue of `A_iJkJ`, which for isotropic laws exceeds it only by shear moduli.
/// Elements that average strain have the frequency of their tetrahedra here: only the growth since the body was at rest
/// matters.
pub(crate) struct Waves<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) scratch: &'a Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) set: InstructionSet,
    /// The largest square so far.
    pub(super) fastest: f64,
    /// The tetrahedron of the region that has it, found by plain numbers only.
    pub(super) tet: Option<usize>,
}

impl Waves<'_> {
    /// True if plain numbers compute it: vectors do not support the stress in addition to the law's.
    pub(super) fn take_numbers(&self) -> bool {
        Wanted::Stiffest.has_beside(self.region)
    }

    /// Computes it with plain numbers.
    pub(super) fn with_numbers(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        law.with(Wanted::Stiffest, Ok(()), |law: &mut (dyn Untyped + '_)| {
            self.tets::<true, f64, _>(law)
        })
    }

    /// Computes the square over all tetrahedra. `ALL` is true if stress in addition to the law's may contribute, which
    /// is compiled for plain numbers only.
    #[inline(always)]
    fn tets<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
    ) -> Result<(), EvaluationError> {
        let (region, relaxing) = (self.region, &self.relaxing);
        let (rest, speeds) = (&region.rest, region.wave_numbers());
        let mut fastest = N::of(self.fastest);
        for first in (0..rest.count()).step_by(N::LANES) {
            let gradient = rest.gradient_of::<N>(first, &self.scratch.displacement);
            let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
            let at = &*at;
            require(at, region, relaxing, first)?;
            let (share, bulk) = left_of_tets(region, relaxing, at, first);
            let over = share.recip();
            let bulk = Bulk {
                stress: over * bulk.stress,
                modulus: over * bulk.modulus,
            };
            let mut moduli = at.wave_moduli(bulk).scaled(share);
            if ALL {
                for axis in Tensor::<N>::identity().0 {
                    let wanted = (Wanted::Stiffest, axis);
                    let beside = block_beside(region, relaxing, first, at.deformation(), wanted);
                    moduli = moduli + beside;
                }
            }
            // Motions that are no plane waves gain where the volume grows.
            let volume = at.deformation().volume_ratio.max(N::of(1.0));
            let squares = N::load(&speeds[first..]) * volume * largest_eigenvalue(moduli);
            if N::LANES == 1 && squares.lane(0) > fastest.lane(0) {
                self.tet = Some(first);
            }
            fastest = fastest.max(squares);
        }
        for lane in 0..N::LANES {
            self.fastest = self.fastest.max(fastest.lane(lane));
        }
        Ok(())
    }
}

/// [`Waves`] with the type of the law.
pub(super) struct OfLaw<'w, 'a> {
    pub(super) waves: &'w mut Waves<'a>,
    pub(super) untyped: &'w dyn Asked,
}

impl OnLaw for OfLaw<'_, '_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        f64::with_vectors_or_numbers(self.waves.set, Sweep { of: self, law })
    }
}

struct Sweep<'w, 'a, L> {
    of: OfLaw<'w, 'a>,
    law: L,
}

impl<L: HyperelasticLaw> WithReal<f64> for Sweep<'_, '_, L> {
    type Output = Result<(), EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(self) -> Self::Output {
        let OfLaw { waves, untyped } = self.of;
        if N::LANES == 1 {
            waves.with_numbers(untyped)
        } else {
            waves.tets::<false, N, _>(&mut Typed(&self.law))
        }
    }
}

/// An upper bound of the largest eigenvalue of a symmetric tensor, from its first two invariants: exact if the two
/// smaller eigenvalues are equal.
#[inline(always)]
fn largest_eigenvalue<N: Number>(tensor: Tensor<N>) -> N {
    let mean = N::of(1.0 / 3.0) * tensor.trace();
    let spread = (tensor - Tensor::diagonal(mean)).squared();
    (N::of(2.0 / 3.0) * spread).sqrt() + mean
}
