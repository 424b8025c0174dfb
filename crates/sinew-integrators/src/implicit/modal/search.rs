//! The search for the modes that loads excite.

use sinew_core::closed_form::Mode;
use sinew_core::vectors::{dot, noise};

use super::candidate::{CandidateMode, most_excited};
use super::columns::add;
use super::failure::Failure;
use super::inverse::Inverse;
use super::lanczos_basis::{LanczosBasis, Ritz};
use super::small::SMALL;
use crate::load_case::LoadCase;

/// Share of the degrees of freedom that a Lanczos basis may take up in the search for a tolerance.
const SHARE: f64 = 0.5;

/// Share of the tolerance that bounds the estimate: it is a mean over all phases of the modes, and a run contains only
/// some of them.
pub(super) const MARGIN: f64 = 0.8;

/// Number of lowest modes that are taken if only the first state excites any.
const WITHOUT_LOADS: usize = 64;

/// Size of the first Lanczos basis; each further one is larger by a third.
const FIRST: usize = 24;

/// `||A x - theta x|| / theta` of a mode that counts as found.
const CONVERGED: f64 = 1e-8;

/// Columns, modes and the estimated error.
pub(super) type Found = (Vec<f64>, Vec<CandidateMode>, Option<f64>);

/// The search for modes in Lanczos bases that start from the static response to each load case (Wilson, Yuan and
/// Dickens, Earthquake Eng. Struct. Dyn. 10, 1982): modes that no load excites are never included. In the basis Q the
/// equation of motion, multiplied by A, is `T q'' + (alpha T + beta) q' + q = Q' A f` with `T = Q' A Q` (Nour-Omid and
/// Clough, same journal 12, 1984), whose eigenvectors are the converged modes and, beyond them, groups of fast modes;
/// the static response is exact in each of these bases.
pub(super) struct Search<'a> {
    pub(super) lanczos: LanczosBasis,
    pub(super) cases: &'a [LoadCase],
    pub(super) rigid_forces: Vec<Vec<f64>>,
    shift: f64,
    pub(super) free: usize,
    /// alpha (1/s) and beta (s) of the responses for the error estimate.
    pub(super) damping: [f64; 2],
}

impl<'a> Search<'a> {
    pub(super) fn new(
        rigid: Vec<f64>,
        cases: &'a [LoadCase],
        inverse: &mut Inverse,
        free: usize,
    ) -> Self {
        let n = inverse.root.len();
        let scaled = |case: &LoadCase, root: &[f64]| -> Vec<f64> {
            let entries = case.force.iter().zip(root);
            let entry = |(force, root): (&f64, &f64)| if *root > 0.0 { force / root } else { 0.0 };
            entries.map(entry).collect()
        };
        let forces: Vec<Vec<f64>> = cases
            .iter()
            .map(|case| scaled(case, &inverse.root))
            .collect();
        let rigid_forces = rigid
            .chunks_exact(n)
            .map(|motion| forces.iter().map(|force| dot(motion, force)).collect())
            .collect();
        let mut starts: Vec<Vec<f64>> = forces
            .iter()
            .map(|force| {
                let mut elastic = force.clone();
                for motion in rigid.chunks_exact(n) {
                    let part = dot(motion, force);
                    add(motion, &[part], -1.0, &mut elastic);
                }
                let mut response = vec![0.0; n];
                inverse.apply(&elastic, &mut response);
                response
            })
            .collect();
        if starts.is_empty() {
            // More than one finds modes of equal frequency.
            starts = (0..3).map(|i| noise(n, i + 100)).collect();
            starts.iter_mut().for_each(|start| inverse.mask(start));
        }
        Self {
            lanczos: LanczosBasis::new(rigid, starts, n),
            cases,
            rigid_forces,
            shift: inverse.shift,
            free,
            damping: [0.0; 2],
        }
    }

    pub(super) fn so_many(
        mut self,
        count: usize,
        basis: Option<usize>,
        inverse: &mut Inverse,
    ) -> Result<Found, Failure> {
        let wanted = count.saturating_sub(self.rigid_forces.len());
        if self.cases.is_empty() {
            let pairs = self.slowest(wanted, inverse)?;
            return Ok(self.take(pairs, count, None));
        }
        let basis = basis.unwrap_or(wanted.saturating_mul(2)).max(wanted);
        self.lanczos.grow(basis.min(self.free), inverse);
        let pairs = self.pairs()?;
        Ok(self.take(pairs, count, None))
    }

    pub(super) fn pairs(&self) -> Result<Vec<Ritz>, Failure> {
        self.lanczos.ritz_pairs().map_err(Failure::Factorization)
    }

    /// The `count` slowest modes, converged.
    fn slowest(&mut self, count: usize, inverse: &mut Inverse) -> Result<Vec<Ritz>, Failure> {
        let mut size = 2 * count + FIRST;
        loop {
            self.lanczos.grow(size, inverse);
            let mut pairs = self.pairs()?;
            pairs.truncate(count);
            let found = pairs
                .iter()
                .all(|pair| pair.residual <= CONVERGED * pair.theta);
            if found || self.lanczos.exhausted() {
                return Ok(pairs);
            }
            size += size / 3;
        }
    }

    /// Grows the basis until the response to suddenly applied loads changes by less than the target error, then leaves
    /// out the least excited modes.
    pub(super) fn within(
        mut self,
        tolerance: f64,
        inverse: &mut Inverse,
    ) -> Result<Found, Failure> {
        if self.cases.is_empty() {
            let pairs = self.slowest(WITHOUT_LOADS, inverse)?;
            let count = self.rigid_forces.len() + pairs.len();
            return Ok(self.take(pairs, count, None));
        }
        let aim = MARGIN * tolerance;
        let (pairs, change) = self.converged(aim, inverse)?;
        Ok(self.thin_out(pairs, aim, change))
    }

    /// The pairs of the first basis whose response changes so little from the last one that half of the squared target
    /// error is left, and that change.
    pub(super) fn converged(
        &mut self,
        aim: f64,
        inverse: &mut Inverse,
    ) -> Result<(Vec<Ritz>, f64), Failure> {
        let most = ((SHARE * self.free as f64) as usize).max(SMALL);
        let mut instants = Vec::new();
        let mut before: Option<Vec<Vec<f64>>> = None;
        let mut size = FIRST;
        loop {
            self.lanczos.grow(size, inverse);
            let pairs = self.pairs()?;
            if instants.is_empty() {
                let slowest = pairs.first().map_or(0.0, |pair| self.squared(pair));
                instants = sample_times(slowest.sqrt());
            }
            let responses = self.responses(&pairs, &instants);
            let change = match &before {
                _ if self.lanczos.exhausted() => 0.0,
                None => f64::INFINITY,
                Some(before) => relative_change(before, &responses),
            };
            // Half of the allowed square is kept for the modes that are left out.
            if change <= aim * std::f64::consts::FRAC_1_SQRT_2 {
                return Ok((pairs, change));
            }
            if size >= most {
                return Err(Failure::TooMany {
                    basis: size,
                    dofs: self.free,
                    estimate: change,
                });
            }
            before = Some(responses);
            size = (size + size / 3).min(most);
        }
    }

    pub(super) fn squared(&self, pair: &Ritz) -> f64 {
        (pair.theta.recip() - self.shift).max(0.0)
    }

    /// The response of a mode to a load suddenly applied, over the static one.
    fn swing(&self, squared: f64, t: f64) -> f64 {
        let [alpha, beta] = self.damping;
        if alpha == 0.0 && beta == 0.0 {
            return 1.0 - (squared.sqrt() * t).cos();
        }
        let mode = Mode {
            lambda: squared,
            damping: alpha + beta * squared,
        };
        let (s, s_rate) = mode.impulse(t);
        1.0 - (s_rate + mode.damping * s)
    }

    /// Components along the basis of the responses to each load case, suddenly applied.
    pub(super) fn responses(&self, pairs: &[Ritz], instants: &[f64]) -> Vec<Vec<f64>> {
        let mut responses = Vec::new();
        for (case, load) in self.cases.iter().enumerate() {
            for t in instants {
                let mut response = vec![0.0; pairs.first().map_or(0, |pair| pair.vector.len())];
                for pair in pairs {
                    let swing = self.swing(self.squared(pair), *t);
                    let size = load.peak() * pair.excitation[case] * swing;
                    add(&pair.vector, &[size], 1.0, &mut response);
                }
                responses.push(response);
            }
        }
        responses
    }

    /// Squared size of a pair's static response to all load cases.
    pub(super) fn excitation(&self, pair: &Ritz) -> f64 {
        let parts = pair.excitation.iter().zip(self.cases);
        parts.map(|(part, case)| (case.peak() * part).powi(2)).sum()
    }

    /// Leaves out the least excited modes as far as the target error allows.
    fn thin_out(self, pairs: Vec<Ritz>, aim: f64, change: f64) -> Found {
        let mut sizes: Vec<f64> = pairs.iter().map(|pair| self.excitation(pair)).collect();
        sizes.sort_by(f64::total_cmp);
        let total: f64 = sizes.iter().sum();
        let allowed = (aim * aim - change * change) * total;
        let mut lost = 0.0;
        let spared = sizes.iter().take_while(|size| {
            let fits = lost + **size <= allowed;
            if fits {
                lost += **size;
            }
            fits
        });
        let count = self.rigid_forces.len() + pairs.len() - spared.count();
        let estimate = (change * change + lost / total).sqrt();
        self.take(pairs, count, Some(estimate))
    }

    pub(super) fn take(self, pairs: Vec<Ritz>, count: usize, estimate: Option<f64>) -> Found {
        let n_rigid = self.rigid_forces.len();
        let size = self.lanczos.size();
        let unit = |at: usize| {
            let mut unit = vec![0.0; n_rigid + size];
            unit[at] = 1.0;
            unit
        };
        let rigid = self
            .rigid_forces
            .iter()
            .enumerate()
            .map(|(i, forces)| CandidateMode {
                squared: 0.0,
                vector: unit(i),
                forces: forces.clone(),
            });
        let elastic = pairs.into_iter().map(|pair| {
            let mut vector = vec![0.0; n_rigid];
            let excitation = pair.excitation.iter();
            CandidateMode {
                // Nothing elastic is without any stiffness.
                squared: (pair.theta.recip() - self.shift).max(f64::MIN_POSITIVE),
                forces: match self.cases.is_empty() {
                    true => Vec::new(),
                    false => excitation.map(|part| part / pair.theta).collect(),
                },
                vector: {
                    vector.extend(pair.vector);
                    vector
                },
            }
        });
        let modes = most_excited(rigid.chain(elastic).collect(), self.cases, count);
        let columns = [self.lanczos.rigid(), self.lanczos.basis()].concat();
        (columns, modes, estimate)
    }
}

/// Instants over eight periods of the slowest mode, spread evenly by the golden ratio.
pub(super) fn sample_times(slowest: f64) -> Vec<f64> {
    const COUNT: u32 = 48;
    let span = 8.0 * std::f64::consts::TAU / slowest.max(f64::MIN_POSITIVE);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    (0..COUNT)
        .map(|i| span * ((f64::from(i) + 0.5) * golden).fract())
        .collect()
}

/// `||now - before|| / ||now||`; the components known before come first.
pub(super) fn relative_change(before: &[Vec<f64>], now: &[Vec<f64>]) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (before, now) in before.iter().zip(now) {
        for (i, value) in now.iter().enumerate() {
            difference += (value - before.get(i).copied().unwrap_or(0.0)).powi(2);
            size += value * value;
        }
    }
    f64::sqrt(difference / size)
}
