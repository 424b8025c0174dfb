//! Tables of numbers over time, read back.

/// Share of a time within which two times count as the same.
pub(crate) const SAME_TIME: f64 = 1e-9;

/// A table of numbers: names of columns, of which the first is the time, and rows of equal length.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Table {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table in the format of runs, or returns a message about the expected content. Lines that begin with #
    /// are comments.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let head = lines.next().ok_or("expected a line of column names")?;
        let names: Vec<String> = head.split(',').map(str::to_owned).collect();
        let row = |line: &str| {
            let values = line.split(',').map(str::parse);
            match values.collect::<Result<Vec<f64>, _>>() {
                Ok(row) if row.len() == names.len() => Ok(row),
                _ => Err(format!("expected {} numbers: {line}", names.len())),
            }
        };
        let rows = lines.map(row).collect::<Result<_, _>>()?;
        Ok(Self { names, rows })
    }

    /// A column by its index.
    pub(crate) fn column(&self, place: usize) -> impl Iterator<Item = f64> + '_ {
        self.rows
            .iter()
            .filter_map(move |row| row.get(place))
            .copied()
    }

    /// Values at a time (s), on a straight line between rows; `None` beyond them.
    pub(crate) fn at(&self, t: f64) -> Option<Vec<f64>> {
        let after = self.rows.partition_point(|row| row[0] < t);
        // Times are steps multiplied by their length: the last ones of two tables may differ by a rounding.
        let last = self
            .rows
            .last()
            .filter(|last| (t - last[0]).abs() <= SAME_TIME * t);
        let Some(next) = self.rows.get(after) else {
            return last.cloned();
        };
        if next[0] == t {
            return Some(next.clone());
        }
        let before = self.rows.get(after.checked_sub(1)?)?;
        let share = (t - before[0]) / (next[0] - before[0]);
        let values = before.iter().zip(next);
        Some(values.map(|(a, b)| a + share * (b - a)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_a_number_for_each_name() {
        let table = Table::parse("# a comment\nt_s,u_m\n0.0,1.0\n0.5,2.0\n").unwrap();
        assert_eq!(table.names, ["t_s", "u_m"]);
        assert_eq!(table.column(1).collect::<Vec<_>>(), [1.0, 2.0]);
        assert_eq!(table.at(0.125), Some(vec![0.125, 1.25]));
        assert_eq!((table.at(0.5), table.at(0.6)), (Some(vec![0.5, 2.0]), None));
        for wrong in ["", "t_s,u_m\n1.0\n", "t_s\nx\n", "t_s\n1.0,2.0\n"] {
            assert!(
                Table::parse(wrong).unwrap_err().starts_with("expected"),
                "{wrong}"
            );
        }
    }
}
