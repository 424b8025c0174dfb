//! Shares on a command line.

/// A number, or one in per cent; `None` for other text.
pub(crate) fn share_of(text: &str) -> Option<f64> {
    match text.strip_suffix('%') {
        Some(percent) => Some(percent.trim_end().parse::<f64>().ok()? / 100.0),
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::share_of;

    #[test]
    fn per_cent_are_hundredths() {
        assert_eq!(share_of("1%"), Some(0.01));
        assert_eq!(share_of("2.5 %"), Some(0.025));
        assert_eq!(share_of("1e-2"), Some(0.01));
        assert_eq!((share_of("%"), share_of("much")), (None, None));
    }
}
