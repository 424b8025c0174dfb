//! `sinew run`.

use std::cell::RefCell;
use std::path::Path;

use sinew_core::{
    Integrator, OptionError, OptionValue, Outcome, Recorders, Run, RunReport, StepReport,
};
use sinew_integrators::Stepper;
use sinew_measure::Forecast;
use sinew_record::{
    Companion, EnergyGrowth, EnergyLoss, FrameLooks, Looked, Request, RunFolder, words_of_cuts,
};
use sinew_scene::output::{Delivery, Destination, Tenant, Voice, complain};
use sinew_scene::{
    Probe, ProbeCsv, ProbeRows, Quantity, Reaction, Scene, Seen, Simulation, Warning, WarningKind,
};

mod arguments;
pub(crate) mod replay;
mod words;

pub(crate) use self::arguments::{Arguments, threads};

use self::words::{summary, summary_of};

use super::Failure;
use super::interruption::Interruption;
use super::onlooker::Onlooker;
use super::scene_with::limit_memory;

/// Predicted time (s) of a run beyond which its user is warned.
pub(crate) const LONG: f64 = 60.0;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let scene = arguments.values.load(&arguments.scene)?;
    let destination = match &arguments.out {
        Some(folder) => {
            check_folder(folder, &scene, arguments.replay.as_deref(), arguments.again)?;
            None
        }
        None => {
            let mut inputs = scene.input_files();
            inputs.extend(arguments.replay.clone());
            let destination = Destination::new(&arguments.probes, &inputs)?;
            arguments.force.check(&destination, || {
                ProbeCsv::is_table(&arguments.probes).unwrap_or(false)
            })?;
            Some(destination)
        }
    };
    if let Some(log) = &arguments.replay {
        return replay::run(arguments, scene, log, destination, interruption);
    }
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
            simulation.set_up(&mut *integrator)?;
            let request = Request {
                threads: arguments.threads.as_ref().map(in_words),
                warnings: warnings.iter().map(ToString::to_string).collect(),
                values: arguments.values.assignments(),
                again: arguments.again,
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

/// Checks that a run of a scene, or a replay by a log, may write into a folder, and says where it replaces an earlier one.
pub(crate) fn check_folder(
    path: &Path,
    scene: &Scene,
    log: Option<&Path>,
    again: bool,
) -> Result<(), Failure> {
    let shown = path.display();
    match RunFolder::check(path, scene, log, again)? {
        Tenant::Nobody => {}
        Tenant::Earlier => complain(&format!(
            "{shown}: the results of an earlier run in it are kept beside it, with .old, until the new ones are complete"
        )),
        Tenant::Unfinished => complain(&format!(
            "{shown}: what a run that was not completed left in it will be removed"
        )),
    }
    Ok(())
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
    Failure::of_end(end.ended, simulation, || {
        format!("; `sinew resume {}` goes on", path.display())
    })
}

/// Runs a scene into an empty folder, which nobody reads but a comparison.
pub(crate) fn run_for_comparison(
    scene: &Path,
    folder: &Path,
    interruption: Interruption,
) -> Result<(), Failure> {
    let loaded = Scene::load(scene)?;
    limit_memory(&loaded);
    let mut simulation = loaded.build()?;
    if let Some(refused) = simulation.refused_load() {
        return Err(refused.into());
    }
    for warning in simulation.warnings() {
        complain(&format!("{}: warning: {warning}", scene.display()));
    }
    simulation.end_at_duration();
    let mut integrator = integrator(&simulation, None)?;
    simulation.set_up(&mut *integrator)?;
    let folder = RunFolder::create(folder, &simulation, &Request::default())?;
    let duration = simulation.settings().duration;
    let mut onlooker = Onlooker::new(interruption, simulation.run().steps, duration);
    let end = folder.run(&simulation, &mut *integrator, &mut onlooker);
    onlooker.finish();
    Failure::of_end(end?.ended, &simulation, String::new)
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
    simulation.set_up(integrator)?;
    let cutter = simulation.cutter()?.map(RefCell::new);
    let rows = ProbeRows::new(simulation);
    let whole = simulation.run();
    let steps = (whole.steps, simulation.dt());
    let schedule = words::schedule(simulation, &rows, steps, destination.is_kept())?;
    let mut output = ProbeCsv::new(destination.open()?, rows, schedule)?.without_rows();
    let mut state = simulation.initial_state().clone();
    let mut onlooker = Onlooker::new(interruption, whole.steps, simulation.settings().duration);
    let mut growth = EnergyGrowth::new(simulation);
    let mut looked = Looked::default();
    let mut loss = EnergyLoss::new(simulation, integrator);
    // The scene on the body as cuts left it.
    let mut cut: Option<Simulation> = None;
    let mut taken = RunReport {
        outcome: Outcome::Finished,
        steps: 0,
        work: StepReport::default(),
    };
    let (csv, report, simulation) = loop {
        let now = cut.as_ref().unwrap_or(simulation);
        let mut csv = output.with_rows(ProbeRows::new(now));
        let mut looks = FrameLooks::new(now, std::mem::take(&mut looked));
        let mut recorders = Recorders::new()
            .with_lent(&mut csv)
            .with_lent(&mut looks)
            .with_lent(&mut onlooker);
        if cutter.is_none() {
            recorders = recorders.with_lent(&mut growth).with_lent(&mut loss);
        }
        let seen = Seen {
            steps: taken.steps,
            beginning: cut.is_some(),
        };
        let run = Run {
            steps: whole.steps - taken.steps,
            ..whole
        };
        let integrator: &mut dyn Integrator = integrator;
        let moving = (cutter.as_ref(), integrator, &mut state);
        let stretch = now.stretch(moving, &run, (&mut recorders, seen));
        drop(recorders);
        looked = looks.into_looked();
        let stretch = match stretch {
            Ok(stretch) => stretch,
            Err(error) => break (csv, Err(error), now),
        };
        taken.steps += stretch.report.steps;
        taken.work += stretch.report.work;
        taken.outcome = stretch.report.outcome;
        let Some(change) = stretch.change else {
            break (csv, Ok(taken), now);
        };
        output = csv.without_rows();
        cut = Some(change.simulation);
    };
    onlooker.finish();
    let system = simulation.system();
    let outrun = simulation.outrun(integrator, &state);
    let mut left = simulation.left_by_tools(&state);
    let cutters = cutter.iter();
    left.extend(cutters.flat_map(|cutter| cutter.borrow().left_by_strokes()));
    // Where the reader of the motion closed its pipe, nobody wants a summary.
    let is_wanted = report.is_err() || csv.finish()? == Delivery::Whole;
    let of_motion = looked.warnings().into_iter().chain(loss.in_words());
    let of_motion = growth
        .in_words()
        .map(str::to_owned)
        .into_iter()
        .chain(of_motion);
    for warning in of_motion.chain(outrun).chain(left).filter(|_| is_wanted) {
        complain(&format!("warning: {warning}"));
    }
    let report = report?;
    if is_wanted {
        voice.say(&summary(simulation, &report))?;
        if let Some(cutter) = &cutter {
            let cutter = cutter.borrow();
            let words = words_of_cuts(cutter.totals(), cutter.pieces());
            voice.say(&format!("cut: {words}"))?;
        }
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
        // Where it diverged there is no motion to hold.
        let reactions = match report.outcome {
            Outcome::Diverged { .. } => Vec::new(),
            _ => simulation.reactions(&state)?,
        };
        for Reaction { by, on, force } in reactions {
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
            remedy: simulation.after_divergence(),
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
    let id = &simulation.settings().integrator;
    let options = sinew_integrators::with_threads(id, &simulation.options(), threads);
    sinew_integrators::build(id, &options)
}

/// An option as a command line has it.
fn in_words(threads: &OptionValue) -> String {
    match threads {
        OptionValue::Number(count) => count.to_string(),
        OptionValue::Text(text) => text.clone(),
        other => format!("{other:?}"),
    }
}
