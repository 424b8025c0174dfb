//! Sizes of letters and colours of errors.

pub(super) const TEXT: f64 = 12.0;
pub(super) const SMALL: f64 = 11.0;

/// Errors (fraction) at the ends of the colours.
pub(super) const RANGE: (f64, f64) = (1e-4, 1.0);

/// Position of an error on the colour scale.
pub(super) fn share(error: f64) -> f64 {
    let (low, high) = (RANGE.0.log10(), RANGE.1.log10());
    ((error.log10() - low) / (high - low)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_errors_apart() {
        assert_eq!(share(1e-6), 0.0);
        assert!((share(0.01) - 0.5).abs() < 1e-12);
        assert_eq!(share(50.0), 1.0);
    }
}
