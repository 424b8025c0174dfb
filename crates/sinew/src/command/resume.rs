//! `sinew resume`.

use std::path::PathBuf;

use sinew_core::OptionValue;
use sinew_record::RunFolder;
use sinew_scene::output::complain;
use sinew_world::World;

use super::Failure;
use super::interruption::Interruption;
use super::run::{in_folder, integrator, threads};
use super::scene_with::limit_memory;

/// The folder of a run.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The folder that `sinew run --out` named.
    folder: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let is_settled = RunFolder::settle(&arguments.folder)?;
    let (folder, scene) = RunFolder::reopen(&arguments.folder)?;
    if is_settled || folder.is_finished()? {
        complain("the run in it has ended: there is nothing to continue");
        return Ok(());
    }
    limit_memory(&scene);
    let mut simulation = scene.build()?;
    simulation.end_at_duration();
    let asked: Option<OptionValue> = folder.threads().and_then(|text| threads(text).ok());
    let integrator = integrator(&simulation, asked.as_ref())?;
    let mut world = World::following(simulation, integrator)?;
    in_folder(&arguments.folder, &folder, &mut world, interruption)
}
