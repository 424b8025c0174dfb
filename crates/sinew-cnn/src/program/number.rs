//! Numbers with a few significant digits.

/// `value` with at most `digits` significant digits, without trailing zeros; very small and very
/// large ones with an exponent.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    if (-5..digits as i32).contains(&power) {
        let decimals = (digits as i32 - 1 - power).max(0) as usize;
        return without_trailing_zeros(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", without_trailing_zeros(mantissa))
}

fn without_trailing_zeros(number: &str) -> &str {
    if !number.contains('.') {
        return number;
    }
    number.trim_end_matches('0').trim_end_matches('.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_in_a_textbook() {
        for (value, expected) in [
            (0.02, "0.02"),
            (80.0, "80"),
            (1.0 / 3.0, "0.333333"),
            (-2.0 / 3.0, "-0.666667"),
            (123_456.7, "123457"),
            (1_234_567.0, "1.23457e6"),
            (1.5e-5, "0.000015"),
            (1.5e-7, "1.5e-7"),
            (-1e300, "-1e300"),
            (0.0, "0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(significant(value, 6), expected);
        }
    }

    #[test]
    fn seventeen_digits_give_the_number_back() {
        for value in [0.1, 1.0 / 3.0, 2.0_f64.sqrt() * 1e-9, 6.02214076e23] {
            assert_eq!(significant(value, 17).parse(), Ok(value));
        }
    }
}
