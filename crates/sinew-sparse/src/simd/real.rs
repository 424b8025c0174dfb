//! Numbers that kernels compute with.

/// A number of a kernel: `f64` or `f32`.
pub trait Real:
    Copy
    + Default
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + std::fmt::Debug
    + std::ops::Add<Output = Self>
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
    + 'static
{
    /// Numbers in 64 bytes.
    const LANES: usize;
    /// Relative rounding error of one operation.
    const ROUNDING: f64;
    /// Size below which results are 0: far below anything that is measured, and as far above the numbers that
    /// processors compute with slowly (denormals) that products of a step do not get there either.
    const TINY: f64;
    /// Largest number.
    const LARGEST: f64;

    /// The nearest number to `value`.
    fn of(value: f64) -> Self;

    /// This number, exactly.
    fn to_f64(self) -> f64;
}

impl Real for f64 {
    const LANES: usize = 8;
    const ROUNDING: f64 = Self::EPSILON / 2.0;
    const TINY: f64 = 1e-280;
    const LARGEST: f64 = Self::MAX;

    fn of(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const LANES: usize = 16;
    const ROUNDING: f64 = Self::EPSILON as f64 / 2.0;
    const TINY: f64 = 1e-30;
    const LARGEST: f64 = Self::MAX as f64;

    fn of(value: f64) -> Self {
        value as Self
    }

    fn to_f64(self) -> f64 {
        self.into()
    }
}
