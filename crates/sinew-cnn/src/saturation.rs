//! The nonlinear current source of a cell.

/// `f(x) = (|x + Q| - |x - Q|)/2`: the identity inside -Q..Q and constant outside (paper, Eq. 5).
///
/// Each component is clamped separately, as in the paper; the result therefore depends on the axes' directions once
/// something saturates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saturation {
    voltage: f64,
}

/// The paper's saturation, 4 m/s.
impl Default for Saturation {
    fn default() -> Self {
        Self::PAPER
    }
}

/// Error of a saturation voltage that is not above 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("saturation voltage Q = {0} m/s: expected a number above 0")]
pub struct SaturationError(f64);

impl Saturation {
    /// No saturation at any velocity.
    pub const OFF: Self = Self {
        voltage: f64::INFINITY,
    };

    /// The paper's voltage, 4 m/s.
    pub const PAPER: Self = Self { voltage: 4.0 };

    /// Saturates at Q = `voltage` (m/s).
    ///
    /// # Errors
    /// [`SaturationError`] when it is not above 0.
    pub fn at(voltage: f64) -> Result<Self, SaturationError> {
        if voltage > 0.0 {
            Ok(Self { voltage })
        } else {
            Err(SaturationError(voltage))
        }
    }

    /// Q (m/s); infinite when it never saturates.
    #[must_use]
    pub const fn voltage(self) -> f64 {
        self.voltage
    }

    /// f(x) (m/s).
    #[must_use]
    #[inline]
    pub fn output(self, x: f64) -> f64 {
        x.clamp(-self.voltage, self.voltage)
    }

    /// True if df/dx is 0 at x.
    #[must_use]
    #[inline]
    pub fn saturates(self, x: f64) -> bool {
        x.abs() >= self.voltage
    }
}

#[cfg(test)]
mod tests {
    use super::Saturation;

    #[test]
    fn a_cell_at_its_limit_is_saturated() {
        let saturation = Saturation::at(2.0).unwrap();
        assert_eq!(
            [2.5, -3.0, 1.0].map(|x| saturation.output(x)),
            [2.0, -2.0, 1.0]
        );
        let found = [2.0, -2.0, 2.1, 1.9].map(|x| saturation.saturates(x));
        assert_eq!(found, [true, true, true, false]);
    }
}
