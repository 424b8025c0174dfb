//! The steps of a run after which something is written.

use sinew_scene::Instants;

/// Evenly spaced steps of a run, the first and the last among them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Schedule {
    /// Steps of the run.
    steps: usize,
    /// Steps between two of them, not a whole number where that does not divide the run.
    spacing: f64,
}

impl Schedule {
    /// Every step, or as many as there is room for.
    pub(crate) fn at_most(most: usize, steps: usize) -> Self {
        Self {
            steps,
            spacing: (steps as f64 / most as f64).max(1.0),
        }
    }

    /// The steps nearest to these instants of a run in steps of `dt` (s).
    pub(crate) fn at(instants: Instants, steps: usize, dt: f64) -> Self {
        let spacing = match instants {
            Instants::Every(seconds) => seconds / dt,
            Instants::Frames(intervals) => steps as f64 / intervals as f64,
        };
        Self {
            steps,
            spacing: spacing.max(1.0),
        }
    }

    /// The first of them from a step on.
    pub(crate) fn next(&self, from: usize) -> Option<usize> {
        if from > self.steps {
            return None;
        }
        let before = (from as f64 / self.spacing) as usize;
        let step = |number: usize| (number as f64 * self.spacing).round() as usize;
        let found = (before..).map(step).find(|step| *step >= from);
        found.map(|step| step.min(self.steps))
    }

    pub(crate) fn is_due(&self, step: usize) -> bool {
        self.next(step) == Some(step)
    }

    pub(crate) fn is_every_step(&self) -> bool {
        self.spacing == 1.0
    }

    /// Their number.
    pub(crate) fn count(&self) -> usize {
        // The end is one more where the spacing does not meet it.
        let last = (self.steps as f64 / self.spacing) as usize;
        let met = (last as f64 * self.spacing).round() as usize >= self.steps;
        last + 1 + usize::from(!met)
    }

    /// Steps between two of them, on average.
    pub(crate) fn spacing(&self) -> f64 {
        self.spacing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(schedule: Schedule) -> Vec<usize> {
        let mut steps = Vec::new();
        let mut from = 0;
        while let Some(step) = schedule.next(from) {
            steps.push(step);
            from = step + 1;
        }
        assert_eq!(steps.len(), schedule.count(), "{steps:?}");
        steps
    }

    #[test]
    fn first_and_last_steps_are_among_them() {
        let frames = |intervals, steps| all(Schedule::at(Instants::Frames(intervals), steps, 0.1));
        assert_eq!(frames(4, 10), [0, 3, 5, 8, 10]);
        assert_eq!(frames(50, 3), [0, 1, 2, 3]);
        let every = |seconds, steps| all(Schedule::at(Instants::Every(seconds), steps, 0.1));
        assert_eq!(every(0.3, 10), [0, 3, 6, 9, 10]);
        assert_eq!(every(0.25, 10), [0, 3, 5, 8, 10]);
        assert_eq!(every(7.0, 10), [0, 10]);
        assert_eq!(every(1e-9, 3), [0, 1, 2, 3]);
        assert_eq!(all(Schedule::at_most(10, 4)), [0, 1, 2, 3, 4]);
        assert_eq!(all(Schedule::at_most(2, 5)), [0, 3, 5]);
    }
}
