//! The steps of a run after which output is written.

use crate::scene::Instants;

/// Largest number of entries of a table, if the scene does not request more.
const MOST_NUMBERS: usize = 5_000_000;

/// Least number of rows of a table with very many columns.
const FEWEST_ROWS: usize = 16;

/// Evenly spaced steps of a run, including the first and the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Steps of the run.
    steps: usize,
    /// Steps between two of them, not a whole number if that does not divide the run.
    spacing: f64,
}

impl Schedule {
    /// At most `most` steps, evenly spaced: every step if they are no more.
    #[must_use]
    pub fn at_most(most: usize, steps: usize) -> Self {
        Self {
            steps,
            spacing: (steps as f64 / most as f64).max(1.0),
        }
    }

    /// The steps nearest to these instants of a run in steps of `dt` (s).
    #[must_use]
    pub fn at(instants: Instants, steps: usize, dt: f64) -> Self {
        let spacing = match instants {
            Instants::Every(seconds) => seconds / dt,
            Instants::Frames(intervals) => steps as f64 / intervals as f64,
        };
        Self {
            steps,
            spacing: spacing.max(1.0),
        }
    }

    /// The steps of rows of probes: at the instants that the scene requests, otherwise at every step, up to `most` rows
    /// or the number of rows of a table of readable length.
    #[must_use]
    pub fn of_probes(
        asked: Option<Instants>,
        columns: usize,
        most: usize,
        (steps, dt): (usize, f64),
    ) -> Self {
        match asked {
            Some(instants) => Self::at(instants, steps, dt),
            None => Self::at_most(
                most.min(MOST_NUMBERS / columns.max(1)).max(FEWEST_ROWS),
                steps,
            ),
        }
    }

    /// The first of them at or after a step.
    #[must_use]
    pub fn next(&self, from: usize) -> Option<usize> {
        if from > self.steps {
            return None;
        }
        let before = (from as f64 / self.spacing) as usize;
        let step = |number: usize| (number as f64 * self.spacing).round() as usize;
        let found = (before..).map(step).find(|step| *step >= from);
        found.map(|step| step.min(self.steps))
    }

    /// True if a step is one of them.
    #[must_use]
    pub fn is_due(&self, step: usize) -> bool {
        self.next(step) == Some(step)
    }

    /// True if all steps are among them.
    #[must_use]
    pub fn is_every_step(&self) -> bool {
        self.spacing == 1.0
    }

    /// Their number.
    #[must_use]
    pub fn count(&self) -> usize {
        // The end is one more where the spacing does not meet it.
        let last = (self.steps as f64 / self.spacing) as usize;
        let met = (last as f64 * self.spacing).round() as usize >= self.steps;
        last + 1 + usize::from(!met)
    }

    /// Steps between two of them, on average.
    #[must_use]
    pub fn spacing(&self) -> f64 {
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

    #[test]
    fn a_table_of_many_columns_has_fewer_rows() {
        let rows = |columns| Schedule::of_probes(None, columns, 10_000, (1_000_000, 1e-6)).count();
        assert_eq!(rows(4), 10_001);
        assert_eq!(rows(5_000), 1001);
        assert_eq!(rows(300_001), 17);
        let asked = Some(Instants::Frames(50_000));
        let rows = Schedule::of_probes(asked, 5_000, 10_000, (1_000_000, 1e-6));
        assert_eq!(rows.count(), 50_001);
    }
}
