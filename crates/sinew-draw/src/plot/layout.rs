//! Layout of a plot.

use super::{Plot, Point, Rule, Series};
use crate::axis::{Fitted, Tick};
use crate::svg::{Frame, text_width};

pub(super) const TICK: f64 = 12.0;
pub(super) const LABEL: f64 = 13.0;
pub(super) const TITLE: f64 = 15.0;
pub(super) const MARGIN: f64 = 12.0;
pub(super) const ROW: f64 = 20.0;
/// Height of a lane beyond the range.
pub(super) const LANE: f64 = 26.0;
/// Length of a line in the legend.
pub(super) const SAMPLE: f64 = 34.0;

/// Layout in pixels.
pub(super) struct Layout {
    pub(super) x: Fitted,
    pub(super) y: Fitted,
    pub(super) x_ticks: Vec<Tick>,
    pub(super) y_ticks: Vec<Tick>,
    pub(super) frame: Frame,
    /// Middles of the lanes above and below the frame.
    pub(super) above: Option<f64>,
    pub(super) below: Option<f64>,
    /// Middles of the rows of labels of vertical rules, with the labels' middles.
    pub(super) rule_labels: Vec<(f64, f64)>,
    pub(super) legend: Legend,
    pub(super) height: f64,
}

/// Positions of the legend's entries.
pub(super) struct Legend {
    pub(super) top: f64,
    pub(super) rows: usize,
    pub(super) column_width: f64,
}

impl Layout {
    /// Computes the layout of a plot; `marks` are the legend's entries in addition to the series.
    pub(super) fn of(plot: &Plot, marks: &[&str]) -> Self {
        let points = || plot.series.iter().flat_map(|series| &series.points);
        let rules = |rules: &[Rule]| rules.iter().map(|rule| rule.at).collect::<Vec<_>>();
        let x = plot
            .x
            .fitted(points().map(|p| p.x).chain(rules(&plot.vertical_rules)));
        let y = plot
            .y
            .fitted(points().map(|p| p.y).chain(rules(&plot.horizontal_rules)));
        let y_ticks = y.ticks((plot.height / 50.0) as usize);

        let y_labels = y_ticks.iter().filter_map(|tick| tick.label.as_deref());
        let gutter = y_labels
            .chain(plot.lane_above.as_deref())
            .chain(plot.lane_below.as_deref())
            .map(|label| text_width(&label.replace("^{", "").replace('}', ""), TICK))
            .fold(0.0, f64::max);
        let left = MARGIN + LABEL + 8.0 + gutter + 8.0;
        let right = plot
            .horizontal_rules
            .iter()
            .flat_map(|rule| rule.label.lines())
            .map(|line| text_width(line, TICK) + 8.0)
            .fold(MARGIN, f64::max);
        let width = (plot.width - left - right).max(80.0);
        let x_ticks = x.ticks((width / 80.0) as usize);

        let below_title = MARGIN + TITLE + 12.0;
        let (rule_labels, rows) = place_rule_labels(plot, &x, left, width, below_title);
        let mut top = below_title + rows as f64 * ROW;
        let above = plot.lane_above.as_ref().map(|_| top + 0.5 * LANE);
        if above.is_some() {
            top += LANE + 4.0;
        }
        let frame = Frame {
            left,
            top,
            width,
            height: plot.height,
        };
        let below = plot.lane_below.as_ref();
        let below = below.map(|_| frame.bottom() + 4.0 + 0.5 * LANE);
        let base = below.map_or(frame.bottom(), |middle| middle + 0.5 * LANE);

        let names = named(plot).map(|(_, series)| series.name.as_str());
        let column_width = names
            .chain(marks.iter().copied())
            .map(|name| SAMPLE + 8.0 + text_width(name, TICK) + 18.0)
            .fold(1.0, f64::max);
        let columns = ((plot.width - left - MARGIN) / column_width)
            .floor()
            .max(1.0);
        let entries = named(plot).count() + marks.len();
        let legend = Legend {
            top: base + 24.0 + LABEL + 16.0,
            rows: entries.div_ceil(columns as usize),
            column_width,
        };
        let height = legend.top + legend.rows as f64 * ROW + MARGIN;
        Self {
            x,
            y,
            x_ticks,
            y_ticks,
            frame,
            above,
            below,
            rule_labels,
            legend,
            height,
        }
    }

    pub(super) fn px_x(&self, share: f64) -> f64 {
        self.frame.left + share * self.frame.width
    }

    pub(super) fn px_y(&self, share: f64) -> f64 {
        self.frame.bottom() - share * self.frame.height
    }

    /// The lower end of frame and lane, where the horizontal axis is.
    pub(super) fn base(&self) -> f64 {
        self.below
            .map_or(self.frame.bottom(), |middle| middle + 0.5 * LANE)
    }

    /// Frame and lanes.
    pub(super) fn clip(&self) -> Frame {
        let top = self.above.map_or(self.frame.top, |y| y - 0.5 * LANE);
        Frame {
            top,
            height: self.base() - top,
            ..self.frame
        }
    }

    /// The position of a point in shares of the frame; `None` if it cannot be shown.
    pub(super) fn shares(&self, point: &Point) -> Option<(f64, f64)> {
        let (x, y) = (self.x.share(point.x), self.y.share(point.y));
        let share = |middle: f64| (self.frame.bottom() - middle) / self.frame.height;
        // Just inside the range counts as inside.
        let y = match (self.above, self.below) {
            (Some(lane), _) if y > 1.0 + 1e-9 => share(lane),
            (_, Some(lane)) if y < -1e-9 => share(lane),
            _ => y,
        };
        (x.is_finite() && !y.is_nan()).then_some((x, y))
    }

    /// True if a point, in shares of the frame, is in the frame or in a lane.
    pub(super) fn is_shown(&self, (x, y): (f64, f64)) -> bool {
        let inside = |share: f64| (-1e-9..=1.0 + 1e-9).contains(&share);
        let in_a_lane = y > 1.0 && self.above.is_some() || y < 0.0 && self.below.is_some();
        inside(x) && (inside(y) || in_a_lane)
    }

    /// The position of the n-th entry of the legend: left end and middle.
    pub(super) fn entry(&self, index: usize) -> (f64, f64) {
        let rows = self.legend.rows.max(1);
        let (column, row) = ((index / rows) as f64, (index % rows) as f64);
        (
            self.frame.left + column * self.legend.column_width,
            self.legend.top + (row + 0.5) * ROW,
        )
    }
}

/// The series that the legend names, with their numbers.
pub(super) fn named(plot: &Plot) -> impl Iterator<Item = (usize, &Series)> {
    let series = plot.series.iter().enumerate();
    series.filter(|(_, series)| !series.name.is_empty())
}

/// Middles of the labels of vertical rules, in as many rows as are needed to separate them.
fn place_rule_labels(
    plot: &Plot,
    x: &Fitted,
    left: f64,
    width: f64,
    top: f64,
) -> (Vec<(f64, f64)>, usize) {
    let mut rows: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut places = Vec::new();
    for rule in &plot.vertical_rules {
        let half = 0.5 * text_width(&rule.label, TICK) + 4.0;
        let (lowest, highest) = (half, (plot.width - half).max(half));
        let share = x.share(rule.at).clamp(0.0, 1.0);
        let middle = (left + share * width).clamp(lowest, highest);
        let free = |row: &Vec<(f64, f64)>| row.iter().all(|&(m, h)| (m - middle).abs() >= h + half);
        let row = match rows.iter().position(free) {
            Some(row) => row,
            None => {
                rows.push(Vec::new());
                rows.len() - 1
            }
        };
        rows[row].push((middle, half));
        places.push((middle, top + (row as f64 + 0.4) * ROW));
    }
    (places, rows.len())
}
