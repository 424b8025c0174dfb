//! `cargo xtask live-test`: the live page in a browser without a window.

mod bench;
mod blade;
mod cdp;
mod chromium;
mod drags;
mod fingers;
mod hand;
mod new_tools;
mod picture;
mod served;
mod speed;
mod stage;
mod start;
mod strangers;

use std::path::PathBuf;

use sinew_scene::output::say;
use tempfile::TempDir;

use self::bench::Bench;
use self::chromium::Chromium;
use crate::failure::Failure;
use crate::program;

/// Options of the test.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Ten minutes of input, after which memory must be unchanged
    #[arg(long)]
    long: bool,
    /// Seconds of random input, at least 30: memory is compared with its value after 20
    #[arg(long, value_name = "S", default_value_t = 60, value_parser = clap::value_parser!(u64).range(30..))]
    seconds: u64,
    /// Random drags in ready scenes
    #[arg(long, value_name = "N", default_value_t = 30)]
    drags: u32,
    /// A sinew that is built already, instead of a release build of this one
    #[arg(long, value_name = "PROGRAM")]
    sinew: Option<PathBuf>,
    /// Fail if a mark of speed is missed, instead of only reporting it
    #[arg(long)]
    strict: bool,
    /// Only a picture of the page, with the tool pressed in: that of the README is docs/live.png
    #[arg(long, value_name = "FILE", conflicts_with_all = ["long", "seconds", "strict"])]
    picture: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(program) = chromium::find() else {
        say("live-test: SKIPPED, for no Chromium is installed (apt install chromium)")?;
        return Ok(());
    };
    let sinew = match &arguments.sinew {
        Some(sinew) => sinew.clone(),
        None => program::build()?,
    };
    let folder = TempDir::new().map_err(Failure::chore)?;
    let bench = Bench {
        sinew,
        chromium: Chromium::start(program)?,
        folder,
    };
    if let Some(path) = &arguments.picture {
        return picture::write(&bench, path);
    }
    if let Ok(load) = std::fs::read_to_string("/proc/loadavg") {
        let minute = load.split_whitespace().next().unwrap_or_default();
        say(&format!(
            "load of this computer in the last minute: {minute}"
        ))?;
    }
    start::opens_scenes(&bench)?;
    hand::press_hold_and_switch(&bench)?;
    hand::side_by_side(&bench)?;
    stage::is_set_up(&bench)?;
    new_tools::are_added(&bench)?;
    fingers::press_pull_and_cut(&bench)?;
    blade::cuts(&bench)?;
    drags::end_no_session(&bench, arguments.drags)?;
    strangers::are_refused(&bench)?;
    strangers::do_no_harm(&bench)?;
    strangers::ctrl_c_and_taken_port(&bench)?;
    speed::measure(&bench, arguments.strict)?;
    let seconds = match arguments.long {
        true => 600,
        false => arguments.seconds,
    };
    hand::random_input(&bench, seconds)?;
    say("live-test: all that was asked for holds")?;
    Ok(())
}
