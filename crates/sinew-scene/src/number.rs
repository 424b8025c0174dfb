//! Formatting of numbers for messages.

/// Four significant digits without trailing zeros.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.3e}");
    // Read back, so that 9.9999 is 10 and not 9.999.
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-4..1e7).contains(&rounded.abs()) {
        return rounded.to_string();
    }
    format!("{rounded:e}")
}

pub(crate) fn vector(value: [f64; 3]) -> String {
    format!("[{}]", value.map(short).join(", "))
}

pub(crate) fn length(value: [f64; 3]) -> f64 {
    value.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A number of things, in the plural unless it is 1.
pub(crate) fn count(number: usize, what: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {what}{plural}")
}

/// A size in bytes.
pub(crate) fn bytes(count: usize) -> String {
    match count {
        0..10_000 => format!("{count} B"),
        10_000..10_000_000 => format!("{} kB", short(count as f64 / 1e3)),
        _ => format!("{} MB", short(count as f64 / 1e6)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_few_and_right() {
        assert_eq!(short(16.199_999_999_999), "16.2");
        assert_eq!(short(9.999_96), "10");
        assert_eq!(short(-0.007_9), "-0.0079");
        assert_eq!(short(1.234_56e-9), "1.235e-9");
        assert_eq!(short(0.0), "0");
        assert_eq!(short(f64::INFINITY), "inf");
        assert_eq!(vector([1e-17, 0.5, -500.0]), "[1e-17, 0.5, -500]");
    }

    #[test]
    fn sizes_and_counts_have_units() {
        assert_eq!(count(1, "step"), "1 step");
        assert_eq!(count(50, "step"), "50 steps");
        assert_eq!(bytes(72), "72 B");
        assert_eq!(bytes(2_345_678), "2346 kB");
        assert_eq!(bytes(12_345_678), "12.35 MB");
    }
}
