//! The Lanczos basis.

use sinew_core::vectors::norm;

use super::columns::orthogonalise;
use super::inverse::Inverse;
use crate::implicit::factor::symmetric_eigen;
use crate::implicit::factor_error::FactorError;

/// Length of a new vector, relative to its length before orthogonalisation, below which it is rounding.
const DEPENDENT: f64 = 1e-12;

/// An orthonormal basis of the span of the starts, A times them, A^2 times them and so on, computed by the Lanczos
/// method with full reorthogonalisation (Golub and Van Loan, Matrix Computations, section 10.3; several starts as in
/// Ruhe, Math. Comp. 33, 1979).
#[derive(Debug)]
pub(super) struct LanczosBasis {
    n: usize,
    /// Rigid motions first, then the basis.
    vectors: Vec<f64>,
    rigid: usize,
    /// Number of starts that were independent.
    width: usize,
    /// Column j: the components of A times vector j along the vectors known at that time.
    image: Vec<Vec<f64>>,
    /// The starts' components along the first vectors.
    starts: Vec<Vec<f64>>,
    work: Vec<f64>,
}

/// A Rayleigh-Ritz approximation to an eigenvector of A.
#[derive(Clone, Debug)]
pub(super) struct Ritz {
    /// Eigenvalue.
    pub(super) theta: f64,
    /// Components along the basis.
    pub(super) vector: Vec<f64>,
    /// `||A x - theta x||`.
    pub(super) residual: f64,
    /// Components of the starts along it.
    pub(super) excitation: Vec<f64>,
}

impl LanczosBasis {
    /// A basis that begins with these vectors, each without its rigid part.
    pub(super) fn new(rigid: Vec<f64>, starts: Vec<Vec<f64>>, n: usize) -> Self {
        let mut krylov = Self {
            n,
            rigid: rigid.len() / n.max(1),
            vectors: rigid,
            width: 0,
            image: Vec::new(),
            starts: Vec::new(),
            work: Vec::new(),
        };
        for start in starts {
            let size = norm(&start);
            let parts = krylov.append(start, size);
            krylov.starts.push(parts);
        }
        krylov.width = krylov.len();
        krylov
    }

    /// Number of vectors.
    fn len(&self) -> usize {
        self.vectors.len() / self.n.max(1) - self.rigid
    }

    /// Number of vectors whose image is known: the size of the projected problem.
    pub(super) fn size(&self) -> usize {
        self.image.len()
    }

    /// True if the basis spans the whole space that the start vectors can reach.
    pub(super) fn exhausted(&self) -> bool {
        self.size() == self.len()
    }

    /// Number of starts that were independent.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    pub(super) fn rigid(&self) -> &[f64] {
        &self.vectors[..self.rigid * self.n]
    }

    pub(super) fn basis(&self) -> &[f64] {
        let first = self.rigid * self.n;
        &self.vectors[first..first + self.size() * self.n]
    }

    /// Makes `x` orthogonal to all vectors and appends what remains of it. Returns its components.
    fn append(&mut self, mut x: Vec<f64>, size: f64) -> Vec<f64> {
        let known = self.rigid + self.len();
        let mut parts = vec![0.0; known];
        self.work.resize(known, 0.0);
        // In exact arithmetic only the latest vectors matter; taking them first leaves rounding to
        // the pass over all.
        let latest = known.saturating_sub(2 * self.width.max(1) + 1);
        let late = &self.vectors[latest * self.n..];
        orthogonalise(late, &mut x, &mut parts[latest..], &mut self.work);
        orthogonalise(&self.vectors, &mut x, &mut parts, &mut self.work);
        let mut parts = parts.split_off(self.rigid);
        let length = norm(&x);
        if length > DEPENDENT * size {
            parts.push(length);
            x.iter_mut().for_each(|value| *value /= length);
            self.vectors.extend(x);
        }
        parts
    }

    /// Grows until the projected problem has `size` unknowns or the basis is complete.
    pub(super) fn grow(&mut self, size: usize, inverse: &mut Inverse) {
        while self.size() < size && !self.exhausted() {
            let mut image = vec![0.0; self.n];
            let at = (self.rigid + self.size()) * self.n;
            inverse.apply(&self.vectors[at..at + self.n], &mut image);
            let length = norm(&image);
            let parts = self.append(image, length);
            self.image.push(parts);
        }
    }

    /// The Ritz pairs, slowest first.
    pub(super) fn ritz_pairs(&self) -> Result<Vec<Ritz>, FactorError> {
        let size = self.size();
        let mut projected = vec![0.0; size * size];
        for (row, image) in self.image.iter().enumerate() {
            // By symmetry, row i up to the diagonal is column i down to it.
            for (column, value) in image.iter().take(row + 1).enumerate() {
                projected[column * size + row] = *value;
            }
        }
        let (theta, vectors) = symmetric_eigen(&projected, size)?;
        let largest = theta.last().copied().unwrap_or(0.0);
        let pairs = theta.iter().zip(vectors.chunks_exact(size.max(1))).rev();
        // What is below rounding of the largest is no eigenvalue of a positive matrix.
        let pairs = pairs.filter(|(theta, _)| **theta > 1e-15 * largest);
        Ok(pairs
            .map(|(theta, y)| Ritz {
                theta: *theta,
                residual: self.residual(y),
                excitation: self.starts.iter().map(|start| along(start, y)).collect(),
                vector: y.to_vec(),
            })
            .collect())
    }

    /// Length of the part of A x outside the projected problem.
    fn residual(&self, y: &[f64]) -> f64 {
        let size = self.size();
        let outside = (size..self.len()).map(|row| {
            let part = |(image, y): (&Vec<f64>, &f64)| image.get(row).map_or(0.0, |part| part * y);
            self.image.iter().zip(y).map(part).sum::<f64>().powi(2)
        });
        outside.sum::<f64>().sqrt()
    }
}

fn along(start: &[f64], y: &[f64]) -> f64 {
    start.iter().zip(y).map(|(s, y)| s * y).sum()
}
