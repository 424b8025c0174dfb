//! Numbers in a form for readers.

/// Three significant digits, trailing zeros kept, because they are significant.
#[must_use]
pub fn three(x: f64) -> String {
    significant(x, 3)
}

/// Two significant digits: for figures that were recorded with two digits.
#[must_use]
pub fn two(x: f64) -> String {
    significant(x, 2)
}

/// A fraction in per cent, three significant digits, without the sign.
#[must_use]
pub fn percent(fraction: f64) -> String {
    three(100.0 * fraction)
}

/// A chosen number, such as a step, without trailing zeros.
#[must_use]
pub fn short(x: f64) -> String {
    let text = significant(x, 4);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, ""));
    let mantissa = if mantissa.contains('.') {
        mantissa.trim_end_matches('0').trim_end_matches('.')
    } else {
        mantissa
    };
    if exponent.is_empty() {
        mantissa.to_owned()
    } else {
        format!("{mantissa}e{exponent}")
    }
}

/// Seconds as milliseconds, without the unit.
#[must_use]
pub fn milliseconds(seconds: f64) -> String {
    short(1e3 * seconds)
}

fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{x:.*e}", digits - 1);
    let Some(exponent) = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok())
    else {
        return scientific;
    };
    if !(-3..5).contains(&exponent) {
        return scientific;
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    let rounded = scientific.parse().unwrap_or(x);
    format!("{rounded:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_significant_digits() {
        let cases = [
            (0.0, "0"),
            (2523.0, "2520"),
            (16540.0, "16500"),
            (4e5, "4.00e5"),
            (25.2, "25.2"),
            (5.0, "5.00"),
            (0.123456, "0.123"),
            (0.00123, "0.00123"),
            (0.000_999_9, "0.00100"),
            (9.0e-4, "9.00e-4"),
            (3.79e-8, "3.79e-8"),
            (4.2e32, "4.20e32"),
            (-17.25, "-17.2"),
        ];
        for (x, expected) in cases {
            assert_eq!(three(x), expected);
        }
        assert_eq!(percent(25.2), "2520");
    }

    #[test]
    fn what_is_not_finite_is_still_printed() {
        assert_eq!(three(f64::INFINITY), "inf");
        assert_eq!(three(f64::NAN), "NaN");
    }

    #[test]
    fn steps_are_short() {
        assert_eq!(milliseconds(0.02), "20");
        assert_eq!(milliseconds(0.001), "1");
        assert_eq!(milliseconds(1.0 / 300.0), "3.333");
        assert_eq!(milliseconds(0.0079), "7.9");
        assert_eq!(milliseconds(2e-8), "2e-5");
        assert_eq!(milliseconds(10.0), "10000");
    }
}
