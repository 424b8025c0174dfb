//! Stress in addition to the law's: that of fibres, and the remainder of earlier stress.

use sinew_core::{EvaluationError, TangentKind};
use std::ops::Range;

use sinew_sparse::simd::{Number, Vectors, WithReal};

use super::defined::{require_fibres, require_limit_of_fibres, require_memory};
use super::fibres::{Directions, RegionFibres};
use super::kept::{load_entries, store_entries};
use super::memory::{Points, Relaxing};
use super::region::HyperelasticRegion;
use super::rest::Rest;
use super::wanted::Wanted;
use crate::hyperelastic::fibres::FibrePoint;
use crate::hyperelastic::prony::first_piola;
use crate::hyperelastic::{Deformation, Tensor, dot};
use crate::tissue::Tissue;

/// The stress in addition to the law's in the tetrahedra of a chunk, compiled once for all laws.
pub(super) struct StressBeside<'a, T> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) rest: &'a Rest<T>,
    /// The directions of each family of fibres.
    pub(super) directions: &'a [Directions<T>],
    pub(super) relaxing: &'a Relaxing<'a, T>,
    /// Places of the chunk's tetrahedra.
    pub(super) slots: &'a Range<usize>,
    pub(super) displacement: &'a [[T; 4]],
    /// Buffer for the gradients of the displacement, vector by vector; `gradients_are_known` if it is filled already.
    pub(super) gradients: &'a mut [T],
    pub(super) gradients_are_known: bool,
    /// Output: the stress (Pa), vector by vector.
    pub(super) stress: &'a mut [T],
    pub(super) with_energy: bool,
}

impl<T: Vectors> WithReal<T> for StressBeside<'_, T> {
    /// The energy (J); 0 unless it is requested.
    type Output = Result<f64, EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = T>>(self) -> Self::Output {
        let rest = self.rest;
        let factor = N::of(self.relaxing.factor_of_fibres());
        let mut energy = N::of(0.0);
        for first in self.slots.clone().step_by(N::LANES) {
            let place = 9 * (first - self.slots.start);
            let gradient = if self.gradients_are_known {
                load_entries(&self.gradients[place..])
            } else {
                let gradient = rest.gradient_of::<N>(first, self.displacement);
                store_entries(gradient, &mut self.gradients[place..]);
                gradient
            };
            let deformation = Deformation::of(gradient);
            let (mut stress, mut density) = (Tensor::zero(), N::of(0.0));
            let mut margin = N::of(f64::from(f32::MAX));
            let families = &self.region.fibres;
            require_fibres(families, &deformation, |lane| rest.tag(first + lane))?;
            for (RegionFibres { fibres, .. }, directions) in families.iter().zip(self.directions) {
                let at = fibres.at(&deformation, directions.of::<N>(first));
                margin = margin.min(fibres.margin(&at));
                stress = stress.plus(factor, fibres.stress(&at));
                if self.with_energy {
                    density = factor.mul_add(fibres.energy(&at), density);
                }
            }
            require_limit_of_fibres(margin, |lane| rest.tag(first + lane))?;
            require_memory(self.relaxing, &deformation, |lane| rest.tag(first + lane))?;
            if let Some(carried) = self.relaxing.carried::<N>(Points::Tets, first) {
                stress = stress + first_piola(&deformation, carried);
                if self.with_energy {
                    density = density + carried_energy(&deformation, carried);
                }
            }
            store_entries(stress, &mut self.stress[place..]);
            if self.with_energy {
                energy = rest.volumes::<N>(first).mul_add(density, energy);
            }
        }
        Ok((0..N::LANES).map(|lane| energy.lane(lane)).sum())
    }
}

/// `R : (F'F - I)/2`, whose derivative by F is F R.
#[inline(always)]
pub(super) fn carried_energy<N: Number>(deformation: &Deformation<N>, carried: [N; 6]) -> N {
    let [[xx, xy, _], [_, yy, yz], [zx, _, zz]] = deformation.twice_green_strain().0;
    let [rxx, ryy, rzz, rxy, ryz, rzx] = carried;
    let diagonal = rxx * xx + ryy * yy + rzz * zz;
    let half = N::of(0.5);
    half.mul_add(diagonal, rxy * xy + ryz * yz + rzx * zx)
}

/// The tangent of the stress in addition to the law's in tetrahedra side by side; empty if absent.
pub(super) struct TangentBeside<'a, N> {
    fibres: [Option<(&'a RegionFibres, FibrePoint<N>)>; Tissue::MOST_FAMILIES],
    factor_of_fibres: f64,
    /// R (Pa).
    carried: Option<Tensor<N>>,
    wanted: Wanted,
}

impl<'a, N: Number<Real = f64>> TangentBeside<'a, N> {
    /// The tangent, or the viscosity.
    #[inline(always)]
    pub(super) fn of(
        region: &'a HyperelasticRegion,
        relaxing: &Relaxing<'_>,
        first: usize,
        deformation: &Deformation<N>,
        wanted: Wanted,
    ) -> Self {
        let idle_count = wanted.idle_fibres_count();
        let mut fibres = [const { None }; Tissue::MOST_FAMILIES];
        for (point, family) in fibres.iter_mut().zip(&region.fibres) {
            let at = family.at(first, deformation);
            *point = Some((family, if idle_count { at.as_if_pulled() } else { at }));
        }
        let is_exact = wanted.kind() == TangentKind::Exact;
        Self {
            fibres,
            factor_of_fibres: relaxing.factor_of_fibres(),
            carried: relaxing.carried_tensor(Points::Tets, first, is_exact),
            wanted,
        }
    }

    /// The change of the total stress, the law's and the additional one, by a change of F.
    #[inline(always)]
    pub(super) fn with(&self, stress: Tensor<N>, change: Tensor<N>) -> Tensor<N> {
        let mut stress = stress;
        for (RegionFibres { fibres, .. }, at) in self.fibres.iter().flatten() {
            let tangent = match self.wanted {
                Wanted::Viscosity | Wanted::MostViscous => fibres.viscous_stress(at, change),
                Wanted::Stiffest | Wanted::Kind(TangentKind::Exact) => fibres.tangent(at, change),
                Wanted::Kind(_) => fibres.semidefinite_tangent(at, change),
            };
            stress = stress.plus(N::of(self.factor_of_fibres), tangent);
        }
        match self.carried {
            Some(carried) => stress + change * carried,
            None => stress,
        }
    }
}

/// A node's own block of the additional stress in tetrahedra side by side, for each m^3, without negative eigenvalues.
/// Fibres in compression count as pulled: otherwise the block would jump as soon as they are.
#[inline(always)]
pub(super) fn block_beside<N: Number<Real = f64>>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    first: usize,
    deformation: &Deformation<N>,
    (wanted, gradient): (Wanted, [N; 3]),
) -> Tensor<N> {
    let mut block = carried_block(relaxing, (Points::Tets, first), gradient);
    for fibres in &region.fibres {
        let at = fibres.at(first, deformation).as_if_pulled();
        let own = match wanted.is_viscosity() {
            true => fibres.fibres.viscous_block(&at, gradient),
            false => fibres.fibres.node_block(&at, gradient),
        };
        block = block.plus(N::of(relaxing.factor_of_fibres()), own);
    }
    block
}

/// `g . R g`, or 0 if that is negative, on the diagonal.
#[inline(always)]
pub(super) fn carried_block<N: Number<Real = f64>>(
    relaxing: &Relaxing<'_>,
    (points, place): (Points, usize),
    gradient: [N; 3],
) -> Tensor<N> {
    let Some(carried) = relaxing.carried_tensor(points, place, true) else {
        return Tensor::zero();
    };
    let along = dot(carried.on(gradient), gradient);
    Tensor::diagonal(along.max(N::of(0.0)))
}
