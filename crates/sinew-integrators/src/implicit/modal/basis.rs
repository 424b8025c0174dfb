//! The modes of a basis.

use sinew_core::LinearOperators;

use super::candidate::{CandidateMode, most_excited};
use super::columns::add;
use super::failure::Failure;
use super::inverse::{Inverse, held};
use super::search::Search;
use super::small::{self, SMALL};
use crate::load_case::LoadCase;

/// Number of modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Choice {
    /// `count` modes, from a Lanczos basis of a given size or of twice as many.
    Modes { count: usize, basis: Option<usize> },
    /// The fewest modes with an estimated error below this share of the response.
    Tolerance(f64),
}

/// Kinds of vectors that represent the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vectors {
    /// Modes, the most excited ones of a Lanczos basis.
    #[default]
    Eigen,
    /// Ritz vectors of the loads: the most excited ones of such a basis, and the rest of the static responses.
    Ritz,
}

/// The chosen modes, with unit modal masses.
#[derive(Debug, Default)]
pub(super) struct Basis {
    /// Angular frequencies (rad/s), in increasing order.
    pub(super) frequencies: Vec<f64>,
    /// Shapes (kg^-1/2), each of the system's length, one after the other.
    pub(super) shapes: Vec<f64>,
    /// Force on each mode, for each load case.
    pub(super) forces: Vec<Vec<f64>>,
    /// True if these are all modes of the system.
    pub(super) complete: bool,
    /// Estimated share of the response to the loads that is lost; none for a fixed number of modes.
    pub(super) estimate: Option<f64>,
    /// The inverse that measures the part of a state outside the modes.
    pub(super) inverse: Option<Inverse>,
    pub(super) solves: u64,
    pub(super) factorizations: u64,
}

impl Basis {
    pub(super) fn build(
        operators: &LinearOperators,
        cases: &[LoadCase],
        choice: Choice,
        vectors: Vectors,
    ) -> Result<Self, Failure> {
        let root: Vec<f64> = operators.mass().iter().map(|mass| mass.sqrt()).collect();
        let held = held(operators);
        let free = held.iter().filter(|held| !**held).count();
        if free <= SMALL && vectors == Vectors::Eigen {
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
        let (candidates, modes, estimate) = match (vectors, choice) {
            (Vectors::Ritz, choice) => {
                let damping = operators.damping();
                let damping = [damping.mass, damping.stiffness];
                search.ritz(choice, damping, &mut inverse)?
            }
            (_, Choice::Modes { count, basis }) => search.so_many(count, basis, &mut inverse)?,
            (_, Choice::Tolerance(tolerance)) => search.within(tolerance, &mut inverse)?,
        };
        let mut basis = Self::of(modes, &candidates, &root, cases.len());
        basis.complete = basis.frequencies.len() == free;
        basis.estimate = estimate;
        basis.keep(inverse);
        Ok(basis)
    }

    /// The shape of each mode, and its angular frequency (rad/s).
    pub(super) fn modes(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let dofs = self.shapes.len() / self.frequencies.len().max(1);
        let shapes = self.shapes.chunks_exact(dofs.max(1));
        shapes.zip(self.frequencies.iter().copied())
    }

    fn keep(&mut self, inverse: Inverse) {
        self.solves = inverse.solves;
        self.factorizations = inverse.factorizations;
        self.inverse = Some(inverse);
    }

    /// Computes shapes from their components along `columns`.
    fn of(mut modes: Vec<CandidateMode>, columns: &[f64], root: &[f64], cases: usize) -> Self {
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
