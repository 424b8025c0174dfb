//! Poses of a tool over time, from a table.

use crate::pose::Pose;
use crate::rotation;
use crate::vector::{between, length, scaled, sub};

/// The pose at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The instant (s).
    pub t: f64,
    /// The position of the own origin (m).
    pub position: [f64; 3],
    /// The rotation vector (rad). It is linear between rows, and its length may exceed pi: a tool can turn several
    /// times about an axis.
    pub rotation_vector: [f64; 3],
}

impl Row {
    fn pose(&self) -> Pose {
        Pose::new(self.position, self.rotation_vector)
    }
}

/// Poses over time: straight lines between rows in all six columns, the first row before, the last one after.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    rows: Vec<Row>,
}

/// Reasons for which a table of poses is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// A table without rows.
    #[error("the table has no row: expected at least one")]
    Empty,
    /// A row with a number that is not finite.
    #[error("row {row}: {value} is not a finite number")]
    NotFinite {
        /// Number of the row (1-based).
        row: usize,
        /// The number.
        value: f64,
    },
    /// A row with a rotation that is too large for its precision.
    #[error("row {row}: a rotation of {angle} rad: expected at most 1e6")]
    Rotation {
        /// Number of the row (1-based).
        row: usize,
        /// The angle (rad).
        angle: f64,
    },
    /// A row whose time does not come after that of the row before.
    #[error("row {row}: t = {t} s does not come after t = {last} s of the row before")]
    Order {
        /// Number of the row (1-based).
        row: usize,
        /// Its time (s).
        t: f64,
        /// The time of the row before (s).
        last: f64,
    },
}

impl Table {
    /// A table of rows whose times rise.
    ///
    /// # Errors
    ///
    /// No row, a number that is not finite, a rotation beyond 1e6 rad, or a time that does not come after the last one.
    pub fn new(rows: Vec<Row>) -> Result<Self, TableError> {
        if rows.is_empty() {
            return Err(TableError::Empty);
        }
        let mut last = None;
        for (row, entry) in (1..).zip(&rows) {
            let numbers = entry.position.iter().chain(&entry.rotation_vector);
            let mut numbers = [entry.t].into_iter().chain(numbers.copied());
            if let Some(value) = numbers.find(|value| !value.is_finite()) {
                return Err(TableError::NotFinite { row, value });
            }
            if !Pose::knows(entry.rotation_vector) {
                let angle = length(entry.rotation_vector);
                return Err(TableError::Rotation { row, angle });
            }
            let t = entry.t;
            if let Some(last) = last.filter(|last| t <= *last) {
                return Err(TableError::Order { row, t, last });
            }
            last = Some(t);
        }
        Ok(Self { rows })
    }

    /// The rows, by rising times.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The velocity (m/s) of the origin and the spin (rad/s) right after time `t` (s).
    #[must_use]
    pub fn velocity(&self, t: f64) -> [[f64; 3]; 2] {
        let next = self.rows.partition_point(|row| row.t <= t);
        let (Some(last), Some(next)) = (next.checked_sub(1), self.rows.get(next)) else {
            return [[0.0; 3]; 2];
        };
        let last = &self.rows[last];
        let rate = |from: [f64; 3], to: [f64; 3]| scaled(sub(to, from), 1.0 / (next.t - last.t));
        let share = (t - last.t) / (next.t - last.t);
        let turned = between(last.rotation_vector, next.rotation_vector, share);
        [
            rate(last.position, next.position),
            rotation::spin(turned, rate(last.rotation_vector, next.rotation_vector)),
        ]
    }

    /// The pose at time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> Pose {
        let next = self.rows.partition_point(|row| row.t <= t);
        let last = &self.rows[next.saturating_sub(1)];
        let Some(next) = self.rows.get(next).filter(|_| next > 0) else {
            return last.pose();
        };
        let share = (t - last.t) / (next.t - last.t);
        Pose::new(
            between(last.position, next.position, share),
            between(last.rotation_vector, next.rotation_vector, share),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn row(t: f64, x: f64, angle: f64) -> Row {
        Row {
            t,
            position: [x, 0.0, 0.0],
            rotation_vector: [0.0, 0.0, angle],
        }
    }

    fn said(rows: Vec<Row>) -> String {
        Table::new(rows).unwrap_err().to_string()
    }

    #[test]
    fn rows_hold_before_at_and_after_and_lines_lie_between() {
        let rows = vec![row(1.0, 0.7, 0.1), row(2.0, 0.2, 1.0), row(4.0, -0.3, 1.0)];
        let table = Table::new(rows.clone()).unwrap();
        for (t, row) in [
            (-3.0, &rows[0]),
            (1.0, &rows[0]),
            (2.0, &rows[1]),
            (4.0, &rows[2]),
            (9.0, &rows[2]),
        ] {
            assert_eq!(table.at(t), row.pose(), "{t}");
        }
        let close = |t: f64, expected: Row| {
            let difference = sub(table.at(t).position(), expected.position);
            let angle = sub(table.at(t).rotation_vector(), expected.rotation_vector);
            length(difference) < 1e-15 && length(angle) < 1e-15
        };
        assert!(close(1.5, row(1.5, 0.45, 0.55)));
        assert!(close(3.5, row(3.5, -0.175, 1.0)));
    }

    #[test]
    fn a_tool_turns_several_times_between_two_rows() {
        let table = Table::new(vec![row(0.0, 0.0, 0.0), row(1.0, 0.0, 3.0 * TAU)]).unwrap();
        // A twelfth of the time is a quarter of a turn.
        let [x, y, _] = table.at(1.0 / 12.0).turned([1.0, 0.0, 0.0]);
        assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
    }

    #[test]
    fn one_row_is_a_tool_at_rest() {
        let table = Table::new(vec![row(1.0, 0.3, 0.2)]).unwrap();
        assert_eq!(table.at(0.0), table.at(5.0));
        assert_eq!(table.rows().len(), 1);
    }

    #[test]
    fn bad_tables_are_refused_by_row_and_time() {
        assert_eq!(said(vec![]), "the table has no row: expected at least one");
        assert_eq!(
            said(vec![row(0.0, 0.0, 0.0), row(1.0, f64::INFINITY, 0.0)]),
            "row 2: inf is not a finite number"
        );
        assert_eq!(
            said(vec![row(f64::NAN, 0.0, 0.0)]),
            "row 1: NaN is not a finite number"
        );
        let equal = vec![row(0.0, 0.0, 0.0), row(0.5, 0.0, 0.0), row(0.5, 1.0, 0.0)];
        assert_eq!(
            said(equal),
            "row 3: t = 0.5 s does not come after t = 0.5 s of the row before"
        );
    }
}
