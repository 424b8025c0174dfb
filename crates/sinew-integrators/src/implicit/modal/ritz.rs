//! Load-dependent Ritz vectors.

use sinew_core::vectors::{add_scaled, dot, norm, scale};

use super::basis::Choice;
use super::failure::Failure;
use super::inverse::Inverse;
use super::lanczos_basis::Ritz;
use super::search::{Found, MARGIN, Search, relative_change, sample_times};
use crate::implicit::factor::symmetric_eigen;

/// Vectors of the basis for each vector chosen from it.
const BASIS: usize = 2;

/// Length of the part of a static response orthogonal to the others, relative to its own, below which it is rounding.
const DEPENDENT: f64 = 1e-10;

impl Search<'_> {
    /// Ritz vectors of the loads: the most excited of a basis that starts from the static response to each load case
    /// (Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10, 1982), and one for the rest of each static
    /// response (modal truncation augmentation: Dickens, Nakagawa and Wittbrodt, Computers & Structures 62, 1997).
    /// Their error is estimated for these rates of damping in proportion to masses (1/s) and stiffness (s).
    pub(super) fn ritz(
        mut self,
        choice: Choice,
        damping: [f64; 2],
        inverse: &mut Inverse,
    ) -> Result<Found, Failure> {
        if self.cases.is_empty() {
            return Err(Failure::NoLoads);
        }
        self.damping = damping;
        let (starts, rigid) = (self.lanczos.width(), self.rigid_forces.len());
        let (pairs, change, aim, fewest) = match choice {
            Choice::Modes { count, .. } => {
                let needed = starts + rigid;
                if count < needed {
                    return Err(Failure::TooFew { needed });
                }
                let (count, least) = (count - rigid, starts + 1);
                let size = (BASIS * count).max(least).min(self.free);
                self.lanczos.grow((size - size / 4).max(starts), inverse);
                let coarse = self.pairs()?;
                self.lanczos.grow(size, inverse);
                let pairs = self.pairs()?;
                let change = match self.lanczos.exhausted() {
                    true => 0.0,
                    false => self.change(&coarse, &pairs),
                };
                (pairs, change, f64::INFINITY, count)
            }
            Choice::Tolerance(tolerance) => {
                let aim = MARGIN * tolerance;
                let (pairs, change) = self.converged(aim, inverse)?;
                (pairs, change, aim, starts)
            }
        };
        let error = |taken: &[Ritz]| self.change(taken, &pairs).hypot(change);
        let (mut too_few, mut enough) = (fewest.saturating_sub(1), fewest.min(pairs.len()));
        let mut taken = self.augmented(&pairs, enough)?;
        if error(&taken) > aim {
            enough = pairs.len();
            while enough - too_few > 1 {
                let middle = too_few.midpoint(enough);
                match error(&self.augmented(&pairs, middle)?) <= aim {
                    true => enough = middle,
                    false => too_few = middle,
                }
            }
            taken = self.augmented(&pairs, enough)?;
        }
        let (estimate, count) = (error(&taken), rigid + taken.len());
        Ok(self.take(taken, count, Some(estimate)))
    }

    /// `count` vectors in the span of these: the most excited, and one for the part of each static response that is
    /// outside them.
    fn augmented(&self, pairs: &[Ritz], count: usize) -> Result<Vec<Ritz>, Failure> {
        if count >= pairs.len() {
            return Ok(pairs.to_vec());
        }
        let mut order: Vec<&Ritz> = pairs.iter().collect();
        order.sort_by(|a, b| self.excitation(b).total_cmp(&self.excitation(a)));
        let (kept, left) = order.split_at(count - self.lanczos.width().min(count));
        let mut taken: Vec<Ritz> = kept.iter().map(|pair| (*pair).clone()).collect();
        taken.extend(self.static_vectors(left)?);
        taken.sort_by(|a, b| b.theta.total_cmp(&a.theta));
        Ok(taken)
    }

    /// Ritz vectors in the span of the static responses along these vectors.
    fn static_vectors(&self, left: &[&Ritz]) -> Result<Vec<Ritz>, Failure> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for case in 0..self.cases.len() {
            let mut response: Vec<f64> = left.iter().map(|pair| pair.excitation[case]).collect();
            let size = norm(&response);
            for _ in 0..2 {
                for known in &basis {
                    let part = dot(known, &response);
                    add_scaled(-part, known, &mut response);
                }
            }
            let length = norm(&response);
            if length > DEPENDENT * size {
                scale(&mut response, 1.0 / length);
                basis.push(response);
            }
        }
        let size = basis.len();
        let mut projected = vec![0.0; size * size];
        for (i, a) in basis.iter().enumerate() {
            for (j, b) in basis.iter().enumerate() {
                let terms = left.iter().zip(a.iter().zip(b));
                projected[i * size + j] = terms.map(|(pair, (a, b))| pair.theta * a * b).sum();
            }
        }
        let (theta, turned) = symmetric_eigen(&projected, size).map_err(Failure::Factorization)?;
        let vectors = theta.iter().zip(turned.chunks_exact(size.max(1)));
        let vectors = vectors.map(|(theta, turn)| {
            let mut parts = vec![0.0; left.len()];
            for (turn, basis) in turn.iter().zip(&basis) {
                add_scaled(*turn, basis, &mut parts);
            }
            let mut vector = vec![0.0; left.first().map_or(0, |pair| pair.vector.len())];
            let mut excitation = vec![0.0; self.cases.len()];
            for (part, pair) in parts.iter().zip(left) {
                add_scaled(*part, &pair.vector, &mut vector);
                add_scaled(*part, &pair.excitation, &mut excitation);
            }
            Ritz {
                theta: *theta,
                vector,
                residual: 0.0,
                excitation,
            }
        });
        Ok(vectors.collect())
    }

    /// Relative change of the response from some vectors to all of a basis.
    fn change(&self, taken: &[Ritz], pairs: &[Ritz]) -> f64 {
        if taken.len() == pairs.len() {
            return 0.0;
        }
        let slowest = pairs.first().map_or(0.0, |pair| self.squared(pair));
        let instants = sample_times(slowest.sqrt());
        let [coarse, fine] = [taken, pairs].map(|pairs| self.responses(pairs, &instants));
        relative_change(&coarse, &fine)
    }
}
