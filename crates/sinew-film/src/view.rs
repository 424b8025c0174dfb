//! The direction of view.

use std::str::FromStr;

use crate::FilmError;

/// A direction of view. The body's z axis points up in it, y for views from above and below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Rotation (degrees) about z: 0 looks along y, 90 against x.
    pub azimuth: f64,
    /// Height (degrees) above the plane of x and y: 90 looks down.
    pub elevation: f64,
    /// True if farther objects look smaller. Otherwise a length is the same everywhere.
    pub is_perspective: bool,
}

/// Views with a name: azimuth, elevation, and true for a perspective view.
const NAMED: [(&str, f64, f64, bool); 6] = [
    ("front", 0.0, 0.0, false),
    ("right", 90.0, 0.0, false),
    ("back", 180.0, 0.0, false),
    ("left", 270.0, 0.0, false),
    ("top", 0.0, 90.0, false),
    ("iso", 32.0, 26.0, true),
];

/// Another word for a view.
const SIDE: (&str, &str) = ("side", "right");

impl View {
    /// The view from the front, the right and above.
    #[must_use]
    pub fn iso() -> Self {
        Self::named("iso").unwrap_or(Self {
            azimuth: 32.0,
            elevation: 26.0,
            is_perspective: true,
        })
    }

    fn named(name: &str) -> Option<Self> {
        let name = if name == SIDE.0 { SIDE.1 } else { name };
        let found = NAMED.iter().find(|view| view.0 == name);
        found.map(|&(_, azimuth, elevation, is_perspective)| Self {
            azimuth,
            elevation,
            is_perspective,
        })
    }
}

impl FromStr for View {
    type Err = FilmError;

    fn from_str(text: &str) -> Result<Self, FilmError> {
        let asked = text.trim();
        if let Some(view) = Self::named(asked) {
            return Ok(view);
        }
        let angles = asked.split_once(',').and_then(|(azimuth, elevation)| {
            let number = |text: &str| text.trim().parse::<f64>().ok();
            Some((number(azimuth)?, number(elevation)?))
        });
        match angles {
            Some((azimuth, elevation)) if azimuth.is_finite() && elevation.abs() <= 90.0 => {
                Ok(Self {
                    azimuth,
                    elevation,
                    is_perspective: true,
                })
            }
            _ => Err(FilmError::View {
                asked: asked.to_owned(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_angles_are_views() {
        let view = |text: &str| {
            text.parse::<View>()
                .map(|view| (view.azimuth, view.elevation))
        };
        assert_eq!(view("top").ok(), Some((0.0, 90.0)));
        assert_eq!(view("side").ok(), view("right").ok());
        assert_eq!(view("-40, 15").ok(), Some((-40.0, 15.0)));
    }

    #[test]
    fn what_is_no_view_is_said_with_what_was_expected() {
        for text in ["", "behind", "30", "30,91", "30,20,10", "nan,0", "inf,0"] {
            let said = text.parse::<View>().map_err(|error| error.to_string());
            let said = said.expect_err(text);
            assert!(said.contains("expected front, back"), "{said}");
        }
    }
}
