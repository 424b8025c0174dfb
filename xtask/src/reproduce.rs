//! `cargo xtask reproduce`.

use std::path::PathBuf;

use sinew_bench::reproduce::{Reproduction, reproduce};
use sinew_bench::scene_files;
use sinew_measure::Case;
use sinew_scene::output::{OutputFolder, say};

use crate::failure::Failure;
use crate::repository::root;

/// The folder for the results.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The folder for the figures and the table [default: target/reproduce]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = |name: &str| root().join("scenes").join(name);
    let scenes = [scene("paper-oscillator.toml"), scene("paper-cube.toml")];
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| root().join("target").join("reproduce"));
    let folder = OutputFolder::new(out, &scene_files(&scenes));
    folder.check(&Reproduction::output_files())?;
    let [mut oscillator, mut cube] = {
        let [oscillator, cube] = scenes.map(|scene| Case::load(&scene).map_err(Failure::input));
        [oscillator?, cube?]
    };
    let reproduction = reproduce(&mut oscillator, &mut cube).map_err(Failure::chore)?;
    let written = reproduction.write(&folder)?;
    for claim in &reproduction.claims {
        let (place, says, verdict) = (claim.place, claim.says, claim.holds.word());
        say(&format!(
            "{place}: {says}\n    {verdict}: {}",
            claim.measured
        ))?;
    }
    say(&format!(
        "page:    {}\ntable:   {}\nfigures: {}",
        written.page.display(),
        written.claims.display(),
        folder.path().display()
    ))?;
    Ok(())
}
