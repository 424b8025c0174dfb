//! The lowest modes, all of them, by iteration of a subspace.

use sinew_core::vectors::{add_scaled, dot, noise, norm, scale};
use sinew_core::{EvaluationError, LinearOperators, OperatorError};
use sinew_integrators::{Combination, FactorError, Solver};

use super::jacobi::eigen;

/// A reason for which there are no modes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModesError {
    /// A system that shows no matrices.
    #[error("natural modes need a system with matrices")]
    NoMatrices,
    /// A law that refuses the state at rest.
    #[error("no natural modes about rest: {0}")]
    Refused(#[from] EvaluationError),
    /// A tangent at rest that makes no system.
    #[error("no natural modes about rest: {0}")]
    Operators(#[from] OperatorError),
    /// A stiffness that has no factor.
    #[error("no natural modes: {0}")]
    Factor(#[from] FactorError),
    /// An iteration that did not converge.
    #[error(
        "{found} of {count} modes were found in {rounds} rounds: ask for another number with `--count`, such as {found}"
    )]
    NotConverged {
        /// Modes that were found.
        found: usize,
        /// Modes that were asked for.
        count: usize,
        /// Rounds of the iteration.
        rounds: usize,
    },
}

/// Rounds of the iteration.
const MOST_ROUNDS: usize = 300;

/// Residual of a mode, relative to its eigenvalue, at which it is found: its eigenvalue is then exact to the square.
const CONVERGED: f64 = 1e-7;

/// Share of the largest stiffness over mass by which the matrix is shifted, so that a free body has a factor.
const SHIFT: f64 = 1e-5;

/// Share of it below which an eigenvalue is that of a rigid motion.
const RIGID: f64 = 1e-10;

/// The modes of the smallest eigenvalues (1/s^2) of M^-1 K, with their shapes of modal mass 1, by iteration of a subspace
/// with more vectors than modes (Bathe, Finite Element Procedures, section 11.6): no mode is left out for being one of
/// several of a frequency, or for being orthogonal to loads.
///
/// A body that can move as a whole has no factor: its matrix is shifted by some of M, which takes more rounds.
pub(super) fn lowest(
    operators: &LinearOperators,
    count: usize,
) -> Result<Vec<(f64, Vec<f64>)>, ModesError> {
    let (root, stiffest) = roots(operators);
    let shifts = [0.0, SHIFT * stiffest];
    let shifts = &shifts[usize::from(moves_as_a_whole(operators, &root, stiffest))..];
    let mut outcome = Err(ModesError::NoMatrices);
    for shift in shifts {
        outcome = about(operators, count, *shift, (&root, stiffest));
        if outcome.is_ok() {
            break;
        }
    }
    outcome
}

/// Whether a motion along an axis meets no spring.
fn moves_as_a_whole(operators: &LinearOperators, root: &[f64], stiffest: f64) -> bool {
    let layers = operators.stiffness().layers().count();
    (0..layers).any(|axis| {
        let along = |(dof, root): (usize, &f64)| f64::from(dof % layers == axis && *root > 0.0);
        let motion: Vec<f64> = root.iter().enumerate().map(along).collect();
        let mut force = vec![0.0; motion.len()];
        operators.stiffness().multiply(&motion, &mut force);
        let mass: f64 = motion
            .iter()
            .zip(root)
            .map(|(x, root)| (x * root).powi(2))
            .sum();
        mass > 0.0 && dot(&motion, &force) <= RIGID * stiffest * mass
    })
}

/// The modes of the eigenvalues nearest to minus a shift (1/s^2).
fn about(
    operators: &LinearOperators,
    count: usize,
    shift: f64,
    (root, stiffest): (&[f64], f64),
) -> Result<Vec<(f64, Vec<f64>)>, ModesError> {
    let n = operators.dofs();
    let free = root.iter().filter(|root| **root > 0.0).count();
    let count = count.min(free);
    let size = (2 * count).max(count + 8).min(free);
    let mut solver = Solver::analyse(operators)?;
    let combination = Combination {
        mass: shift,
        stiffness: 1.0,
        extra: 0.0,
    };
    solver.prepare(operators, combination)?;
    // R (K + shift M)^-1 R with the root R of the masses, 0 where a component is held.
    let mut inverse = |x: &Vec<f64>| -> Result<Vec<f64>, FactorError> {
        let mut y: Vec<f64> = x.iter().zip(root).map(|(x, root)| x * root).collect();
        solver.solve(&mut y)?;
        y.iter_mut().zip(root).for_each(|(y, root)| *y *= root);
        Ok(y)
    };
    let mut vectors = started(size, root);
    let mut found = 0;
    for _ in 0..MOST_ROUNDS {
        orthonormalise(&mut vectors);
        let images: Vec<Vec<f64>> = vectors.iter().map(&mut inverse).collect::<Result<_, _>>()?;
        let mut matrix = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let entry = dot(&vectors[i], &images[j]);
                (matrix[i * size + j], matrix[j * size + i]) = (entry, entry);
            }
        }
        let (values, rows) = eigen(&mut matrix, size);
        let turned = |of: &[Vec<f64>], row: &[f64]| -> Vec<f64> {
            let mut sum = vec![0.0; n];
            for (x, share) in of.iter().zip(row) {
                add_scaled(*share, x, &mut sum);
            }
            sum
        };
        let ritz: Vec<Vec<f64>> = rows.chunks(size).map(|row| turned(&vectors, row)).collect();
        let images: Vec<Vec<f64>> = rows.chunks(size).map(|row| turned(&images, row)).collect();
        let residual = |k: usize| {
            let off = images[k]
                .iter()
                .zip(&ritz[k])
                .map(|(y, x)| (y - values[k] * x).powi(2));
            off.sum::<f64>().sqrt() / values[k]
        };
        found = (0..count).take_while(|k| residual(*k) <= CONVERGED).count();
        if found == count {
            let modes = ritz.into_iter().zip(values).take(count);
            return Ok(modes
                .map(|(x, value)| finished(x, value, shift, stiffest, root))
                .collect());
        }
        vectors = images;
    }
    Err(ModesError::NotConverged {
        found,
        count,
        rounds: MOST_ROUNDS,
    })
}

/// A mode from a vector of the iteration and its eigenvalue.
fn finished(x: Vec<f64>, value: f64, shift: f64, stiffest: f64, root: &[f64]) -> (f64, Vec<f64>) {
    let eigenvalue = value.recip() - shift;
    let eigenvalue = if eigenvalue <= RIGID * stiffest {
        0.0
    } else {
        eigenvalue
    };
    let shape = x.into_iter().zip(root);
    let shape = shape.map(|(x, root)| if *root > 0.0 { x / root } else { 0.0 });
    (eigenvalue, shape.collect())
}

/// Roots of the masses, 0 for components that are held although their cell moves, and the largest stiffness over mass.
fn roots(operators: &LinearOperators) -> (Vec<f64>, f64) {
    let stiffness = operators.stiffness();
    let layers = stiffness.layers().count();
    let mut stiffest = 0.0_f64;
    let of = |(dof, mass): (usize, &f64)| {
        let cell = dof / layers;
        let own = stiffness
            .block(cell, cell)
            .map_or(0.0, |block| block[dof % layers * (layers + 1)]);
        stiffest = stiffest.max(own / mass);
        if own == 0.0 { 0.0 } else { mass.sqrt() }
    };
    let roots = operators.mass().iter().enumerate().map(of).collect();
    (roots, stiffest)
}

/// Vectors in all directions, the same each time.
fn started(size: usize, root: &[f64]) -> Vec<Vec<f64>> {
    let vector = |seed: usize| {
        let mut vector = noise(root.len(), seed as u64);
        for (x, root) in vector.iter_mut().zip(root) {
            if *root == 0.0 {
                *x = 0.0;
            }
        }
        vector
    };
    (0..size).map(vector).collect()
}

/// Makes the vectors orthonormal, twice against rounding.
fn orthonormalise(vectors: &mut [Vec<f64>]) {
    for k in 0..vectors.len() {
        let (before, rest) = vectors.split_at_mut(k);
        let own = &mut rest[0];
        for _ in 0..2 {
            for other in before.iter() {
                let share = dot(other, own);
                add_scaled(-share, other, own);
            }
            let length = norm(own);
            scale(own, length.recip());
        }
    }
}
