//! The bar that shows the values of colours.

use sinew_draw::short;

use super::measure::prefixed;
use super::text::{self, Anchor, Ink};
use crate::Picture;
use crate::render::colour_of;

/// Position and size of the bar, as shares of the picture: from its right end, from top to bottom, and its width in
/// heights of capitals.
const FROM_RIGHT: f32 = 0.145;
const ROWS: [f32; 2] = [0.24, 0.76];
const WIDTH: f32 = 1.3;

/// The largest share of the width for a title.
const LONGEST: f32 = 0.5;

/// The title, unit and values of a field's colours.
#[derive(Debug, Clone)]
pub(crate) struct Bar {
    title: String,
    /// The unit with its prefix.
    unit: String,
    /// The texts at the lower end, in the middle and at the upper end.
    pub(crate) marks: [String; 3],
}

impl Bar {
    /// The bar of a quantity between two values. `beyond`: for each end, true if values lie beyond it.
    pub(crate) fn new(title: &str, unit: &str, [from, to]: [f64; 2], beyond: [bool; 2]) -> Self {
        let (factor, unit) = prefixed(from.abs().max(to.abs()), unit);
        let number = |value: f64| short(value / factor).replace('-', "−");
        let end = |value: f64, is_beyond: bool, sign: &str| match is_beyond {
            true => format!("{sign} {}", number(value)),
            false => number(value),
        };
        Self {
            title: title.to_owned(),
            unit,
            marks: [
                end(from, beyond[0], "≤"),
                number(0.5 * (from + to)),
                end(to, beyond[1], "≥"),
            ],
        }
    }

    /// Draws the bar on the right of a picture.
    pub(super) fn draw(&self, picture: &mut Picture, ink: Ink, pale: Ink) {
        let size = picture.size();
        let [width, height] = [size.width() as f32, size.height() as f32];
        let [top, bottom] = ROWS.map(|row| (row * height).round());
        let left = (width - FROM_RIGHT * width).round();
        let right = left + (WIDTH * ink.height).round();
        for row in top as i64..bottom as i64 {
            let share = (bottom - row as f32 - 0.5) / (bottom - top);
            for column in left as i64..right as i64 {
                picture.lay((column, row), colour_of(share), 1.0);
            }
        }
        let gap = 0.7 * ink.height;
        for (mark, share) in self.marks.iter().zip([0.0, 0.5, 1.0]) {
            let row = bottom + share * (top - bottom);
            let place = (right + gap, row + 0.5 * ink.height);
            text::write(picture, mark, place, Anchor::Left, ink);
        }
        let end = width - 0.8 * ink.height;
        for (line, above) in [(&self.unit, 1.4), (&self.title, 3.1)] {
            let row = top - above * ink.height;
            // A long title begins before the bar, and ends with the picture.
            match text::width(line, pale) <= end - left {
                true => text::write(picture, line, (left, row), Anchor::Left, pale),
                false => {
                    let line = text::shortened(line, LONGEST * width, pale);
                    text::write(picture, &line, (end, row), Anchor::Right, pale);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_have_the_prefix_of_the_larger_one_and_say_if_more_lies_beyond() {
        let bar = Bar::new("stress", "Pa", [-500.0, 12_000.0], [false, true]);
        assert_eq!(bar.unit, "kPa");
        assert_eq!(bar.marks, ["−0.5", "5.75", "≥ 12"]);
    }
}
