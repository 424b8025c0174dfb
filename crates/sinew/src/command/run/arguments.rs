//! Arguments of `sinew run`.

use std::path::PathBuf;

use sinew_core::OptionValue;

use crate::command::own_file::Force;
use crate::command::scene_with::Values;

/// A scene and the destination of the results.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    pub(super) scene: PathBuf,
    /// The folder for fields, tables, summary and report: a new one, or that of an earlier run, whose results are kept
    /// next to it as DIR.old until the new ones are complete
    #[arg(long, value_name = "DIR", conflicts_with = "probes")]
    pub(super) out: Option<PathBuf>,
    /// Discard a run in DIR that was not completed and that `sinew resume` could continue
    #[arg(long, requires = "out")]
    pub(super) again: bool,
    /// The CSV file for the motion of the probes: a new file or an earlier table of probes, a device or a
    /// pipe, or - for standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(super) probes: PathBuf,
    #[command(flatten)]
    pub(super) force: Force,
    /// The largest number of threads for methods that machines run, or auto for one per processor: fewer if more do not
    /// help, and the same bits for every number [default: that of the scene, or auto]
    #[arg(long, value_name = "N|auto", value_parser = threads)]
    pub(super) threads: Option<OptionValue>,
    /// Repeat a session by its log, bit for bit: with --out the motion since its last reset as a folder, else as the motion of the
    /// probes; --threads does not go with it
    #[arg(long, value_name = "LOG", conflicts_with = "threads")]
    pub(super) replay: Option<PathBuf>,
    /// Make warnings errors, before the run begins
    #[arg(long)]
    pub(super) strict: bool,
    #[command(flatten)]
    pub(super) values: Values,
}

/// A number of threads as written on a command line.
pub(crate) fn threads(text: &str) -> Result<OptionValue, &'static str> {
    const EXPECTED: &str = "expected a whole number from 1 on, or auto";
    if text == "auto" {
        return Ok(OptionValue::Text(text.to_owned()));
    }
    match text.parse::<u32>() {
        Ok(count) if count > 0 => Ok(OptionValue::Number(f64::from(count))),
        _ => Err(EXPECTED),
    }
}
