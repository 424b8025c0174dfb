//! The columns of every table of runs.

use super::{number, verdict};
use sinew_measure::Row;

/// A column: its head, what stands in it, what it is sorted by.
pub(super) struct Column {
    pub(super) head: &'static str,
    pub(super) unit: &'static str,
    pub(super) explained: &'static str,
    pub(super) cell: fn(&Row) -> String,
    /// Numbers are sorted by this and stand on the right; none sorts by the text.
    pub(super) key: Option<fn(&Row) -> f64>,
}

impl Column {
    /// Head with its unit after a separator.
    pub(super) fn title(&self, separator: &str) -> String {
        if self.unit.is_empty() {
            self.head.to_owned()
        } else {
            format!("{}{separator}[{}]", self.head, self.unit)
        }
    }
}

/// The error stands before the speeds and next to them.
pub(super) const COLUMNS: [Column; 13] = [
    Column {
        head: "method",
        unit: "",
        explained: "integrator and its options",
        cell: Row::label,
        key: None,
    },
    Column {
        head: "dt",
        unit: "ms",
        explained: "time step",
        cell: |row| number::milliseconds(row.dt),
        key: Some(|row| row.dt),
    },
    Column {
        head: "steps",
        unit: "",
        explained: "steps taken",
        cell: |row| row.steps.to_string(),
        key: Some(|row| row.steps as f64),
    },
    Column {
        head: "sweeps",
        unit: "1/s",
        explained: "sweeps over the network (and solves) per simulated second",
        cell: sweeps,
        key: Some(|row| row.sweeps_per_s),
    },
    Column {
        head: "error",
        unit: "%",
        explained: "relative L2 error of the displacement; returning zero scores 100 %",
        cell: verdict::error,
        key: Some(|row| row.error.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "CPU",
        unit: "s/s",
        explained: "CPU seconds per simulated second, without the set-up",
        cell: |row| number::three(row.cpu_s_per_s),
        key: Some(|row| row.cpu_s_per_s),
    },
    Column {
        head: "step",
        unit: "µs",
        explained: "CPU time per step",
        cell: |row| number::three(row.us_per_step),
        key: Some(|row| row.us_per_step),
    },
    Column {
        head: "Pareto",
        unit: "",
        explained: "no other run of the case is both as cheap and as accurate",
        cell: |row| if row.pareto { "●" } else { "" }.to_owned(),
        key: Some(|row| f64::from(u8::from(!row.pareto))),
    },
    Column {
        head: "bounded",
        unit: "",
        explained: "all finite, and |u| at most 10 times the reference's",
        cell: |row| yes(row.bounded),
        key: None,
    },
    Column {
        head: "settles",
        unit: "",
        explained: "the motion dies out as the reference's does",
        cell: |row| yes(row.settles),
        key: None,
    },
    Column {
        head: "saturated",
        unit: "%",
        explained: "share of the (dof, step) pairs that were saturated",
        cell: |row| number::percent(row.saturated),
        key: Some(|row| row.saturated),
    },
    Column {
        head: "inverted",
        unit: "",
        explained: "inverted elements in the last state",
        cell: |row| row.inverted.to_string(),
        key: Some(|row| row.inverted as f64),
    },
    Column {
        head: "set-up",
        unit: "ms",
        explained: "CPU time of the set-up, in none of the other times",
        cell: |row| number::three(1e3 * row.setup_cpu_s),
        key: Some(|row| row.setup_cpu_s),
    },
];

fn sweeps(row: &Row) -> String {
    let sweeps = number::short(row.sweeps_per_s);
    if row.work.solves == 0 {
        return sweeps;
    }
    let solves = number::short(row.work.solves as f64 / (row.steps as f64 * row.dt));
    if row.work.sweeps == 0 {
        format!("{solves} solves")
    } else {
        format!("{sweeps} + {solves} solves")
    }
}

fn yes(value: bool) -> String {
    if value { "yes" } else { "no" }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_measure::Work;

    #[test]
    fn solves_are_work_too() {
        let row = |count: u32, solves| Row {
            dt: 0.02,
            steps: 50,
            sweeps_per_s: f64::from(count),
            work: Work {
                sweeps: count.into(),
                solves,
                ..Work::default()
            },
            ..Row::default()
        };
        assert_eq!(sweeps(&row(150, 0)), "150");
        assert_eq!(sweeps(&row(0, 50)), "50 solves");
        assert_eq!(sweeps(&row(50, 50)), "50 + 50 solves");
    }

    #[test]
    fn every_speed_has_the_error_before_it() {
        let at = |head| COLUMNS.iter().position(|c| c.head == head).unwrap();
        assert_eq!(at("error") + 1, at("CPU"));
        assert_eq!(at("CPU") + 1, at("step"));
    }
}
