//! Columns of a table over time.

use sinew_draw::{Axis, Plot, Series, Style};

use crate::csv::Table;

/// Number of intervals of a curve that are drawn by their least and largest value: about two per pixel.
const STRETCHES: usize = 600;

/// A plot of columns, with the names from `called`, over the first one, the time.
pub(super) fn plot(
    table: &Table,
    title: &str,
    label: &str,
    called: impl Fn(&str) -> Option<String>,
) -> Plot {
    let mut plot = Plot::new(title, Axis::linear("t [s]"), Axis::linear(label));
    let names = table.names.iter().enumerate().skip(1);
    let shown = names.filter_map(|(place, name)| Some((called(name)?, place)));
    for (number, (name, place)) in shown.enumerate() {
        let points = table.column(0).zip(table.column(place)).collect();
        plot = plot.with(Series::line(name, Style::nth(number), thinned(points)));
    }
    plot
}

/// The points of a curve in its picture: all of a short curve, the extremes of each interval of a long one.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
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
        let points: Vec<(f64, f64)> = times.iter().copied().zip(values).collect();
        let few = points[..5].to_vec();
        let shown = thinned(points);
        assert!(shown.len() <= 2 * STRETCHES);
        assert!(shown.contains(&(12_345.0, 5.0)) && shown.contains(&(70_001.0, -7.0)));
        assert!(shown.is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!(thinned(few.clone()), few);
    }
}
