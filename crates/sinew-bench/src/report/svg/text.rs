//! Texts and how much room they take.

use std::fmt::{self, Display};

use super::Paint;
use crate::report::markup::escape;

/// The part of a text that its position refers to.
#[derive(Clone, Copy)]
pub(in crate::report) enum Anchor {
    Start,
    Middle,
    End,
}

/// A text and how it is set; `y` is the middle of the line.
pub(in crate::report) struct Text<'a> {
    pub(in crate::report) x: f64,
    pub(in crate::report) y: f64,
    pub(in crate::report) content: &'a str,
    pub(in crate::report) size: f64,
    pub(in crate::report) anchor: Anchor,
    pub(in crate::report) paint: Paint,
    pub(in crate::report) bold: bool,
    /// Turned a quarter to the left.
    pub(in crate::report) upward: bool,
}

impl<'a> Text<'a> {
    pub(in crate::report) fn new(x: f64, y: f64, content: &'a str) -> Self {
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

    pub(in crate::report) fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    pub(in crate::report) fn painted(self, paint: Paint) -> Self {
        Self { paint, ..self }
    }

    pub(in crate::report) fn sized(self, size: f64) -> Self {
        Self { size, ..self }
    }

    pub(in crate::report) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub(in crate::report) fn upward(self) -> Self {
        Self {
            upward: true,
            ..self
        }
    }
}

/// Estimated width of a text, on the wide side: fonts differ from machine to machine.
pub(in crate::report) fn text_width(text: &str, size: f64) -> f64 {
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
