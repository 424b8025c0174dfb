//! A small SVG writer.
//!
//! Clipping uses nested `svg` elements rather than ids, which would collide when several pictures
//! share a page.

use std::fmt::{self, Display, Write};

mod paint;
mod text;

use crate::{
    markup::{attribute, escape},
    style::{Colour, Marker},
};
pub use paint::{Paint, Stroke};
use text::Raised;
pub use text::{Anchor, Text, text_width};

const FONTS: &str = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'DejaVu Sans', \
                     'Liberation Sans', sans-serif";

/// A picture being written.
#[derive(Debug)]
pub struct Svg {
    out: String,
}

/// A rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Its left side (px).
    pub left: f64,
    /// Its upper side (px from the top of the picture).
    pub top: f64,
    /// Its width (px).
    pub width: f64,
    /// Its height (px).
    pub height: f64,
}

impl Frame {
    /// Its right side (px).
    #[must_use]
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Its lower side (px).
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

impl Svg {
    /// A picture of the given size, described for readers who cannot see it.
    #[must_use]
    pub fn new(width: f64, height: f64, described: &str) -> Self {
        let mut svg = Self { out: String::new() };
        let (w, h) = (N(width), N(height));
        svg.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" \
             height=\"{h}\" font-family=\"{FONTS}\" role=\"img\" aria-label=\"{}\">\n",
            escape(described)
        ));
        let page = Frame {
            left: 0.0,
            top: 0.0,
            width,
            height,
        };
        svg.rect(page, Paint::Paper);
        svg
    }

    /// The complete picture.
    #[must_use]
    pub fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }

    /// A filled rectangle.
    pub fn rect(&mut self, frame: Frame, fill: Paint) {
        let Frame {
            left,
            top,
            width,
            height,
        } = frame;
        self.put(format_args!(
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n",
            N(left),
            N(top),
            N(width),
            N(height),
            fill.as_fill()
        ));
    }

    /// A straight line.
    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
        self.polyline(&[from, to], stroke);
    }

    /// A broken line; nothing is drawn for fewer than two points.
    pub fn polyline(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        if points.len() < 2 {
            return;
        }
        let dash = stroke.dash.array().map_or_else(String::new, |array| {
            format!(" stroke-dasharray=\"{array}\"")
        });
        self.put(format_args!(
            "<path d=\"{}\" fill=\"none\" {} stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}/>\n",
            Path { points, closed: false },
            stroke.paint.as_stroke(),
            N(stroke.width)
        ));
    }

    /// A filled polygon with an edge of the same colour, which hides the seams between neighbours.
    pub fn facet(&mut self, points: &[(f64, f64)], colour: Colour, edge: Colour) {
        self.put(format_args!(
            "<path d=\"{}\" fill=\"{colour}\" stroke=\"{edge}\" stroke-width=\"0.5\" \
             stroke-linejoin=\"round\"/>\n",
            Path {
                points,
                closed: true
            }
        ));
    }

    /// A marker; an open one is filled with paper.
    pub fn marker(
        &mut self,
        marker: Marker,
        (x, y): (f64, f64),
        radius: f64,
        colour: Colour,
        open: bool,
    ) {
        let (fill, edge) = if open {
            (Paint::Paper, Paint::Data(colour))
        } else {
            (Paint::Data(colour), Paint::Paper)
        };
        let paint = format!(
            "{} {} stroke-width=\"{}\"",
            fill.as_fill(),
            edge.as_stroke(),
            if open { "1.5" } else { "0.75" }
        );
        let corners: Vec<(f64, f64)> = marker
            .corners(radius)
            .iter()
            .map(|(dx, dy)| (x + dx, y + dy))
            .collect();
        if corners.is_empty() {
            self.put(format_args!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {paint}/>\n",
                N(x),
                N(y),
                N(radius)
            ));
        } else {
            self.put(format_args!(
                "<path d=\"{}\" {paint}/>\n",
                Path {
                    points: &corners,
                    closed: true
                }
            ));
        }
    }

    /// A circle around a marker.
    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64) {
        self.put(format_args!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" {} stroke-width=\"1.25\"/>\n",
            N(x),
            N(y),
            N(radius),
            Paint::Ink.as_stroke()
        ));
    }

    /// A text; `^{..}` in it is raised.
    pub fn text(&mut self, text: &Text<'_>) {
        // Not `dominant-baseline`, which renderers treat differently.
        let drop = 0.35 * text.size;
        let place = if text.upward {
            let (x, y) = (N(text.x + drop), N(text.y));
            format!("transform=\"translate({x} {y}) rotate(-90)\"")
        } else {
            format!("x=\"{}\" y=\"{}\"", N(text.x), N(text.y + drop))
        };
        let anchor = match text.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let weight = if text.bold {
            " font-weight=\"600\""
        } else {
            ""
        };
        self.put(format_args!(
            "<text {place} font-size=\"{}\"{anchor}{weight} {}>{}</text>\n",
            N(text.size),
            text.paint.as_fill(),
            Raised(text.content)
        ));
    }

    /// Draws with `draw`, with a text shown when the pointer is over it.
    pub fn noted(&mut self, note: &str, draw: impl FnOnce(&mut Self)) {
        if note.is_empty() {
            draw(self);
            return;
        }
        self.put(format_args!("<g><title>{}</title>", escape(note)));
        draw(self);
        self.out.push_str("</g>\n");
    }

    /// A group with the content that `draw` adds, with attributes for scripts.
    pub fn group(&mut self, attributes: &[(&str, String)], draw: impl FnOnce(&mut Self)) {
        let attributes: String = attributes
            .iter()
            .map(|(name, value)| attribute(name, value))
            .collect();
        self.put(format_args!("<g{attributes}>"));
        draw(self);
        self.out.push_str("</g>\n");
    }

    /// Draws with `draw`, clipped to the frame.
    pub fn clipped(&mut self, frame: Frame, draw: impl FnOnce(&mut Self)) {
        let (x, y, w, h) = (N(frame.left), N(frame.top), N(frame.width), N(frame.height));
        self.put(format_args!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" viewBox=\"{x} {y} {w} {h}\" \
             overflow=\"hidden\">\n"
        ));
        draw(self);
        self.out.push_str("</svg>\n");
    }

    /// Inserts a whole picture into this one, with its upper left corner at a position.
    pub fn picture(&mut self, (x, y): (f64, f64), picture: &str) {
        self.put(format_args!(
            "<svg x=\"{}\" y=\"{}\" overflow=\"visible\">\n{picture}</svg>\n",
            N(x),
            N(y)
        ));
    }

    fn put(&mut self, arguments: fmt::Arguments<'_>) {
        // Writing into a String cannot fail.
        let _ = self.out.write_fmt(arguments);
    }
}

/// A coordinate with at most two decimals.
#[derive(Clone, Copy)]
struct N(f64);

impl Display for N {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = (self.0 * 100.0).round() / 100.0;
        // `+ 0.0` turns a negative zero.
        write!(f, "{}", rounded + 0.0)
    }
}

struct Path<'a> {
    points: &'a [(f64, f64)],
    closed: bool,
}

impl Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, &(x, y)) in self.points.iter().enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            write!(f, "{command}{} {}", N(x), N(y))?;
        }
        if self.closed {
            f.write_str("Z")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_escaped() {
        let mut svg = Svg::new(10.0, 10.0, "a \"<b>\"");
        svg.text(&Text::new(0.0, 0.0, "1 < 2 & 10^{-3}"));
        svg.noted("<i>", |svg| svg.ring((1.0, 1.0), 2.0));
        let out = svg.finish();
        assert!(out.contains("aria-label=\"a &quot;&lt;b&gt;&quot;\""));
        assert!(out.contains("1 &lt; 2 &amp; 10<tspan dy=\"-0.4em\" font-size=\"75%\">-3</tspan>"));
        assert!(out.contains("<title>&lt;i&gt;</title>"));
    }

    #[test]
    fn coordinates_are_short() {
        assert_eq!(N(1.0).to_string(), "1");
        assert_eq!(N(-0.001).to_string(), "0");
        assert_eq!(N(2.0 / 3.0).to_string(), "0.67");
    }
}
