//! Roofline plots (Williams, Waterman and Patterson, Commun. ACM 52, 2009): operations per second over operations per
//! byte, beneath the limits of memory and arithmetic.

use crate::axis::{Axis, Fitted, Tick};
use crate::style::{Dash, Marker, Style};
use crate::svg::{Anchor, Frame, Paint, Stroke, Svg, Text, text_width};

const WIDTH: f64 = 920.0;
const HEIGHT: f64 = 460.0;
const MARGIN: f64 = 12.0;
const TITLE: f64 = 15.0;
const TEXT: f64 = 12.0;
const SMALL: f64 = 11.0;
const LEFT: f64 = 62.0;
/// Space for the labels of horizontal roofs.
const RIGHT: f64 = 150.0;
const MARKER: f64 = 4.2;
/// Distance between labels.
const LINE: f64 = 13.0;
/// Distance from a mark to its label.
const AWAY: f64 = 20.0;

/// A roofline plot.
#[derive(Clone, Debug)]
pub struct Roofline {
    /// Title above the frame.
    pub title: String,
    /// Names of memories, with the rates at which they are read (GB/s), the fastest first.
    pub memories: Vec<(String, f64)>,
    /// Names of instructions, with their rates (GFLOP/s).
    pub arithmetic: Vec<(String, f64)>,
    /// The marks, in families of a colour.
    pub families: Vec<Family>,
}

/// Marks of one colour.
#[derive(Clone, Debug)]
pub struct Family {
    /// Its name in the legend.
    pub name: String,
    /// Label, operations per byte, and operations per second (GFLOP/s) of each mark.
    pub marks: Vec<(String, f64, f64)>,
}

struct Layout {
    frame: Frame,
    x: Fitted,
    y: Fitted,
}

impl Layout {
    fn of(plot: &Roofline) -> Self {
        let marks = || plot.families.iter().flat_map(|family| &family.marks);
        let peak = plot.arithmetic.iter().map(|(_, rate)| *rate);
        let top = peak.chain(marks().map(|mark| mark.2)).fold(1.0, f64::max);
        let low = marks().map(|mark| mark.1).fold(0.25, f64::min);
        let high = marks().map(|mark| mark.1).fold(4.0, f64::max);
        let slow = marks().map(|mark| mark.2).fold(top, f64::min);
        let x = Axis::log("").range(0.5 * low, 8.0 * high);
        let y = Axis::log("").range(0.4 * slow, 1.6 * top);
        let frame = Frame {
            left: LEFT,
            top: MARGIN + TITLE + 16.0,
            width: WIDTH - LEFT - RIGHT,
            height: HEIGHT,
        };
        Self {
            frame,
            x: x.fitted(std::iter::empty()),
            y: y.fitted(std::iter::empty()),
        }
    }

    fn at(&self, intensity: f64, rate: f64) -> (f64, f64) {
        let x = self.frame.left + self.x.share(intensity) * self.frame.width;
        let y = self.frame.bottom() - self.y.share(rate) * self.frame.height;
        (x, y)
    }
}

impl Roofline {
    /// The picture as a separate file or for a page.
    #[must_use]
    pub fn svg(&self) -> String {
        let layout = Layout::of(self);
        let rows = self.families.len().div_ceil(2) as f64;
        let legend = layout.frame.bottom() + 58.0;
        let mut svg = Svg::new(WIDTH, legend + 20.0 * rows + MARGIN, &self.described());
        let title = Text::new(LEFT, MARGIN + 0.6 * TITLE, &self.title);
        svg.text(&title.sized(TITLE).bold());
        axes(&mut svg, &layout);
        svg.clipped(layout.frame, |svg| {
            for (_, rate) in &self.memories {
                let ends = [1e-3, 1e4].map(|intensity| layout.at(intensity, intensity * rate));
                svg.line(ends[0], ends[1], roof(Dash::Solid));
            }
            for (_, rate) in &self.arithmetic {
                let (_, y) = layout.at(1.0, *rate);
                svg.line(
                    (layout.frame.left, y),
                    (layout.frame.right(), y),
                    roof(Dash::Dashed),
                );
            }
        });
        self.name_roofs(&mut svg, &layout);
        for (index, family) in self.families.iter().enumerate() {
            let style = Style::nth(index);
            family.draw(&mut svg, &layout, style);
            let (column, row) = ((index % 2) as f64, (index / 2) as f64);
            let (x, y) = (LEFT + 330.0 * column, legend + 20.0 * row);
            let marker = style.marker.unwrap_or(Marker::Circle);
            svg.marker(marker, (x + 6.0, y), MARKER, style.colour, false);
            svg.text(&Text::new(x + 18.0, y, &family.name).sized(TEXT));
        }
        svg.finish()
    }

    fn described(&self) -> String {
        let names: Vec<&str> = self
            .families
            .iter()
            .map(|family| family.name.as_str())
            .collect();
        format!(
            "{}: operations a second over operations a byte, of {}",
            self.title,
            names.join(", ")
        )
    }

    /// Writes the names of arithmetic on the right, and those of memories at the point at which their roof leaves the
    /// frame's left or lower side.
    fn name_roofs(&self, svg: &mut Svg, layout: &Layout) {
        let frame = layout.frame;
        let mut rates: Vec<&(String, f64)> = self.arithmetic.iter().collect();
        rates.sort_by(|a, b| b.1.total_cmp(&a.1));
        let places = rates.iter().map(|(_, rate)| layout.at(1.0, *rate).1);
        for ((name, _), y) in rates.iter().zip(apart(places.collect())) {
            let text = Text::new(frame.right() + 6.0, y, name);
            svg.text(&text.sized(SMALL).painted(Paint::Muted));
        }
        let room: Vec<f64> = self
            .memories
            .iter()
            .map(|(_, rate)| {
                // Where the roof meets the left side, or the lower one.
                let (_, y) = layout.at(1.0, *rate);
                let (x, _) = layout.at(1.0, *rate);
                let slope = {
                    let (x2, y2) = layout.at(10.0, 10.0 * rate);
                    (y2 - y) / (x2 - x)
                };
                let at = frame.left + 8.0;
                (y + slope * (at - x)).min(frame.bottom() - 4.0) - 9.0
            })
            .collect();
        for ((name, _), y) in self.memories.iter().zip(apart(room)) {
            let width = text_width(name, SMALL);
            let back = Frame {
                left: frame.left + 6.0,
                top: y - 7.0,
                width,
                height: 14.0,
            };
            svg.rect(back, Paint::Paper);
            svg.text(
                &Text::new(frame.left + 8.0, y, name)
                    .sized(SMALL)
                    .painted(Paint::Muted),
            );
        }
    }
}

impl Family {
    /// Draws marks, with their labels in a column to the right of them, joined by thin lines.
    fn draw(&self, svg: &mut Svg, layout: &Layout, style: Style) {
        let mut marks: Vec<(&str, (f64, f64))> = self
            .marks
            .iter()
            .map(|(label, intensity, rate)| (label.as_str(), layout.at(*intensity, *rate)))
            .collect();
        marks.sort_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let column = marks.iter().map(|mark| mark.1.0).fold(0.0, f64::max) + AWAY;
        let labels = apart(marks.iter().map(|mark| mark.1.1).collect());
        let thin = Stroke::new(Paint::Muted, 0.5);
        for ((label, at), y) in marks.iter().zip(&labels) {
            svg.line(*at, (column - 3.0, *y), thin);
            let width = text_width(label, SMALL) * 0.92;
            let back = Frame {
                left: column - 2.0,
                top: y - 6.5,
                width,
                height: 13.0,
            };
            svg.rect(back, Paint::Paper);
            svg.text(&Text::new(column, *y, label).sized(SMALL));
        }
        for ((_, at), (label, intensity, rate)) in marks.iter().zip(self.sorted()) {
            let note = format!(
                "{}, {label}: {rate:.2} GFLOP/s at {intensity:.2} flop a byte",
                self.name
            );
            let marker = style.marker.unwrap_or(Marker::Circle);
            svg.noted(&note, |svg| {
                svg.marker(marker, *at, MARKER, style.colour, false);
            });
        }
    }

    /// The marks, the fastest first.
    fn sorted(&self) -> Vec<&(String, f64, f64)> {
        let mut marks: Vec<_> = self.marks.iter().collect();
        marks.sort_by(|a, b| b.2.total_cmp(&a.2));
        marks
    }
}

/// Positions in increasing order, moved apart until each has space for a line, near their original positions.
fn apart(mut places: Vec<f64>) -> Vec<f64> {
    for _ in 0..200 {
        let mut moved = false;
        for upper in 1..places.len() {
            let missing = LINE - (places[upper] - places[upper - 1]);
            if missing > 1e-6 {
                places[upper - 1] -= 0.5 * missing;
                places[upper] += 0.5 * missing;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    places
}

fn roof(dash: Dash) -> Stroke {
    Stroke {
        dash,
        ..Stroke::new(Paint::Muted, 1.25)
    }
}

fn axes(svg: &mut Svg, layout: &Layout) {
    let frame = layout.frame;
    let (right, bottom) = (frame.right(), frame.bottom());
    let grid = |tick: &Tick| Stroke::new(Paint::Grid, if tick.label.is_some() { 1.0 } else { 0.4 });
    for tick in layout.x.ticks(6) {
        let x = frame.left + tick.at * frame.width;
        svg.line((x, frame.top), (x, bottom), grid(&tick));
        if let Some(label) = &tick.label {
            svg.text(
                &Text::new(x, bottom + 14.0, label)
                    .sized(TEXT)
                    .anchored(Anchor::Middle),
            );
        }
    }
    for tick in layout.y.ticks(6) {
        let y = bottom - tick.at * frame.height;
        svg.line((frame.left, y), (right, y), grid(&tick));
        if let Some(label) = &tick.label {
            svg.text(
                &Text::new(frame.left - 8.0, y, label)
                    .sized(TEXT)
                    .anchored(Anchor::End),
            );
        }
    }
    let sides = [
        (frame.left, frame.top),
        (frame.left, bottom),
        (right, bottom),
    ];
    svg.polyline(&sides, Stroke::new(Paint::Muted, 1.0));
    let middle = (
        frame.left + 0.5 * frame.width,
        frame.top + 0.5 * frame.height,
    );
    let x = Text::new(
        middle.0,
        bottom + 36.0,
        "operations for each byte moved [flop/byte]",
    );
    svg.text(&x.anchored(Anchor::Middle));
    let y = Text::new(MARGIN + 6.0, middle.1, "operations a second [GFLOP/s]");
    svg.text(&y.anchored(Anchor::Middle).upward());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_distance_and_order() {
        let places = apart(vec![100.0, 101.0, 101.5, 180.0]);
        for pair in places.windows(2) {
            assert!(pair[1] - pair[0] > LINE - 1e-3, "{places:?}");
        }
        assert_eq!(places[3], 180.0);
        let middle = (places[0] + places[1] + places[2]) / 3.0;
        assert!((middle - 100.8).abs() < 0.1);
    }

    /// Roofs meet at equal rates of memory and arithmetic: 50 GB/s and 100 GFLOP/s at 2 flop per byte.
    #[test]
    fn a_mark_at_the_ridge_lies_on_both_roofs() {
        let plot = Roofline {
            title: "a <title>".into(),
            memories: vec![("L2".into(), 50.0)],
            arithmetic: vec![("avx2".into(), 100.0)],
            families: vec![Family {
                name: "general".into(),
                marks: vec![("cube".into(), 2.0, 100.0)],
            }],
        };
        let layout = Layout::of(&plot);
        let (x, y) = layout.at(2.0, 100.0);
        let (a, b) = (layout.at(0.5, 25.0), layout.at(4.0, 200.0));
        let on_roof = a.1 + (x - a.0) * (b.1 - a.1) / (b.0 - a.0);
        assert!((on_roof - y).abs() < 1e-9);
        let svg = plot.svg();
        assert!(
            svg.contains("&lt;title&gt;") && svg.contains("100.00 GFLOP/s at 2.00 flop a byte")
        );
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn a_plot_without_marks_is_a_picture() {
        let plot = Roofline {
            title: String::new(),
            memories: Vec::new(),
            arithmetic: Vec::new(),
            families: Vec::new(),
        };
        assert!(!plot.svg().contains("NaN"));
    }
}
