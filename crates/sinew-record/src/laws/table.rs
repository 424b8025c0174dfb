//! The table of the curves of laws.

use sinew_draw::short;

use super::curves::RegionCurves;

/// The line of column names.
pub(super) const HEAD: &str = "region,load,stretch_or_shear_1,nominal_stress_Pa,nominal_stress_across_Pa,cauchy_stress_Pa,volume_ratio_1,stable";

/// The curves as CSV: a comment on each region, then a row for each state. `docs/theory.md` in the repository
/// describes the columns.
#[must_use]
pub fn table_of_laws(regions: &[RegionCurves]) -> String {
    let mut text = String::new();
    for region in regions {
        text.push_str(&format!("# {}: {}\n", region.name(), region.law));
        for note in &region.notes {
            text.push_str(&format!("# {note}\n"));
        }
    }
    text.push_str(HEAD);
    text.push('\n');
    for region in regions {
        for curve in &region.curves {
            for state in &curve.states {
                let (number, load) = (region.number, curve.load.id());
                let numbers = [
                    state.amount,
                    state.nominal,
                    state.nominal_across,
                    state.cauchy,
                    state.volume_ratio,
                ];
                // With + 0.0 no zero is negative.
                let numbers = numbers
                    .map(|number| format!("{:?}", number + 0.0))
                    .join(",");
                let stable = u8::from(state.is_stable);
                text.push_str(&format!("{number},{load},{numbers},{stable}\n"));
            }
        }
    }
    text
}

/// A line of a law's comments, as short as a title.
pub(super) fn title(region: &RegionCurves) -> String {
    format!(
        "{}: {}",
        region.name().replace('`', ""),
        rounded(&region.law)
    )
}

/// A text with its numbers rounded to four digits.
fn rounded(text: &str) -> String {
    let word = |word: &str| {
        let end = word.trim_end_matches([',', ']']);
        let start = end.trim_start_matches('[');
        let (before, after) = (&end[..end.len() - start.len()], &word[end.len()..]);
        match start.parse::<f64>() {
            Ok(number) if start.len() > 6 => format!("{before}{}{after}", short(number)),
            _ => word.to_owned(),
        }
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_have_short_numbers() {
        let text = "yeoh, mu = 1206.8965517241379 Pa, c = [603.4482758620689, 60] Pa, nu = 0.45";
        assert_eq!(
            rounded(text),
            "yeoh, mu = 1207 Pa, c = [603.4, 60] Pa, nu = 0.45"
        );
    }
}
