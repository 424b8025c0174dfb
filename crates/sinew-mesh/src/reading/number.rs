//! Numbers as text, also in the form in which Python shows those of NumPy 2: `np.float64(0.5)`.

use super::cursor::{Token, quoted};
use super::fault::Fault;

/// A count or tag: decimal digits only, so that `-1`, `3.5` and numbers beyond 64 bits are refused, not misread.
pub(crate) fn unsigned(token: Token<'_>, what: &str) -> Result<u64, Fault> {
    let digits = without_numpy(token.text);
    let value = digits.iter().try_fold(0u64, |value, byte| {
        let digit = byte.is_ascii_digit().then(|| u64::from(byte - b'0'))?;
        value.checked_mul(10)?.checked_add(digit)
    });
    value.filter(|_| !digits.is_empty()).ok_or_else(|| {
        let expected = if !digits.is_empty() && digits.iter().all(u8::is_ascii_digit) {
            "a number below 2^64"
        } else {
            "a non-negative whole number"
        };
        wrong(token, what, expected)
    })
}

/// A signed number of 32 bits.
pub(crate) fn signed(token: Token<'_>, what: &str) -> Result<i32, Fault> {
    text_of(token)
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| wrong(token, what, "a whole number of at most 32 bits"))
}

/// A signed number of 64 bits; a larger one becomes the largest.
pub(crate) fn signed_long(token: Token<'_>, what: &str) -> Result<i64, Fault> {
    let number = text_of(token).and_then(|text| {
        let unsigned = || text.parse::<u64>().ok().map(|_| i64::MAX);
        text.parse().ok().or_else(unsigned)
    });
    number.ok_or_else(|| wrong(token, what, "a whole number of at most 64 bits"))
}

/// A floating-point number; may be infinite or NaN.
pub(crate) fn double(token: Token<'_>, what: &str) -> Result<f64, Fault> {
    text_of(token)
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| {
            let is_fortran = token.text.iter().any(|byte| matches!(byte, b'd' | b'D'))
                && token
                    .text
                    .iter()
                    .all(|byte| b"+-.dD0123456789".contains(byte));
            let expected = if is_fortran {
                "a number with exponent E (Fortran's D is not accepted)"
            } else {
                "a number"
            };
            wrong(token, what, expected)
        })
}

/// The start of a number in the form in which Python shows those of NumPy 2.
pub(crate) const NUMPY: &[u8] = b"np.";

fn text_of(token: Token<'_>) -> Option<&str> {
    std::str::from_utf8(without_numpy(token.text)).ok()
}

/// The text inside `np.NAME(...)`, or the whole text if it is not such a call.
#[inline]
fn without_numpy(text: &[u8]) -> &[u8] {
    let inside = || {
        let call = text.strip_prefix(NUMPY)?.strip_suffix(b")")?;
        let open = call.iter().position(|&byte| byte == b'(')?;
        let (name, inside) = call.split_at_checked(open)?;
        let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        (!name.is_empty() && name.iter().all(is_name)).then(|| inside.get(1..))?
    };
    inside().unwrap_or(text)
}

fn wrong(token: Token<'_>, what: &str, expected: &str) -> Fault {
    let problem = format!("{what} is {}", quoted(token.text));
    if token.text.starts_with(b"$") {
        Fault::shortage(
            token.offset,
            format!("the section ends early: {problem}"),
            expected,
        )
    } else {
        Fault::new(token.offset, problem, expected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn token(text: &str) -> Token<'_> {
        Token {
            text: text.as_bytes(),
            offset: 0,
        }
    }

    #[test]
    fn every_usual_spelling_of_a_double_is_read() {
        let spellings = [
            ("0", 0.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("+0", 0.0),
            ("0.E0", 0.0),
            ("1E+00", 1.0),
            ("-9.999999994736442e-08", -9.999999994736442e-8),
            ("4.9406564584124654e-324", 5e-324),
        ];
        for (spelling, value) in spellings {
            assert_eq!(double(token(spelling), "x").ok(), Some(value), "{spelling}");
        }
        assert!(double(token("-0"), "x").is_ok_and(f64::is_sign_negative));
        for spelling in ["", ".", "1D-3", "1,5", "0x10", "1e", "--1", "1_000", "1f"] {
            assert!(double(token(spelling), "x").is_err(), "{spelling}");
        }
    }

    #[test]
    fn numbers_of_any_type_of_numpy_are_read() {
        for name in [
            "float64",
            "float32",
            "float16",
            "longdouble",
            "uint8",
            "int_",
        ] {
            let spelling = format!("np.{name}(-2)");
            assert_eq!(double(token(&spelling), "x").ok(), Some(-2.0), "{spelling}");
            assert_eq!(signed(token(&spelling), "n").ok(), Some(-2), "{spelling}");
            assert_eq!(signed_long(token(&spelling), "n").ok(), Some(-2));
            assert!(unsigned(token(&spelling), "n").is_err(), "{spelling}");
        }
        assert_eq!(unsigned(token("np.uint64(7)"), "n").ok(), Some(7));
        assert!(double(token("np.float64(nan)"), "x").is_ok_and(f64::is_nan));
        for spelling in [
            "np.float64(1",
            "np.float641)",
            "np.(1)",
            "np.float64()",
            "np.a(np.b(1))",
            "np.a.b(1)",
            "float64(1)",
            "np.float64(1)2",
        ] {
            assert!(double(token(spelling), "x").is_err(), "{spelling}");
        }
    }

    #[test]
    fn counts_are_plain_digits_of_64_bits() {
        assert_eq!(
            unsigned(token("18446744073709551615"), "n").ok(),
            Some(u64::MAX)
        );
        for spelling in ["18446744073709551616", "-1", "+1", "1.0", "1e3", "", "١"] {
            assert!(unsigned(token(spelling), "n").is_err(), "{spelling}");
        }
    }

    #[test]
    fn signed_numbers_have_32_bits() {
        assert_eq!(signed(token("-2147483648"), "n").ok(), Some(i32::MIN));
        for spelling in ["2147483648", "1.0", "", "-"] {
            assert!(signed(token(spelling), "n").is_err(), "{spelling}");
        }
    }
}
