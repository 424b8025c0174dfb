//! The known name nearest to a misspelt one.

/// The most similar name in `known`, if one is similar enough.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const SIMILAR_ENOUGH: f64 = 0.75;
    let lower = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| {
            (
                strsim::jaro_winkler(&lower, &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(similarity, _)| *similarity > SIMILAR_ENOUGH)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_slip_is_understood_and_nonsense_is_not() {
        let known = ["density", "damping", "group"];
        assert_eq!(nearest("densty", known), Some("density"));
        assert_eq!(nearest("Group", known), Some("group"));
        assert_eq!(nearest("xyzzy", known), None);
    }

    #[test]
    fn of_several_similar_names_it_is_the_most_similar() {
        let known = ["youngs_moduli", "youngs_modulus", "young_module"];
        assert_eq!(nearest("young_modulus", known), Some("youngs_modulus"));
    }
}
