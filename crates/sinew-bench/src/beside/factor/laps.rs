//! Alternating laps: they factorise, we factorise, they solve, we solve.

use sinew_core::LinearSystem;
use sinew_integrators::Factor;
use sinew_measure::{on_one_thread, thread_cpu_time};
use sinew_verify::LabError;

use super::super::laps::{RivalError, Rounds};
use super::effective::EffectiveMatrix;
use crate::median::median_of_sorted;

/// Another library with the factor of one matrix.
pub trait FactorLibrary {
    /// CPU time (s) of one numeric factorisation.
    ///
    /// # Errors
    /// An error of the library.
    fn factorise(&mut self) -> Result<f64, RivalError>;

    /// CPU time (s) of one solution with the load.
    ///
    /// # Errors
    /// An error of the library.
    fn solve(&mut self) -> Result<f64, RivalError>;

    /// The last solution.
    ///
    /// # Errors
    /// An error of the library.
    fn solution(&mut self) -> Result<Vec<f64>, RivalError>;

    /// Its name, version and ordering.
    fn name(&self) -> String;
}

/// Our factor of one matrix compared with the other library's.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorPair {
    /// Nodes along an edge of the cube.
    pub side: usize,
    /// Unknowns.
    pub unknowns: usize,
    /// The other library, with its ordering.
    pub library: String,
    /// CPU time of our numeric factorisation over that of theirs in the preceding lap, sorted.
    pub factorise: Vec<f64>,
    /// CPU time of our solution over that of theirs in the preceding lap, sorted.
    pub solve: Vec<f64>,
    /// `||A x - F|| / ||F||` of our solution and of theirs.
    pub residuals: [f64; 2],
}

/// Pairs of several sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorTable(pub Vec<FactorPair>);

/// Factorises and solves alternately with another library, on one thread.
///
/// # Errors
/// [`LabError`].
pub fn run_factor_laps(
    matrix: &EffectiveMatrix,
    library: &mut (dyn FactorLibrary + Send),
    rounds: Rounds,
) -> Result<FactorPair, LabError> {
    on_one_thread(|| run_here(matrix, library, rounds))?
}

fn run_here(
    matrix: &EffectiveMatrix,
    library: &mut dyn FactorLibrary,
    Rounds(rounds): Rounds,
) -> Result<FactorPair, LabError> {
    let (operators, combination) = (matrix.model.operators(), matrix.combination());
    let mut factor = Factor::analyse(operators)?;
    let mut solution = matrix.force.clone();
    let (mut factorise, mut solve) = (Vec::new(), Vec::new());
    // The first round brings memory and clocks up to speed and counts for nothing.
    for round in 0..=rounds {
        let theirs = library.factorise().map_err(LabError::boxed)?;
        let before = thread_cpu_time();
        factor.factorise(operators, combination)?;
        let ours = thread_cpu_time() - before;
        if round > 0 {
            factorise.push(ours.as_secs_f64() / theirs);
        }
        for _ in 0..SOLUTIONS {
            let theirs = library.solve().map_err(LabError::boxed)?;
            solution.copy_from_slice(&matrix.force);
            let before = thread_cpu_time();
            factor.solve(&mut solution);
            let ours = thread_cpu_time() - before;
            if round > 0 {
                solve.push(ours.as_secs_f64() / theirs);
            }
        }
    }
    factorise.sort_by(f64::total_cmp);
    solve.sort_by(f64::total_cmp);
    let theirs = library.solution().map_err(LabError::boxed)?;
    Ok(FactorPair {
        side: matrix.side,
        unknowns: matrix.force.len(),
        library: library.name(),
        factorise,
        solve,
        residuals: [matrix.residual(&solution), matrix.residual(&theirs)],
    })
}

/// Solutions in each round.
const SOLUTIONS: usize = 5;

impl FactorPair {
    /// Medians of the ratios: factorisation and solution.
    #[must_use]
    pub fn medians(&self) -> [f64; 2] {
        [&self.factorise, &self.solve].map(|ratios| median_of_sorted(ratios))
    }
}
