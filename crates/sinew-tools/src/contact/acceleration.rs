//! Acceleration of an iteration that converges slowly.

use crate::vector::Vector;

/// Number of earlier sweeps that an extrapolation combines.
const MEMORY: usize = 4;

/// Largest number of forces that are extrapolated.
const MOST: usize = 128;

/// Growth of the residual, as a factor over the least so far, beyond which earlier sweeps say nothing about the next.
const MOST_GROWTH: f64 = 2.0;

/// Number of times that this may happen until the iteration is left to itself: contacts that come and go from sweep to
/// sweep have no next forces that could be foreseen.
const MOST_FAILURES: u32 = 4;

/// Largest number of sweeps that are accelerated.
const MOST_SWEEPS: u32 = 100;

/// Share of the largest entry of a matrix below which a pivot counts as 0.
const PIVOT: f64 = 1e-14;

/// Anderson's extrapolation of a fixed-point iteration (Walker and Ni, SIAM J. Numer. Anal. 49, 2011): the next forces are
/// those of a combination of the last sweeps whose change would be the smallest. It changes where the iteration goes
/// next, not where it ends: only a sweep that changes nothing ends it.
#[derive(Debug, Default)]
pub(super) struct Acceleration {
    /// The forces before the sweep, and its changes; those of the sweep before.
    before: Vec<Vector>,
    change: Vec<Vector>,
    last: [Vec<Vector>; 2],
    /// Differences of changes, and of results, from one sweep to the next: the youngest replaces the oldest.
    differences: [[Vec<Vector>; 2]; MEMORY],
    /// Number of differences since the beginning.
    known: usize,
    /// True if `last` holds a sweep.
    has_last: bool,
    least: f64,
    failures: u32,
    sweeps: u32,
}

impl Acceleration {
    /// Space for up to `forces` forces.
    pub(super) fn new(forces: usize) -> Self {
        let room = || Vec::with_capacity(forces.min(MOST));
        Self {
            before: room(),
            change: room(),
            last: [room(), room()],
            differences: std::array::from_fn(|_| [room(), room()]),
            ..Self::default()
        }
    }

    /// True if it extrapolates that many forces: one is found by one sweep.
    pub(super) fn takes(&self, forces: usize) -> bool {
        forces > 1 && forces <= MOST.min(self.before.capacity())
    }

    /// Begins an iteration.
    pub(super) fn begin(&mut self) {
        (self.known, self.has_last, self.least) = (0, false, f64::INFINITY);
        (self.failures, self.sweeps) = (0, 0);
    }

    /// True while it helps.
    pub(super) fn goes_on(&self) -> bool {
        self.failures < MOST_FAILURES && self.sweeps < MOST_SWEEPS
    }

    /// Takes the forces before a sweep.
    pub(super) fn before(&mut self, forces: impl Iterator<Item = Vector>) {
        self.before.clear();
        self.before.extend(forces);
    }

    /// Takes the forces after it, and its residual; returns changes of these forces that lead nearer to the end, unless
    /// nothing is known of them yet.
    pub(super) fn after(
        &mut self,
        forces: impl Iterator<Item = Vector> + Clone,
        residual: f64,
    ) -> Option<&[Vector]> {
        self.change.clear();
        let both = forces.clone().zip(&self.before);
        self.change
            .extend(both.map(|(after, before)| less(after, *before)));
        self.sweeps += 1;
        if residual > MOST_GROWTH * self.least {
            (self.known, self.has_last) = (0, false);
            self.failures += 1;
        }
        self.least = self.least.min(residual);
        if self.has_last {
            let [change, result] = &mut self.differences[self.known % MEMORY];
            let [last_change, last_result] = &self.last;
            change.clear();
            let pairs = self.change.iter().zip(last_change);
            change.extend(pairs.map(|(now, last)| less(*now, *last)));
            result.clear();
            let pairs = forces.clone().zip(last_result);
            result.extend(pairs.map(|(now, last)| less(now, *last)));
            self.known += 1;
        }
        let [last_change, last_result] = &mut self.last;
        last_change.clone_from(&self.change);
        last_result.clear();
        last_result.extend(forces);
        self.has_last = true;
        let count = self.known.min(MEMORY);
        if count == 0 {
            return None;
        }
        let weights = self.weights(count)?;
        self.before.fill([0.0; 3]);
        for (weight, [_, result]) in weights.iter().zip(&self.differences[..count]) {
            for (sum, result) in self.before.iter_mut().zip(result) {
                for (sum, result) in sum.iter_mut().zip(result) {
                    *sum -= weight * result;
                }
            }
        }
        Some(&self.before)
    }

    /// The weights of the differences with which the change would be the smallest; 0 for those that are combinations of
    /// others.
    fn weights(&self, count: usize) -> Option<[f64; MEMORY]> {
        let of = |place: usize| &self.differences[place][0];
        let (mut matrix, mut right) = ([[0.0; MEMORY]; MEMORY], [0.0; MEMORY]);
        let mut largest = 0.0_f64;
        for row in 0..count {
            for column in 0..=row {
                matrix[row][column] = product(of(row), of(column));
                matrix[column][row] = matrix[row][column];
            }
            largest = largest.max(matrix[row][row]);
            right[row] = product(of(row), &self.change);
        }
        // Cholesky's factors, row by row.
        let mut factor = [[0.0; MEMORY]; MEMORY];
        for row in 0..count {
            for column in 0..row {
                let known = (0..column).map(|k| factor[row][k] * factor[column][k]);
                let left = matrix[row][column] - known.sum::<f64>();
                let pivot = factor[column][column];
                factor[row][column] = if pivot > 0.0 { left / pivot } else { 0.0 };
            }
            let known = (0..row).map(|k| factor[row][k] * factor[row][k]);
            let left = matrix[row][row] - known.sum::<f64>();
            factor[row][row] = if left > PIVOT * largest {
                left.sqrt()
            } else {
                0.0
            };
        }
        let mut weights = [0.0; MEMORY];
        for row in 0..count {
            let known = (0..row).map(|k| factor[row][k] * weights[k]);
            let left = right[row] - known.sum::<f64>();
            let pivot = factor[row][row];
            weights[row] = if pivot > 0.0 { left / pivot } else { 0.0 };
        }
        for row in (0..count).rev() {
            let known = (row + 1..count).map(|k| factor[k][row] * weights[k]);
            let left = weights[row] - known.sum::<f64>();
            let pivot = factor[row][row];
            weights[row] = if pivot > 0.0 { left / pivot } else { 0.0 };
        }
        weights
            .iter()
            .all(|weight| weight.is_finite())
            .then_some(weights)
    }
}

fn less(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn product(a: &[Vector], b: &[Vector]) -> f64 {
    let (a, b) = (a.as_flattened(), b.as_flattened());
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps of Gauss and Seidel's iteration for two nearly equal rows, whose changes shrink by a hundredth from one to the
    /// next, until a sweep changes nothing; the result is that of the equations.
    #[test]
    fn two_nearly_equal_contacts_are_solved_in_few_sweeps() {
        let solve = |accelerated: bool| {
            let mut acceleration = Acceleration::new(2);
            let mut x = [[0.0; 3]; 2];
            acceleration.begin();
            for sweep in 1.. {
                acceleration.before(x.into_iter());
                let old = x;
                for axis in 0..3 {
                    x[0][axis] = 1.0 - 0.995 * x[1][axis];
                    x[1][axis] = 0.9 - 0.995 * x[0][axis];
                }
                let left = old.as_flattened().iter().zip(x.as_flattened());
                let left = left.fold(0.0_f64, |left, (a, b)| left.max((a - b).abs()));
                if left < 1e-13 || sweep == 10_000 {
                    return (sweep, x);
                }
                let further = acceleration.after(x.into_iter(), left);
                if let Some(further) = further.filter(|_| accelerated) {
                    for (x, by) in x.iter_mut().zip(further) {
                        *x = [0, 1, 2].map(|axis| x[axis] + by[axis]);
                    }
                }
            }
            unreachable!()
        };
        let [(plain, _), (accelerated, x)] = [false, true].map(solve);
        assert!(plain > 2000 && accelerated < 10, "{plain} {accelerated}");
        let expected = (1.0 - 0.995 * 0.9) / (1.0 - 0.995 * 0.995);
        assert!((x[0][0] - expected).abs() < 1e-10, "{}", x[0][0]);
    }

    #[test]
    fn a_single_force_and_too_many_are_left_to_the_iteration() {
        let acceleration = Acceleration::new(1000);
        let taken = [0, 1, 2, MOST, MOST + 1].map(|forces| acceleration.takes(forces));
        assert_eq!(taken, [false, false, true, true, false]);
    }
}
