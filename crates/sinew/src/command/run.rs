//! `sinew run`.

use std::path::{Path, PathBuf};

use sinew_core::{Outcome, RunReport, simulate};
use sinew_scene::output::{Delivery, Destination, Voice, complain};
use sinew_scene::{ProbeCsv, Scene, Simulation};

use super::Failure;

/// A scene and where its probes go.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// Where the motion of the probes goes, as CSV: a new file, a writable file that is no input, a
    /// device or a pipe, or - for standard output [default: the scene's name with .csv, here]
    #[arg(long, value_name = "FILE")]
    probes: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::load(&arguments.scene)?;
    let path = match &arguments.probes {
        Some(path) => path.clone(),
        None => default_probes(&arguments.scene),
    };
    let destination = Destination::new(&path, &scene.input_files())?;
    let voice = Voice::beside(&destination);

    let simulation = scene.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(Failure::Input(refused));
    }
    let plan = simulation.plan();
    for warning in &plan.warnings {
        complain(&format!("warning: {warning}"));
    }
    let mut integrator = simulation
        .integrator()
        .map_err(|error| Failure::Input(error.to_string()))?;
    let system = simulation.system();
    integrator
        .prepare(system, simulation.dt())
        .map_err(|error| Failure::Input(error.to_string()))?;
    let mut csv = ProbeCsv::new(destination.open()?, simulation.probes())?;
    let mut state = simulation.initial_state().clone();
    let settings = simulation.run();
    let report = simulate(system, &mut *integrator, &mut state, &settings, &mut csv)
        .map_err(|error| Failure::Run(error.to_string()))?;
    // Nobody is left to read of the run where the reader of its motion went away.
    if csv.finish()? == Delivery::Whole {
        voice.say(&summary(&simulation, &report))?;
        for remark in integrator.remarks() {
            voice.say(&remark)?;
        }
        for probe in simulation.probes() {
            let u: Vec<String> = probe
                .displacement(&state.u)
                .map(|u| format!("{u:.6e}"))
                .collect();
            voice.say(&format!(
                "{}: u = ({}) m at t = {:.6} s",
                probe.name,
                u.join(", "),
                state.t()
            ))?;
        }
        voice.say(&format!("probes: {}", path.display()))?;
    }
    match report.outcome {
        Outcome::Diverged { t, cell } => Err(Failure::Run(format!(
            "the run diverged at t = {t:.6} s, first at {}; `sinew plan` names the stable step",
            system.cell_name(cell)
        ))),
        Outcome::Finished | Outcome::Stopped => Ok(()),
    }
}

/// The scene's name with .csv for its extension, of which only the last is one.
fn default_probes(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or_default().to_owned();
    name.push(".csv");
    name.into()
}

fn summary(simulation: &Simulation, report: &RunReport) -> String {
    let settings = simulation.settings();
    let pairs = report.steps as f64 * simulation.system().dofs() as f64;
    let work = report.work;
    let mut text = format!(
        "{}: {} steps of {} s by `{}`: {} sweeps, {} solves",
        simulation.scene().title(),
        report.steps,
        simulation.dt(),
        settings.integrator,
        work.sweeps,
        work.solves
    );
    if work.saturated > 0 {
        let share = 100.0 * work.saturated as f64 / pairs;
        text.push_str(&format!(
            "\nguarded: {share:.3} % of all velocities were saturated; the motion is bounded, not accurate"
        ));
    }
    text.push_str(
        "\nno error is known without a reference: `cargo xtask bench --scene` measures it",
    );
    text
}
