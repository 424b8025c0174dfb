//! Table of ratios, each with both errors.

use std::fmt;

use super::laps::{Beside, Pair};
use crate::report::{milliseconds, percent, three};
use sinew_verify::ruled;

const HEAD: [&str; 8] = [
    "wanted",
    "ours",
    "computed by",
    "dt\n[ms]",
    "our error\n[%]",
    "CPU of ours\nover theirs",
    "lowest .. highest",
    "set-up over\ntheir run",
];

impl fmt::Display for Beside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (integrator, dt) = (&self.same.0, milliseconds(self.same.1));
        let laps = self.pairs.first().map_or(0, |pair| pair.ratios.len());
        writeln!(
            f,
            "{}: {integrator}, {dt} ms, error {} %",
            self.rival,
            percent(self.error)
        )?;
        writeln!(
            f,
            "Its displacements and those of our {integrator} differ by {:.1e} (relative): the same computation.",
            self.difference
        )?;
        writeln!(
            f,
            "Each of our laps follows one of theirs, {laps} pairs each, one thread; CPU time of the steps alone, medians.\n"
        )?;
        let table = ruled::table(HEAD, self.pairs.iter().map(cells), 2);
        f.write_str(&ruled::lines(table, 2))
    }
}

fn cells(pair: &Pair) -> [String; 8] {
    let row = &pair.target.row;
    let wanted = match pair.target.error {
        None => "the same".to_owned(),
        Some(error) => format!("error at most {} %", short_percent(error)),
    };
    let end = |ratio: Option<&f64>| ratio.map_or_else(String::new, |ratio| three(*ratio));
    [
        wanted,
        row.label(),
        row.kernel
            .clone()
            .unwrap_or_else(|| "no machine".to_owned()),
        milliseconds(row.dt),
        row.error.map_or_else(|| "none".to_owned(), percent),
        three(pair.median()),
        format!(
            "{} .. {}",
            end(pair.ratios.first()),
            end(pair.ratios.last())
        ),
        three(pair.setup),
    ]
}

fn short_percent(fraction: f64) -> String {
    crate::report::short(100.0 * fraction)
}

#[cfg(test)]
mod tests {
    use super::super::Target;
    use super::*;
    use sinew_measure::{MethodChoice, Row};

    #[test]
    fn a_ratio_stands_beside_both_errors() {
        let pair = Pair {
            target: Target {
                error: Some(1e-6),
                method: MethodChoice::new("rk4"),
                row: Row {
                    integrator: "rk4".into(),
                    dt: 1e-4,
                    kernel: Some("general f64 avx2".into()),
                    error: Some(7.5e-7),
                    ..Row::default()
                },
            },
            ratios: vec![0.5, 0.6, 0.9],
            setup: 0.001,
        };
        let beside = Beside {
            rival: "scipy 1.0".into(),
            same: ("central-difference".into(), 1e-3),
            error: 0.0313,
            difference: 2e-13,
            pairs: vec![pair],
        };
        let text = beside.to_string();
        assert!(text.starts_with("scipy 1.0: central-difference, 1 ms, error 3.13 %\n"));
        let line = text.lines().find(|line| line.contains("rk4")).unwrap();
        let cells: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(
            cells,
            [
                "error", "at", "most", "1e-4", "%", "rk4", "general", "f64", "avx2", "0.1",
                "7.50e-5", "0.600", "0.500", "..", "0.900", "0.00100"
            ]
        );
    }
}
