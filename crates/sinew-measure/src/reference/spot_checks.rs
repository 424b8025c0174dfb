//! Parts of a reference solved again by another method.

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::norm;
use sinew_core::{LinearOperators, State};

use super::Taylor;

/// Share of the time that is solved again.
const SHARE: f64 = 0.2;

/// Solves steps of a reference again by the Taylor series, each from the state of the reference.
#[derive(Debug)]
pub(super) struct SpotChecks<'a> {
    taylor: Taylor<'a>,
    /// Simulated time (s) of all steps, and of those that were solved again.
    offered: f64,
    solved: f64,
    /// Number of steps offered, and of those that were solved again.
    steps: [u32; 2],
    /// Sizes and differences of displacements (m), and of velocities (m/s).
    displacement: Differences,
    velocity: Differences,
}

/// The distance of two solutions.
#[derive(Clone, Copy, Debug, Default)]
struct Differences {
    /// Sum of the norms of the differences at the ends of the steps that were solved again.
    sum: f64,
    /// Largest norm of the reference itself.
    largest: f64,
}

impl<'a> SpotChecks<'a> {
    pub(super) fn new(operators: &'a LinearOperators, spectrum: &Spectrum) -> Self {
        Self {
            taylor: Taylor::checking(operators, spectrum),
            offered: 0.0,
            solved: 0.0,
            steps: [0, 0],
            displacement: Differences::default(),
            velocity: Differences::default(),
        }
    }

    /// Receives a step from one state to another, and solves it again if it is due: the first step, then a fifth of the
    /// time.
    pub(super) fn see(&mut self, before: &State, after: &State) {
        self.displacement.note_size(&after.u);
        self.velocity.note_size(&after.v);
        let is_due = self.solved <= SHARE * self.offered;
        let time = after.t() - before.t();
        self.offered += time;
        self.steps[0] += 1;
        if is_due {
            self.solved += time;
            self.steps[1] += 1;
            let mut again = before.clone();
            self.taylor.advance(&mut again, after.t(), |_| {});
            self.displacement.add(&again.u, &after.u);
            self.velocity.add(&again.v, &after.v);
        }
    }

    /// The expected error of displacements, relative to `size` (m): the sum of the differences of all steps, as if no
    /// difference decayed and the steps not solved again were like the others, plus the standard error of that mean if
    /// the spread of the differences is as large as the differences. A relative error of the velocity counts as one of
    /// the displacement.
    pub(super) fn error(&self, size: f64) -> f64 {
        let all = match self.solved > 0.0 {
            true => self.offered / self.solved,
            false => 1.0,
        };
        let [steps, solved] = self.steps;
        let spread = match solved < steps {
            true => f64::from(solved).sqrt().recip(),
            false => 0.0,
        };
        let all = all * (1.0 + spread);
        let relative = |sum: f64, size: f64| if sum == 0.0 { 0.0 } else { all * sum / size };
        let displacement = relative(self.displacement.sum, size);
        displacement.max(relative(self.velocity.sum, self.velocity.largest))
    }

    /// Products with the matrices so far.
    pub(super) fn sweeps(&self) -> u64 {
        self.taylor.sweeps
    }
}

impl Differences {
    fn note_size(&mut self, vector: &[f64]) {
        self.largest = self.largest.max(norm(vector));
    }

    fn add(&mut self, a: &[f64], b: &[f64]) {
        let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        self.sum += norm(&difference);
    }
}

#[cfg(test)]
mod tests {
    use sinew_core::Clock;
    use sinew_core::closed_form::DampedOscillator;

    use super::*;

    /// Error reported by the checks for steps that are wrong by a share of the largest displacement and velocity.
    fn said(off: f64) -> f64 {
        let operators = LinearOperators::oscillator(1.0, 400.0, 0.5).unwrap();
        let exact = DampedOscillator {
            omega: 20.0,
            damping: 0.5,
            load: 0.0,
            displacement: 1.0,
            velocity: 0.0,
        };
        let state = |t: f64, off: f64| {
            let (u, v) = exact.at(t);
            let mut state = State::new(vec![u + off], vec![v + 20.0 * off]);
            state.clock = Clock::at(t);
            state
        };
        let mut checks = SpotChecks::new(&operators, &Spectrum::of(&operators));
        for step in 0..10 {
            let t = f64::from(step);
            checks.see(&state(t, 0.0), &state(t + 1.0, off));
        }
        checks.error(1.0)
    }

    #[test]
    fn an_error_in_every_step_is_counted_for_every_step() {
        assert!(said(0.0) < 1e-9, "{:e}", said(0.0));
        for off in [1e-6, 1e-3] {
            let said = said(off);
            assert!(said >= 10.0 * off, "{said:e}");
            // A mean of so few may be off by more than half.
            assert!(said < 30.0 * off, "{said:e}");
        }
    }
}
