//! Numbers on axes and scales.

/// Four significant digits without trailing zeros.
#[must_use]
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.abs().to_string();
    }
    // Read back, so that 9.9999 is 10 and not 9.999.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-4..1e7).contains(&rounded.abs()) {
        return rounded.to_string();
    }
    format!("{rounded:e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_few_and_right() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (9.999_96, "10"),
            (0.3 - 0.1, "0.2"),
            (-0.007_9, "-0.0079"),
            (2e7, "2e7"),
            (1.234_56e-9, "1.235e-9"),
        ];
        for (value, expected) in cases {
            assert_eq!(short(value), expected);
        }
    }
}
