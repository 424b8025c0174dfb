//! The columns of every table of runs.

use sinew_draw::page;
use sinew_measure::Row;

use super::{missing::shown, number, verdict};

/// A column: its header, its cells, its key for sorting.
pub(super) struct Column {
    pub(super) head: &'static str,
    pub(super) unit: &'static str,
    pub(super) explained: &'static str,
    pub(super) cell: fn(&Row) -> String,
    /// Key by which numbers are sorted and aligned on the right; without a key the text is sorted.
    pub(super) key: Option<fn(&Row) -> f64>,
}

impl Column {
    /// Header with its unit after a separator.
    pub(super) fn title(&self, separator: &str) -> String {
        if self.unit.is_empty() {
            self.head.to_owned()
        } else {
            format!("{}{separator}[{}]", self.head, self.unit)
        }
    }

    /// The column of a page's table.
    pub(super) fn on_page(&self) -> page::Column {
        let column = match self.key {
            Some(_) => page::Column::number(self.head, self.unit),
            None => page::Column::text(self.head),
        };
        column.explained(self.explained)
    }
}

/// The error comes before the speeds and next to them.
static COLUMNS: [Column; 13] = [
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
        cell: |row| shown(row.dt, number::milliseconds),
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
        key: Some(|row| row.error_at_most().unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "CPU",
        unit: "s/s",
        explained: "CPU seconds per simulated second, without the set-up",
        cell: |row| shown(row.cpu_s_per_s, number::three),
        key: Some(|row| row.cpu_s_per_s),
    },
    Column {
        head: "step",
        unit: "µs",
        explained: "CPU time per step",
        cell: |row| shown(row.us_per_step, number::three),
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
        cell: |row| shown(row.saturated, number::percent),
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
        cell: |row| shown(1e3 * row.setup_cpu_s, number::three),
        key: Some(|row| row.setup_cpu_s),
    },
];

/// Figures that exist only for hard cases, large deformations or tools.
static OTHER_COLUMNS: [Column; 8] = [
    Column {
        head: "force err.",
        unit: "%",
        explained: "relative L2 error of the forces on tools, means over the time between two of the instants compared",
        cell: |row| share(row.force_error),
        key: Some(|row| row.force_error.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "mesh error",
        unit: "%",
        explained: "relative L2 error of the mesh and its element alone, without any error in time",
        cell: |row| share(row.mesh_error),
        key: Some(|row| row.mesh_error.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "times",
        unit: "",
        explained: "CPU time over that of central difference whose steps follow the stiffness, on the same scene in the same run",
        cell: |row| three(row.cost_ratio),
        key: Some(|row| row.cost_ratio.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "energy rise",
        unit: "%",
        explained: "largest excess of the energy over that of the start and the work of loads since, over the most they brought in",
        cell: |row| share(row.energy_rise),
        key: Some(|row| row.energy_rise.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "least J",
        unit: "",
        explained: "smallest ratio of an element's volume to that at rest, over all steps",
        cell: |row| three(row.smallest_volume_ratio),
        key: Some(|row| row.smallest_volume_ratio.unwrap_or(f64::NEG_INFINITY)),
    },
    Column {
        head: "dt/crit.",
        unit: "",
        explained: "step over the critical step 2/omega of the fastest undamped mode",
        cell: |row| three(row.step_over_critical),
        key: Some(|row| row.step_over_critical.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "static err.",
        unit: "%",
        explained: "distance of the last displacement from K u = F, where the reference comes to rest",
        cell: |row| share(row.static_error),
        key: Some(|row| row.static_error.unwrap_or(f64::INFINITY)),
    },
    Column {
        head: "energy drift",
        unit: "1/1000 steps",
        explained: "relative change of the method's own energy in 1000 steps, where nothing damps or loads the body",
        cell: |row| three(row.energy_drift),
        key: Some(|row| row.energy_drift.unwrap_or(f64::INFINITY)),
    },
];

/// The columns of a table of these rows: those of hard cases and large deformations only if a row has such a figure.
pub(super) fn columns_of(rows: &[&Row]) -> Vec<&'static Column> {
    let filled = |column: &&Column| rows.iter().any(|row| !(column.cell)(row).is_empty());
    COLUMNS
        .iter()
        .chain(OTHER_COLUMNS.iter().filter(filled))
        .collect()
}

fn sweeps(row: &Row) -> String {
    let sweeps = shown(row.sweeps_per_s, number::short);
    if row.work.solves == 0 {
        return sweeps;
    }
    let solves = row.work.solves as f64 / (row.steps as f64 * row.dt);
    let solves = shown(solves, number::short);
    if row.work.sweeps == 0 {
        format!("{solves} solves")
    } else {
        format!("{sweeps} + {solves} solves")
    }
}

/// A share in per cent, if any.
fn share(value: Option<f64>) -> String {
    value.map_or_else(String::new, |x| shown(x, number::percent))
}

fn three(value: Option<f64>) -> String {
    value.map_or_else(String::new, |x| shown(x, number::three))
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
    fn figures_of_hard_cases_take_room_only_where_there_are_some() {
        let plain = Row::default();
        let hard = Row {
            static_error: Some(1e-7),
            ..Row::default()
        };
        assert_eq!(columns_of(&[&plain]).len(), COLUMNS.len());
        let columns = columns_of(&[&plain, &hard]);
        assert_eq!(columns.len(), COLUMNS.len() + 1);
        let last = columns.last().unwrap();
        assert_eq!((last.cell)(&hard), "1.00e-5");
        assert_eq!((last.cell)(&plain), "");
    }

    #[test]
    fn every_speed_has_the_error_before_it() {
        let at = |head| COLUMNS.iter().position(|c| c.head == head).unwrap();
        assert_eq!(at("error") + 1, at("CPU"));
        assert_eq!(at("CPU") + 1, at("step"));
    }
}
