//! The expected error beyond the compared part of a scene.

/// Sizes of error and displacement at the instants of a comparison, equally spaced from t = 0 on.
#[derive(Clone, Debug)]
pub(crate) struct ErrorHistory {
    damped: bool,
    instants: Vec<Instant>,
    /// The reference at the last instant (m).
    last: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Instant {
    /// Time (s).
    t: f64,
    /// Sum of squared differences (m^2).
    difference: f64,
    /// Sum of squared displacements of the reference (m^2).
    reference: f64,
    /// Sum of squared changes of the reference since the previous instant (m^2).
    motion: f64,
}

/// Smallest number of instants for which quarters are compared too.
const FOR_QUARTERS: usize = 16;

/// Factor by which one or two periods may show too little growth of a squared error.
const MARGIN: f64 = 1.5;

/// Like [`MARGIN`], for instants that are too few for quarters and often end within the first period.
const MARGIN_OF_FEW: f64 = 4.0;

impl ErrorHistory {
    /// A history without instants, of a damped or undamped system.
    pub(crate) fn new(damped: bool) -> Self {
        Self {
            damped,
            instants: Vec::new(),
            last: Vec::new(),
        }
    }

    /// Includes the displacement at one more instant (s).
    pub(crate) fn include(&mut self, t: f64, u: &[f64], reference: &[f64]) {
        let squares = |u: &[f64]| {
            let pairs = u.iter().zip(reference);
            pairs.map(|(u, reference)| (u - reference).powi(2)).sum()
        };
        self.instants.push(Instant {
            t,
            difference: squares(u),
            reference: reference.iter().map(|u| u * u).sum(),
            motion: squares(&self.last),
        });
        self.last.clear();
        self.last.extend_from_slice(reference);
    }

    /// The relative L2 error to expect over `duration` (s), under the loads that act at the end of
    /// the history.
    ///
    /// A wrong frequency shifts an undamped motion by an angle that grows as t, so that the squared error grows at most
    /// as t^2. Its growth between the first and the last half, or the first and the last quarter, is extrapolated in
    /// this way, with a margin; a decreasing error is assumed constant after the last half, and so is the size of the
    /// motion. If the motion continues, the error of the start may still hide that of the phase: the whole error of the
    /// last half then grows as t^2. No error grows beyond that of a motion that is out of phase.
    pub(crate) fn expected_over(&self, duration: f64) -> f64 {
        let all = &self.instants;
        let (first, last) = all.split_at(all.len().div_ceil(2));
        let (Some(end), [_, ..]) = (all.last().map(|instant| instant.t), last) else {
            return f64::INFINITY;
        };
        let beyond = (duration / end - 1.0).max(0.0) * (all.len() - 1) as f64;
        let difference = |instant: &Instant| instant.difference;
        let reference = |instant: &Instant| instant.reference;
        let square_of_time = |instant: &Instant| instant.t.powi(2);
        let growth = |early: &[Instant], late: &[Instant]| {
            let growth = mean(late, difference) - mean(early, difference);
            growth / (mean(late, square_of_time) - mean(early, square_of_time))
        };
        let mut rate = growth(first, last).max(0.0);
        if all.len() >= FOR_QUARTERS {
            let quarter = all.len() / 4;
            rate = rate.max(growth(&all[..quarter], &all[all.len() - quarter..]));
        }
        let seen = mean(last, square_of_time);
        let observed = rate * (mean_square(end, duration, duration) - seen);
        let until = self.motion_lasts_until(duration);
        let hidden = if until > end {
            mean(last, difference) / seen * (mean_square(end, duration, until) - seen)
        } else {
            0.0
        };
        let margin = if all.len() >= FOR_QUARTERS {
            MARGIN
        } else {
            MARGIN_OF_FEW
        };
        let later = margin * observed.max(hidden);
        // Two motions of the same size that have nothing in common.
        let largest = mean(last, difference).max(2.0 * mean(last, reference));
        let later = (mean(last, difference) + later).min(largest);
        let sum = |of: fn(&Instant) -> f64| all.iter().map(of).sum::<f64>();
        let difference = sum(difference) + beyond * later;
        let reference = sum(reference) + beyond * mean(last, reference);
        if difference == 0.0 {
            return 0.0;
        }
        (difference / reference).sqrt()
    }

    /// The time (s) until which a phase error grows. In a motion that dies out as exp(-s t) the error behaves as t
    /// exp(-s t), with its maximum at 1/s; comparing the last half of the history with the first gives s.
    fn motion_lasts_until(&self, duration: f64) -> f64 {
        let all = &self.instants;
        // The first instant has none before it to move from.
        let (first, last) = all.split_at(all.len().div_ceil(2));
        let (Some(end), [_, first @ ..]) = (all.last().map(|instant| instant.t), first) else {
            return duration;
        };
        if !self.damped || first.is_empty() {
            return duration;
        }
        let motion = |instant: &Instant| instant.motion;
        let (early, late) = (mean(first, motion), mean(last, motion));
        if early == 0.0 && late == 0.0 {
            return 0.0;
        }
        // Squares die out as exp(-2 s t), and the halves are end/2 apart: this is s end.
        let decay = (early / late).ln();
        if decay > 0.0 {
            (end / decay).min(duration)
        } else {
            duration
        }
    }
}

/// The mean of the smaller of t^2 and `until`^2 (s^2) for t from `end` to `duration` (s), `until` being between them.
fn mean_square(end: f64, duration: f64, until: f64) -> f64 {
    if duration <= end {
        return end * end;
    }
    let grows = (end * end + end * until + until * until) / 3.0 * (until - end);
    (grows + until * until * (duration - until)) / (duration - end)
}

fn mean(instants: &[Instant], of: impl Fn(&Instant) -> f64) -> f64 {
    instants.iter().map(of).sum::<f64>() / instants.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The history of `motion` against `reference`, functions of time, over `duration` (s).
    fn history(
        damped: bool,
        duration: f64,
        motion: impl Fn(f64) -> f64,
        reference: impl Fn(f64) -> f64,
    ) -> ErrorHistory {
        let mut history = ErrorHistory::new(damped);
        for j in 0..=(50.0 * duration) as u32 {
            let t = f64::from(j) / 50.0;
            history.include(t, &[motion(t)], &[reference(t)]);
        }
        history
    }

    /// Error expected over 20 s from a part of it, over the error over all of it.
    fn over_truth(
        damped: bool,
        part: f64,
        motion: impl Fn(f64) -> f64,
        reference: impl Fn(f64) -> f64,
    ) -> f64 {
        let seen = history(damped, part, &motion, &reference);
        let all = history(damped, 20.0, motion, reference);
        seen.expected_over(20.0) / all.expected_over(20.0)
    }

    #[test]
    fn a_wrong_frequency_costs_more_the_longer_it_runs() {
        for part in [0.7, 1.0, 2.0, 5.0, 19.0] {
            let ratio = over_truth(false, part, |t| (10.001 * t).cos(), |t| (10.0 * t).cos());
            assert!((0.95..1.3).contains(&ratio), "{part} s: {ratio}");
        }
    }

    #[test]
    fn a_wrong_frequency_shows_behind_a_wrong_amplitude() {
        for part in [2.0, 5.0] {
            let ratio = over_truth(
                false,
                part,
                |t| 1.002 * (10.001 * t).cos(),
                |t| (10.0 * t).cos(),
            );
            // An amplitude is no less suspect than a start of hiding an error of the phase.
            assert!((0.95..2.0).contains(&ratio), "{part} s: {ratio}");
        }
    }

    #[test]
    fn an_error_that_dies_out_is_not_continued() {
        let motion = |t: f64| 1.0 - (-5.0 * t).exp() * (10.1 * t).cos();
        let reference = |t: f64| 1.0 - (-5.0 * t).exp() * (10.0 * t).cos();
        let ratio = over_truth(true, 3.0, motion, reference);
        assert!((1.0..1.01).contains(&ratio), "{ratio}");
    }

    #[test]
    fn an_error_that_stays_stays() {
        let ratio = over_truth(true, 2.0, |_| 1.01, |_| 1.0);
        assert!((ratio - 1.0).abs() < 1e-9, "{ratio}");
        assert_eq!(
            history(true, 2.0, |_| 1.0, |_| 1.0).expected_over(20.0),
            0.0
        );
    }

    #[test]
    fn a_phase_error_is_expected_behind_a_larger_error_of_the_start() {
        // The error of the start dies out for as long as it is seen; that of the phase is left.
        let start = |t: f64| 2e-3 * (-t).exp() * (25.0 * t).cos();
        for part in [0.7, 1.0, 2.0] {
            let motion = |t: f64| (10.001 * t).cos() + start(t);
            let ratio = over_truth(false, part, motion, |t| (10.0 * t).cos());
            assert!((1.0..5.0).contains(&ratio), "{part} s: {ratio}");
        }
    }

    #[test]
    fn damping_too_light_to_end_the_motion_does_not_hold_a_phase_error_back() {
        for rate in [0.0, 0.01, 0.1] {
            let swing = |w: f64, t: f64| (-rate * t).exp() * (w * t).cos();
            let motion = |t: f64| swing(10.001, t) + 2e-3 * (-t).exp() * (25.0 * t).cos();
            let ratio = over_truth(true, 2.0, motion, |t| swing(10.0, t));
            assert!((1.0..5.0).contains(&ratio), "{rate}/s: {ratio}");
        }
    }

    #[test]
    fn one_instant_after_the_start_is_enough() {
        let mut history = ErrorHistory::new(true);
        history.include(0.0, &[1.0], &[1.0]);
        assert_eq!(history.expected_over(2.0), f64::INFINITY);
        history.include(1.0, &[1.01], &[1.0]);
        assert!(history.expected_over(2.0) > 1e-2);
    }
}
