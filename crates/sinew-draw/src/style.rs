//! Colours, markers and dashes that stay apart without colour vision.

/// An sRGB colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(
    /// Red.
    pub u8,
    /// Green.
    pub u8,
    /// Blue.
    pub u8,
);

impl std::fmt::Display for Colour {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Palette of M. Okabe and K. Ito, Color Universal Design (2008), without yellow, which is too
/// light for lines on white, and with a grey that shows on dark pages in place of black.
const PALETTE: [Colour; 7] = [
    Colour(0x00, 0x72, 0xb2),
    Colour(0xd5, 0x5e, 0x00),
    Colour(0x00, 0x9e, 0x73),
    Colour(0xe6, 0x9f, 0x00),
    Colour(0xcc, 0x79, 0xa7),
    Colour(0x56, 0xb4, 0xe9),
    Colour(0x70, 0x70, 0x70),
];

/// The sign at every point of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A disc.
    Circle,
    /// A square.
    Square,
    /// A triangle on its base.
    Up,
    /// A square on its corner.
    Diamond,
    /// A triangle on its corner.
    Down,
    /// A pentagon.
    Pentagon,
    /// A star with four points.
    Star,
    /// A Greek cross.
    Plus,
}

const MARKERS: [Marker; 8] = [
    Marker::Circle,
    Marker::Square,
    Marker::Up,
    Marker::Diamond,
    Marker::Down,
    Marker::Star,
    Marker::Pentagon,
    Marker::Plus,
];

impl Marker {
    /// Corners on a circle about the origin that gives all markers about the same area; none is a
    /// circle. Downwards is positive.
    pub(crate) fn corners(self, radius: f64) -> Vec<(f64, f64)> {
        let ring = |n: usize, start: f64, radii: &[f64]| {
            (0..n)
                .map(|i| {
                    let angle = (start + 360.0 * i as f64 / n as f64).to_radians();
                    let r = radius * radii[i % radii.len()];
                    (r * angle.cos(), r * angle.sin())
                })
                .collect()
        };
        match self {
            Self::Circle => Vec::new(),
            Self::Square => ring(4, 45.0, &[1.25]),
            Self::Up => ring(3, -90.0, &[1.45]),
            Self::Diamond => ring(4, 0.0, &[1.35]),
            Self::Down => ring(3, 90.0, &[1.45]),
            Self::Pentagon => ring(5, -90.0, &[1.2]),
            Self::Star => ring(8, -90.0, &[1.75, 0.65]),
            Self::Plus => {
                let (a, b) = (0.42 * radius, 1.4 * radius);
                vec![
                    (-a, -b),
                    (a, -b),
                    (a, -a),
                    (b, -a),
                    (b, a),
                    (a, a),
                    (a, b),
                    (-a, b),
                    (-a, a),
                    (-b, a),
                    (-b, -a),
                    (-a, -a),
                ]
            }
        }
    }
}

/// The dashes of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// A line without gaps.
    Solid,
    /// Long strokes.
    Dashed,
    /// Dots.
    Dotted,
}

const DASHES: [Dash; 3] = [Dash::Solid, Dash::Dashed, Dash::Dotted];

impl Dash {
    pub(crate) fn array(self) -> Option<&'static str> {
        match self {
            Self::Solid => None,
            Self::Dashed => Some("7 4"),
            Self::Dotted => Some("2 3"),
        }
    }
}

/// Colour, line and marker of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colour of line and markers.
    pub colour: Colour,
    /// Marker at every point.
    pub marker: Option<Marker>,
    /// The dashes of the line.
    pub dash: Dash,
    /// Width of the line (px).
    pub width: f64,
    /// The line goes right, then up or down, from point to point.
    pub steps: bool,
}

impl Style {
    /// The n-th of many styles that differ from each other.
    #[must_use]
    pub fn nth(n: usize) -> Self {
        Self::of_family(n, 0)
    }

    /// The style of a member of the n-th family: one colour and dash per family, other markers.
    #[must_use]
    pub fn of_family(family: usize, member: usize) -> Self {
        Self {
            colour: PALETTE[family % PALETTE.len()],
            marker: Some(MARKERS[(family + member) % MARKERS.len()]),
            dash: DASHES[(family / PALETTE.len()) % DASHES.len()],
            width: 1.75,
            steps: false,
        }
    }

    /// The style without markers.
    #[must_use]
    pub fn line_only(self) -> Self {
        Self {
            marker: None,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_families_differ() {
        let styles: Vec<Style> = (0..21).map(Style::nth).collect();
        for (i, a) in styles.iter().enumerate() {
            assert!(styles[i + 1..].iter().all(|b| a != b), "{i}");
        }
    }

    #[test]
    fn colours_are_hexadecimal() {
        assert_eq!(Colour(0, 0x72, 0xb2).to_string(), "#0072b2");
    }
}
