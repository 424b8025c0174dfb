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
    /// Size below which results are set to 0: far below any measured quantity, and so far above the numbers that
    /// processors handle slowly (denormals) that products in a step do not reach these either.
    const TINY: f64;
    /// Largest number.
    const LARGEST: f64;

    /// The nearest number to `value`.
    fn of(value: f64) -> Self;

    /// This number, exactly.
    fn to_f64(self) -> f64;

    /// 2 to the power of this number, which is whole; the result is neither 0 nor infinite.
    fn two_to_it(self) -> Self;

    /// m and e of `m 2^e`, for a number above 0: m from the root of 1/2 to that of 2, e whole.
    fn parts(self) -> [Self; 2];
}

/// Bits of numbers, for exponents.
pub(crate) mod bits {
    /// Bits of a mantissa.
    pub(crate) const OF_DOUBLE: u32 = 52;
    pub(crate) const OF_SINGLE: u32 = 23;
    /// A number whose last bits become those of a whole number added to it, biased as an exponent is.
    pub(crate) const BIASED_DOUBLE: f64 = 4_503_599_627_371_519.0;
    pub(crate) const BIASED_SINGLE: f32 = 8_388_735.0;
    /// The root of 1/2 with an exponent that is lower by 1024, or by 128.
    pub(crate) const ROOT_OF_DOUBLE: u64 = 0x3FE6_A09E_667F_3BCD_u64.wrapping_sub(1 << 62);
    pub(crate) const ROOT_OF_SINGLE: u32 = 0x3F35_04F3_u32.wrapping_sub(1 << 30);
    /// 2^52 or 2^23, whose last bits are those of a whole number.
    pub(crate) const WHOLE_DOUBLE: f64 = 4_503_599_627_370_496.0;
    pub(crate) const WHOLE_SINGLE: f32 = 8_388_608.0;
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

    #[inline(always)]
    fn two_to_it(self) -> Self {
        Self::from_bits((self + bits::BIASED_DOUBLE).to_bits() << bits::OF_DOUBLE)
    }

    #[inline(always)]
    fn parts(self) -> [Self; 2] {
        let own = self.to_bits();
        let exponent = own.wrapping_sub(bits::ROOT_OF_DOUBLE) >> bits::OF_DOUBLE;
        let bias = 1_u64 << 62;
        let mantissa = own
            .wrapping_sub(exponent << bits::OF_DOUBLE)
            .wrapping_add(bias);
        let whole = Self::from_bits(exponent | bits::WHOLE_DOUBLE.to_bits());
        [
            Self::from_bits(mantissa),
            whole - (bits::WHOLE_DOUBLE + 1024.0),
        ]
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

    #[inline(always)]
    fn two_to_it(self) -> Self {
        Self::from_bits((self + bits::BIASED_SINGLE).to_bits() << bits::OF_SINGLE)
    }

    #[inline(always)]
    fn parts(self) -> [Self; 2] {
        let own = self.to_bits();
        let exponent = own.wrapping_sub(bits::ROOT_OF_SINGLE) >> bits::OF_SINGLE;
        let bias = 1_u32 << 30;
        let mantissa = own
            .wrapping_sub(exponent << bits::OF_SINGLE)
            .wrapping_add(bias);
        let whole = Self::from_bits(exponent | bits::WHOLE_SINGLE.to_bits());
        [
            Self::from_bits(mantissa),
            whole - (bits::WHOLE_SINGLE + 128.0),
        ]
    }
}
