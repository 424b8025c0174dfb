//! Which modes are taken.

use sinew_core::{LinearOperators, Ramp};

use super::columns::{add, dot};
use super::inverse::{Inverse, held};
use super::krylov::{Krylov, Ritz};
use super::small;

/// How many modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Choice {
    /// So many, from a Lanczos basis of a given size or of twice as many.
    Modes { count: usize, basis: Option<usize> },
    /// As many as bring the estimated error below this share of the response.
    Tolerance(f64),
}

/// Degrees of freedom up to which all modes are found at once: choosing would cost more than it
/// saves.
const SMALL: usize = 256;

/// Share of the degrees of freedom that a Lanczos basis may take up in the search for a tolerance.
const SHARE: f64 = 0.5;

/// Share of the tolerance that the estimate is held to: it is a mean over all phases of the modes,
/// and a run sees some of them.
const MARGIN: f64 = 0.8;

/// Lowest modes that are taken where nothing but the first state excites any.
const WITHOUT_LOADS: usize = 64;

/// Size of the first Lanczos basis; each further one is larger by a third.
const FIRST: usize = 24;

/// `||A x - theta x|| / theta` of a mode that counts as found.
const CONVERGED: f64 = 1e-8;

/// Loads with one ramp, as one.
#[derive(Clone, Debug)]
pub(super) struct LoadCase {
    pub(super) ramp: Ramp,
    /// The force (N) on each degree of freedom.
    pub(super) force: Vec<f64>,
}

impl LoadCase {
    /// The loads of a system, those with equal ramps added up.
    pub(super) fn of(operators: &LinearOperators) -> Vec<Self> {
        let mut cases: Vec<Self> = Vec::new();
        for load in operators.loads() {
            let at = cases.iter().position(|case| case.ramp == load.ramp);
            let at = at.unwrap_or_else(|| {
                cases.push(Self {
                    ramp: load.ramp.clone(),
                    force: vec![0.0; operators.dofs()],
                });
                cases.len() - 1
            });
            for &(dof, force) in &load.entries {
                cases[at].force[dof as usize] += force;
            }
        }
        cases.retain(|case| case.force.iter().any(|force| *force != 0.0));
        cases
    }

    /// Largest size of the ramp.
    fn peak(&self) -> f64 {
        match &self.ramp {
            Ramp::Table { values, .. } => values.iter().fold(0.0, |peak, x| x.abs().max(peak)),
            Ramp::Step | Ramp::Sin2 { .. } | Ramp::Pulse { .. } => 1.0,
        }
    }
}

/// A mode before it is taken.
#[derive(Debug)]
pub(super) struct Candidate {
    /// omega^2 (1/s^2); 0 exactly for a rigid motion.
    pub(super) squared: f64,
    /// Its parts along the columns of [`Candidates::columns`].
    pub(super) vector: Vec<f64>,
    /// Each load case's force on it, its mass being 1.
    pub(super) forces: Vec<f64>,
}

impl Candidate {
    fn is_rigid(&self) -> bool {
        self.squared == 0.0
    }

    /// The squared size of its static response to all load cases.
    fn excitation(&self, cases: &[LoadCase]) -> f64 {
        let forces = self.forces.iter().zip(cases);
        let response = forces.map(|(force, case)| (case.peak() * force / self.squared).powi(2));
        response.sum()
    }
}

/// Modes that may be taken.
#[derive(Debug)]
pub(super) struct Candidates {
    /// M^1/2 times a basis, orthonormal.
    pub(super) columns: Vec<f64>,
    /// Slowest first.
    pub(super) modes: Vec<Candidate>,
}

/// The modes taken, with unit modal masses.
#[derive(Debug, Default)]
pub(super) struct Basis {
    /// Angular frequencies (rad/s), in increasing order.
    pub(super) frequencies: Vec<f64>,
    /// Shapes (kg^-1/2), each of the system's length, one after the other.
    pub(super) shapes: Vec<f64>,
    /// For each load case, its force on each mode.
    pub(super) forces: Vec<Vec<f64>>,
    /// Whether they are all the modes there are.
    pub(super) complete: bool,
    /// Estimated share of the response to the loads that is lost; none for a fixed number of modes.
    pub(super) estimate: Option<f64>,
    /// What answers how much a part of a state outside the modes matters.
    pub(super) inverse: Option<Inverse>,
    pub(super) solves: u64,
    pub(super) factorizations: u64,
}

/// Why there is no basis.
#[derive(Debug)]
pub(super) enum Failure {
    Factorization(String),
    /// The tolerance needs more modes than may be taken.
    TooMany {
        basis: usize,
        dofs: usize,
        estimate: f64,
    },
}

impl Basis {
    pub(super) fn build(
        operators: &LinearOperators,
        cases: &[LoadCase],
        choice: Choice,
    ) -> Result<Self, Failure> {
        let root: Vec<f64> = operators.mass().iter().map(|mass| mass.sqrt()).collect();
        let held = held(operators);
        let free = held.iter().filter(|held| !**held).count();
        if free <= SMALL {
            let candidates =
                small::all_modes(operators, cases, &held).map_err(Failure::Factorization)?;
            let modes = match choice {
                Choice::Modes { count, .. } => most_excited(candidates.modes, cases, count),
                Choice::Tolerance(_) => candidates.modes,
            };
            let complete = modes.len() == free;
            let mut basis = Self::of(modes, &candidates.columns, &root, cases.len());
            basis.complete = complete;
            if complete {
                basis.estimate = Some(0.0);
            } else {
                let inverse = Inverse::new(operators).map_err(Failure::Factorization)?;
                basis.keep(inverse);
            }
            return Ok(basis);
        }
        let mut inverse = Inverse::new(operators).map_err(Failure::Factorization)?;
        let rigid = inverse.rigid_motions().map_err(Failure::Factorization)?;
        let search = Search::new(rigid, cases, &mut inverse, free);
        let (candidates, modes, estimate) = match choice {
            Choice::Modes { count, basis } => search.so_many(count, basis, &mut inverse)?,
            Choice::Tolerance(tolerance) => search.within(tolerance, &mut inverse)?,
        };
        let mut basis = Self::of(modes, &candidates, &root, cases.len());
        basis.estimate = estimate;
        basis.keep(inverse);
        Ok(basis)
    }

    fn keep(&mut self, inverse: Inverse) {
        self.solves = inverse.solves;
        self.factorizations = inverse.factorizations;
        self.inverse = Some(inverse);
    }

    /// Shapes from their parts along `columns`.
    fn of(mut modes: Vec<Candidate>, columns: &[f64], root: &[f64], cases: usize) -> Self {
        modes.sort_by(|a, b| a.squared.total_cmp(&b.squared));
        let n = root.len();
        let mut shapes = vec![0.0; modes.len() * n];
        for (mode, shape) in modes.iter().zip(shapes.chunks_exact_mut(n.max(1))) {
            add(columns, &mode.vector, 1.0, shape);
            for (value, root) in shape.iter_mut().zip(root) {
                *value /= root;
            }
        }
        let force = |case: usize| modes.iter().map(|mode| mode.forces[case]).collect();
        Self {
            frequencies: modes.iter().map(|mode| mode.squared.sqrt()).collect(),
            shapes,
            forces: (0..cases).map(force).collect(),
            ..Self::default()
        }
    }
}

/// Rigid motions, then the most excited modes, or the slowest where there are no loads.
fn most_excited(mut modes: Vec<Candidate>, cases: &[LoadCase], count: usize) -> Vec<Candidate> {
    let rigid = modes.iter().filter(|mode| mode.is_rigid()).count();
    if !cases.is_empty() {
        let rank = |mode: &Candidate| match mode.is_rigid() {
            true => f64::INFINITY,
            false => mode.excitation(cases),
        };
        modes.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    }
    modes.truncate(count.max(rigid));
    modes
}

/// Columns, modes and the estimated error.
type Found = (Vec<f64>, Vec<Candidate>, Option<f64>);

/// The search for modes in Lanczos bases that start from the static response to each load case
/// (Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10, 1982): what loads do not excite
/// never enters. In the basis Q the equation of motion, multiplied by A, is
/// `T q'' + (alpha T + beta) q' + q = Q' A f` with `T = Q' A Q` (Nour-Omid and Clough, same journal
/// 12, 1984), whose eigenvectors are the modes as far as they have converged and bundles of fast
/// modes beyond; the static response is exact in any of these bases.
struct Search<'a> {
    krylov: Krylov,
    cases: &'a [LoadCase],
    rigid_forces: Vec<Vec<f64>>,
    shift: f64,
    free: usize,
}

impl<'a> Search<'a> {
    fn new(rigid: Vec<f64>, cases: &'a [LoadCase], inverse: &mut Inverse, free: usize) -> Self {
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
            starts = (0..3).map(|i| super::inverse::noise(n, i + 100)).collect();
            starts.iter_mut().for_each(|start| inverse.mask(start));
        }
        Self {
            krylov: Krylov::new(rigid, starts, n),
            cases,
            rigid_forces,
            shift: inverse.shift,
            free,
        }
    }

    fn so_many(
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
        self.krylov.grow(basis.min(self.free), inverse);
        let pairs = self.pairs()?;
        Ok(self.take(pairs, count, None))
    }

    fn pairs(&self) -> Result<Vec<Ritz>, Failure> {
        self.krylov.ritz_pairs().map_err(Failure::Factorization)
    }

    /// So many of the slowest modes, converged.
    fn slowest(&mut self, count: usize, inverse: &mut Inverse) -> Result<Vec<Ritz>, Failure> {
        let mut size = 2 * count + FIRST;
        loop {
            self.krylov.grow(size, inverse);
            let mut pairs = self.pairs()?;
            pairs.truncate(count);
            let found = pairs
                .iter()
                .all(|pair| pair.residual <= CONVERGED * pair.theta);
            if found || self.krylov.exhausted() {
                return Ok(pairs);
            }
            size += size / 3;
        }
    }

    /// Grows the basis until the response to suddenly applied loads changes by less than the
    /// error aimed at, then leaves out what is least excited.
    fn within(mut self, tolerance: f64, inverse: &mut Inverse) -> Result<Found, Failure> {
        if self.cases.is_empty() {
            let pairs = self.slowest(WITHOUT_LOADS, inverse)?;
            let count = self.rigid_forces.len() + pairs.len();
            return Ok(self.take(pairs, count, None));
        }
        let aim = MARGIN * tolerance;
        let most = ((SHARE * self.free as f64) as usize).max(SMALL);
        let mut instants = Vec::new();
        let mut before: Option<Vec<Vec<f64>>> = None;
        let mut size = FIRST;
        loop {
            self.krylov.grow(size, inverse);
            let pairs = self.pairs()?;
            if instants.is_empty() {
                let slowest = pairs.first().map_or(0.0, |pair| self.squared(pair));
                instants = sample_times(slowest.sqrt());
            }
            let responses = self.responses(&pairs, &instants);
            let change = match &before {
                _ if self.krylov.exhausted() => 0.0,
                None => f64::INFINITY,
                Some(before) => relative_change(before, &responses),
            };
            // Half of the allowed square is kept for the modes that are left out.
            if change <= aim * std::f64::consts::FRAC_1_SQRT_2 {
                return Ok(self.thin_out(pairs, aim, change));
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

    fn squared(&self, pair: &Ritz) -> f64 {
        (pair.theta.recip() - self.shift).max(0.0)
    }

    /// Parts along the basis of the undamped responses to each load case, suddenly applied.
    fn responses(&self, pairs: &[Ritz], instants: &[f64]) -> Vec<Vec<f64>> {
        let mut responses = Vec::new();
        for (case, load) in self.cases.iter().enumerate() {
            for t in instants {
                let mut response = vec![0.0; self.krylov.size()];
                for pair in pairs {
                    let swing = 1.0 - (self.squared(pair).sqrt() * t).cos();
                    let size = load.peak() * pair.excitation[case] * swing;
                    add(&pair.vector, &[size], 1.0, &mut response);
                }
                responses.push(response);
            }
        }
        responses
    }

    /// Leaves out the least excited modes as far as the error aimed at allows.
    fn thin_out(self, pairs: Vec<Ritz>, aim: f64, change: f64) -> Found {
        let size = |pair: &Ritz| -> f64 {
            let parts = pair.excitation.iter().zip(self.cases);
            parts.map(|(part, case)| (case.peak() * part).powi(2)).sum()
        };
        let mut sizes: Vec<f64> = pairs.iter().map(size).collect();
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

    fn take(self, pairs: Vec<Ritz>, count: usize, estimate: Option<f64>) -> Found {
        let n_rigid = self.rigid_forces.len();
        let size = self.krylov.size();
        let unit = |at: usize| {
            let mut unit = vec![0.0; n_rigid + size];
            unit[at] = 1.0;
            unit
        };
        let rigid = self
            .rigid_forces
            .iter()
            .enumerate()
            .map(|(i, forces)| Candidate {
                squared: 0.0,
                vector: unit(i),
                forces: forces.clone(),
            });
        let elastic = pairs.into_iter().map(|pair| {
            let mut vector = vec![0.0; n_rigid];
            let excitation = pair.excitation.iter();
            Candidate {
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
        let columns = [self.krylov.rigid(), self.krylov.basis()].concat();
        (columns, modes, estimate)
    }
}

/// Instants over eight periods of the slowest mode, spread evenly by the golden ratio.
fn sample_times(slowest: f64) -> Vec<f64> {
    const COUNT: u32 = 48;
    let span = 8.0 * std::f64::consts::TAU / slowest.max(f64::MIN_POSITIVE);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    (0..COUNT)
        .map(|i| span * ((f64::from(i) + 0.5) * golden).fract())
        .collect()
}

/// `||now - before|| / ||now||`; the parts known before come first.
fn relative_change(before: &[Vec<f64>], now: &[Vec<f64>]) -> f64 {
    let (mut difference, mut size) = (0.0, 0.0);
    for (before, now) in before.iter().zip(now) {
        for (i, value) in now.iter().enumerate() {
            difference += (value - before.get(i).copied().unwrap_or(0.0)).powi(2);
            size += value * value;
        }
    }
    f64::sqrt(difference / size)
}
