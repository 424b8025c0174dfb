//! Length of a film and number of its pictures.

use crate::FilmError;

/// The lowest and the highest rate of pictures (1/s).
const RATES: [f64; 2] = [0.1, 120.0];

/// The shortest and the longest film (s) unless another length is requested.
const LENGTHS: [f64; 2] = [4.0, 12.0];

/// The largest number of pictures of a film.
const MOST: usize = 5000;

/// Pictures per second, and the length of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    fps: f64,
    pictures: usize,
}

impl Timing {
    /// Pictures of the times `span` (s) at a rate (1/s), in a film of the length `seconds`. Without a length the film is as
    /// long as the motion, but at least 4 s and at most 12 s.
    ///
    /// # Errors
    /// [`FilmError`] for a rate or a length that is not valid, and for too many pictures.
    pub fn new(span: [f64; 2], fps: f64, seconds: Option<f64>) -> Result<Self, FilmError> {
        let [least, most] = RATES;
        if !(fps >= least && fps <= most) {
            return Err(FilmError::Rate {
                asked: fps,
                least,
                most,
            });
        }
        let [shortest, longest] = LENGTHS;
        let [first, last] = span;
        let seconds = match seconds {
            Some(asked) if !(asked > 0.0 && asked.is_finite()) => {
                return Err(FilmError::Length { asked });
            }
            Some(asked) => asked,
            None => (last - first).clamp(shortest, longest),
        };
        let pictures = (seconds * fps).round().max(1.0);
        if pictures > MOST as f64 {
            let most = MOST;
            return Err(FilmError::TooLong { seconds, fps, most });
        }
        Ok(Self {
            fps,
            // What does not move needs no film.
            pictures: if last > first { pictures as usize } else { 1 },
        })
    }

    /// Pictures per second.
    #[must_use]
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// The number of pictures.
    #[must_use]
    pub fn pictures(&self) -> usize {
        self.pictures
    }

    /// Times (s) of the pictures, including the first and the last of the span.
    #[must_use]
    pub fn instants(&self, [first, last]: [f64; 2]) -> Vec<f64> {
        let ways = self.pictures.saturating_sub(1).max(1);
        let at = |picture: usize| first + (last - first) * (picture as f64 / ways as f64);
        (0..self.pictures).map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_lasts_as_long_as_the_motion_within_bounds() {
        let pictures = |last: f64, seconds| {
            Timing::new([0.0, last], 25.0, seconds)
                .map(|timing| timing.pictures())
                .ok()
        };
        assert_eq!(pictures(5.0, None), Some(125));
        assert_eq!(pictures(0.8, None), Some(100));
        assert_eq!(pictures(60.0, None), Some(300));
        assert_eq!(pictures(0.8, Some(2.0)), Some(50));
        assert_eq!(pictures(0.0, None), Some(1));
        let instants =
            Timing::new([1.0, 2.0], 1.0, Some(3.0)).map(|timing| timing.instants([1.0, 2.0]));
        assert_eq!(instants.ok(), Some(vec![1.0, 1.5, 2.0]));
    }

    #[test]
    fn rates_and_lengths_without_sense_are_refused() {
        for (fps, seconds) in [
            (0.0, None),
            (-1.0, None),
            (f64::NAN, None),
            (1e3, None),
            (25.0, Some(0.0)),
            (25.0, Some(1e9)),
        ] {
            let said = Timing::new([0.0, 1.0], fps, seconds).map_err(|error| error.to_string());
            assert!(
                said.is_err_and(|said| said.contains("--")),
                "{fps} {seconds:?}"
            );
        }
    }
}
