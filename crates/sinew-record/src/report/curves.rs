//! Columns of a table over time.

use sinew_draw::{Axis, Plot, Series, Style};
use sinew_scene::output::OwnedFolder;

use crate::error::RecordRunError;

/// Stretches of a curve that are drawn by their least and largest value: about two to a pixel.
const STRETCHES: usize = 600;

/// A table of numbers over time.
pub(super) struct Curves {
    columns: Vec<(String, Vec<f64>)>,
}

impl Curves {
    /// The table of this name; `None` where there is none.
    pub(super) fn read(folder: &OwnedFolder, name: &str) -> Result<Option<Self>, RecordRunError> {
        let Some(content) = folder.read(name)? else {
            return Ok(None);
        };
        let text = String::from_utf8_lossy(&content);
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let names = lines.next().unwrap_or_default().split(',');
        let mut columns: Vec<(String, Vec<f64>)> =
            names.map(|name| (name.to_owned(), Vec::new())).collect();
        for line in lines {
            for (column, value) in columns.iter_mut().zip(line.split(',')) {
                column.1.push(value.parse().unwrap_or(f64::NAN));
            }
        }
        Ok(Some(Self { columns }))
    }

    /// Columns, by the names that `called` gives them, over the first one, the time.
    pub(super) fn plot(
        &self,
        title: &str,
        label: &str,
        called: impl Fn(&str) -> Option<String>,
    ) -> Plot {
        let mut plot = Plot::new(title, Axis::linear("t [s]"), Axis::linear(label));
        let Some(((_, times), columns)) = self.columns.split_first() else {
            return plot;
        };
        let shown = columns
            .iter()
            .filter_map(|(name, values)| Some((called(name)?, values)));
        for (number, (name, values)) in shown.enumerate() {
            plot = plot.with(Series::line(
                name,
                Style::nth(number),
                thinned(times, values),
            ));
        }
        plot
    }
}

/// The points of a curve that its picture shows: all of a short one, the extremes of each stretch of a long one.
fn thinned(times: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = times.iter().copied().zip(values.iter().copied()).collect();
    if points.len() <= 4 * STRETCHES {
        return points;
    }
    let mut shown = Vec::new();
    for stretch in points.chunks(points.len().div_ceil(STRETCHES)) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (least, most) = (
            stretch.iter().min_by(by_value),
            stretch.iter().max_by(by_value),
        );
        let mut extremes: Vec<(f64, f64)> = least.into_iter().chain(most).copied().collect();
        extremes.sort_by(|a, b| a.0.total_cmp(&b.0));
        extremes.dedup();
        shown.extend(extremes);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_of_long_curves_are_kept() {
        let times: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values: Vec<f64> = times.iter().map(|t| (t / 1e4).sin()).collect();
        (values[12_345], values[70_001]) = (5.0, -7.0);
        let shown = thinned(&times, &values);
        assert!(shown.len() <= 2 * STRETCHES);
        assert!(shown.contains(&(12_345.0, 5.0)) && shown.contains(&(70_001.0, -7.0)));
        assert!(shown.is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!(thinned(&times[..5], &values[..5]).len(), 5);
    }
}
