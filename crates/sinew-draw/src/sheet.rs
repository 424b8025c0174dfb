//! Plots side by side under one title, as a separate picture.

use crate::plot::Plot;
use crate::svg::{Paint, Svg, Text, text_width};

const MARGIN: f64 = 12.0;
const TITLE: f64 = 16.0;
const LINE: f64 = 12.5;
/// Height of a line over the size of its letters.
const LEADING: f64 = 1.45;

/// Plots side by side, with a title and lines of text above them.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Description for readers who cannot see it.
    pub described: String,
    /// Title, which is broken into lines if it is long.
    pub title: String,
    /// Paragraphs below it, broken in the same way.
    pub lines: Vec<String>,
    /// The plots, from left to right.
    pub plots: Vec<Plot>,
}

impl Sheet {
    /// The picture as a separate file.
    #[must_use]
    pub fn svg(&self) -> String {
        let width: f64 = self.plots.iter().map(|plot| plot.width).sum();
        let title = broken(&self.title, TITLE, width - 2.0 * MARGIN);
        let lines = self.lines.iter();
        let lines: Vec<String> = lines
            .flat_map(|line| broken(line, LINE, width - 2.0 * MARGIN))
            .collect();
        let heads = LEADING * (TITLE * title.len() as f64 + LINE * lines.len() as f64);
        let below = MARGIN + heads;
        let pictures: Vec<String> = self.plots.iter().map(Plot::svg).collect();
        let heights = self.plots.iter().map(Plot::full_height);
        let height = below + heights.fold(MARGIN, f64::max);
        let mut svg = Svg::new(width, height, &self.described);
        let mut y = MARGIN;
        for line in &title {
            let text = Text::new(MARGIN, y + 0.5 * LEADING * TITLE, line);
            svg.text(&text.sized(TITLE).bold());
            y += LEADING * TITLE;
        }
        for line in &lines {
            let text = Text::new(MARGIN, y + 0.5 * LEADING * LINE, line);
            svg.text(&text.sized(LINE).painted(Paint::Muted));
            y += LEADING * LINE;
        }
        let mut x = 0.0;
        for (plot, picture) in self.plots.iter().zip(&pictures) {
            svg.picture((x, below), picture);
            x += plot.width;
        }
        svg.finish()
    }
}

/// A text in lines that are no wider than `width` (px), if its words allow that.
fn broken(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;

    #[test]
    fn long_texts_are_broken_between_words() {
        let text = "a stress of one thousand pascals ".repeat(6);
        let lines = broken(&text, 12.0, 300.0);
        assert!(lines.len() > 3 && lines.iter().all(|line| text_width(line, 12.0) <= 300.0));
        assert_eq!(lines.join(" "), text.trim());
        assert_eq!(broken("", 12.0, 300.0), [""; 0]);
    }

    #[test]
    fn plots_stand_side_by_side_below_the_texts() {
        let plot = |name: &str| Plot::new(name, Axis::linear("x"), Axis::linear("y"));
        let sheet = Sheet {
            described: "two".to_owned(),
            title: "a < b".to_owned(),
            lines: vec!["one".to_owned(), "two".to_owned()],
            plots: vec![plot("left"), plot("right")],
        };
        let svg = sheet.svg();
        assert!(svg.contains("width=\"1520\"") && svg.contains("a &lt; b"));
        for place in ["<svg x=\"0\" y=\"71.45\"", "<svg x=\"760\" y=\"71.45\""] {
            assert!(svg.contains(place), "{place}");
        }
        assert_eq!(svg.matches("</svg>").count(), svg.matches("<svg").count());
    }
}
