//! Drawing a plot.

use super::cover::Places;
use super::layout::{Layout, MARGIN, SAMPLE, TICK, TITLE, named};
use super::thin::thinned;
use super::{Plot, Series, follow::followed};
use crate::axis::{Fitted, Scale};
use crate::style::{Colour, Marker, Style};
use crate::svg::{Paint, Stroke, Svg, Text};

const MARKER: f64 = 4.2;
/// Width of a rim (px) around lines and markers that cover others.
const RIM: f64 = 1.6;
/// The colour of signs that belong to no series.
const NEUTRAL: Colour = Colour(0x77, 0x77, 0x77);
/// The legend's text for the arrow at which a series leaves the frame.
const LEAVES: &str = "leaves the frame";

impl Plot {
    /// The picture as a separate file or for a page. Covered lines and markers are visible as rims; lines without
    /// markers are thinned to the resolution of pixels.
    #[must_use]
    pub fn svg(&self) -> String {
        draw(self)
    }

    /// Height of the whole picture (px).
    #[must_use]
    pub fn full_height(&self) -> f64 {
        laid_out(self).0.height
    }
}

/// The position at which each series leaves the frame, in shares of the frame; `None` if it does not.
type Exits = Vec<Option<(f64, f64)>>;

/// The layout, the position at which each series leaves the frame, and the legend's entries in addition to the series.
fn laid_out(plot: &Plot) -> (Layout, Exits, &'static [&'static str]) {
    // Where series leave does not depend on the legend.
    let plain = Layout::of(plot, &[]);
    let exits: Exits = plot.series.iter().map(|s| plain.exit(s)).collect();
    let leaves: &[&str] = match exits.iter().any(Option::is_some) {
        true => &[LEAVES],
        false => &[],
    };
    (Layout::of(plot, leaves), exits, leaves)
}

fn draw(plot: &Plot) -> String {
    let (layout, exits, leaves) = laid_out(plot);
    let places = layout.places(plot);
    let mut svg = Svg::new(plot.width, layout.height, &described(plot));
    svg.text(
        &Text::new(layout.frame.left, MARGIN + 0.6 * TITLE, &plot.title)
            .sized(TITLE)
            .bold(),
    );
    svg.group(&layout.for_scripts(plot), |svg| {
        layout.axes(svg, plot);
        layout.rules(svg, plot);
        svg.clipped(layout.clip(), |svg| {
            for index in 0..plot.series.len() {
                svg.group(&of_series(index), |svg| {
                    layout.line(svg, plot, index, &places);
                });
            }
            for index in 0..plot.series.len() {
                svg.group(&of_series(index), |svg| {
                    layout.markers(svg, plot, index, &places);
                });
            }
        });
        for (index, (series, exit)) in plot.series.iter().zip(&exits).enumerate() {
            if let Some(exit) = exit {
                svg.group(&of_series(index), |svg| layout.arrow(svg, series, *exit));
            }
        }
        layout.legend(svg, plot, leaves);
    });
    svg.finish()
}

fn of_series(index: usize) -> [(&'static str, String); 1] {
    [("data-series", index.to_string())]
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

impl Layout {
    /// Frame and axes, with which a script converts a position into values.
    fn for_scripts(&self, plot: &Plot) -> [(&'static str, String); 5] {
        let frame = self.frame;
        let is_lines = plot
            .series
            .iter()
            .all(|series| series.style.marker.is_none());
        let axis = |axis: &Fitted| {
            let (low, high) = axis.ends();
            format!("{low} {high} {}", u8::from(axis.scale() == Scale::Log))
        };
        [
            (
                "data-plot",
                format!(
                    "{:.1} {:.1} {:.1} {:.1}",
                    frame.left, frame.top, frame.width, frame.height
                ),
            ),
            ("data-x", axis(&self.x)),
            ("data-y", axis(&self.y)),
            ("data-over", plot.x.label.clone()),
            ("data-read", if is_lines { "lines" } else { "" }.to_owned()),
        ]
    }

    /// The positions of the series with markers; others are too long to be compared.
    fn places(&self, plot: &Plot) -> Places {
        let of = |series: &Series| match series.style.marker {
            None => Vec::new(),
            Some(_) => {
                let shares = series.points.iter().map(|point| self.shares(point));
                shares
                    .map(|share| {
                        let (x, y) = share.filter(|share| self.is_shown(*share))?;
                        Some((self.px_x(x), self.px_y(y)))
                    })
                    .collect()
            }
        };
        Places(plot.series.iter().map(of).collect())
    }

    fn line(&self, svg: &mut Svg, plot: &Plot, index: usize, places: &Places) {
        let series = &plot.series[index];
        let has_markers = series.style.marker.is_some();
        let shares: Vec<_> = series.points.iter().map(|p| self.shares(p)).collect();
        let mut part: Vec<(f64, f64)> = Vec::new();
        let mut rims = 0;
        for (from_point, pair) in shares.windows(2).enumerate() {
            let (Some(a), Some(b)) = (pair[0], pair[1]) else {
                continue;
            };
            let above = match has_markers {
                true => places.above_stretch(index, from_point),
                false => 0,
            };
            let corner = if series.style.steps { (b.0, a.1) } else { b };
            for (from, to) in [(a, corner), (corner, b)] {
                let Some((from, to)) = followed(from, to) else {
                    continue;
                };
                let [from, to] = [from, to].map(|(x, y)| (self.px_x(x), self.px_y(y)));
                if part.last() != Some(&from) || rims != above {
                    svg.polyline(&thinned(&part), stroke(&series.style, rims));
                    part = vec![from];
                    rims = above;
                }
                if from != to {
                    part.push(to);
                }
            }
        }
        svg.polyline(&thinned(&part), stroke(&series.style, rims));
    }

    fn markers(&self, svg: &mut Svg, plot: &Plot, index: usize, places: &Places) {
        let series = &plot.series[index];
        let Some(marker) = series.style.marker else {
            return;
        };
        for (at_point, (point, place)) in series.points.iter().zip(&places.0[index]).enumerate() {
            let Some(at) = *place else {
                continue;
            };
            let beyond = at.1 < self.frame.top - 1e-6;
            let radius = MARKER + RIM * places.above_point(index, at_point) as f64;
            svg.noted(&point.note, |svg| {
                svg.marker(marker, at, radius, series.style.colour, beyond);
                if point.ringed {
                    svg.ring(at, radius + 1.1 * MARKER);
                }
            });
        }
    }

    /// The position at which a series first leaves the frame through its top or bottom, in shares of the frame.
    fn exit(&self, series: &Series) -> Option<(f64, f64)> {
        let shares: Vec<_> = series.points.iter().map(|p| self.shares(p)).collect();
        shares.windows(2).find_map(|pair| {
            let (Some((x0, y0)), Some((x1, y1))) = (pair[0], pair[1]) else {
                return None;
            };
            let stays = self.is_shown((0.5, y1)) || !(0.0..=1.0).contains(&y0);
            if stays {
                return None;
            }
            let edge = if y1 > 1.0 { 1.0 } else { 0.0 };
            let way = if y1.is_finite() {
                (edge - y0) / (y1 - y0)
            } else {
                0.0
            };
            Some((x0 + way * (x1 - x0), edge))
        })
    }

    /// Draws an arrow at the position at which a series leaves the frame.
    fn arrow(&self, svg: &mut Svg, series: &Series, (x, edge): (f64, f64)) {
        let (marker, inwards) = if edge > 0.5 {
            (Marker::Up, 1.0)
        } else {
            (Marker::Down, -1.0)
        };
        let at = (self.px_x(x), self.px_y(edge) + 4.0 * inwards);
        svg.noted(&format!("{} {LEAVES}", series.name), |svg| {
            svg.marker(marker, at, 5.5, series.style.colour, false);
        });
    }

    fn legend(&self, svg: &mut Svg, plot: &Plot, leaves: &[&str]) {
        let count = named(plot).count();
        for (entry, (index, series)) in named(plot).enumerate() {
            let (x, y) = self.entry(entry);
            let name = Text::new(x + SAMPLE + 8.0, y, &series.name).sized(TICK);
            let attributes = [("data-key", index.to_string())];
            svg.group(&attributes, |svg| {
                svg.line((x, y), (x + SAMPLE, y), stroke(&series.style, 0));
                if let Some(marker) = series.style.marker {
                    let at = (x + 0.5 * SAMPLE, y);
                    svg.marker(marker, at, MARKER, series.style.colour, false);
                }
                svg.text(&name);
            });
        }
        for (entry, meaning) in (count..).zip(leaves) {
            let (x, y) = self.entry(entry);
            for (side, marker) in [(-7.0, Marker::Up), (7.0, Marker::Down)] {
                let at = (x + 0.5 * SAMPLE + side, y);
                svg.marker(marker, at, 4.5, NEUTRAL, false);
            }
            svg.text(&Text::new(x + SAMPLE + 8.0, y, meaning).sized(TICK));
        }
    }
}

fn stroke(style: &Style, rims: usize) -> Stroke {
    Stroke {
        paint: Paint::Data(style.colour),
        width: style.width + 2.0 * RIM * rims as f64,
        dash: style.dash,
    }
}
