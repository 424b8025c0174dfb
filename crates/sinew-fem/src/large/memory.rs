//! Memory of a region: stress that relaxes.
//!
//! With S0 the instantaneous value of the stress that relaxes, and h_i the history variables of its terms, the stress
//! at the end of a step is `S = f S0 + R`: f is a factor and R, which is symmetric, follows from the history variables
//! before the step. So during a step a tissue with memory is elastic: its stress is the derivative of
//! `f psi + R : (F'F - I)/2`, which allows tangents and line searches. Only the update of the history variables needs an
//! inverse of F, once per step.

use std::ops::Range;

use sinew_sparse::simd::{Number, Real, SharedSlice};

use crate::hyperelastic::prony::{Symmetric, Term, TermStep, relaxing, second_piola};
use crate::hyperelastic::{Bulk, Deformation, SMALLEST_VOLUME_RATIO, Tensor, semidefinite};
use crate::tissue::{Memory, ViscousPart};

/// History variables of a body, and the time since their last update.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Past<'a, T = f64> {
    /// Internal variables; empty if the body was at rest before.
    pub(crate) internal: &'a [T],
    /// Time (s) since the last update: 0 for an instantaneous change, infinite for complete relaxation.
    pub(crate) dt: f64,
}

impl<T> Past<'_, T> {
    /// Instantaneous change from rest, without history.
    pub(crate) const NONE: Self = Self {
        internal: &[],
        dt: 0.0,
    };

    /// Complete relaxation.
    pub(crate) const RELAXED: Self = Self {
        internal: &[],
        dt: f64::INFINITY,
    };
}

/// Layout of the history variables of a region: for each of its points S0 and h of each term, six numbers each. Points
/// are the places of tetrahedra and, if shear is averaged over edges, those of edges. All first numbers of tetrahedra
/// are consecutive, then all second ones, and so on.
#[derive(Clone, Debug)]
pub(super) struct RegionMemory {
    terms: Vec<Term>,
    is_deviatoric: bool,
    /// Its first internal variable among those of the body.
    first: usize,
    tets: usize,
    edges: usize,
    /// Bulk modulus (Pa) of the local part of the law.
    local_bulk: f64,
}

impl RegionMemory {
    /// `points` are numbers of places of tetrahedra and edges.
    pub(super) fn new(memory: &Memory, mu: f64, first: usize, points: [usize; 2]) -> Self {
        let [tets, edges] = points;
        Self {
            terms: memory.terms.clone(),
            is_deviatoric: memory.part == ViscousPart::Deviatoric,
            first,
            tets,
            edges,
            local_bulk: 2.0 / 3.0 * mu,
        }
    }

    /// Numbers at each point.
    fn numbers(&self) -> usize {
        6 * (1 + self.terms.len())
    }

    /// Number of internal variables.
    pub(super) fn variables(&self) -> usize {
        self.numbers() * (self.tets + self.edges)
    }

    /// Its internal variables among those of the body.
    pub(super) fn range(&self) -> Range<usize> {
        self.first..self.first + self.variables()
    }

    /// The coefficients of the terms over a step of `dt` (s).
    fn steps(&self, dt: f64) -> Steps {
        let mut terms = [TermStep::default(); Memory::MOST_TERMS];
        for (step, term) in terms.iter_mut().zip(&self.terms) {
            *step = term.over(dt);
        }
        Steps {
            terms,
            count: self.terms.len(),
        }
    }
}

/// Coefficients of the terms of a series over one step.
#[derive(Clone, Copy, Debug)]
struct Steps {
    terms: [TermStep; Memory::MOST_TERMS],
    count: usize,
}

impl Steps {
    #[inline(always)]
    fn all(&self) -> &[TermStep] {
        &self.terms[..self.count]
    }
}

/// A kind of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Points {
    Tets,
    Edges,
}

/// The memory of a region in an evaluation; for regions without it, that of an elastic one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relaxing<'a, T = f64> {
    memory: Option<&'a RegionMemory>,
    steps: Steps,
    /// f.
    pub(super) factor: f64,
    /// Internal variables of the region; empty if it was at rest before.
    internal: &'a [T],
}

impl<'a, T: Real> Relaxing<'a, T> {
    /// The memory of a region in an evaluation, the time `past.dt` after its history variables.
    pub(super) fn of(memory: Option<&'a RegionMemory>, past: Past<'a, T>) -> Self {
        let Some(memory) = memory else {
            return Self::none();
        };
        let steps = memory.steps(past.dt);
        let gains: f64 = steps.all().iter().map(TermStep::gain).sum();
        Self {
            memory: Some(memory),
            steps,
            factor: 1.0 - relaxing(&memory.terms) + gains,
            internal: past.internal.get(memory.range()).unwrap_or_default(),
        }
    }

    /// An elastic region: no memory.
    pub(super) fn none() -> Self {
        Self {
            memory: None,
            steps: Steps {
                terms: [TermStep::default(); Memory::MOST_TERMS],
                count: 0,
            },
            factor: 1.0,
            internal: &[],
        }
    }

    /// True if the region has memory.
    #[inline(always)]
    pub(super) fn is_there(&self) -> bool {
        self.memory.is_some()
    }

    /// The factor of the stress of fibres, which are elastic if only deviatoric stress relaxes: their deviatoric stress
    /// alone has no energy.
    #[inline(always)]
    pub(super) fn factor_of_fibres(&self) -> f64 {
        if self.is_deviatoric() {
            1.0
        } else {
            self.factor
        }
    }

    #[inline(always)]
    fn is_deviatoric(&self) -> bool {
        self.memory.is_some_and(|memory| memory.is_deviatoric)
    }

    /// The factor of the dilational energy of patches.
    #[inline(always)]
    pub(super) fn factor_of_dilation(&self) -> f64 {
        self.factor_of_fibres()
    }

    /// Bulk modulus (Pa) of the part of the local energy that does not relax although f multiplies it.
    #[inline(always)]
    pub(super) fn bulk_left(&self) -> f64 {
        match self.memory {
            Some(memory) if memory.is_deviatoric => (1.0 - self.factor) * memory.local_bulk,
            _ => 0.0,
        }
    }

    /// The remainder, after relaxation, of a share of the local energy, and of the derivatives of the dilational one.
    #[inline(always)]
    pub(super) fn left_of<N: Number>(&self, share: N, bulk: Bulk<N>, dilation: N) -> (N, Bulk<N>) {
        if !self.is_there() {
            return (share, bulk);
        }
        let (factor, left) = (
            N::of(self.factor_of_dilation()),
            share * N::of(self.bulk_left()),
        );
        let bulk = Bulk {
            stress: factor * bulk.stress + left * dilation,
            modulus: factor * bulk.modulus + left,
        };
        (N::of(self.factor) * share, bulk)
    }

    /// R (Pa) at points side by side; `None` without history.
    #[inline(always)]
    pub(super) fn carried<N: Number<Real = T>>(
        &self,
        points: Points,
        place: usize,
    ) -> Option<Symmetric<N>> {
        let memory = self.memory?;
        if self.internal.is_empty() {
            return None;
        }
        let (start, count) = memory.part(points);
        let all = &self.internal[start + place..];
        let mut gains = 0.0;
        let mut carried = [N::of(0.0); 6];
        for (k, step) in self.steps.all().iter().enumerate() {
            gains += step.gain();
            let of_term = &all[6 * (k + 1) * count..];
            add(&mut carried, N::of(step.decay()), of_term, count);
        }
        add(&mut carried, N::of(-gains), all, count);
        Some(carried)
    }

    /// True if the memory is defined for a deformation, in all lanes.
    #[inline(always)]
    pub(super) fn admits<N: Number>(&self, deformation: &Deformation<N>) -> bool {
        !self.is_there() || N::all_le(N::of(SMALLEST_VOLUME_RATIO), deformation.volume_ratio)
    }
}

impl Relaxing<'_> {
    /// R (Pa) at points side by side as tensors, without negative eigenvalues unless the exact tensor is requested.
    #[inline(always)]
    pub(super) fn carried_tensor<N: Number<Real = f64>>(
        &self,
        points: Points,
        place: usize,
        is_exact: bool,
    ) -> Option<Tensor<N>> {
        let carried = tensor(self.carried::<N>(points, place)?);
        Some(if is_exact {
            carried
        } else {
            semidefinite(carried)
        })
    }
}

impl RegionMemory {
    /// The first variable of points of a kind, and their number.
    #[inline(always)]
    fn part(&self, points: Points) -> (usize, usize) {
        match points {
            Points::Tets => (0, self.tets),
            Points::Edges => (self.numbers() * self.tets, self.edges),
        }
    }
}

/// Internal variables of a body that are updated, `dt` (s) after the time that they hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remembered<'a, T> {
    pub(super) internal: SharedSlice<'a, T>,
    pub(super) dt: f64,
}

/// The memory of a region during its update.
#[derive(Debug)]
pub(super) struct Remembering<'a, T> {
    memory: &'a RegionMemory,
    steps: Steps,
    internal: &'a mut [T],
}

impl<'a, T: Real> Remembering<'a, T> {
    /// The memory of a region, to be updated `dt` (s) after the time that its internal variables hold.
    pub(super) fn of(memory: &'a RegionMemory, dt: f64, internal: &'a mut [T]) -> Self {
        Self {
            memory,
            steps: memory.steps(dt),
            internal,
        }
    }

    /// True if only deviatoric stress relaxes.
    #[inline(always)]
    pub(super) fn is_deviatoric(&self) -> bool {
        self.memory.is_deviatoric
    }

    /// Updates the history variables from the first Piola-Kirchhoff stress (Pa) that relaxes, at points side by side.
    #[inline(always)]
    pub(super) fn take<N: Number<Real = T>>(
        &mut self,
        points: Points,
        place: usize,
        deformation: &Deformation<N>,
        stress: Tensor<N>,
    ) {
        let now = second_piola(deformation, stress);
        let (start, count) = self.memory.part(points);
        let all = &mut self.internal[start + place..];
        let mut change = now;
        for (c, change) in change.iter_mut().enumerate() {
            let at = &mut all[c * count..];
            let before = N::load(at);
            change.store(at);
            *change = *change - before;
        }
        for (k, step) in self.steps.all().iter().enumerate() {
            for (c, change) in change.iter().enumerate() {
                let at = &mut all[(6 * (k + 1) + c) * count..];
                let kept = N::load(at) * N::of(step.decay());
                change.mul_add(N::of(step.gain()), kept).store(at);
            }
        }
    }
}

/// Adds numbers, `count` apart from each other.
#[inline(always)]
fn add<N: Number>(sum: &mut Symmetric<N>, factor: N, numbers: &[N::Real], count: usize) {
    for (c, sum) in sum.iter_mut().enumerate() {
        *sum = N::load(&numbers[c * count..]).mul_add(factor, *sum);
    }
}

#[inline(always)]
fn tensor<N: Number>([xx, yy, zz, xy, yz, zx]: Symmetric<N>) -> Tensor<N> {
    Tensor([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
}
