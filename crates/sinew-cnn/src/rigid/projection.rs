//! Projection of rigid motions out of an iteration.

use sinew_core::FreePart;

use super::RigidMotions;
use super::motions::by_diagonal;

/// `P^-1 = Z Q^-1 Z' + R (R'M' R)^-1 R'`, with `Z = I - R (R'M' R)^-1 R'M'`, for any `Q >= A` of a matrix A that equals
/// M' on rigid motions R: an iteration for the elastic part of a motion, and M' alone for its rigid part.
///
/// A maps R and its complement in the metric of M' to their duals, P does the same, and on the complement
/// `Z Q^-1 Z' <= Z A^-1 Z'`: so `P >= A`.
#[derive(Clone, Debug)]
pub struct Projection {
    parts: Vec<RigidMotions>,
}

impl Projection {
    /// The rigid motions of these parts about rest, with M' by its diagonal.
    #[must_use]
    pub fn new(parts: Vec<FreePart>, inertia: impl Fn(usize) -> f64) -> Self {
        let take = |free: FreePart| {
            let mut rigid = RigidMotions::new(free);
            let is_sound = rigid.take(None, by_diagonal(&inertia));
            is_sound.then_some(rigid)
        };
        Self {
            parts: parts.into_iter().filter_map(take).collect(),
        }
    }

    /// `r = Z' r`.
    pub(crate) fn take_out(&self, r: &mut [f64]) {
        for part in &self.parts {
            let sums = part.sums(&part.motions, r).map(|sum| -sum);
            part.add(&part.weighted, &sums, r);
        }
    }

    /// `x = Z x + R (R'M' R)^-1 R' r`.
    pub(crate) fn put_back(&self, r: &[f64], x: &mut [f64]) {
        for part in &self.parts {
            let mut sums = part.sums(&part.motions, r);
            let own = part.sums(&part.weighted, x);
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum -= own);
            part.add(&part.motions, &sums, x);
        }
    }
}
