//! Laying out and drawing a plot.

use super::{Plot, Point, Rule, Series, follow::followed};
use crate::{
    axis::{Fitted, Tick},
    style::{Dash, Marker, Style},
    svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width},
};

const TICK: f64 = 12.0;
const LABEL: f64 = 13.0;
const TITLE: f64 = 15.0;
const MARGIN: f64 = 12.0;
const ROW: f64 = 20.0;
const LANE: f64 = 26.0;
const MARKER: f64 = 4.2;
const SAMPLE: f64 = 34.0;

impl Plot {
    /// The picture as a file of its own or for a page.
    #[must_use]
    pub fn svg(&self) -> String {
        draw(self)
    }
}

fn draw(plot: &Plot) -> String {
    let layout = Layout::of(plot);
    let mut svg = Svg::new(plot.width, layout.height, &described(plot));
    svg.text(
        &Text::new(layout.frame.left, MARGIN + 0.6 * TITLE, &plot.title)
            .sized(TITLE)
            .bold(),
    );
    layout.axes(&mut svg, plot);
    layout.rules(&mut svg, plot);
    svg.clipped(layout.clip(), |svg| {
        for series in &plot.series {
            layout.line(svg, series);
        }
        for series in &plot.series {
            layout.markers(svg, series);
        }
    });
    if plot.lane.is_none() {
        for series in &plot.series {
            layout.exit(&mut svg, series);
        }
    }
    layout.legend(&mut svg, plot);
    svg.finish()
}

fn described(plot: &Plot) -> String {
    let names: Vec<&str> = plot.series.iter().map(|s| s.name.as_str()).collect();
    format!(
        "{}: {} over {}, of {}",
        plot.title,
        plot.y.label,
        plot.x.label,
        names.join(", ")
    )
}

struct Layout {
    x: Fitted,
    y: Fitted,
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
    frame: Frame,
    /// Middle of the lane for points beyond the range.
    lane: Option<f64>,
    /// Middles of the rows of labels of vertical rules, with the labels' middles.
    rule_labels: Vec<(f64, f64)>,
    legend: Legend,
    height: f64,
}

struct Legend {
    top: f64,
    columns: usize,
    column_width: f64,
}

impl Layout {
    fn of(plot: &Plot) -> Self {
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
            .chain(plot.lane.as_deref())
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
        let lane = plot.lane.as_ref().map(|_| top + 0.5 * LANE);
        if lane.is_some() {
            top += LANE + 4.0;
        }
        let frame = Frame {
            left,
            top,
            width,
            height: plot.height,
        };

        let entry = named(plot)
            .map(|series| SAMPLE + 8.0 + text_width(&series.name, TICK) + 18.0)
            .fold(1.0, f64::max);
        let columns = ((plot.width - left - MARGIN) / entry).floor().max(1.0) as usize;
        let legend = Legend {
            top: frame.bottom() + 24.0 + LABEL + 16.0,
            columns,
            column_width: entry,
        };
        let legend_rows = named(plot).count().div_ceil(columns);
        let height = legend.top + legend_rows as f64 * ROW + MARGIN;
        Self {
            x,
            y,
            x_ticks,
            y_ticks,
            frame,
            lane,
            rule_labels,
            legend,
            height,
        }
    }

    fn px_x(&self, share: f64) -> f64 {
        self.frame.left + share * self.frame.width
    }

    fn px_y(&self, share: f64) -> f64 {
        self.frame.bottom() - share * self.frame.height
    }

    /// Frame and lane.
    fn clip(&self) -> Frame {
        let top = self.lane.map_or(self.frame.top, |y| y - 0.5 * LANE);
        Frame {
            top,
            height: self.frame.bottom() - top,
            ..self.frame
        }
    }

    /// The place of a point in shares of the frame; none where it cannot be shown.
    fn shares(&self, point: &Point) -> Option<(f64, f64)> {
        let (x, y) = (self.x.share(point.x), self.y.share(point.y));
        let y = match self.lane {
            // Just inside the range counts as inside.
            Some(lane) if y > 1.0 + 1e-9 => (self.frame.bottom() - lane) / self.frame.height,
            _ => y,
        };
        (x.is_finite() && !y.is_nan()).then_some((x, y))
    }

    fn axes(&self, svg: &mut Svg, plot: &Plot) {
        let Frame {
            left, top, height, ..
        } = self.frame;
        let (right, bottom) = (self.frame.right(), self.frame.bottom());
        for tick in &self.x_ticks {
            let x = self.px_x(tick.at);
            let width = if tick.label.is_some() { 1.0 } else { 0.4 };
            svg.line((x, top), (x, bottom), Stroke::new(Paint::Grid, width));
            if let Some(label) = &tick.label {
                svg.line(
                    (x, bottom),
                    (x, bottom + 4.0),
                    Stroke::new(Paint::Muted, 1.0),
                );
                svg.text(
                    &Text::new(x, bottom + 14.0, label)
                        .sized(TICK)
                        .anchored(Anchor::Middle),
                );
            }
        }
        for tick in &self.y_ticks {
            let y = self.px_y(tick.at);
            let width = if tick.label.is_some() { 1.0 } else { 0.4 };
            svg.line((left, y), (right, y), Stroke::new(Paint::Grid, width));
            if let Some(label) = &tick.label {
                svg.line((left - 4.0, y), (left, y), Stroke::new(Paint::Muted, 1.0));
                svg.text(
                    &Text::new(left - 8.0, y, label)
                        .sized(TICK)
                        .anchored(Anchor::End),
                );
            }
        }
        svg.polyline(
            &[(left, top), (left, bottom), (right, bottom)],
            Stroke::new(Paint::Muted, 1.0),
        );
        if let (Some(y), Some(name)) = (self.lane, &plot.lane) {
            let (above, below) = (y - 0.5 * LANE, y + 0.5 * LANE);
            for edge in [above, below] {
                svg.line((left, edge), (right, edge), Stroke::new(Paint::Grid, 1.0));
            }
            svg.line((left, above), (left, below), Stroke::new(Paint::Muted, 1.0));
            svg.text(
                &Text::new(left - 8.0, y, name)
                    .sized(TICK)
                    .anchored(Anchor::End),
            );
        }
        svg.text(
            &Text::new(
                left + 0.5 * self.frame.width,
                bottom + 24.0 + LABEL,
                &plot.x.label,
            )
            .sized(LABEL)
            .anchored(Anchor::Middle),
        );
        svg.text(
            &Text::new(MARGIN + 0.5 * LABEL, top + 0.5 * height, &plot.y.label)
                .sized(LABEL)
                .anchored(Anchor::Middle)
                .upward(),
        );
    }

    fn rules(&self, svg: &mut Svg, plot: &Plot) {
        let stroke = Stroke {
            dash: Dash::Dashed,
            ..Stroke::new(Paint::Muted, 1.25)
        };
        for (rule, &(text_x, text_y)) in plot.vertical_rules.iter().zip(&self.rule_labels) {
            let share = self.x.share(rule.at);
            if !(0.0..=1.0).contains(&share) {
                continue;
            }
            let x = self.px_x(share);
            svg.line((x, text_y + 8.0), (x, self.frame.bottom()), stroke);
            svg.text(
                &Text::new(text_x, text_y, &rule.label)
                    .sized(TICK)
                    .anchored(Anchor::Middle)
                    .painted(Paint::Muted),
            );
        }
        for rule in &plot.horizontal_rules {
            let share = self.y.share(rule.at);
            if !(0.0..=1.0).contains(&share) {
                continue;
            }
            let y = self.px_y(share);
            svg.line((self.frame.left, y), (self.frame.right(), y), stroke);
            let lines = rule.label.lines().count() as f64;
            for (i, line) in rule.label.lines().enumerate() {
                let down = (i as f64 - 0.5 * (lines - 1.0)) * 1.2 * TICK;
                svg.text(
                    &Text::new(self.frame.right() + 6.0, y + down, line)
                        .sized(TICK)
                        .painted(Paint::Muted),
                );
            }
        }
    }

    fn line(&self, svg: &mut Svg, series: &Series) {
        let shares: Vec<_> = series.points.iter().map(|p| self.shares(p)).collect();
        let mut part: Vec<(f64, f64)> = Vec::new();
        for pair in shares.windows(2) {
            let (Some(a), Some(b)) = (pair[0], pair[1]) else {
                continue;
            };
            let corner = if series.style.steps { (b.0, a.1) } else { b };
            for (from, to) in [(a, corner), (corner, b)] {
                let Some((from, to)) = followed(from, to) else {
                    continue;
                };
                let [from, to] = [from, to].map(|(x, y)| (self.px_x(x), self.px_y(y)));
                if part.last() != Some(&from) {
                    svg.polyline(&part, stroke(&series.style));
                    part = vec![from];
                }
                if from != to {
                    part.push(to);
                }
            }
        }
        svg.polyline(&part, stroke(&series.style));
    }

    fn markers(&self, svg: &mut Svg, series: &Series) {
        let Some(marker) = series.style.marker else {
            return;
        };
        for point in &series.points {
            let Some((x, y)) = self.shares(point) else {
                continue;
            };
            let at = (self.px_x(x), self.px_y(y));
            let beyond = y > 1.0 + 1e-9;
            if !(-1e-9..=1.0 + 1e-9).contains(&x) || beyond && self.lane.is_none() || y < -1e-9 {
                continue;
            }
            svg.noted(&point.note, |svg| {
                svg.marker(marker, at, MARKER, series.style.colour, beyond);
                if point.ringed {
                    svg.ring(at, 2.1 * MARKER);
                }
            });
        }
    }

    /// An arrow where the series first leaves through the top or the bottom of the frame.
    fn exit(&self, svg: &mut Svg, series: &Series) {
        let mut last: Option<(f64, f64)> = None;
        for point in &series.points {
            let here = self.shares(point);
            if let (Some((x0, y0)), Some((x1, y1))) = (last, here) {
                let inside = (0.0..=1.0).contains(&y0);
                let edge = if y1 > 1.0 { 1.0 } else { 0.0 };
                if inside && !(0.0..=1.0).contains(&y1) {
                    let way = if y1.is_finite() {
                        (edge - y0) / (y1 - y0)
                    } else {
                        0.0
                    };
                    let x = self.px_x(x0 + way * (x1 - x0));
                    let (marker, inwards) = if edge > 0.5 {
                        (Marker::Up, 1.0)
                    } else {
                        (Marker::Down, -1.0)
                    };
                    let y = self.px_y(edge) + 4.0 * inwards;
                    svg.noted(&format!("{} leaves the frame", series.name), |svg| {
                        svg.marker(marker, (x, y), 5.5, series.style.colour, false);
                    });
                    return;
                }
            }
            last = here;
        }
    }

    fn legend(&self, svg: &mut Svg, plot: &Plot) {
        let rows = named(plot).count().div_ceil(self.legend.columns);
        for (i, series) in named(plot).enumerate() {
            let (column, row) = (i / rows, i % rows);
            let x = self.frame.left + column as f64 * self.legend.column_width;
            let y = self.legend.top + (row as f64 + 0.5) * ROW;
            svg.line((x, y), (x + SAMPLE, y), stroke(&series.style));
            if let Some(marker) = series.style.marker {
                let at = (x + 0.5 * SAMPLE, y);
                svg.marker(marker, at, MARKER, series.style.colour, false);
            }
            svg.text(&Text::new(x + SAMPLE + 8.0, y, &series.name).sized(TICK));
        }
    }
}

fn named(plot: &Plot) -> impl Iterator<Item = &Series> {
    plot.series.iter().filter(|series| !series.name.is_empty())
}

fn stroke(style: &Style) -> Stroke {
    Stroke {
        paint: Paint::Data(style.colour),
        width: style.width,
        dash: style.dash,
    }
}

/// Middles of the labels of vertical rules, in as many rows as keep them apart.
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
