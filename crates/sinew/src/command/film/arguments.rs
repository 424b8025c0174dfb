//! Arguments of `sinew film`.

use std::path::PathBuf;

use crate::command::own_file::Force;

/// A run and the way it is shown.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The folder of a run, as `sinew run SCENE --out DIR` leaves it, or a scene file, which is run and leaves nothing else
    #[arg(value_name = "DIR|SCENE")]
    pub(super) run: PathBuf,
    /// The instant of a single picture, in s; without it the film goes from the first frame to the last
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(super) at: Option<f64>,
    /// Direction of view: front, back, left, right (or side), top, iso, or an azimuth and an elevation in degrees such as
    /// 30,25
    #[arg(
        long,
        value_name = "NAME|AZIMUTH,ELEVATION",
        default_value = "iso",
        allow_hyphen_values = true
    )]
    pub(super) view: String,
    /// Meaning of the colour: tissue, or a field of the run such as displacement, von_mises, stress or
    /// contact_pressure; a component follows a dot, as in displacement.z
    #[arg(long, value_name = "FIELD", default_value = "tissue", alias = "color")]
    pub(super) colour: String,
    /// The values at the ends of a field's colours, in the unit of its array [default: round ones that fit]
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true)]
    pub(super) range: Option<Vec<f64>>,
    /// Width and height in pixels [default: 720x405 for a film as .png, else 1280x720]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    /// Leave out title, time, length and the values of colours, as for a small picture
    #[arg(long)]
    pub(super) bare: bool,
    /// Pictures per second
    #[arg(
        long,
        value_name = "RATE",
        default_value_t = 25.0,
        allow_negative_numbers = true
    )]
    pub(super) fps: f64,
    /// Length of the film in s [default: that of the motion, but at least 4 and at most 12]
    #[arg(
        long,
        value_name = "S",
        allow_negative_numbers = true,
        conflicts_with = "at"
    )]
    pub(super) seconds: Option<f64>,
    /// A file that ends in .png: a picture, or a film that browsers play as they show pictures; one that ends in .mp4:
    /// a film, if ffmpeg is found; or a folder for all pictures, a new one or that of earlier pictures, which is
    /// replaced [default: the name of the run with .png, in the current folder]
    #[arg(long, value_name = "FILE.png|FILE.mp4|DIR")]
    pub(super) out: Option<PathBuf>,
    #[command(flatten)]
    pub(super) force: Force,
}
