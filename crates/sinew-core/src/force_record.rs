//! Forces given from outside, in the order of their times.

use crate::load::Load;
use crate::ramp::Ramp;

/// Reasons for which forces from outside are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForceInputError {
    /// A time that is not finite.
    #[error("forces from t = {t} s on: expected a finite time")]
    Time {
        /// The time (s).
        t: f64,
    },
    /// A force that is not finite.
    #[error(
        "a force of {force} N on degree of freedom {dof} from t = {t} s on: expected a finite number"
    )]
    Force {
        /// The degree of freedom.
        dof: u32,
        /// The force (N).
        force: f64,
        /// The time (s).
        t: f64,
    },
}

/// Forces by the time at which they were given. Each set acts until the next, so that their times
/// neither overlap nor fall, and those that act at a time are found by bisection.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForceRecord {
    given: Vec<Given>,
    /// Lists of forces that were forgotten or replaced: the next ones are written into them.
    spare: Vec<Vec<(u32, f64)>>,
}

/// Forces given at one time.
#[derive(Clone, Debug)]
struct Given {
    /// The forces, under a [`Ramp::Pulse`].
    load: Load,
    /// The highest degree of freedom of these and all earlier forces on record.
    highest_dof: u32,
}

impl Given {
    /// First instant (s), and first instant after the last (s).
    fn times(&self) -> [f64; 2] {
        match self.load.ramp {
            Ramp::Pulse { from, to } => [from, to],
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// Compares the forces on record; spare buffers do not count.
impl PartialEq for ForceRecord {
    fn eq(&self, other: &Self) -> bool {
        self.all().eq(other.all())
    }
}

impl ForceRecord {
    pub(crate) const fn new() -> Self {
        Self {
            given: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Replaces all forces from `t` (s) on.
    pub(crate) fn set(&mut self, t: f64, entries: &[(u32, f64)]) -> Result<(), ForceInputError> {
        if !t.is_finite() {
            return Err(ForceInputError::Time { t });
        }
        if let Some(&(dof, force)) = entries.iter().find(|(_, force)| !force.is_finite()) {
            return Err(ForceInputError::Force { dof, force, t });
        }
        let kept = self.given.partition_point(|given| given.times()[0] < t);
        for given in self.given.drain(kept..) {
            self.spare.push(given.load.entries);
        }
        if let Some(Given { load, .. }) = self.given.last_mut()
            && let Ramp::Pulse { to, .. } = &mut load.ramp
        {
            *to = to.min(t);
        }
        let Some(highest) = highest_of(entries) else {
            return Ok(());
        };
        let mut list = self.spare.pop().unwrap_or_default();
        list.clear();
        list.extend_from_slice(entries);
        let ramp = Ramp::Pulse {
            from: t,
            to: f64::INFINITY,
        };
        self.given.push(Given {
            highest_dof: self.highest_dof().map_or(highest, |dof| dof.max(highest)),
            load: Load {
                ramp,
                entries: list,
            },
        });
        Ok(())
    }

    /// Forgets forces that ended before `t` (s).
    pub(crate) fn forget_before(&mut self, t: f64) {
        let gone = self.given.partition_point(|given| given.times()[1] < t);
        for given in self.given.drain(..gone) {
            self.spare.push(given.load.entries);
        }
        if gone > 0 {
            let mut highest = 0;
            for Given { load, highest_dof } in &mut self.given {
                highest = highest_of(&load.entries).map_or(highest, |own| highest.max(own));
                *highest_dof = highest;
            }
        }
    }

    /// All forces on record, in the order of their times.
    pub(crate) fn all(&self) -> impl ExactSizeIterator<Item = &Load> {
        self.given.iter().map(|given| &given.load)
    }

    /// The forces that act at some time from `from` to `to` (s), both included.
    pub(crate) fn between(&self, from: f64, to: f64) -> impl ExactSizeIterator<Item = &Load> {
        let first = self.given.partition_point(|given| given.times()[1] <= from);
        let end = self.given.partition_point(|given| given.times()[0] <= to);
        let acting = self.given.get(first..end).unwrap_or_default();
        acting.iter().map(|given| &given.load)
    }

    /// The highest degree of freedom of all forces on record.
    pub(crate) fn highest_dof(&self) -> Option<u32> {
        self.given.last().map(|given| given.highest_dof)
    }
}

fn highest_of(entries: &[(u32, f64)]) -> Option<u32> {
    entries.iter().map(|(dof, _)| *dof).max()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forces of 1 N on degrees of freedom 0, 1, .. from 0 s, 1 s, .. on.
    fn seconds(count: u32) -> ForceRecord {
        let mut record = ForceRecord::default();
        for second in 0..count {
            record.set(f64::from(second), &[(second, 1.0)]).unwrap();
        }
        record
    }

    fn acting(record: &ForceRecord, from: f64, to: f64) -> Vec<u32> {
        let acting = record.between(from, to);
        acting.map(|load| load.entries[0].0).collect()
    }

    #[test]
    fn a_step_meets_the_forces_that_act_in_it_however_long_the_record_is() {
        let mut record = seconds(1000);
        assert_eq!(acting(&record, 500.2, 500.7), [500]);
        assert_eq!(acting(&record, 500.0, 500.7), [500]);
        assert_eq!(acting(&record, 499.9, 500.0), [499, 500]);
        assert_eq!(acting(&record, 7.5, 9.5), [7, 8, 9]);
        assert_eq!(acting(&record, -1.0, -0.5), [0; 0]);
        assert_eq!(acting(&record, 5e3, 6e3), [999]);
        // A pause between two forces.
        record.set(30.5, &[]).unwrap();
        record.set(40.0, &[(40, 1.0)]).unwrap();
        assert_eq!(acting(&record, 31.0, 39.0), [0; 0]);
        assert_eq!(acting(&record, 30.4, 40.0), [30, 40]);
        for nowhere in [f64::NAN, f64::NEG_INFINITY] {
            assert_eq!(acting(&record, 5.0, nowhere), [0; 0]);
        }
    }

    #[test]
    fn the_highest_degree_of_freedom_is_that_of_the_forces_on_record() {
        let mut record = seconds(3);
        record.set(3.0, &[(90, 1.0)]).unwrap();
        assert_eq!(record.highest_dof(), Some(90));
        record.set(3.0, &[(1, 1.0)]).unwrap();
        assert_eq!(record.highest_dof(), Some(2), "a slip that was corrected");
        record.set(4.0, &[(0, 1.0)]).unwrap();
        record.forget_before(3.5);
        assert_eq!(record.highest_dof(), Some(1), "of what is left");
    }
}
