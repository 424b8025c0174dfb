//! `sinew modes`.

use std::path::PathBuf;

use comfy_table::CellAlignment;
use sinew_record::{NaturalMode, check_modes_folder, natural_modes, write_modes};
use sinew_scene::output::say;
use sinew_scene::{Simulation, Subject};

use super::Failure;
use super::ruled;
use super::scene_with::Values;

/// A scene and the number of its modes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file; its loads determine which modes are reported as excited
    scene: PathBuf,
    /// The number of modes, from the lowest frequency on
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=200))]
    count: u16,
    /// The folder for the table and the mode shapes, a series for ParaView: a new one, or that of earlier
    /// modes, which is replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    values: Values,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.values.load(&arguments.scene)?;
    if let Some(path) = &arguments.out {
        check_modes_folder(path, &scene.input_files())?;
    }
    let mut simulation = scene.build()?;
    if simulation.is_cut_later() {
        say("of the body before it is cut while it moves")?;
    } else {
        simulation = simulation.cut_beforehand()?;
    }
    let modes = natural_modes(&simulation, usize::from(arguments.count))?;
    say(&table(&modes))?;
    if simulation.system().as_linear().is_none() {
        say(
            "of small motions about rest: loads and deformation change the frequencies of this body",
        )?;
    }
    if has_fibres(&simulation) {
        say("without the fibres, which are idle at rest: pulled ones raise the frequencies")?;
    }
    if let Some(path) = &arguments.out {
        write_modes(path, &simulation, &modes)?;
        say(&format!(
            "{}: modes.csv, fields.pvd for ParaView",
            path.display()
        ))?;
    }
    Ok(())
}

fn has_fibres(simulation: &Simulation) -> bool {
    match simulation.scene().subject() {
        Subject::Body(body) => {
            let mut regions = body.problem.regions.iter();
            regions.any(|region| !region.tissue.fibres.is_empty())
        }
        Subject::Oscillator(_) => false,
    }
}

fn table(modes: &[NaturalMode]) -> String {
    let mut table = ruled::table();
    table.set_header([
        "mode",
        "frequency [Hz]",
        "period [s]",
        "mass in x [%]",
        "mass in y [%]",
        "mass in z [%]",
        "of loads [%]",
    ]);
    for (number, mode) in (1..).zip(modes) {
        let [x, y, z] = mode
            .effective_mass
            .map(|share| format!("{:.2}", 100.0 * share));
        let frequency = mode.frequency();
        let period = match frequency > 0.0 {
            true => format!("{:.5}", frequency.recip()),
            false => "rigid".to_owned(),
        };
        let loads = match mode.of_loads.is_finite() {
            true => format!("{:.2}", 100.0 * mode.of_loads),
            false => String::new(),
        };
        table.add_row([
            number.to_string(),
            format!("{frequency:.5}"),
            period,
            x,
            y,
            z,
            loads,
        ]);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}
