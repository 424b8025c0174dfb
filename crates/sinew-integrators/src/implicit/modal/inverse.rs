//! The inverse of the stiffness, made symmetric by the masses.

use sinew_core::LinearOperators;
use sinew_core::vectors::{dot, noise, norm};

use super::columns::{add, orthogonalise, project};
use crate::implicit::factor::{Combination, Factor, symmetric_eigen};
use crate::implicit::factor_error::FactorError;

/// `A = M^1/2 (K + shift M)^-1 M^1/2` on the free components. Its eigenvectors are
/// M^1/2 times the modes, its eigenvalues 1/(omega^2 + shift).
#[derive(Debug)]
pub(super) struct Inverse {
    factor: Factor,
    /// s^2 (1/s^2); 0 if the body has supports, so that K has an inverse.
    pub(super) shift: f64,
    /// Square roots of the masses, 0 for fixed components.
    pub(super) root: Vec<f64>,
    pub(super) solves: u64,
    pub(super) factorizations: u64,
}

/// Largest `||K x - b|| / ||b||` at which a factor is accepted: due to rounding, the factorisation of a singular matrix
/// can succeed.
const SOLVED: f64 = 1e-6;

/// The shift of a floating body over the largest k_ii/m_i: far below the slowest vibration,
/// far above rounding.
const SHIFT: f64 = 1e-7;

/// Largest omega^2 over the shift that counts as zero.
const RIGID: f64 = 1e-4;

impl Inverse {
    /// Factorises K, or K + s^2 M if K has no inverse.
    pub(super) fn new(operators: &LinearOperators) -> Result<Self, FactorError> {
        let held = held(operators);
        let masses = operators.mass().iter().zip(&held);
        let root = masses.map(|(mass, held)| if *held { 0.0 } else { mass.sqrt() });
        let mut inverse = Self {
            factor: Factor::analyse(operators)?,
            shift: 0.0,
            root: root.collect(),
            solves: 0,
            factorizations: 1,
        };
        let sound = inverse.factor.factorise(operators, Combination::STATIC);
        if sound.is_err() || !inverse.solves_well(operators) {
            let cells = operators.stiffness();
            let layers = cells.layers().count();
            let stiffest = operators.mass().iter().enumerate().map(|(dof, mass)| {
                let (cell, layer) = (dof / layers, dof % layers);
                let block = cells.block(cell, cell);
                block.map_or(0.0, |block| block[layer * (layers + 1)]) / mass
            });
            let stiffest = stiffest.fold(0.0, f64::max);
            inverse.shift = if stiffest > 0.0 {
                SHIFT * stiffest
            } else {
                1.0
            };
            let shifted = Combination {
                mass: inverse.shift,
                ..Combination::STATIC
            };
            inverse.factorizations += 1;
            inverse.factor.factorise(operators, shifted)?;
        }
        Ok(inverse)
    }

    fn solves_well(&mut self, operators: &LinearOperators) -> bool {
        let mut force = noise(self.root.len(), 1);
        self.mask(&mut force);
        let mut solution = force.clone();
        self.factor.solve(&mut solution);
        self.solves += 1;
        let size = norm(&force);
        operators
            .stiffness()
            .subtract_product(&solution, &mut force);
        norm(&force) <= SOLVED * size
    }

    /// Sets fixed components to zero.
    pub(super) fn mask(&self, x: &mut [f64]) {
        for (value, root) in x.iter_mut().zip(&self.root) {
            if *root == 0.0 {
                *value = 0.0;
            }
        }
    }

    /// `out = A x`.
    pub(super) fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        for ((out, x), root) in out.iter_mut().zip(x).zip(&self.root) {
            *out = root * x;
        }
        self.factor.solve(out);
        self.solves += 1;
        for (out, root) in out.iter_mut().zip(&self.root) {
            *out *= root;
        }
    }

    /// The rigid motions of a floating body, orthonormal, by block inverse iteration (Parlett, The
    /// Symmetric Eigenvalue Problem, chapter 14).
    pub(super) fn rigid_motions(&mut self) -> Result<Vec<f64>, FactorError> {
        if self.shift == 0.0 {
            return Ok(Vec::new());
        }
        let n = self.root.len();
        let free = self.root.iter().filter(|root| **root > 0.0).count();
        let mut count = 8.min(free);
        loop {
            let motions = self.slowest(count, n)?;
            if motions.len() < count * n || count == free {
                return Ok(motions);
            }
            count = (2 * count).min(free);
        }
    }

    /// The rigid motions among the `count` slowest motions.
    fn slowest(&mut self, count: usize, n: usize) -> Result<Vec<f64>, FactorError> {
        let mut block: Vec<f64> = (0..count as u64).flat_map(|i| noise(n, i + 1)).collect();
        block
            .chunks_exact_mut(n)
            .for_each(|column| self.mask(column));
        let mut image = vec![0.0; count * n];
        let mut work = vec![0.0; count];
        for _ in 0..100 {
            for j in 0..count {
                let (done, rest) = block.split_at_mut(j * n);
                let column = &mut rest[..n];
                orthogonalise(done, column, &mut vec![0.0; j], &mut work);
                let length = norm(column);
                column.iter_mut().for_each(|x| *x /= length);
            }
            for (x, out) in block.chunks_exact(n).zip(image.chunks_exact_mut(n)) {
                self.apply(x, out);
            }
            let mut projected = vec![0.0; count * count];
            let columns = projected.chunks_exact_mut(count);
            for (out, x) in columns.zip(image.chunks_exact(n)) {
                project(&block, x, out);
            }
            let (theta, vectors) = symmetric_eigen(&projected, count)?;
            let mut rigid = Vec::new();
            let mut settled = true;
            for (theta, y) in theta.iter().zip(vectors.chunks_exact(count)) {
                if theta.recip() - self.shift <= RIGID * self.shift {
                    let (mut motion, mut residual) = (vec![0.0; n], vec![0.0; n]);
                    add(&block, y, 1.0, &mut motion);
                    add(&image, y, 1.0, &mut residual);
                    add(&motion, &[*theta], -1.0, &mut residual);
                    settled &= norm(&residual) <= 1e-9 * theta;
                    rigid.extend(motion);
                }
            }
            if settled && !rigid.is_empty() {
                return Ok(rigid);
            }
            std::mem::swap(&mut block, &mut image);
        }
        // Nearly singular, yet without a rigid motion: the shift does no harm.
        Ok(Vec::new())
    }

    /// `x' A x`.
    pub(super) fn form(&mut self, x: &[f64], work: &mut [f64]) -> f64 {
        self.apply(x, work);
        dot(x, work)
    }
}

/// Marks fixed components of cells with other free components: their rows of K are zero. A cell without any stiffness
/// is free.
pub(super) fn held(operators: &LinearOperators) -> Vec<bool> {
    let stiffness = operators.stiffness();
    let layers = stiffness.layers().count();
    let mut held = vec![true; stiffness.dofs()];
    for (cell, held) in held.chunks_exact_mut(layers).enumerate() {
        for (_, block) in stiffness.row_blocks(cell) {
            for (held, row) in held.iter_mut().zip(block.chunks_exact(layers)) {
                *held &= row.iter().all(|entry| *entry == 0.0);
            }
        }
        if held.iter().all(|held| *held) {
            held.fill(false);
        }
    }
    held
}
