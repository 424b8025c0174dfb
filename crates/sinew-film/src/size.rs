//! Width and height of pictures.

use std::str::FromStr;

use crate::FilmError;

/// The smallest width and height.
const LEAST: usize = 64;

/// The largest width and height: eight thousand lines.
const MOST: usize = 8192;

/// Width and height of pictures in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    width: usize,
    height: usize,
}

impl Size {
    /// A size.
    ///
    /// # Errors
    /// [`FilmError::Size`] for pictures that are too small for their labels, or too large.
    pub fn new(width: usize, height: usize) -> Result<Self, FilmError> {
        let fits = |length| (LEAST..=MOST).contains(&length);
        match fits(width) && fits(height) {
            true => Ok(Self { width, height }),
            false => Err(refused(&format!("{width}x{height}"))),
        }
    }

    /// Pixels from left to right.
    #[must_use]
    pub fn width(self) -> usize {
        self.width
    }

    /// Pixels from top to bottom.
    #[must_use]
    pub fn height(self) -> usize {
        self.height
    }

    /// The same size rounded down to even numbers of rows and columns, which most mp4 films need.
    #[must_use]
    pub fn even(self) -> Self {
        Self {
            width: self.width & !1,
            height: self.height & !1,
        }
    }
}

impl FromStr for Size {
    type Err = FilmError;

    fn from_str(text: &str) -> Result<Self, FilmError> {
        let sides = text.trim().split_once(['x', 'X']);
        let sides =
            sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
        let (width, height) = sides.ok_or_else(|| refused(text))?;
        Self::new(width, height)
    }
}

fn refused(asked: &str) -> FilmError {
    FilmError::Size {
        asked: asked.to_owned(),
        least: LEAST,
        most: MOST,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_two_numbers_within_bounds() {
        let size = "1280x720"
            .parse::<Size>()
            .map(|size| (size.width(), size.height()));
        assert_eq!(size.ok(), Some((1280, 720)));
        for text in [
            "0x0", "720", "1280x", "64x8193", "-640x480", "1e3x500", "axb",
        ] {
            let said = text.parse::<Size>().map_err(|error| error.to_string());
            let said = said.expect_err(text);
            assert!(
                said.contains("such as 1280x720, each between 64 and 8192"),
                "{said}"
            );
        }
    }
}
