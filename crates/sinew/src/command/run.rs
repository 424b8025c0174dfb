//! `sinew run`.

use std::path::{Path, PathBuf};

use sinew_core::{OptionError, OptionValue, Outcome, RunReport, simulate};
use sinew_integrators::Stepper;
use sinew_scene::output::{Delivery, Destination, Voice, complain};
use sinew_scene::{ProbeCsv, Reaction, Scene, Simulation};

use super::Failure;

/// A scene and the destination of its probes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// The CSV file for the motion of the probes: a new file, a writable file that the run does not
    /// read, a device or a pipe, or - for standard output [default: the scene's name with .csv, in
    /// the current folder]
    #[arg(long, value_name = "FILE")]
    probes: Option<PathBuf>,
    /// The largest number of threads for methods that machines run, or auto for one a processor: fewer
    /// where they do not pay, and the same bits for every number [default: that of the scene, or auto]
    #[arg(long, value_name = "N|auto", value_parser = threads)]
    threads: Option<OptionValue>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = Scene::load(&arguments.scene)?;
    let path = match &arguments.probes {
        Some(path) => path.clone(),
        None => default_probes(&arguments.scene),
    };
    let destination = Destination::new(&path, &scene.input_files())?;
    let voice = Voice::apart_from(&destination);

    let simulation = scene.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(refused.into());
    }
    for warning in simulation.warnings() {
        complain(&format!("warning: {warning}"));
    }
    let mut integrator = integrator(&simulation, arguments.threads.as_ref())?;
    let system = simulation.system();
    integrator.prepare(system, simulation.dt())?;
    let mut csv = ProbeCsv::new(destination.open()?, simulation.probes())?;
    let mut state = simulation.initial_state().clone();
    let settings = simulation.run();
    let report = simulate(system, &mut *integrator, &mut state, &settings, &mut csv)?;
    // Where the reader of the motion closed its pipe, nobody wants a summary.
    if csv.finish()? == Delivery::Whole {
        voice.say(&summary(&simulation, &report))?;
        for remark in integrator.computed_by().iter().chain(&integrator.remarks()) {
            voice.say(remark)?;
        }
        for probe in simulation.probes() {
            let u: Vec<String> = probe
                .displacement(state.t(), &state.u)
                .map(|u| format!("{u:.6e}"))
                .collect();
            voice.say(&format!(
                "{}: u = ({}) m at t = {:.6} s",
                probe.name,
                u.join(", "),
                state.t()
            ))?;
        }
        for Reaction { by, on, force } in simulation.reactions(&state)? {
            let force = force.map(|force| format!("{force:.6e}"));
            voice.say(&format!(
                "{by} on {on}: reaction = ({}) N at t = {:.6} s",
                force.join(", "),
                state.t()
            ))?;
        }
        voice.say(&format!("probes: {}", path.display()))?;
    }
    match report.outcome {
        Outcome::Diverged { t, dof } => Err(Failure::Diverged {
            t,
            place: system.cell_name(dof),
        }),
        Outcome::Finished | Outcome::Stopped => Ok(()),
    }
}

/// The scene's integrator with as many threads as were asked for, or as the scene asks for, or as help. Methods that no
/// machine runs have none.
fn integrator(
    simulation: &Simulation,
    threads: Option<&OptionValue>,
) -> Result<Box<dyn Stepper>, OptionError> {
    const KEY: &str = "threads";
    let settings = simulation.settings();
    let mut options = settings.options.clone();
    let programs =
        sinew_integrators::entry(&settings.integrator).is_some_and(|entry| entry.programs);
    match threads {
        Some(threads) => options.insert(KEY, threads.clone()),
        None if programs && options.get(KEY).is_none() => {
            options.insert(KEY, OptionValue::Text("auto".to_owned()));
        }
        None => {}
    }
    sinew_integrators::build(&settings.integrator, &options)
}

fn threads(text: &str) -> Result<OptionValue, &'static str> {
    const EXPECTED: &str = "expected a whole number from 1 on, or auto";
    if text == "auto" {
        return Ok(OptionValue::Text(text.to_owned()));
    }
    match text.parse::<u32>() {
        Ok(count) if count > 0 => Ok(OptionValue::Number(f64::from(count))),
        _ => Err(EXPECTED),
    }
}

/// The scene's file name with .csv in place of its last extension.
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
    text.push_str("\nthe error of this run is not known: `sinew plan --tolerance` measures it");
    text
}
