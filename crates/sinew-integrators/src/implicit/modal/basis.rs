//! Which modes are taken.

use sinew_core::{LinearOperators, Ramp};

use super::columns::add;
use super::inverse::{Inverse, held};
use super::search::Search;
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
pub(super) const SMALL: usize = 256;

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
    pub(super) fn peak(&self) -> f64 {
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
pub(super) fn most_excited(
    mut modes: Vec<Candidate>,
    cases: &[LoadCase],
    count: usize,
) -> Vec<Candidate> {
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
