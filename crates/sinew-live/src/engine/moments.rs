//! Moments of the panes, to which they go back where the user's hand has led them into a state without a next step, or
//! where a user wants to go on from an earlier time.

use std::collections::VecDeque;

use sinew_core::Clock;

use super::pane::PaneMoment;

/// Simulated time (s) between two moments.
const EVERY: f64 = 0.1;

/// Number of bytes that all moments may take.
const MEMORY: usize = 64 << 20;

/// Least number of moments that are kept.
const LEAST: usize = 16;

/// Simulated time (s) before a failure within which a state leads to it, for each attempt to go on.
const DOOMED: f64 = 0.1;

/// Simulated time (s) beyond the last failure after which a motion has gone on.
const GONE_ON: f64 = 0.3;

/// Attempts to go on without a command in between: then the motion fails by itself.
const MOST_ATTEMPTS: u32 = 5;

/// Simulated time (s) within which a failure is due to a command.
const DUE_TO_COMMAND: f64 = 1.0;

/// A moment of all panes.
pub(super) struct Moment {
    pub(super) clock: Clock,
    /// `None` for panes that have stopped.
    pub(super) panes: Vec<Option<PaneMoment>>,
    /// Pose of each steered tool.
    pub(super) hands: Vec<Option<[f64; 6]>>,
    pub(super) factors: Vec<f64>,
    pub(super) grasped: Vec<bool>,
}

impl Moment {
    /// Number of bytes of its fields.
    fn bytes(&self) -> usize {
        self.panes.iter().flatten().map(PaneMoment::bytes).sum()
    }
}

/// The latest moments of all panes, and the failures since the last one that was survived.
#[derive(Default)]
pub(super) struct Moments {
    kept: VecDeque<Moment>,
    /// Simulated time (s) of the last command since the last failure.
    commanded: Option<f64>,
    /// The latest simulated time (s) of a failure.
    failed: Option<f64>,
    attempts: u32,
}

impl Moments {
    /// True if a moment is due at a simulated time (s).
    pub(super) fn is_due(&self, t: f64) -> bool {
        let last = self.kept.back();
        last.is_none_or(|last| t - last.clock.time() >= EVERY * (1.0 - Clock::ROUNDING))
    }

    /// Keeps a moment. The first one stays for good; where the memory is full, every second one of the older half goes.
    pub(super) fn keep(&mut self, moment: Moment) {
        let most = (MEMORY / moment.bytes().max(1)).max(LEAST);
        self.keep_at_most(moment, most);
    }

    fn keep_at_most(&mut self, moment: Moment, most: usize) {
        if self.kept.len() >= most {
            let older = self.kept.len() / 2;
            let mut number = 0;
            self.kept.retain(|_| {
                number += 1;
                number > older || number % 2 == 1
            });
        }
        self.kept.push_back(moment);
    }

    /// The last one that is kept.
    pub(super) fn last(&self) -> Option<&Moment> {
        self.kept.back()
    }

    /// The last moment up to a simulated time (s). The later ones are dropped; if all are later, none is.
    pub(super) fn up_to(&mut self, t: f64) -> Option<&Moment> {
        let until = t * (1.0 + Clock::ROUNDING);
        let first = self.kept.front().map(|first| first.clock.time());
        first.filter(|first| *first <= until)?;
        self.drop_after(until);
        self.commanded = None;
        self.kept.back()
    }

    /// Drops the moments after a simulated time (s), but the first one.
    fn drop_after(&mut self, until: f64) {
        let is_after = |moment: &Moment| moment.clock.time() > until;
        while self.kept.len() > 1 && self.kept.back().is_some_and(is_after) {
            self.kept.pop_back();
        }
    }

    /// Notes a command at a simulated time (s).
    pub(super) fn note_command(&mut self, t: f64) {
        self.commanded = Some(t);
    }

    /// The moment to go back to after a failure at a simulated time (s): each attempt to go on goes back farther.
    /// `None` if the motion fails by itself.
    pub(super) fn before_failure(&mut self, t: f64) -> Option<&Moment> {
        let commanded = self.commanded.take();
        if self.failed.is_none_or(|failed| t > failed + GONE_ON) {
            self.attempts = 0;
        }
        let is_due_to_command = commanded.is_some_and(|commanded| t - commanded <= DUE_TO_COMMAND);
        let has_tried = (1..MOST_ATTEMPTS).contains(&self.attempts);
        if !is_due_to_command && !has_tried {
            return None;
        }
        self.failed = Some(self.failed.map_or(t, |failed| failed.max(t)));
        self.attempts = (self.attempts + 1).min(MOST_ATTEMPTS);
        self.drop_after(t - DOOMED * f64::from(self.attempts));
        self.kept.back()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(clock: Clock) -> Moment {
        Moment {
            clock,
            panes: Vec::new(),
            hands: Vec::new(),
            factors: Vec::new(),
            grasped: Vec::new(),
        }
    }

    fn moments(until: f64) -> Moments {
        let mut moments = Moments::default();
        let mut clock = Clock::default();
        while clock.time() < until {
            if moments.is_due(clock.time()) {
                moments.keep(moment(clock));
            }
            clock.advance(0.01);
        }
        moments
    }

    fn back(moments: &mut Moments, t: f64) -> Option<f64> {
        moments.before_failure(t).map(|moment| moment.clock.time())
    }

    /// True for the last moment that is not after a time (s).
    fn is_last_until(found: Option<f64>, until: f64) -> bool {
        found.is_some_and(|found| (until - 0.12..until + 1e-9).contains(&found))
    }

    #[test]
    fn each_attempt_goes_back_farther_and_the_beginning_stays() {
        let mut moments = moments(10.0);
        moments.note_command(9.9);
        assert!(is_last_until(back(&mut moments, 10.0), 9.9));
        assert!(is_last_until(back(&mut moments, 10.0), 9.8));
        assert!(is_last_until(back(&mut moments, 10.01), 9.7));
        // It has gone on since then.
        moments.note_command(10.6);
        assert!(is_last_until(back(&mut moments, 10.6), 9.7));
        for _ in 0..9 {
            moments.note_command(1.0);
            back(&mut moments, 1.0);
        }
        moments.note_command(0.5);
        assert!(is_last_until(back(&mut moments, 0.5), 0.0));
    }

    #[test]
    fn a_full_memory_keeps_the_new_ones_close_and_the_old_ones_apart() {
        let mut moments = Moments::default();
        let mut clock = Clock::default();
        for _ in 0..100_000 {
            moments.keep_at_most(moment(clock), 100);
            clock.advance(0.1);
        }
        let times: Vec<f64> = moments.kept.iter().map(|kept| kept.clock.time()).collect();
        assert!(times.len() <= 100 && times[0] == 0.0, "{times:?}");
        let gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!((gaps[times.len() - 2] - 0.1).abs() < 1e-6);
        assert!(gaps[0] > 100.0, "{gaps:?}");
        // The last half reaches back at least as many moments as there are of them.
        assert!(times[times.len() / 2] > 9990.0, "{times:?}");
        let middle = moments.up_to(9995.0).unwrap().clock.time();
        assert!((9994.0..=9995.1).contains(&middle), "{middle}");
        assert!(moments.up_to(-1.0).is_none() && moments.up_to(f64::NAN).is_none());
        assert_eq!(moments.up_to(0.0).unwrap().clock.time(), 0.0);
    }

    #[test]
    fn a_motion_that_fails_without_a_command_is_not_repeated() {
        assert_eq!(back(&mut moments(5.0), 5.0), None);
        let mut late = moments(5.0);
        late.note_command(3.5);
        assert_eq!(back(&mut late, 5.0), None);
        let mut doomed = moments(5.0);
        doomed.note_command(4.9);
        let attempts = std::iter::from_fn(|| back(&mut doomed, 5.0)).count();
        assert_eq!(attempts, MOST_ATTEMPTS as usize);
    }
}
