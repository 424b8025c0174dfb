//! Axes: ranges, ticks, and positions of values.

use crate::number;

/// The spread of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic; values that are not positive are left out, but minus infinity is below all values.
    Log,
}

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity, with its unit.
    pub label: String,
    /// The spread of values.
    pub scale: Scale,
    /// Lowest and highest value shown; otherwise they come from the data.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis that fits the data.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    /// A logarithmic axis that fits the data.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// The axis with a fixed range.
    #[must_use]
    pub fn range(self, low: f64, high: f64) -> Self {
        Self {
            range: Some((low, high)),
            ..self
        }
    }

    /// The axis with the range that it shows: its own, or that of the data with some margin.
    #[must_use]
    pub fn fitted(&self, data: impl Iterator<Item = f64>) -> Fitted {
        let scale = self.scale;
        let (low, high) = match self.range {
            Some((low, high)) => (scale.forward(low), scale.forward(high)),
            None => padded(scale, data),
        };
        let usable = low.is_finite() && high.is_finite() && high > low;
        let (low, high) = if usable { (low, high) } else { (0.0, 1.0) };
        Fitted { scale, low, high }
    }
}

/// Margin around the data, and some extent if the data have none.
fn padded(scale: Scale, data: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for x in data.map(|x| scale.forward(x)).filter(|x| x.is_finite()) {
        low = low.min(x);
        high = high.max(x);
    }
    let least = match scale {
        Scale::Linear if high > low => 0.0,
        Scale::Linear if high == 0.0 => 1.0,
        Scale::Linear => high.abs(),
        Scale::Log => 1.0,
    };
    let missing = 0.5 * (least - (high - low)).max(0.0);
    let room = 0.04 * (high - low).max(least);
    (low - missing - room, high + missing + room)
}

impl Scale {
    fn forward(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Log if x > 0.0 => x.log10(),
            Self::Log if x == f64::NEG_INFINITY => x,
            Self::Log => f64::NAN,
        }
    }
}

/// An axis with its range, in forward (possibly logarithmic) coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    scale: Scale,
    low: f64,
    high: f64,
}

/// A tick; without a label it is a minor one.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position as a share of the axis.
    pub at: f64,
    /// The text of the value.
    pub label: Option<String>,
}

impl Fitted {
    /// Position of a value as a share of the axis: 0 at the low end, 1 at the high end. NaN if the axis cannot show it.
    #[must_use]
    pub fn share(&self, x: f64) -> f64 {
        (self.scale.forward(x) - self.low) / (self.high - self.low)
    }

    /// The lowest and the highest value shown.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        let backward = |x: f64| match self.scale {
            Scale::Linear => x,
            Scale::Log => 10f64.powf(x),
        };
        (backward(self.low), backward(self.high))
    }

    /// The spread of its values.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Ticks inside the range, about `wanted` of them labelled.
    #[must_use]
    pub fn ticks(&self, wanted: usize) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(wanted),
            Scale::Log => self.log_ticks(wanted),
        }
    }

    fn linear_ticks(&self, wanted: usize) -> Vec<Tick> {
        let step = nice_step((self.high - self.low) / wanted.max(1) as f64);
        let decimals = (-step.log10().floor()).max(0.0);
        let far = self.low.abs().max(self.high.abs()) >= 1e6 || decimals > 6.0;
        let first = (self.low / step - 1e-9).ceil();
        let last = (self.high / step + 1e-9).floor();
        // Extents at the end of what floats can tell apart have no ticks.
        if !(0.0..=100.0).contains(&(last - first)) {
            return Vec::new();
        }
        (0..=(last - first) as usize)
            .map(|i| {
                let x = (first + i as f64) * step + 0.0;
                let label = if far {
                    number::short(x)
                } else {
                    format!("{x:.*}", decimals as usize)
                };
                Tick {
                    at: (x - self.low) / (self.high - self.low),
                    label: Some(label),
                }
            })
            .collect()
    }

    fn log_ticks(&self, wanted: usize) -> Vec<Tick> {
        let decades = self.high - self.low;
        let stride = (decades / wanted.max(1) as f64).ceil().max(1.0) as i32;
        let mut ticks = Vec::new();
        for exponent in self.low.floor() as i32..=self.high.ceil() as i32 {
            for digit in 1..10 {
                let forward = f64::from(exponent) + f64::from(digit).log10();
                let at = (forward - self.low) / decades;
                if !(-1e-9..=1.0 + 1e-9).contains(&at) {
                    continue;
                }
                let labelled = match digit {
                    1 => exponent.rem_euclid(stride) == 0,
                    2 | 5 => decades < 1.6 || 3.0 * decades <= wanted as f64,
                    _ => false,
                };
                if labelled {
                    let label = Some(power_label(digit, exponent));
                    ticks.push(Tick { at, label });
                } else if stride == 1 && decades <= 5.0 || digit == 1 {
                    ticks.push(Tick { at, label: None });
                }
            }
        }
        ticks
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
pub(crate) fn nice_step(least: f64) -> f64 {
    if !least.is_finite() || least <= 0.0 {
        return 1.0;
    }
    let power = 10f64.powi(least.log10().floor() as i32);
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

fn power_label(digit: i32, exponent: i32) -> String {
    match (digit, exponent) {
        (digit, -3..=4) => number::short(f64::from(digit) * 10f64.powi(exponent)),
        (1, exponent) => format!("10^{{{}}}", minus(exponent)),
        (digit, exponent) => format!("{digit}·10^{{{}}}", minus(exponent)),
    }
}

fn minus(exponent: i32) -> String {
    exponent.to_string().replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_1_2_or_5_times_a_power_of_ten() {
        for (least, step) in [
            (0.9, 1.0),
            (1.1, 2.0),
            (2.1, 5.0),
            (4.5, 5.0),
            (5.1, 10.0),
            (0.03, 0.05),
        ] {
            assert!((nice_step(least) / step - 1.0).abs() < 1e-12, "{least}");
        }
    }

    fn labels(axis: &Axis, data: &[f64], wanted: usize) -> Vec<String> {
        let fitted = axis.fitted(data.iter().copied());
        let ticks = fitted.ticks(wanted);
        assert!(
            ticks
                .iter()
                .all(|tick| (-1e-6..1.0 + 1e-6).contains(&tick.at))
        );
        ticks.into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        let axis = Axis::linear("t").range(0.0, 1.0);
        assert_eq!(
            labels(&axis, &[], 5),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        let axis = Axis::linear("u").range(-0.13, 0.13);
        assert_eq!(labels(&axis, &[], 5), ["-0.1", "0.0", "0.1"]);
        let axis = Axis::linear("u").range(0.0, 3e7);
        assert_eq!(labels(&axis, &[], 3), ["0", "1e7", "2e7", "3e7"]);
    }

    #[test]
    fn log_ticks_are_decades() {
        let axis = Axis::log("e").range(0.01, 1000.0);
        assert_eq!(
            labels(&axis, &[], 6),
            ["0.01", "0.1", "1", "10", "100", "1000"]
        );
        let axis = Axis::log("e").range(1e-9, 1e3);
        assert_eq!(
            labels(&axis, &[], 6),
            ["10^{−8}", "10^{−6}", "10^{−4}", "0.01", "1", "100"]
        );
        let axis = Axis::log("e").range(1.0, 10.0);
        assert_eq!(labels(&axis, &[], 6), ["1", "2", "5", "10"]);
        let axis = Axis::log("e").range(0.3, 40.0);
        assert_eq!(labels(&axis, &[], 6), ["1", "10"]);
        assert_eq!(labels(&axis, &[], 8), ["0.5", "1", "2", "5", "10", "20"]);
    }

    #[test]
    fn any_data_gives_an_axis() {
        for axis in [Axis::linear("x"), Axis::log("x")] {
            for data in [
                &[][..],
                &[0.0],
                &[3.0, 3.0],
                &[f64::NAN],
                &[-1.0],
                &[1e-300],
            ] {
                labels(&axis, data, 5);
            }
        }
        let fitted = Axis::log("x").fitted([1.0, f64::INFINITY, 0.0, 100.0].into_iter());
        assert!((fitted.share(10.0) - 0.5).abs() < 1e-12);
        assert!(fitted.share(0.0).is_nan());
    }
}
