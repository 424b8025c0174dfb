//! Texts and their extent.

use std::fmt::{self, Display};

use super::Paint;
use crate::markup::escape;

/// The part of a text to which its position refers.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// A text and its style; `y` is the middle of the line.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// Position of its anchor (px from the left).
    pub x: f64,
    /// Middle of its line (px from the top).
    pub y: f64,
    /// Its characters.
    pub content: &'a str,
    /// Size of its letters (px).
    pub size: f64,
    /// The part of it that is at `x`.
    pub anchor: Anchor,
    /// Its colour.
    pub paint: Paint,
    /// True if it is bold.
    pub bold: bool,
    /// True if it is rotated by 90 degrees to the left.
    pub upward: bool,
}

impl<'a> Text<'a> {
    /// A text in ordinary letters that begins at a position.
    #[must_use]
    pub fn new(x: f64, y: f64, content: &'a str) -> Self {
        Self {
            x,
            y,
            content,
            size: 12.0,
            anchor: Anchor::Start,
            paint: Paint::Ink,
            bold: false,
            upward: false,
        }
    }

    /// The text with another anchor.
    #[must_use]
    pub fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// The text in another colour.
    #[must_use]
    pub fn painted(self, paint: Paint) -> Self {
        Self { paint, ..self }
    }

    /// The text in another size (px).
    #[must_use]
    pub fn sized(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// The text set bold.
    #[must_use]
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The text rotated by 90 degrees to the left.
    #[must_use]
    pub fn upward(self) -> Self {
        Self {
            upward: true,
            ..self
        }
    }
}

/// Estimated width of a text, rather too large: fonts differ from machine to machine.
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    let ems: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | '|' | '\'' | ' ' => 0.36,
            'm' | 'w' | 'M' | 'W' | '%' => 0.95,
            _ => 0.62,
        })
        .sum();
    ems * size
}

/// Escaped text in which `^{..}` is raised.
pub(super) struct Raised<'a>(pub(super) &'a str);

impl Display for Raised<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some((before, rest)) = self.0.split_once("^{") else {
            return f.write_str(&escape(self.0));
        };
        let Some((raised, after)) = rest.split_once('}') else {
            return f.write_str(&escape(self.0));
        };
        write!(
            f,
            "{}<tspan dy=\"-0.4em\" font-size=\"75%\">{}</tspan>",
            escape(before),
            escape(raised)
        )?;
        if after.is_empty() {
            return Ok(());
        }
        write!(f, "<tspan dy=\"0.3em\">{}</tspan>", escape(after))
    }
}
