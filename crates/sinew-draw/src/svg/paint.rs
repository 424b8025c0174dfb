//! Colours and lines.
//!
//! Neutral colours have a name in addition to their value, so that a page can restyle them: its CSS overrides
//! attributes, and a file alone still looks right.

use crate::style::{Colour, Dash};

/// A colour: of the data, or one that follows the page.
#[derive(Clone, Copy, Debug)]
pub enum Paint {
    /// A colour with a meaning, the same on light and dark pages.
    Data(Colour),
    /// The page.
    Paper,
    /// Text and strong lines.
    Ink,
    /// Secondary text and lines.
    Muted,
    /// Lines behind the data.
    Grid,
    /// Text on a tint, which stays light on a dark page.
    OnTint,
}

/// Colour, width and dashes of a line.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Its colour.
    pub paint: Paint,
    /// Its width (px).
    pub width: f64,
    /// Its dashes.
    pub dash: Dash,
}

impl Stroke {
    /// A line without gaps.
    #[must_use]
    pub fn new(paint: Paint, width: f64) -> Self {
        Self {
            paint,
            width,
            dash: Dash::Solid,
        }
    }
}

impl Paint {
    fn class_and_colour(self) -> (&'static str, Colour) {
        match self {
            Self::Data(colour) => ("", colour),
            Self::Paper => ("paper", Colour(0xff, 0xff, 0xff)),
            Self::Ink => ("ink", Colour(0x22, 0x22, 0x22)),
            Self::Muted => ("muted", Colour(0x66, 0x66, 0x66)),
            Self::Grid => ("grid", Colour(0xe3, 0xe3, 0xe3)),
            Self::OnTint => ("", Colour(0x11, 0x11, 0x11)),
        }
    }

    pub(super) fn as_fill(self) -> String {
        self.attribute("fill", "f")
    }

    pub(super) fn as_stroke(self) -> String {
        self.attribute("stroke", "s")
    }

    fn attribute(self, attribute: &str, prefix: &str) -> String {
        match self.class_and_colour() {
            ("", colour) => format!("{attribute}=\"{colour}\""),
            // Not classes: fill and stroke of one element would need the attribute twice.
            (class, colour) => {
                format!("{attribute}=\"{colour}\" data-{prefix}=\"{class}\"")
            }
        }
    }
}
