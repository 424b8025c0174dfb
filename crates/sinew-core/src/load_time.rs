//! Instants and windows of time at which a step takes its loads.

use std::f64::consts::PI;

use crate::clock::Clock;
use crate::gauss::gauss_points;
use crate::input::Inputs;
use crate::ramp::Ramp;

/// Number of windows in half a period from which on a sine counts as smooth; for the rise of a squared sine, smooth at
/// both ends.
const LONG_RISE: f64 = 2.0;

/// Phase (rad) of a sine over an interval, up to which Gauss' rule integrates it to rounding.
const FEW_RADIANS: f64 = 2.0;

/// The instant at which a step takes its loads, with the window of time they act for and the inputs
/// that are known.
///
/// A load that is smooth over the window is taken at the instant. One that jumps or has a kink inside is replaced by a
/// mean over the window, weighted so that its impulse is kept, whatever its course between two instants, and so that a
/// method keeps the order that it has for smooth loads, up to order 2. Positions of supports ([`Ramp::Position`]) are
/// taken at the instant for any window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadTime<'a> {
    t: f64,
    window: Window,
    inputs: &'a Inputs,
}

/// The window, and the replacement of a load that is not smooth in it. Times in s.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Window {
    /// No window: loads are taken at the instant.
    Instant,
    /// Loads are taken as smooth, as in the middle of the window.
    Smooth { from: f64, to: f64 },
    /// The mean over the window.
    Mean { from: f64, to: f64 },
    /// The line with the same mean and first moment over the window, taken `shift` after the instant.
    Line { from: f64, to: f64, shift: f64 },
    /// The mean with weights that fall linearly from the instant to 0 at both ends.
    Hat { from: f64, to: f64 },
}

impl LoadTime<'static> {
    fn new(t: f64, window: Window) -> Self {
        Self {
            t,
            window,
            inputs: Inputs::none(),
        }
    }

    /// The loads at an instant (s); at a jump, those after it.
    #[must_use]
    pub fn at(t: f64) -> Self {
        Self::new(t, Window::Instant)
    }

    /// The loads at the beginning of a step from `t` (s) to `t + dt`, or their mean over the step: for
    /// methods that take loads as constant over a step. Tables always enter by their mean.
    #[must_use]
    pub fn start_of(t: f64, dt: f64) -> Self {
        Self::mean_at(t, t, dt)
    }

    /// The loads in the middle of a step from `t` (s) to `t + dt`, or their mean over the step.
    #[must_use]
    pub fn middle_of(t: f64, dt: f64) -> Self {
        Self::mean_at(t + 0.5 * dt, t, dt)
    }

    /// The loads at the end of a step from `t` (s) to `t + dt`, or their mean over the step.
    #[must_use]
    pub fn end_of(t: f64, dt: f64) -> Self {
        Self::mean_at(t + dt, t, dt)
    }

    /// The loads at `t` (s), or their mean over the time from `from` (s) to `from + dt`.
    #[must_use]
    pub(crate) fn mean_at(t: f64, from: f64, dt: f64) -> Self {
        let window = Window::Mean {
            from,
            to: from + dt,
        };
        Self::new(t, window)
    }

    /// The loads at `t + share dt` within a step from `t` (s) to `t + dt`, or the line over the step
    /// with the same impulse and first moment: for methods that take loads at several instants of a
    /// step.
    #[must_use]
    pub fn within(t: f64, dt: f64, share: f64) -> Self {
        let window = Window::Line {
            from: t,
            to: t + dt,
            shift: 0.0,
        };
        Self::new(t + share * dt, window)
    }

    /// The loads at both ends of a step from `t` (s) to `t + dt`, for a method that adds up `1 - gamma` of
    /// the first and gamma of the second. A line is taken at shifted times if gamma is not 1/2, so that
    /// the sum is its mean.
    #[must_use]
    pub fn at_both_ends(t: f64, dt: f64, gamma: f64) -> [Self; 2] {
        let window = Window::Line {
            from: t,
            to: t + dt,
            shift: (0.5 - gamma) * dt,
        };
        [t, t + dt].map(|t| Self::new(t, window))
    }

    /// The loads at `t` (s), or their mean over `t - before`..`t + after` (s) with weights that fall
    /// linearly to both ends: for leapfrog methods, for which
    /// `u(t + dt) - 2 u(t) + u(t - dt) = dt^2` times that mean of the acceleration.
    #[must_use]
    pub fn around(t: f64, before: f64, after: f64) -> Self {
        let window = Window::Hat {
            from: t - before,
            to: t + after,
        };
        Self::new(t, window)
    }

    /// The loads at `t` (s) as they are throughout a step from `from` to `from + dt` (s), in which
    /// they are known to be smooth.
    #[must_use]
    pub fn smooth_in(t: f64, from: f64, dt: f64) -> Self {
        let window = Window::Smooth {
            from,
            to: from + dt,
        };
        Self::new(t, window)
    }
}

impl<'a> LoadTime<'a> {
    /// This time under these inputs.
    #[must_use]
    pub fn under<'b>(self, inputs: &'b Inputs) -> LoadTime<'b> {
        LoadTime {
            t: self.t,
            window: self.window,
            inputs,
        }
    }

    /// The inputs that are known.
    #[must_use]
    pub fn inputs(self) -> &'a Inputs {
        self.inputs
    }

    /// The instant (s).
    #[must_use]
    pub fn t(self) -> f64 {
        self.t
    }

    /// Times (s) on both sides of the instant, inside the window by a rounding; equal if there is one side only.
    fn beside(self) -> [f64; 2] {
        let (from, to) = match self.window {
            Window::Instant => return [self.t; 2],
            Window::Smooth { from, to } => return [0.5 * (from + to); 2],
            _ => self.span(),
        };
        let slack = Clock::ROUNDING * from.abs().max(to.abs());
        match to - from > 2.0 * slack {
            true => [-slack, slack].map(|side| (self.t + side).clamp(from + slack, to - slack)),
            false => [0.5 * (from + to); 2],
        }
    }

    /// Start and end (s) of the time in which loads matter: the window, or the instant.
    #[must_use]
    pub fn span(self) -> (f64, f64) {
        match self.window {
            Window::Instant => (self.t, self.t),
            Window::Smooth { from, to }
            | Window::Mean { from, to }
            | Window::Line { from, to, .. }
            | Window::Hat { from, to } => (from, to),
        }
    }
}

impl From<f64> for LoadTime<'static> {
    fn from(t: f64) -> Self {
        Self::at(t)
    }
}

impl Ramp {
    /// The factor that a step takes.
    #[must_use]
    pub fn factor(&self, when: LoadTime<'_>) -> f64 {
        let LoadTime { t, window, inputs } = when;
        match self {
            Self::Input(_) | Self::InputRate(_) => return self.known(inputs).factor(when),
            Self::Position(of) => return of.known(inputs).place(when),
            _ => {}
        }
        let (from, to) = match window {
            Window::Instant => return self.value(t),
            Window::Smooth { from, to } => return self.value_within(from, to, t),
            Window::Mean { from, to }
            | Window::Line { from, to, .. }
            | Window::Hat { from, to } => (from, to),
        };
        let slack = Clock::ROUNDING * from.abs().max(to.abs());
        if let Self::Scaled(of, scaling) = self
            && scaling.instant_between(from + slack, to - slack).is_none()
        {
            return scaling.at(0.5 * (from + to)) * of.factor(when);
        }
        // All windows of a leapfrog count as long, so that its first is not taken otherwise than the next.
        let length = match window {
            Window::Hat { .. } => 2.0 * (t - from).max(to - t),
            _ => to - from,
        };
        // Methods that take means over a step move by them: the velocity of a support is then the way that it goes over the time.
        let is_way = matches!((self, window), (Self::Rate(_), Window::Mean { .. }));
        if !is_way && self.is_smooth_in_steps(from, to, length) {
            // The mean of a line is its value at the centre of the weights. Taken at the instant, it would
            // not fit the means on both sides of a kink, and the impulse of a table would depend on
            // where its kinks fall.
            let centre = match window {
                Window::Mean { .. } => 0.5 * (from + to),
                Window::Line { shift, .. } => t + shift,
                Window::Hat { .. } => t + ((to - t) - (t - from)) / 3.0,
                Window::Instant | Window::Smooth { .. } => t,
            };
            return match self {
                Self::Sin2 { .. } => self.value(t),
                Self::Sine { .. } => self.value_within(from, to, t),
                _ => self.value_within(from, to, centre),
            };
        }
        let length = to - from;
        match window {
            Window::Line { shift, .. } => {
                let middle = 0.5 * (from + to);
                let mean = self.integral(from, to, |_| 1.0) / length;
                let moment = self.integral(from, to, |s| s - middle);
                mean + 12.0 * moment / length.powi(3) * (t + shift - middle)
            }
            Window::Hat { .. } => {
                let (before, after) = (t - from, to - t);
                let rising = self.integral(from, t, |s| (s - from) / before);
                let falling = self.integral(t, to, |s| (to - s) / after);
                2.0 * (rising + falling) / length
            }
            _ => self.integral(from, to, |_| 1.0) / length,
        }
    }

    /// The value at the instant, also at jumps and kinks: at either end of a window the value inside it, and at a jump
    /// in the middle of one the mean of both sides. Used for positions of supports, which follow no input
    /// ([`Ramp::known`]).
    #[must_use]
    pub fn place(&self, when: LoadTime<'_>) -> f64 {
        let value = |at: f64| self.derivative_of_piece(0, at, when.t);
        let [before, after] = when.beside();
        match before == after {
            true => value(after),
            false => 0.5 * (value(before) + value(after)),
        }
    }

    /// The second derivative (1/s^2) at the instant, taken like [`Ramp::place`]. A kink inside a window adds its change
    /// of slope over the time, with weights that fall linearly from the instant to 0 at both ends: at the centre of a
    /// window of two steps this is the second difference of the values, and the sum over steps contains the whole
    /// change of speed.
    #[must_use]
    pub fn bend(&self, when: LoadTime<'_>) -> f64 {
        let LoadTime { t, .. } = when;
        let [_, after] = when.beside();
        let smooth = self.derivative_of_piece(2, after, t);
        let (from, to) = when.span();
        let slack = Clock::ROUNDING * from.abs().max(to.abs());
        let next = |after: f64| self.breakpoint_between(after + slack, to - slack);
        let slope = |from: f64, to: f64, t: f64| self.derivative_of_piece(1, 0.5 * (from + to), t);
        let (mut sum, mut start, mut kink) = (0.0, from, next(from));
        while let Some(at) = kink {
            let following = next(at);
            let change = slope(at, following.unwrap_or(to), at) - slope(start, at, at);
            let weight = match at < t {
                true => (at - from) / (t - from),
                false => (to - at) / (to - t),
            };
            sum += 2.0 / (to - from) * weight * change;
            (start, kink) = (at, following);
        }
        smooth + sum
    }

    /// True if a step over `from`..`to` (s) may use sampled values: no breakpoint is between them, apart from rounding
    /// of either instant. A rise of a squared sine that is long compared with the step is smooth at its ends too, where
    /// value and slope are continuous. A short one is smooth nowhere, so that all steps over it use means of it. A sine
    /// of a short period is not smooth either, because its samples would represent a slower sine.
    #[must_use]
    pub(crate) fn is_smooth_between(&self, from: f64, to: f64) -> bool {
        self.is_smooth_in_steps(from, to, to - from)
    }

    fn is_smooth_in_steps(&self, from: f64, to: f64, length: f64) -> bool {
        let is_short = |half: f64| half < LONG_RISE * length && to > 0.0;
        let is_short_rise = |rise: f64| is_short(rise) && from < rise;
        match self {
            Self::Sin2 { rise } => return !is_short_rise(*rise),
            // The rate of a long rise has kinks where the rise begins and ends.
            Self::Rate(of) if matches!(**of, Self::Sin2 { rise } if is_short_rise(rise)) => {
                return false;
            }
            _ => {}
        }
        if let Some([_, rate, _]) = self.sine_at(to)
            && is_short(PI / rate)
        {
            return false;
        }
        let slack = Clock::ROUNDING * from.abs().max(to.abs());
        if let Self::Scaled(of, scaling) = self {
            let jump = scaling.instant_between(from + slack, to - slack);
            return jump.is_none() && of.is_smooth_in_steps(from, to, length);
        }
        self.breakpoint_between(from + slack, to - slack).is_none()
    }

    /// The integral of the value times a linear weight between two instants (s), by pieces between breakpoints: exact,
    /// except that of a squared sine, which is exact to rounding. Breakpoints within rounding of an end give no
    /// separate piece; otherwise the bits would depend on the course after the end.
    fn integral(&self, from: f64, to: f64, weight: impl Fn(f64) -> f64) -> f64 {
        let slack = Clock::ROUNDING * from.abs().max(to.abs());
        let (mut sum, mut start) = (0.0, from);
        while start < to {
            let next = self.breakpoint_between(start + slack, to - slack);
            let end = next.unwrap_or(to);
            let sine = self.sine_at(0.5 * (start + end));
            sum += match sine.filter(|[_, rate, _]| rate * (end - start) > FEW_RADIANS) {
                Some(sine) => integral_of_sine(sine, [start, end], &weight),
                None => gauss_points(start, end)
                    .map(|(s, share)| share * weight(s) * self.value_within(start, end, s))
                    .sum(),
            };
            start = end;
        }
        sum
    }
}

/// The integral of `size sin(rate t + phase)` times a linear weight between two instants (s).
fn integral_of_sine(
    [size, rate, phase]: [f64; 3],
    [from, to]: [f64; 2],
    weight: impl Fn(f64) -> f64,
) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let slope = (weight(to) - weight(from)) / (to - from);
    let (sin, cos) = (rate * middle + phase).sin_cos();
    let (sin_half, cos_half) = (rate * half).sin_cos();
    let even = weight(middle) * sin * sin_half / rate;
    let odd = slope * cos * (sin_half - rate * half * cos_half) / (rate * rate);
    2.0 * size * (even + odd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaling::Scaling;

    fn pulse(from: f64, to: f64) -> Ramp {
        Ramp::Pulse { from, to }
    }

    /// The triangle of height 1 between two instants.
    fn triangle(from: f64, to: f64) -> Ramp {
        Ramp::Table {
            times: vec![from, 0.5 * (from + to), to],
            values: vec![0.0, 1.0, 0.0],
        }
    }

    /// A ramp with these factors from these instants (s) on.
    fn scaled(ramp: Ramp, factors: &[(f64, f64)]) -> Ramp {
        let (times, factors) = factors.iter().copied().unzip();
        Ramp::Scaled(Box::new(ramp), Scaling { times, factors })
    }

    /// Ramps that come and go within 0..1, with the time integral of each.
    fn transient() -> Vec<(Ramp, f64)> {
        vec![
            (pulse(0.131, 0.137), 0.006),
            (pulse(0.3, 0.7), 0.4),
            (pulse(0.05, 0.15), 0.1),
            (triangle(0.211, 0.219), 0.004),
            (triangle(0.2, 0.6), 0.2),
            (triangle(0.0, 0.102), 0.051),
            (scaled(pulse(0.3, 0.7), &[(0.45, 2.5)]), 0.775),
            (scaled(triangle(0.2, 0.6), &[(0.4, 0.0)]), 0.1),
            (scaled(pulse(0.3, 0.7), &[(0.41, -1.0), (0.43, 1.0)]), 0.36),
        ]
    }

    #[test]
    fn every_window_passes_on_the_whole_impulse() {
        let dt = 0.05;
        for (ramp, impulse) in transient() {
            let sum = |taken: &dyn Fn(f64) -> f64| -> f64 {
                (0..20).map(|n| dt * taken(f64::from(n) * dt)).sum()
            };
            let factor = |when: LoadTime| ramp.factor(when);
            let sums = [
                sum(&|t| factor(LoadTime::start_of(t, dt))),
                sum(&|t| factor(LoadTime::end_of(t, dt))),
                sum(&|t| {
                    let [start, end] =
                        [0.0, 1.0].map(|share| factor(LoadTime::within(t, dt, share)));
                    0.5 * (start + end)
                }),
                sum(&|t| factor(LoadTime::around(t, dt, dt))),
                sum(&|t| {
                    let [start, end] = LoadTime::at_both_ends(t, dt, 0.8).map(factor);
                    0.2 * start + 0.8 * end
                }),
                // A leapfrog begins with half a step.
                sum(&|t| match t {
                    0.0 => 0.5 * factor(LoadTime::around(t, 0.0, dt)),
                    _ => factor(LoadTime::around(t, dt, dt)),
                }),
            ];
            for (window, found) in sums.into_iter().enumerate() {
                let off = (found / impulse - 1.0).abs();
                assert!(off < 1e-12, "{ramp:?}, window {window}: {found}");
            }
        }
    }

    #[test]
    fn a_factor_that_stays_changes_nothing_but_the_size() {
        let dt = 0.05;
        for ramp in [Ramp::Step, Ramp::Sin2 { rise: 0.4 }, pulse(0.31, 0.7)] {
            let whole = scaled(ramp.clone(), &[]);
            let driven = scaled(ramp.clone(), &[(0.3, 2.5)]);
            for n in 0..20 {
                let t = f64::from(n) * dt;
                for when in [
                    LoadTime::start_of(t, dt),
                    LoadTime::within(t, dt, 0.3),
                    LoadTime::around(t, dt, dt),
                    LoadTime::smooth_in(t, t, dt),
                    LoadTime::at(t),
                ] {
                    let of = ramp.factor(when);
                    assert_eq!(whole.factor(when), of, "{ramp:?} {when:?}");
                    if when.span().0 > 0.29 {
                        assert_eq!(driven.factor(when), 2.5 * of, "{ramp:?} {when:?}");
                    }
                }
            }
        }
    }

    /// Sums over steps of `dt` (s) of the factors that methods take, up to t = 1, one for each window.
    fn sums(dt: f64, factor: impl Fn(LoadTime) -> f64) -> [f64; 5] {
        let steps = (1.0 / dt).round() as usize;
        let sum = |taken: &dyn Fn(f64) -> f64| -> f64 {
            (0..steps).map(|n| dt * taken(n as f64 * dt)).sum()
        };
        [
            sum(&|t| factor(LoadTime::start_of(t, dt))),
            sum(&|t| factor(LoadTime::end_of(t, dt))),
            sum(&|t| {
                0.5 * factor(LoadTime::within(t, dt, 0.0))
                    + 0.5 * factor(LoadTime::within(t, dt, 1.0))
            }),
            sum(&|t| {
                let [start, end] = LoadTime::at_both_ends(t, dt, 0.8).map(&factor);
                0.2 * start + 0.8 * end
            }),
            sum(&|t| match t {
                0.0 => 0.5 * factor(LoadTime::around(t, 0.0, dt)),
                _ => factor(LoadTime::around(t, dt, dt)),
            }),
        ]
    }

    #[test]
    fn the_rates_that_steps_take_add_up_to_the_way() {
        let table = |late: f64| Ramp::Table {
            times: [0.1, 0.22, 0.5].map(|t| t + late).to_vec(),
            values: vec![0.0, 3.0, -1.0],
        };
        for (of, way) in [
            (table(0.0), -1.0),
            (table(0.013), -1.0),
            (Ramp::Sin2 { rise: 0.03 }, 1.0),
            (Ramp::Sin2 { rise: 0.099 }, 1.0),
        ] {
            for (window, found) in sums(0.05, |when| of.rate().factor(when))
                .into_iter()
                .enumerate()
            {
                assert!(
                    (found - way).abs() < 1e-12,
                    "{of:?}, window {window}: {found}"
                );
            }
        }
        // A leapfrog's way ends half a step before the last instant.
        for (window, found) in sums(0.05, |when| Ramp::Linear.rate().factor(when))
            .into_iter()
            .enumerate()
        {
            let way = if window == 4 { 0.975 } else { 1.0 };
            assert!((found - way).abs() < 1e-12, "window {window}: {found}");
        }
        // A long rise is sampled, with means at its two kinks, where a method does not move by means: the error falls as dt^2.
        let of = Ramp::Sin2 { rise: 0.713 };
        let errors =
            |dt: f64| sums(dt, |when| of.rate().factor(when)).map(|found| (found - 1.0).abs());
        for (window, (coarse, fine)) in errors(0.02).into_iter().zip(errors(0.005)).enumerate() {
            let is_way = window < 2;
            assert!(
                if is_way {
                    coarse.max(fine) < 1e-12
                } else {
                    coarse < 2e-3 && fine < coarse / 10.0
                },
                "window {window}: {coarse} {fine}"
            );
        }
    }

    #[test]
    fn a_place_is_that_of_the_instant_whatever_the_window() {
        let dt = 0.05;
        let table = Ramp::Table {
            times: vec![0.013, 0.021, 0.1, 0.213, 0.7],
            values: vec![0.0, 3.0, -1.0, 2.0, 2.5],
        };
        let rises = [0.03, 0.4].map(|rise| Ramp::Sin2 { rise });
        for of in [table, Ramp::Linear].into_iter().chain(rises) {
            let place = Ramp::Position(Box::new(of.clone()));
            for t in (0..15).map(|n| f64::from(n) * dt) {
                let [start, end] = LoadTime::at_both_ends(t, dt, 0.7);
                for (when, at) in [
                    (LoadTime::start_of(t, dt), t),
                    (LoadTime::end_of(t, dt), t + dt),
                    (LoadTime::within(t, dt, 0.3), t + 0.3 * dt),
                    (LoadTime::around(t, dt, dt), t),
                    (LoadTime::around(t, 0.0, dt), t),
                    (LoadTime::smooth_in(t, t, dt), t),
                    (LoadTime::at(t), t),
                    (start, t),
                    (end, t + dt),
                ] {
                    // Over a kink no window is smooth.
                    if when != LoadTime::smooth_in(t, t, dt) || of.is_smooth_between(t, t + dt) {
                        let off = (place.factor(when) - of.value(at)).abs();
                        assert!(off < 1e-13, "{of:?} {when:?}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_place_that_jumps_is_that_inside_the_step() {
        let place = Ramp::Position(Box::new(pulse(0.1, 0.3)));
        let factor = |when: LoadTime<'_>| place.factor(when);
        assert_eq!(factor(LoadTime::end_of(0.05, 0.05)), 0.0);
        assert_eq!(factor(LoadTime::start_of(0.1, 0.05)), 1.0);
        // What a leapfrog takes: the mean of both sides.
        assert_eq!(factor(LoadTime::around(0.1, 0.05, 0.05)), 0.5);
        assert_eq!(factor(LoadTime::around(0.1, 0.0, 0.05)), 1.0);
        assert_eq!(factor(LoadTime::at(0.1)), 1.0);
    }

    #[test]
    fn bends_over_steps_add_up_to_the_speed_gained() {
        let dt = 0.05;
        let around = |n: i32| LoadTime::around(f64::from(n) * dt, dt, dt);
        for spacing in [0.05, 0.0125, 0.0173, 0.31] {
            // From rest to rest along a parabola between.
            let rows = (0..).map(|row| 0.1 + f64::from(row) * spacing);
            let times: Vec<f64> = rows.take_while(|t| *t < 0.8).collect();
            let values: Vec<f64> = times.iter().map(|t| (t - 0.1).powi(2)).collect();
            let table = Ramp::Table {
                times: [&times[..], &[0.9, 1.0]].concat(),
                values: [&values[..], &[1.0, 1.0]].concat(),
            };
            let gained: f64 = (0..=20).map(|n| dt * table.bend(around(n))).sum();
            assert!(gained.abs() < 1e-12, "{spacing}: {gained:e}");
            let kink = Ramp::Table {
                times: vec![0.0, 0.3 + spacing, 2.0],
                values: vec![0.0, 0.0, 3.4 - 2.0 * spacing],
            };
            let gained: f64 = (0..=20).map(|n| dt * kink.bend(around(n))).sum();
            assert!((gained - 2.0).abs() < 1e-12, "{spacing}: {gained:e}");
            if spacing == dt {
                let second = table.bend(around(8));
                assert!((second - 2.0).abs() < 1e-12, "{second}");
            }
        }
        let rise = Ramp::Sin2 { rise: 0.4 };
        let mut smooth = [0.0; 3];
        rise.derivatives_after(3.0 * dt, &mut smooth);
        assert_eq!(rise.bend(around(3)), smooth[2]);
    }

    #[test]
    fn the_middle_of_a_step_sees_the_mean_rate() {
        // What a step of a method of order 2 moves by is the way of the support in it.
        let of = Ramp::Table {
            times: vec![0.0, 0.03, 0.2],
            values: vec![0.0, 1.0, 0.4],
        };
        for t in [0.0, 0.05, 0.1] {
            let mean = (of.value(t + 0.05) - of.value(t)) / 0.05;
            for when in [LoadTime::start_of(t, 0.05), LoadTime::within(t, 0.05, 0.5)] {
                assert!((of.rate().factor(when) - mean).abs() < 1e-12, "from {t}");
            }
        }
    }

    #[test]
    fn short_rises_that_cancel_leave_their_difference() {
        let dt = 0.01;
        for (first, second) in [(0.017, 0.020), (0.005, 0.0149), (0.0004, 0.0399)] {
            let [first_ramp, second_ramp] = [first, second].map(|rise| Ramp::Sin2 { rise });
            let difference = |when| first_ramp.factor(when) - second_ramp.factor(when);
            let sum = |taken: &dyn Fn(f64) -> f64| -> f64 {
                (0..10).map(|n| dt * taken(f64::from(n) * dt)).sum()
            };
            let expected = 0.5 * (second - first);
            let sums = [
                sum(&|t| match t {
                    0.0 => 0.5 * difference(LoadTime::around(t, 0.0, dt)),
                    _ => difference(LoadTime::around(t, dt, dt)),
                }),
                sum(&|t| {
                    let [start, end] = LoadTime::at_both_ends(t, dt, 0.5).map(difference);
                    0.5 * (start + end)
                }),
                sum(&|t| difference(LoadTime::start_of(t, dt))),
                sum(&|t| difference(LoadTime::end_of(t, dt))),
            ];
            for (window, found) in sums.into_iter().enumerate() {
                // Rises of two windows and more are sampled: at one end of a step they are late or early by
                // half of it.
                let sampled = second >= 2.0 * dt && window > 0;
                let bound = if sampled { 0.51 * dt } else { 1e-14 };
                let off = (found - expected).abs();
                assert!(off < bound, "{first} {second}, window {window}: {found}");
            }
        }
    }

    #[test]
    fn a_rise_within_a_step_arrives_whole() {
        let (ramp, dt) = (Ramp::Sin2 { rise: 0.004 }, 0.05);
        // The mean over the step is less by half the rise, that with falling weights by about all.
        let mean = ramp.factor(LoadTime::start_of(0.0, dt));
        assert!((mean - (1.0 - 0.002 / dt)).abs() < 1e-14);
        let falling = ramp.factor(LoadTime::around(0.0, 0.0, dt));
        let weight = |s: f64| 2.0 * (dt - s) / (dt * dt);
        let fine = 100_000;
        let h = 0.004 / f64::from(fine);
        let lost = (0..fine).map(|n| (f64::from(n) + 0.5) * h);
        let lost: f64 = lost.map(|s| h * weight(s) * (1.0 - ramp.value(s))).sum();
        assert!((falling - (1.0 - lost)).abs() < 1e-10);
    }

    /// Integral of `sin(rate t + phase)` from t = 0 on.
    fn way_of_sine(rate: f64, phase: f64, t: f64) -> f64 {
        (phase.cos() - (rate * t + phase).cos()) / rate
    }

    #[test]
    fn a_sine_of_a_short_period_enters_by_its_means() {
        let dt = 0.01;
        // Samples of a period of one step would be a constant load.
        for (frequency, phase) in [(100.0, 0.9), (37.0, 0.0), (260.0, -0.4), (1e5, 0.3)] {
            let (ramp, rate) = (Ramp::Sine { frequency, phase }, 2.0 * PI * frequency);
            let scaled = Ramp::Scaled(
                Box::new(ramp.clone()),
                Scaling {
                    times: vec![0.0042],
                    factors: vec![-2.0],
                },
            );
            for n in 0..7 {
                let t = f64::from(n) * dt;
                let whole = |to: f64| way_of_sine(rate, phase, to) - way_of_sine(rate, phase, t);
                let mean = ramp.factor(LoadTime::start_of(t, dt));
                assert!(
                    (mean - whole(t + dt) / dt).abs() < 1e-10,
                    "{frequency} Hz from {t}"
                );
                let ends = LoadTime::at_both_ends(t, dt, 0.5).map(|when| ramp.factor(when));
                let sum = 0.5 * (ends[0] + ends[1]);
                assert!((sum - mean).abs() < 1e-10, "{frequency} Hz from {t}");
                let rate_of = ramp.rate().factor(LoadTime::start_of(t, dt));
                let change = (ramp.value(t + dt) - ramp.value(t)) / dt;
                assert!(
                    (rate_of - change).abs() < 1e-9 * rate,
                    "{frequency} Hz from {t}"
                );
                if n == 0 {
                    let before = way_of_sine(rate, phase, 0.0042);
                    let after = way_of_sine(rate, phase, dt) - before;
                    let found = scaled.factor(LoadTime::start_of(0.0, dt));
                    let expected = (before - 2.0 * after) / dt;
                    assert!((found - expected).abs() < 1e-10, "{frequency} Hz");
                }
            }
        }
    }

    #[test]
    fn a_hat_over_a_short_sine_has_the_weights_of_a_leapfrog() {
        let (dt, frequency, phase) = (0.01, 137.0, 0.2);
        let ramp = Ramp::Sine { frequency, phase };
        let (t, fine) = (0.03, 400_000);
        let h = 2.0 * dt / f64::from(fine);
        let terms = (0..fine).map(|n| t - dt + (f64::from(n) + 0.5) * h);
        let sum: f64 = terms
            .map(|s| h * (1.0 - (s - t).abs() / dt) / dt * ramp.value(s))
            .sum();
        let found = ramp.factor(LoadTime::around(t, dt, dt));
        assert!((found - sum).abs() < 1e-8, "{found} {sum}");
    }

    #[test]
    fn a_sine_of_a_long_period_is_sampled_and_begins_at_once() {
        let ramp = Ramp::Sine {
            frequency: 3.0,
            phase: 0.5 * PI,
        };
        for t in [0.05, 0.1, 0.2, 0.35] {
            let value = ramp.value(t);
            for when in [
                LoadTime::around(t, 0.01, 0.01),
                LoadTime::start_of(t, 0.01),
                LoadTime::within(t - 0.005, 0.01, 0.5),
            ] {
                assert!((ramp.factor(when) - value).abs() < 1e-15, "at {t}");
            }
        }
        assert!((ramp.factor(LoadTime::start_of(0.0, 0.01)) - 1.0).abs() < 1e-15);
        assert!((ramp.factor(LoadTime::around(0.0, 0.0, 0.01)) - 1.0).abs() < 1e-15);
    }

    /// A table that ends abruptly, on a step or within one.
    #[test]
    fn a_jump_of_a_table_acts_from_its_step_on_and_within_a_step_by_its_mean() {
        let dropped = |at: f64| Ramp::Table {
            times: vec![0.0, at, at],
            values: vec![1.0, 1.0, 0.0],
        };
        let dt = 0.05;
        let on = dropped(0.3);
        for n in 0..12_i32 {
            let t = f64::from(n) * dt;
            let expected = f64::from(n < 6);
            assert_eq!(on.factor(LoadTime::start_of(t, dt)), expected, "step {n}");
            assert_eq!(on.factor(LoadTime::end_of(t, dt)), expected, "step {n}");
            for share in [0.0, 0.5, 1.0] {
                let found = on.factor(LoadTime::within(t, dt, share));
                assert_eq!(found, expected, "step {n}");
            }
            let both = LoadTime::at_both_ends(t, dt, 0.5).map(|when| on.factor(when));
            assert_eq!(both, [expected; 2], "step {n}");
        }
        let within = dropped(0.3 + 0.3 * dt);
        let step = |n: f64| within.factor(LoadTime::start_of(n * dt, dt));
        assert_eq!((step(5.0), step(7.0)), (1.0, 0.0));
        assert!((step(6.0) - 0.3).abs() < 1e-12);
        let both = LoadTime::at_both_ends(6.0 * dt, dt, 0.5).map(|when| within.factor(when));
        assert!((0.5 * (both[0] + both[1]) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_jump_at_the_instant_counts_half() {
        let ramp = pulse(0.1, 0.3);
        for n in [2, 6] {
            let t = f64::from(n) * 0.05;
            assert!((ramp.factor(LoadTime::around(t, 0.05, 0.05)) - 0.5).abs() < 1e-12);
        }
        assert_eq!(ramp.factor(LoadTime::around(0.2, 0.05, 0.05)), 1.0);
    }

    #[test]
    fn one_sided_windows_see_their_side_of_a_jump_only() {
        let ramp = pulse(0.1, 0.3);
        assert_eq!(ramp.factor(LoadTime::around(0.1, 0.0, 0.05)), 1.0);
        assert_eq!(ramp.factor(LoadTime::around(0.1, 0.05, 0.0)), 0.0);
        assert_eq!(ramp.factor(LoadTime::start_of(0.1, 0.05)), 1.0);
        assert_eq!(ramp.factor(LoadTime::end_of(0.05, 0.05)), 0.0);
        assert_eq!(ramp.factor(LoadTime::within(0.05, 0.05, 1.0)), 0.0);
        assert_eq!(ramp.factor(LoadTime::within(0.3, 0.05, 0.0)), 0.0);
        // The beginning of a load counts whole, so that a body is loaded from t = 0 on.
        assert_eq!(Ramp::Step.factor(LoadTime::around(0.0, 0.0, 0.05)), 1.0);
    }

    #[test]
    fn where_nothing_changes_loads_are_sampled() {
        let ramp = Ramp::Sin2 { rise: 0.4 };
        for t in [0.05, 0.1, 0.2, 0.35] {
            let value = ramp.value(t);
            assert_eq!(ramp.factor(LoadTime::around(t, 0.05, 0.05)), value);
            assert_eq!(ramp.factor(LoadTime::start_of(t, 0.05)), value);
            assert_eq!(ramp.factor(LoadTime::within(t - 0.025, 0.05, 0.5)), value);
        }
        // The end of a long rise is smooth too.
        let before = ramp.value(0.38);
        assert_eq!(ramp.factor(LoadTime::around(0.38, 0.05, 0.05)), before);
        assert_eq!(ramp.factor(LoadTime::around(0.42, 0.05, 0.05)), 1.0);
        assert_eq!(ramp.factor(LoadTime::within(0.38, 0.05, 1.0)), 1.0);
    }

    #[test]
    fn jumps_are_matched_to_steps_however_late() {
        // 13602 steps of 1 ms are 13.602 s but for rounding.
        let (dt, ramp) = (1e-3, pulse(13.6, 13.602));
        for n in 13_590_i32..13_610 {
            let t = f64::from(n) * dt;
            let expected = f64::from((13_600..13_602).contains(&n));
            assert_eq!(ramp.factor(LoadTime::start_of(t, dt)), expected, "step {n}");
            let end = ramp.factor(LoadTime::within(t, dt, 1.0));
            assert_eq!(end, expected, "step {n}");
        }
    }

    #[test]
    fn the_line_has_the_moments_of_what_it_replaces() {
        // A jump at a third of the step: mean 2/3, first moment about the middle 1/9.
        let ramp = pulse(1.0 / 3.0, 9.0);
        let at = |share: f64| ramp.factor(LoadTime::within(0.0, 1.0, share));
        assert!((at(0.5) - 2.0 / 3.0).abs() < 1e-14);
        assert!((at(1.0) - at(0.0) - 12.0 / 9.0).abs() < 1e-13);
    }
}
