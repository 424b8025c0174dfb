//! The lowest modes, by locally optimal block preconditioned conjugate gradients (LOBPCG).

use sinew_core::LinearOperators;
use sinew_core::vectors::{add_scaled, dot, noise, norm, scale};
use sinew_integrators::{Combination, FactorError, Solver, symmetric_eigen};
use sinew_scene::AtRestError;

/// A reason for which there are no modes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModesError {
    /// A body without matrices at rest.
    #[error("no natural modes about rest: {0}")]
    AtRest(#[from] AtRestError),
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
        /// The requested modes.
        count: usize,
        /// Number of rounds of the iteration.
        rounds: usize,
    },
}

/// Number of rounds of the iteration.
const MOST_ROUNDS: usize = 500;

/// Preconditioned residual of a mode, relative to its length, at which it counts as converged: the relative error of
/// its eigenvalue is then the square of this number.
const CONVERGED: f64 = 1e-6;

/// Share of the largest stiffness over mass by which the matrix is shifted, so that a free body has a factor.
const SHIFT: f64 = 1e-5;

/// Share of the largest stiffness over mass below which an eigenvalue is that of a rigid motion.
const RIGID: f64 = 1e-10;

/// Share of the length of a vector below which its orthogonal part is rounding.
const DEPENDENT: f64 = 1e-8;

/// The modes of the smallest eigenvalues (1/s^2) of M^-1 K, with their shapes of modal mass 1, by LOBPCG (Knyazev,
/// Toward the optimal preconditioned eigensolver, SIAM J. Sci. Comput. 23, 2001) with more vectors than modes: so no
/// mode is missed if its frequency is multiple, or if it is orthogonal to the loads. The preconditioner is a factor, or
/// two grids if there is no memory for one.
///
/// A body with rigid-body modes has no factor: its matrix is shifted by a part of M.
pub(super) fn lowest(
    operators: &LinearOperators,
    count: usize,
) -> Result<Vec<(f64, Vec<f64>)>, ModesError> {
    let (root, stiffest) = roots(operators);
    let shifts = [0.0, SHIFT * stiffest];
    let shifts = &shifts[usize::from(moves_as_a_whole(operators, &root, stiffest))..];
    let mut outcome = Err(ModesError::AtRest(AtRestError::NoMatrices));
    for shift in shifts {
        outcome = about(operators, count, *shift, (&root, stiffest));
        if outcome.is_ok() {
            break;
        }
    }
    outcome
}

/// True if a translation of all nodes along an axis strains no spring.
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

/// The modes, with a preconditioner of the matrix shifted by a part of M (1/s^2).
fn about(
    operators: &LinearOperators,
    count: usize,
    shift: f64,
    (root, stiffest): (&[f64], f64),
) -> Result<Vec<(f64, Vec<f64>)>, ModesError> {
    let free = root.iter().filter(|root| **root > 0.0).count();
    let count = count.min(free);
    let size = (count + count / 4).max(count + 6).min(free);
    let mut preconditioner = Solver::analyse(operators)?;
    let combination = Combination {
        mass: shift,
        stiffness: 1.0,
        extra: 0.0,
    };
    preconditioner.prepare(operators, combination)?;
    // Symmetric matrices in x = M^1/2 u, with the root of the masses, 0 where a component is held.
    let unscaled = |x: f64, root: f64| if root > 0.0 { x / root } else { 0.0 };
    let image = |x: &[f64]| -> Vec<f64> {
        let u: Vec<f64> = x
            .iter()
            .zip(root)
            .map(|(x, root)| unscaled(*x, *root))
            .collect();
        let mut force = vec![0.0; u.len()];
        operators.stiffness().multiply(&u, &mut force);
        force
            .iter_mut()
            .zip(root)
            .for_each(|(f, root)| *f = unscaled(*f, *root));
        force
    };
    let mut preconditioned = |residual: &[f64]| -> Result<Vec<f64>, FactorError> {
        let mut y: Vec<f64> = residual
            .iter()
            .zip(root)
            .map(|(x, root)| x * root)
            .collect();
        preconditioner.precondition(&mut y)?;
        y.iter_mut().zip(root).for_each(|(y, root)| *y *= root);
        Ok(y)
    };
    let mut basis = Basis::default();
    started(size, root)
        .into_iter()
        .for_each(|x| basis.add(x, image));
    let size = basis.vectors.len();
    let mut found = 0;
    for _ in 0..MOST_ROUNDS {
        let (values, shares) = basis.eigen()?;
        let (mut next, conjugate) = basis.turned(&shares, size);
        let mut corrections = Vec::new();
        let mut is_found = vec![false; size];
        for (k, value) in values.iter().take(size).enumerate() {
            let mut residual = next.images[k].clone();
            add_scaled(-value, &next.vectors[k], &mut residual);
            let correction = preconditioned(&residual)?;
            is_found[k] = norm(&correction) <= CONVERGED;
            if !is_found[k] {
                corrections.push(correction);
            }
        }
        found = is_found.iter().take(count).take_while(|is| **is).count();
        if found == count {
            let modes = next.vectors.into_iter().zip(values).take(count);
            return Ok(modes
                .map(|(x, eigenvalue)| finished(x, eigenvalue, stiffest, root))
                .collect());
        }
        corrections.into_iter().for_each(|x| next.add(x, image));
        next.add_all(conjugate);
        basis = next;
    }
    Err(ModesError::NotConverged {
        found,
        count,
        rounds: MOST_ROUNDS,
    })
}

/// Orthonormal vectors, with their images under a symmetric matrix.
#[derive(Default)]
struct Basis {
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

impl Basis {
    /// Adds the part of a vector orthogonal to the others.
    fn add(&mut self, mut x: Vec<f64>, image: impl Fn(&[f64]) -> Vec<f64>) {
        if self.orthonormalise(&mut x, None) {
            self.images.push(image(&x));
            self.vectors.push(x);
        }
    }

    /// Adds vectors whose images are known.
    fn add_all(&mut self, others: Self) {
        for (mut x, mut image) in others.vectors.into_iter().zip(others.images) {
            if self.orthonormalise(&mut x, Some(&mut image)) {
                self.vectors.push(x);
                self.images.push(image);
            }
        }
    }

    /// Makes a vector orthogonal to the others and of length 1; returns false if its orthogonal part is only rounding.
    fn orthonormalise(&self, x: &mut [f64], mut image: Option<&mut Vec<f64>>) -> bool {
        let mut change = |x: &mut [f64], factor: f64, with: Option<usize>| match with {
            Some(other) => {
                add_scaled(factor, &self.vectors[other], x);
                if let Some(image) = &mut image {
                    add_scaled(factor, &self.images[other], image);
                }
            }
            None => {
                scale(x, factor);
                if let Some(image) = &mut image {
                    scale(image, factor);
                }
            }
        };
        let length = norm(x);
        change(x, length.recip(), None);
        // Twice against rounding.
        for _ in 0..2 {
            for other in 0..self.vectors.len() {
                let share = dot(&self.vectors[other], x);
                change(x, -share, Some(other));
            }
            let left = norm(x);
            if left <= DEPENDENT || left.is_nan() {
                return false;
            }
            change(x, left.recip(), None);
        }
        true
    }

    /// Eigenvalues of the matrix on the space of the vectors, the smallest first, and its eigenvectors as coefficients
    /// of the vectors, one after the other.
    fn eigen(&self) -> Result<(Vec<f64>, Vec<f64>), FactorError> {
        let size = self.vectors.len();
        let mut matrix = vec![0.0; size * size];
        for (column, image) in self.images.iter().enumerate() {
            for row in column..size {
                matrix[column * size + row] = dot(&self.vectors[row], image);
            }
        }
        symmetric_eigen(&matrix, size)
    }

    /// The first `size` eigenvectors, and their parts along vectors after the first `size`: the conjugate directions.
    fn turned(&self, shares: &[f64], size: usize) -> (Self, Self) {
        let rows = self.vectors.len();
        let sums = |of: &[Vec<f64>], from: usize, column: usize| {
            let mut sum = vec![0.0; of.first().map_or(0, Vec::len)];
            for (row, x) in of.iter().enumerate().skip(from) {
                add_scaled(shares[column * rows + row], x, &mut sum);
            }
            sum
        };
        let both = |from: usize| Self {
            vectors: (0..size).map(|k| sums(&self.vectors, from, k)).collect(),
            images: (0..size).map(|k| sums(&self.images, from, k)).collect(),
        };
        let (mut next, conjugate) = (both(size), both(size));
        for (k, (vector, image)) in next.vectors.iter_mut().zip(&mut next.images).enumerate() {
            for row in 0..size {
                add_scaled(shares[k * rows + row], &self.vectors[row], vector);
                add_scaled(shares[k * rows + row], &self.images[row], image);
            }
        }
        (next, conjugate)
    }
}

/// A mode from a vector of the iteration and its eigenvalue.
fn finished(x: Vec<f64>, eigenvalue: f64, stiffest: f64, root: &[f64]) -> (f64, Vec<f64>) {
    let eigenvalue = if eigenvalue <= RIGID * stiffest {
        0.0
    } else {
        eigenvalue
    };
    let shape = x.into_iter().zip(root);
    let shape = shape.map(|(x, root)| if *root > 0.0 { x / root } else { 0.0 });
    (eigenvalue, shape.collect())
}

/// Roots of the masses, 0 for fixed components of cells that move, and the largest stiffness over mass.
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
