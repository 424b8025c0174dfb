//! Colours, markers and dashes that can be distinguished without colour vision.

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

/// Twelve colours: six of M. Okabe and K. Ito, Color Universal Design (2008), their orange darker, and
/// five between them. Each has a contrast of at least 2.4 to both the light and the dark page.
const PALETTE: [Colour; 12] = [
    Colour(0x00, 0x72, 0xb2),
    Colour(0xd5, 0x5e, 0x00),
    Colour(0x00, 0x9e, 0x73),
    Colour(0xcc, 0x79, 0xa7),
    Colour(0xc4, 0x8a, 0x00),
    Colour(0x45, 0xa5, 0xdc),
    Colour(0x8a, 0x5f, 0xd0),
    Colour(0x77, 0x77, 0x77),
    Colour(0xd0, 0x2f, 0x5b),
    Colour(0x7f, 0x8f, 0x1c),
    Colour(0x9a, 0x5b, 0x3f),
    Colour(0x14, 0xa0, 0xa8),
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
    /// True for a line that moves right, then up or down, from point to point.
    pub steps: bool,
}

impl Style {
    /// The n-th of many styles: no two of the first 96 share colour and marker.
    #[must_use]
    pub fn nth(n: usize) -> Self {
        Self {
            colour: PALETTE[n % PALETTE.len()],
            marker: Some(MARKERS[(n + n / PALETTE.len()) % MARKERS.len()]),
            dash: DASHES[(n / PALETTE.len()) % DASHES.len()],
            width: 1.75,
            steps: false,
        }
    }

    /// The style of a member of the n-th family: one colour and dash per family, with different markers.
    #[must_use]
    pub fn of_family(family: usize, member: usize) -> Self {
        Self {
            marker: Some(MARKERS[(family + member) % MARKERS.len()]),
            ..Self::nth(family)
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
    fn no_two_of_96_share_colour_and_marker() {
        let styles: Vec<Style> = (0..96).map(Style::nth).collect();
        for (i, a) in styles.iter().enumerate() {
            let same = |b: &&Style| (a.colour, a.marker) == (b.colour, b.marker);
            assert_eq!(styles[i + 1..].iter().find(same), None, "{i}");
        }
    }

    /// Red, green and blue, linear (IEC 61966-2-1).
    fn linear(colour: Colour) -> [f64; 3] {
        [colour.0, colour.1, colour.2].map(|channel| match f64::from(channel) / 255.0 {
            c if c <= 0.040_45 => c / 12.92,
            c => ((c + 0.055) / 1.055).powf(2.4),
        })
    }

    /// Relative luminance and contrast, WCAG 2.1.
    fn contrast(a: Colour, b: Colour) -> f64 {
        let luminance = |colour| {
            let [r, g, b] = linear(colour);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    /// Coordinates in CIE L*a*b* (D65), in which a distance of 2.3 is just visible.
    fn lab(colour: Colour) -> [f64; 3] {
        let [r, g, b] = linear(colour);
        let f = |t: f64| {
            if t > 216.0 / 24389.0 {
                t.cbrt()
            } else {
                (24389.0 / 27.0 * t + 16.0) / 116.0
            }
        };
        let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
        let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn colours_stand_out_from_both_pages_and_from_each_other() {
        let [light, dark] = [Colour(0xff, 0xff, 0xff), Colour(0x17, 0x19, 0x1c)];
        for (i, a) in PALETTE.iter().enumerate() {
            for page in [light, dark] {
                assert!(
                    contrast(*a, page) > 2.4,
                    "{a} on {page}: {}",
                    contrast(*a, page)
                );
            }
            for b in &PALETTE[i + 1..] {
                let apart = lab(*a).into_iter().zip(lab(*b));
                let apart = apart.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
                assert!(apart > 20.0, "{a} and {b}: {apart}");
            }
        }
    }

    #[test]
    fn colours_are_hexadecimal() {
        assert_eq!(Colour(0, 0x72, 0xb2).to_string(), "#0072b2");
    }
}
