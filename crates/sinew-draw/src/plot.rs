//! Plots of series on two axes.

mod axes;
mod cover;
mod draw;
mod follow;
mod layout;
mod thin;

use crate::{axis::Axis, style::Style};

/// A plot: series on two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Title above the frame.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The series, the first lowest.
    pub series: Vec<Series>,
    /// Lines at fixed `x`, labelled above the frame.
    pub vertical_rules: Vec<Rule>,
    /// Lines at fixed `y`, labelled to the right of the frame.
    pub horizontal_rules: Vec<Rule>,
    /// Name of a lane above the frame for points above the range of `y`. Without one, series are
    /// cut off at the frame and an arrow shows where each leaves first.
    pub lane_above: Option<String>,
    /// Name of a lane below the frame for points below the range of `y`.
    pub lane_below: Option<String>,
    /// Width of the whole picture (px).
    pub width: f64,
    /// Height of the frame (px).
    pub height: f64,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points in the order of the line. NaN breaks the line, infinity leaves the frame.
    pub points: Vec<Point>,
    /// Its colour, line and marker.
    pub style: Style,
}

/// A point of a series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Position on the horizontal axis.
    pub x: f64,
    /// Position on the vertical axis.
    pub y: f64,
    /// Text shown when the pointer is over its marker.
    pub note: String,
    /// True to draw a ring around its marker.
    pub ringed: bool,
}

/// A line across the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Its position on the axis that it crosses.
    pub at: f64,
    /// Description of its meaning.
    pub label: String,
}

impl Plot {
    /// A plot without series.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            vertical_rules: Vec::new(),
            horizontal_rules: Vec::new(),
            lane_above: None,
            lane_below: None,
            width: 760.0,
            height: 360.0,
        }
    }

    /// Adds a series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a line at a fixed `x`.
    #[must_use]
    pub fn with_vertical_rule(mut self, at: f64, label: impl Into<String>) -> Self {
        let label = label.into();
        self.vertical_rules.push(Rule { at, label });
        self
    }

    /// Adds a line at a fixed `y`.
    #[must_use]
    pub fn with_horizontal_rule(mut self, at: f64, label: impl Into<String>) -> Self {
        let label = label.into();
        self.horizontal_rules.push(Rule { at, label });
        self
    }
}

impl Series {
    /// A series over its points.
    #[must_use]
    pub fn new(name: impl Into<String>, style: Style, points: Vec<Point>) -> Self {
        Self {
            name: name.into(),
            points,
            style,
        }
    }

    /// A line without markers, for example of a displacement over time.
    #[must_use]
    pub fn line(
        name: impl Into<String>,
        style: Style,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().map(Point::from).collect();
        Self::new(name, style.line_only(), points)
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self {
            x,
            y,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: &[(f64, f64)]) -> Plot {
        Plot::new(
            "<title>",
            Axis::linear("t [s]"),
            Axis::linear("u [m]").range(-1.0, 1.0),
        )
        .with(Series::line("a & b", Style::nth(0), points.iter().copied()))
    }

    #[test]
    fn texts_are_escaped() {
        let svg = plot(&[(0.0, 0.0), (1.0, 0.5)]).svg();
        assert!(svg.contains("&lt;title&gt;") && svg.contains("a &amp; b"));
        assert!(!svg.contains("<title>"));
    }

    #[test]
    fn a_diverging_series_leaves_the_frame_and_nothing_is_nan() {
        let arrows = |svg: &str| svg.matches("b leaves the frame").count();
        let quiet = plot(&[(0.0, 0.0), (1.0, 0.5)]).svg();
        assert_eq!(arrows(&quiet), 0);
        let wild = plot(&[
            (0.0, 0.0),
            (0.5, 4e30),
            (0.6, -1e300),
            (0.7, f64::INFINITY),
            (0.8, f64::NAN),
        ]);
        let svg = wild.svg();
        assert_eq!(arrows(&svg), 1);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }

    #[test]
    fn points_beyond_the_range_have_their_lane() {
        let mut lane = plot(&[(0.0, 0.0), (0.5, f64::INFINITY)]);
        lane.lane_above = Some("diverged".into());
        lane.series[0].style = Style::nth(0);
        let svg = lane.svg();
        assert!(svg.contains("diverged"));
        assert!(!svg.contains("leaves the frame") && !svg.contains("NaN"));
    }

    #[test]
    fn points_below_the_range_have_their_lane_too() {
        let mut lane = plot(&[(0.0, 0.5), (0.5, f64::NEG_INFINITY), (0.7, -1.5)]);
        lane.lane_below = Some("nothing left".into());
        lane.series[0].style = Style::nth(0);
        let svg = lane.svg();
        assert!(svg.contains("nothing left"));
        assert!(!svg.contains("leaves the frame") && !svg.contains("NaN"));
        let circles = svg.split("<circle").skip(1);
        let heights: Vec<&str> = circles
            .map(|circle| {
                circle
                    .split("cy=\"")
                    .nth(1)
                    .unwrap()
                    .split('"')
                    .next()
                    .unwrap()
            })
            .collect();
        // Three points and the legend's.
        assert_eq!(heights.len(), 4);
        assert_eq!(heights[1], heights[2]);
        assert_ne!(heights[0], heights[1]);
    }

    #[test]
    fn the_legend_says_what_an_arrow_means() {
        let leaving = plot(&[(0.0, 0.0), (1.0, 4.0)]).svg();
        assert!(leaving.contains(">leaves the frame</text>"));
        let staying = plot(&[(0.0, 0.0), (1.0, 0.5)]).svg();
        assert!(!staying.contains("leaves the frame"));
    }

    #[test]
    fn a_line_under_another_shows_as_a_rim() {
        let points = [(0.0, 0.0), (1.0, 0.5)];
        let one = |style| {
            let points = points.map(Point::from).to_vec();
            Series::new("a", style, points)
        };
        let alone = plot(&[]).with(one(Style::nth(0))).svg();
        let both = plot(&[])
            .with(one(Style::nth(0)))
            .with(one(Style::nth(1)))
            .svg();
        let wide = |svg: &str| svg.matches("stroke-width=\"4.95\"").count();
        assert_eq!((wide(&alone), wide(&both)), (0, 1));
    }

    #[test]
    fn a_line_of_many_points_is_thinned() {
        let many = (0..200_000).map(|i| f64::from(i) * 1e-4);
        let points: Vec<(f64, f64)> = many.map(|t| (t, 0.5 * (31.0 * t).sin())).collect();
        let svg = plot(&points).svg();
        assert!(svg.len() < 80_000, "{}", svg.len());
    }

    #[test]
    fn a_script_finds_frame_axes_and_series() {
        let mut log = plot(&[(0.1, 0.5), (10.0, 0.7)]);
        log.x = Axis::log("t [s]").range(0.1, 10.0);
        let svg = log.svg();
        let places = |name: &str| svg.split(&format!("{name}=\"")).nth(1).unwrap();
        let values = |name: &str| places(name).split('"').next().unwrap().to_owned();
        assert_eq!(values("data-plot").split(' ').count(), 4);
        assert_eq!(values("data-x"), "0.1 10 1");
        assert_eq!(values("data-y"), "-1 1 0");
        assert_eq!(values("data-over"), "t [s]");
        assert_eq!(values("data-read"), "lines");
        log.series[0].style = Style::nth(0);
        assert!(!log.svg().contains("data-read"));
        assert!(svg.contains("<g data-series=\"0\">") && svg.contains("<g data-key=\"0\">"));
    }

    #[test]
    fn an_empty_plot_is_a_picture() {
        let svg = Plot::new("", Axis::log("x"), Axis::log("y")).svg();
        assert!(svg.starts_with("<svg") && !svg.contains("NaN"));
    }
}
