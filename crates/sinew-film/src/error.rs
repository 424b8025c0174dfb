//! Errors of films.

use std::io;

/// A run or a request for which no picture can be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// A folder without the list of frames.
    #[error(
        "no frames to show: {name} is not there; a body's run leaves them with `sinew run SCENE --out DIR` when it has come to its end, \
         unless `fields` in [output] says otherwise"
    )]
    NoFrames {
        /// The list's name.
        name: &'static str,
    },
    /// A list of frames without entries.
    #[error(
        "no frames to show: {name} names none; `fields = {{ frames = 50 }}` in [output] of the scene lets a run write 50"
    )]
    EmptySeries {
        /// The list's name.
        name: &'static str,
    },
    /// A clip without frames.
    #[error("no frames to show")]
    NothingToShow,
    /// A film that was stopped before its end.
    #[error("stopped before the film was finished")]
    Stopped,
    /// A file that cannot be read.
    #[error("cannot read {name}: {source}")]
    Read {
        /// The name of the file.
        name: String,
        /// The reason.
        source: io::Error,
    },
    /// A file with unexpected content.
    #[error("{name}: {reason}; run `sinew run SCENE --out DIR` again to write it")]
    Damaged {
        /// The name of the file.
        name: String,
        /// The error in the file.
        reason: String,
    },
    /// A colour for which the run has no field.
    #[error("--colour {asked}: the run has no such field; it has {known}")]
    Colour {
        /// The requested colour.
        asked: String,
        /// List of the available colours.
        known: String,
    },
    /// A view that is not valid.
    #[error(
        "--view {asked}: expected front, back, left, right, top, iso, or an azimuth and an elevation in degrees such as 30,25, the elevation between -90 and 90"
    )]
    View {
        /// The requested view.
        asked: String,
    },
    /// A size that is not valid.
    #[error(
        "--size {asked}: expected WIDTHxHEIGHT in pixels such as 1280x720, each between {least} and {most}"
    )]
    Size {
        /// The requested size.
        asked: String,
        /// The smallest width and height.
        least: usize,
        /// The largest width and height.
        most: usize,
    },
    /// A range that is not valid.
    #[error(
        "--range {from} {to}: expected a number and a larger one, in the unit {unit} of the field"
    )]
    Range {
        /// The lower end.
        from: f64,
        /// The upper end.
        to: f64,
        /// The unit of the field's values.
        unit: String,
    },
    /// A range given for tissue, which shows no field.
    #[error("--range goes with the colour of a field; --colour displacement is one")]
    RangeOfTissue,
    /// A rate of pictures that is not valid.
    #[error("--fps {asked}: expected a number of pictures a second between {least} and {most}")]
    Rate {
        /// The requested rate (1/s).
        asked: f64,
        /// The lowest rate.
        least: f64,
        /// The highest rate.
        most: f64,
    },
    /// A length that is not valid.
    #[error("--seconds {asked}: expected the length of the film in s, above 0")]
    Length {
        /// The requested length (s).
        asked: f64,
    },
    /// More pictures than a film may have.
    #[error(
        "a film of {seconds} s at {fps} pictures a second has more than {most}; --seconds or --fps makes it shorter"
    )]
    TooLong {
        /// Its length (s).
        seconds: f64,
        /// Pictures a second.
        fps: f64,
        /// The largest number of pictures.
        most: usize,
    },
    /// An instant at which there is no frame.
    #[error("--at {asked}: the frames lie between t = {first} s and t = {last} s")]
    Instant {
        /// The requested time (s).
        asked: f64,
        /// Time (s) of the first frame.
        first: f64,
        /// Time (s) of the last frame.
        last: f64,
    },
    /// A picture that could not be written in the format of the file.
    #[error("the picture could not be written as PNG: {0}")]
    Png(#[from] png::EncodingError),
}
