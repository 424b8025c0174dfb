//! Rule that decides if sweeps are shared with other threads.

/// Kinds of sweeps whose times are distinguished; further ones share these.
const KINDS: usize = 8;

/// Sweeps that the host runs alone to measure their time.
const LEARNT: u32 = 8;

/// Number of sweeps with others after which the time is measured again.
const AGAIN: u32 = 1024;

/// Share of the time that may be lost by sharing sweeps when this is no gain.
const PRICE: f64 = 0.03;

/// Largest loss of time with others before the host continues alone, and largest gain that is counted against a loss,
/// both in times of one sweep alone.
const MOST_LOST: f64 = 4.0;
const MOST_GAINED: f64 = 32.0;

/// Time (s) added to both limits: a few time slices of a scheduler, which may be as long as many sweeps.
const SLICES: f64 = 0.01;

/// The host's experience with the other threads of a crew, kept from batch to batch. On a shared machine, or one with
/// fewer processors than it reports, a thread that gets no processor for a while delays the whole sweep. So the times
/// of sweeps with others are compared with those of sweeps alone. After a loss the host runs enough sweeps alone to
/// make the loss a small part of the whole time, whatever its reason.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    /// Time of a chunk of each kind if the host is alone (s), and how often it was measured.
    alone_times: [(f64, u32); KINDS],
    /// Sweeps that are still to be run alone.
    alone: u32,
    /// Sweeps with others since the times alone were measured.
    shared: u32,
    /// Time lost with others (s), or gained if negative.
    lost: f64,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            alone_times: [(0.0, 0); KINDS],
            alone: LEARNT,
            shared: 0,
            lost: 0.0,
        }
    }
}

impl Patience {
    /// Experience of other threads that never cost time.
    #[cfg(test)]
    pub(super) fn trusting() -> Self {
        Self {
            alone_times: [(f64::INFINITY, LEARNT); KINDS],
            alone: 0,
            ..Self::default()
        }
    }

    /// True if the next `sweeps` sweeps are run alone in any case.
    pub(crate) fn is_alone_for(&self, sweeps: usize) -> bool {
        self.alone as usize >= sweeps
    }

    /// True if the next sweep, if it is of this kind, is run alone.
    pub(super) fn is_alone(&self, kind: usize) -> bool {
        self.alone > 0 || self.alone_times[kind % KINDS].1 == 0
    }

    /// Notes the time (s) of a sweep that the host ran alone.
    pub(super) fn note_alone(&mut self, kind: usize, chunks: usize, time: f64) {
        self.alone = self.alone.saturating_sub(1);
        if chunks > 0 {
            let (mean, times) = &mut self.alone_times[kind % KINDS];
            // The first one may have found nothing in caches: the second one takes its place.
            let weight = f64::from((*times).clamp(1, LEARNT)).recip();
            *mean += (time / chunks as f64 - *mean) * weight;
            *times += 1;
        }
    }

    /// Notes the time (s) of a sweep with others.
    pub(super) fn note_shared(&mut self, kind: usize, chunks: usize, time: f64) {
        let alone = self.alone_times[kind % KINDS].0 * chunks as f64;
        self.lose(time - alone, alone);
        self.shared += 1;
        if self.shared >= AGAIN {
            (self.shared, self.alone) = (0, self.alone.max(LEARNT));
        }
    }

    /// Notes the time (s) for gathering and dismissing the other threads.
    pub(super) fn note_gathering(&mut self, time: f64) {
        self.lost += time;
    }

    /// Adds to the lost time; a sweep alone takes `alone` (s).
    fn lose(&mut self, time: f64, alone: f64) {
        self.lost = (self.lost + time).max(-MOST_GAINED * alone - SLICES);
        if self.lost > MOST_LOST * alone + SLICES {
            let sweeps = self.lost / (PRICE * alone.max(1e-9));
            (self.alone, self.shared, self.lost) = (sweeps as u32, 0, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time of `sweeps` sweeps over that of as many alone, of which each takes 1 s; `with_others` gives the time with
    /// others.
    fn ratio(sweeps: u32, mut with_others: impl FnMut(u32) -> f64) -> f64 {
        let mut patience = Patience::default();
        let total: f64 = (0..sweeps)
            .map(|sweep| match patience.is_alone(0) {
                true => {
                    patience.note_alone(0, 10, 1.0);
                    1.0
                }
                false => {
                    let time = with_others(sweep);
                    patience.note_shared(0, 10, time);
                    time
                }
            })
            .sum();
        total / f64::from(sweeps)
    }

    #[test]
    fn others_who_help_share_nearly_all_sweeps() {
        assert!(ratio(100_000, |_| 0.5) < 0.505);
    }

    #[test]
    fn others_who_do_not_help_cost_a_few_hundredths_at_most() {
        for slower in [1.05, 1.2, 2.0, 10.0, 1000.0] {
            let ratio = ratio(1_000_000, |_| slower);
            assert!(ratio < 1.0 + 1.5 * PRICE, "{slower}: {ratio}");
        }
    }

    #[test]
    fn late_sweeps_are_put_up_with_as_long_as_the_others_make_up_for_them() {
        let late = |each: u32, time: f64| {
            move |sweep: u32| {
                if sweep.is_multiple_of(each) {
                    time
                } else {
                    0.5
                }
            }
        };
        assert!(ratio(100_000, late(50, 5.0)) < 0.62);
        let often = ratio(100_000, late(5, 8.0));
        assert!(often < 1.0 + 1.5 * PRICE, "{often}");
    }

    #[test]
    fn others_who_were_held_up_for_a_while_are_tried_again() {
        let ratio = ratio(100_000, |sweep| if sweep < 1000 { 5.0 } else { 0.5 });
        assert!(ratio < 0.52, "{ratio}");
    }

    #[test]
    fn a_loss_is_made_up_for_by_sweeps_alone() {
        let mut patience = Patience::default();
        assert!(patience.is_alone_for(8) && !patience.is_alone_for(9));
        for _ in 0..8 {
            patience.note_alone(3, 100, 1.0);
        }
        // A sweep of which nothing is known is made alone.
        assert!(!patience.is_alone(3) && patience.is_alone(4));
        patience.note_gathering(0.5);
        patience.note_shared(3, 100, 4.0);
        assert!(!patience.is_alone(3));
        patience.note_shared(3, 100, 2.0);
        assert!(patience.is_alone_for(150) && !patience.is_alone_for(151));
    }
}
