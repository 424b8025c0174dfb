//! Lines of text on pictures.

use super::glyphs::glyph;
use crate::Picture;

/// Height of capitals in the units of letters.
const CAPITAL: f32 = 10.0;

/// Space between letters, in these units.
const APART: f32 = 2.3;

/// Width of the pen, in these units, and its minimum in pixels.
const PEN: f32 = 1.15;
const THINNEST: f32 = 1.05;

/// Style of a line of text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ink {
    /// Height of capitals (pixels).
    pub(super) height: f32,
    pub(super) colour: [u8; 3],
}

/// The point of a line of text that is at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// The width (pixels) of a line of text.
pub(super) fn width(text: &str, ink: Ink) -> f32 {
    let widths = text.chars().map(|letter| glyph(letter).width + APART);
    let all: f32 = widths.sum();
    (all - APART).max(0.0) * ink.height / CAPITAL
}

/// The longest beginning of a line that fits into a width (pixels), with dots instead of the rest.
pub(super) fn shortened(text: &str, most: f32, ink: Ink) -> String {
    if width(text, ink) <= most {
        return text.to_owned();
    }
    let mut left: Vec<char> = text.chars().collect();
    while left.pop().is_some() {
        let short: String = left.iter().collect();
        let short = format!("{}...", short.trim_end());
        if width(&short, ink) <= most {
            return short;
        }
    }
    String::new()
}

/// Writes a line of text. `y` is the row of its baseline.
pub(super) fn write(
    picture: &mut Picture,
    text: &str,
    (x, y): (f32, f32),
    anchor: Anchor,
    ink: Ink,
) {
    let scale = ink.height / CAPITAL;
    let wide = width(text, ink);
    let mut left = match anchor {
        Anchor::Left => x,
        Anchor::Middle => x - 0.5 * wide,
        Anchor::Right => x - wide,
    };
    let pen = 0.5 * (PEN * scale).max(THINNEST);
    for letter in text.chars() {
        let glyph = glyph(letter);
        let lines = glyph
            .lines
            .iter()
            .map(|line| line.map(|[across, above]| [left + across * scale, y - above * scale]));
        stroke(picture, &lines.collect::<Vec<_>>(), pen, ink.colour);
        left += (glyph.width + APART) * scale;
    }
}

/// Draws lines with a round pen of this half width (pixels).
pub(super) fn stroke(picture: &mut Picture, lines: &[[[f32; 2]; 2]], pen: f32, colour: [u8; 3]) {
    let points = || lines.iter().flatten();
    let low = |axis: usize| points().map(|point| point[axis]).fold(f32::MAX, f32::min);
    let high = |axis: usize| points().map(|point| point[axis]).fold(f32::MIN, f32::max);
    if lines.is_empty() {
        return;
    }
    let range = |axis: usize| {
        let from = (low(axis) - pen - 1.0).floor().max(-1.0) as i64;
        let to = (high(axis) + pen + 1.0).ceil().min(1e5) as i64;
        from..=to
    };
    for row in range(1) {
        for column in range(0) {
            let at = [column as f32 + 0.5, row as f32 + 0.5];
            let nearest = lines
                .iter()
                .map(|line| distance(at, *line))
                .fold(f32::MAX, f32::min);
            picture.lay((column, row), colour, (pen + 0.5 - nearest).clamp(0.0, 1.0));
        }
    }
}

/// The distance of a point from a line between two others.
fn distance([x, y]: [f32; 2], [[ax, ay], [bx, by]]: [[f32; 2]; 2]) -> f32 {
    let [along, down] = [bx - ax, by - ay];
    let square = along * along + down * down;
    let share = match square > 0.0 {
        true => (((x - ax) * along + (y - ay) * down) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    let [dx, dy] = [x - ax - share * along, y - ay - share * down];
    (dx * dx + dy * dy).sqrt()
}
