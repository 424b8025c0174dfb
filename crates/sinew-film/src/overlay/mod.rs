//! Texts on pictures: title, time, a length, and the values of colours.

mod bar;
mod glyphs;
mod measure;
mod text;

pub(crate) use bar::Bar;

use crate::Picture;
use crate::render::Room;
use measure::{in_prefixed, round_below};
use text::{Anchor, Ink};

/// The colour of text.
const DARK: [u8; 3] = [44, 52, 64];

/// The colour of secondary text: the length and the bar's title and unit.
const PALE: [u8; 3] = [104, 114, 128];

/// Height of capitals as a share of the picture's height, and its minimum in pixels.
const HEIGHT: f32 = 0.0215;
const LEAST: f32 = 7.0;

/// The largest share of the width for the length on the scale.
const LONGEST: f32 = 0.2;

/// The texts on all pictures of a film.
#[derive(Debug, Clone)]
pub(crate) struct Overlay {
    pub(crate) title: String,
    /// Times (s) of the first and the last frame. They determine the unit and the digits of the time.
    pub(crate) span: [f64; 2],
    /// Pixels for a length of 1 m.
    pub(crate) pixels_per_metre: f64,
    pub(crate) bar: Option<Bar>,
}

/// Margins for texts, as shares of the picture.
pub(crate) fn room(has_bar: bool) -> Room {
    Room {
        left: 0.045,
        right: if has_bar { 0.185 } else { 0.045 },
        top: 0.12,
        bottom: 0.135,
    }
}

impl Overlay {
    /// Writes the texts on the picture of the time `t` (s).
    pub(crate) fn draw(&self, picture: &mut Picture, t: f64) {
        let size = picture.size();
        let [width, height] = [size.width() as f32, size.height() as f32];
        let capital = (HEIGHT * height.min(0.75 * width)).max(LEAST);
        let ink = Ink {
            height: capital,
            colour: DARK,
        };
        let pale = Ink {
            colour: PALE,
            ..ink
        };
        let edge = 2.0 * capital;
        let base = height - edge;
        let title = text::shortened(&self.title, width - 2.0 * edge, ink);
        text::write(picture, &title, (edge, edge + capital), Anchor::Left, ink);
        text::write(picture, &self.time(t), (edge, base), Anchor::Left, ink);
        self.scale(picture, [width - edge, base], pale);
        if let Some(bar) = &self.bar {
            bar.draw(picture, ink, pale);
        }
    }

    /// The time as text, with the same number of digits at every instant.
    fn time(&self, t: f64) -> String {
        let span = (self.span[1] - self.span[0]).max(f64::MIN_POSITIVE);
        let (factor, unit) = match span {
            span if span >= 0.5 => (1.0, "s"),
            span if span >= 5e-4 => (1e3, "ms"),
            _ => (1e6, "µs"),
        };
        let digits = (2.0 - (span * factor).log10().floor()).clamp(0.0, 6.0) as usize;
        format!("t = {:.digits$} {unit}", t * factor)
    }

    /// Draws a round length, whose right end is at a point.
    fn scale(&self, picture: &mut Picture, [right, base]: [f32; 2], ink: Ink) {
        let width = picture.size().width() as f32;
        let most = f64::from(LONGEST * width) / self.pixels_per_metre;
        let Some(length) = round_below(most) else {
            return;
        };
        let pixels = (length * self.pixels_per_metre) as f32;
        let [left, tick] = [right - pixels, 0.45 * ink.height];
        let lines = [
            [[left, base], [right, base]],
            [[left, base - tick], [left, base + tick]],
            [[right, base - tick], [right, base + tick]],
        ];
        text::stroke(picture, &lines, (0.06 * ink.height).max(0.6), ink.colour);
        let middle = (0.5 * (left + right), base - 0.9 * ink.height);
        text::write(
            picture,
            &in_prefixed(length, "m"),
            middle,
            Anchor::Middle,
            ink,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits_of_the_span_in_a_fitting_unit() {
        let said = |span: [f64; 2], t: f64| {
            let overlay = Overlay {
                title: String::new(),
                span,
                pixels_per_metre: 1.0,
                bar: None,
            };
            overlay.time(t)
        };
        assert_eq!(said([0.0, 1.6], 0.5), "t = 0.50 s");
        assert_eq!(said([0.0, 0.04], 0.012_34), "t = 12.3 ms");
        assert_eq!(said([0.0, 300.0], 12.34), "t = 12 s");
    }
}
