//! Numbers as text: round ones, and units with prefixes.

use sinew_draw::short;

/// Prefixes of units and their factors.
const PREFIXES: [(f64, &str); 7] = [
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
    (1e6, "M"),
    (1e9, "G"),
];

/// The factor of a prefix and the unit with it. With this prefix a number has one to three digits before the point.
pub(super) fn prefixed(largest: f64, unit: &str) -> (f64, String) {
    // Plain numbers have no prefix, and powers of units would take it with them.
    let takes_none = unit.is_empty() || unit.contains(['²', '³']);
    let fits = |(factor, _): &&(f64, &str)| largest >= 0.999_9 * factor;
    let found = PREFIXES.iter().rev().find(fits);
    match found {
        Some((factor, prefix)) if !takes_none => (*factor, format!("{prefix}{unit}")),
        _ => (1.0, unit.to_owned()),
    }
}

/// A number with its unit.
pub(super) fn in_prefixed(value: f64, unit: &str) -> String {
    let (factor, unit) = prefixed(value.abs(), unit);
    format!("{} {unit}", short(value / factor))
        .trim_end()
        .to_owned()
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a number; `None` if absent.
pub(super) fn round_below(most: f64) -> Option<f64> {
    if !(most.is_finite() && most > 0.0) {
        return None;
    }
    let power = most.log10().floor() as i32;
    let steps = [5.0, 2.0, 1.0];
    let step = steps.into_iter().map(|step| step * 10_f64.powi(power));
    let found = step.into_iter().find(|step| *step <= most * (1.0 + 1e-9));
    Some(found.unwrap_or_else(|| 10_f64.powi(power)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round_and_have_prefixes() {
        let said = |most: f64| round_below(most).map(|length| in_prefixed(length, "m"));
        assert_eq!(said(0.023), Some("20 mm".to_owned()));
        assert_eq!(said(0.99), Some("500 mm".to_owned()));
        assert_eq!(said(1.0), Some("1 m".to_owned()));
        assert_eq!(said(0.0), None);
        assert_eq!(in_prefixed(12_300.0, "Pa"), "12.3 kPa");
        assert_eq!(in_prefixed(0.02, "m/s²"), "0.02 m/s²");
        assert_eq!(in_prefixed(0.02, ""), "0.02");
    }
}
