//! Table of ratios of factorisations and solutions, each with both residuals.

use std::fmt;

use super::laps::{FactorPair, FactorTable};
use sinew_verify::ruled;

use crate::report::three;

const HEAD: [&str; 7] = [
    "cube",
    "unknowns",
    "beside",
    "factorising\nover theirs",
    "solving\nover theirs",
    "our\nresidual",
    "their\nresidual",
];

impl fmt::Display for FactorTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Newmark's matrix at 20 ms: each of our laps follows one of theirs on one thread; CPU time, medians.\n"
        )?;
        let table = ruled::table(HEAD, self.0.iter().map(cells), 3);
        f.write_str(&ruled::lines(table, 2))
    }
}

fn cells(pair: &FactorPair) -> [String; 7] {
    let [factorise, solve] = pair.medians();
    let [ours, theirs] = pair.residuals;
    [
        format!("{}^3", pair.side),
        pair.unknowns.to_string(),
        pair.library.clone(),
        three(factorise),
        three(solve),
        format!("{ours:.1e}"),
        format!("{theirs:.1e}"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_the_middle_of_the_ratios_and_both_residuals() {
        let pair = FactorPair {
            side: 11,
            unknowns: 2673,
            library: "X 1.0".into(),
            factorise: vec![0.5, 0.75, 3.0],
            solve: vec![0.5, 1.0, 4.0],
            residuals: [2e-15, 1e-15],
        };
        let text = FactorTable(vec![pair]).to_string();
        let line = text.lines().find(|line| line.contains("11^3"));
        let cells: Vec<&str> = line.unwrap().split_whitespace().collect();
        let expected = [
            "11^3", "2673", "X", "1.0", "0.750", "1.00", "2.0e-15", "1.0e-15",
        ];
        assert_eq!(cells, expected);
    }
}
