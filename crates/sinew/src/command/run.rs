//! `sinew run`.

use std::path::{Path, PathBuf};

use sinew_core::{OptionError, OptionValue, Outcome, Recorders, RunReport, simulate};
use sinew_integrators::Stepper;
use sinew_measure::Forecast;
use sinew_record::{Companion, Ended, EnergyGrowth, Request, RunEnd, RunFolder};
use sinew_scene::output::{Delivery, Destination, Tenant, Voice, complain};
use sinew_scene::{
    Probe, ProbeCsv, ProbeRows, Quantity, Reaction, Scene, Simulation, Warning, WarningKind,
};

use super::Failure;
use super::interruption::Interruption;
use super::onlooker::Onlooker;
use super::scene_with::Values;

/// Predicted time (s) of a run beyond which its user is warned.
pub(crate) const LONG: f64 = 60.0;

/// What no run knows of itself.
fn error_not_known(simulation: &Simulation) -> String {
    let how = simulation.how_to_know_the_error();
    format!("the error of this run is not known: {how}")
}

/// A scene and the destination of what the run gives.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file.
    scene: PathBuf,
    /// The folder for fields, tables, summary and report: a new one, or that of an earlier run, which
    /// is replaced
    #[arg(long, value_name = "DIR", conflicts_with = "probes")]
    out: Option<PathBuf>,
    /// The CSV file for the motion of the probes: a new file, a writable file that the run does not
    /// read, a device or a pipe, or - for standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    probes: PathBuf,
    /// The largest number of threads for methods that machines run, or auto for one a processor: fewer
    /// where they do not pay, and the same bits for every number [default: that of the scene, or auto]
    #[arg(long, value_name = "N|auto", value_parser = threads)]
    threads: Option<OptionValue>,
    /// Make warnings errors, before the run begins
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    values: Values,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let scene = arguments.values.load(&arguments.scene)?;
    let destination = match &arguments.out {
        Some(folder) => {
            if RunFolder::check(folder, &scene)? == Tenant::Earlier {
                let path = folder.display();
                complain(&format!(
                    "{path}: the results of an earlier run in it will be replaced"
                ));
            }
            None
        }
        None => Some(Destination::new(&arguments.probes, &scene.input_files())?),
    };
    let mut simulation = scene.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(refused.into());
    }
    let mut warnings = simulation.warnings();
    if arguments.out.is_some() {
        // A folder shows the motion of all nodes.
        warnings.retain(|warning| warning.kind != WarningKind::NoProbe);
    }
    for warning in &warnings {
        complain(&format!("warning: {warning}"));
    }
    if arguments.strict {
        Failure::of_warnings(&warnings)?;
    }
    simulation.end_at_duration();
    let mut integrator = integrator(&simulation, arguments.threads.as_ref())?;
    // What ends a first step with an error will end the run with it. The folder does not keep a warning that depends on the computer.
    if let Ok(Some(forecast)) = Forecast::of_long_run(&simulation, &mut *integrator, LONG) {
        let long = Warning::long_run(forecast.run_s(), forecast.steps, forecast.dt);
        complain(&format!("warning: {long}"));
        if arguments.strict {
            Failure::of_warnings(&[long])?;
        }
    }
    match (destination, &arguments.out) {
        (None, Some(path)) => {
            // Before the folder is made, so that what cannot run leaves none.
            integrator.prepare(simulation.system(), simulation.dt())?;
            let request = Request {
                threads: arguments.threads.as_ref().map(in_words),
                warnings: warnings.iter().map(ToString::to_string).collect(),
                values: arguments.values.assignments(),
            };
            let folder = RunFolder::create(path, &simulation, &request)?;
            in_folder(path, &folder, &simulation, &mut *integrator, interruption)
        }
        (Some(destination), _) => {
            let path = &arguments.probes;
            probes_alone(
                path,
                destination,
                &simulation,
                &mut *integrator,
                interruption,
            )
        }
        (None, None) => Ok(()),
    }
}

/// Runs a simulation into its folder and says what came out.
pub(crate) fn in_folder(
    path: &Path,
    folder: &RunFolder,
    simulation: &Simulation,
    integrator: &mut dyn Stepper,
    interruption: Interruption,
) -> Result<(), Failure> {
    let duration = simulation.settings().duration;
    let mut onlooker = Onlooker::new(interruption, simulation.run().steps, duration);
    let end = folder.run(simulation, integrator, &mut onlooker);
    onlooker.finish();
    let end = end?;
    for line in summary_of(simulation, &end, path) {
        complain(&line);
    }
    match end.ended {
        Ended::Finished => Ok(()),
        Ended::Diverged { t, place } => Err(Failure::Diverged { t, place }),
        Ended::Refused { t, reason } => Err(Failure::Refused { t, reason }),
        Ended::Interrupted { t } => Err(Failure::Interrupted {
            t,
            remedy: format!("; `sinew resume {}` goes on", path.display()),
        }),
    }
}

/// Runs a scene into an empty folder, which nobody reads but a comparison.
pub(crate) fn run_for_comparison(
    scene: &Path,
    folder: &Path,
    interruption: Interruption,
) -> Result<(), Failure> {
    let mut simulation = Scene::load(scene)?.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(refused.into());
    }
    for warning in simulation.warnings() {
        complain(&format!("{}: warning: {warning}", scene.display()));
    }
    simulation.end_at_duration();
    let mut integrator = integrator(&simulation, None)?;
    integrator.prepare(simulation.system(), simulation.dt())?;
    let folder = RunFolder::create(folder, &simulation, &Request::default())?;
    let duration = simulation.settings().duration;
    let mut onlooker = Onlooker::new(interruption, simulation.run().steps, duration);
    let end = folder.run(&simulation, &mut *integrator, &mut onlooker);
    onlooker.finish();
    match end?.ended {
        Ended::Finished => Ok(()),
        Ended::Diverged { t, place } => Err(Failure::Diverged { t, place }),
        Ended::Refused { t, reason } => Err(Failure::Refused { t, reason }),
        Ended::Interrupted { t } => Err(Failure::Interrupted {
            t,
            remedy: String::new(),
        }),
    }
}

/// A line about steps that were taken again, where there were any.
fn retaken(times: u64) -> Option<String> {
    (times > 0).then(|| {
        format!("{times} times a step was taken again in shorter parts, because the body stiffened within it")
    })
}

/// At most sixteen lines about a run.
fn summary_of(simulation: &Simulation, end: &RunEnd, path: &Path) -> Vec<String> {
    let (steps, wall) = end.own;
    let own = steps as f64 * simulation.dt();
    let (sweeps, solves) = end.work;
    let mut lines = vec![
        format!(
            "{}: {} steps of {} s by `{}`: {sweeps} sweeps, {solves} solves",
            simulation.scene().title(),
            end.steps,
            simulation.dt(),
            simulation.settings().integrator,
        ),
        format!(
            "{own:.4} s in {wall:.2} s, outputs included: {:.3} times real time",
            own / wall.max(1e-9)
        ),
    ];
    if simulation.model().body().is_some() {
        let (u, t, node) = end.largest;
        lines.push(format!(
            "largest displacement in {} frames: {u:.6e} m at t = {t:.6} s, node {node}",
            end.frames
        ));
    }
    if end.saturated > 0.0 {
        lines.push(format!(
            "guarded: {:.3} % of all velocities were saturated; the motion is bounded, not accurate",
            100.0 * end.saturated
        ));
    }
    lines.extend(retaken(end.retaken));
    lines.extend(end.remarks.iter().cloned());
    let warnings = end.warnings.iter();
    lines.extend(warnings.map(|warning| format!("warning: {warning}")));
    lines.push(error_not_known(simulation));
    lines.push(format!(
        "{}: report.html, fields.pvd for ParaView, tables, summary.json",
        path.display()
    ));
    lines
}

/// Runs a simulation and writes the motion of its probes alone.
fn probes_alone(
    path: &Path,
    destination: Destination,
    simulation: &Simulation,
    integrator: &mut dyn Stepper,
    interruption: Interruption,
) -> Result<(), Failure> {
    let voice = Voice::apart_from(&destination);
    let system = simulation.system();
    integrator.prepare(system, simulation.dt())?;
    let mut csv = ProbeCsv::new(destination.open()?, ProbeRows::new(simulation))?;
    let mut state = simulation.initial_state().clone();
    let settings = simulation.run();
    let mut onlooker = Onlooker::new(interruption, settings.steps, simulation.settings().duration);
    let mut growth = EnergyGrowth::new(simulation);
    let mut recorders = Recorders::new()
        .with_lent(&mut csv)
        .with_lent(&mut growth)
        .with_lent(&mut onlooker);
    let report = simulate(system, integrator, &mut state, &settings, &mut recorders);
    drop(recorders);
    onlooker.finish();
    let outrun = simulation.outrun(integrator, &state);
    let left = simulation.left_in_tools(&state);
    let left = left.iter().map(String::as_str);
    for warning in growth
        .in_words()
        .into_iter()
        .chain(outrun.as_deref())
        .chain(left)
    {
        complain(&format!("warning: {warning}"));
    }
    let report = report?;
    // Where the reader of the motion closed its pipe, nobody wants a summary.
    if csv.finish()? == Delivery::Whole {
        voice.say(&summary(simulation, &report))?;
        for remark in integrator.computed_by().iter().chain(&integrator.remarks()) {
            voice.say(remark)?;
        }
        let displaced = |probe: &&Probe| probe.quantity == Quantity::Displacement;
        for probe in simulation.probes().iter().filter(displaced) {
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
        if voice == Voice::StandardOutput {
            voice.say(&format!("probes: {}", path.display()))?;
        }
    }
    match report.outcome {
        Outcome::Diverged { t, dof } => Err(Failure::Diverged {
            t,
            place: system.cell_name(dof),
        }),
        Outcome::Stopped if onlooker.is_interrupted() => Err(Failure::Interrupted {
            t: state.t(),
            remedy: String::new(),
        }),
        Outcome::Finished | Outcome::Stopped => Ok(()),
    }
}

/// The scene's integrator with as many threads as were asked for, or as the scene asks for, or as help. Methods that no
/// machine runs have none.
pub(crate) fn integrator(
    simulation: &Simulation,
    threads: Option<&OptionValue>,
) -> Result<Box<dyn Stepper>, OptionError> {
    const KEY: &str = "threads";
    let settings = simulation.settings();
    let mut options = simulation.options();
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

/// An option as a command line has it.
fn in_words(threads: &OptionValue) -> String {
    match threads {
        OptionValue::Number(count) => count.to_string(),
        OptionValue::Text(text) => text.clone(),
        other => format!("{other:?}"),
    }
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
    for line in retaken(work.retaken)
        .into_iter()
        .chain([error_not_known(simulation)])
    {
        text.push('\n');
        text.push_str(&line);
    }
    text
}
