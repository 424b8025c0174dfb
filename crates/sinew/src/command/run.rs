//! `sinew run`.

use std::path::Path;
use std::sync::Arc;

use sinew_core::{OptionError, OptionValue};
use sinew_integrators::Stepper;
use sinew_measure::Forecast;
use sinew_record::{
    Companion, EnergyGrowth, EnergyLoss, FrameLooks, Request, RunFolder, words_of_cuts,
};
use sinew_scene::output::{Delivery, Destination, Tenant, Voice, complain};
use sinew_scene::{
    Cutter, Probe, ProbeCsv, ProbeRows, Quantity, Reaction, Scene, Simulation, Warning, WarningKind,
};
use sinew_world::{Ended, Recorders, World};

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
    // An error of the first step will end the run too, so it is not reported here. The folder does not keep a warning
    // that depends on the computer.
    if let Ok(Some(forecast)) = Forecast::of_long_run(&simulation, &mut *integrator, LONG) {
        let long = Warning::long_run(forecast.run_s(), forecast.steps, forecast.dt);
        complain(&format!("warning: {long}"));
        if arguments.strict {
            Failure::of_warnings(&[long])?;
        }
    }
    let mut world = World::following(simulation, integrator)?;
    // Before a folder is created, so that a run that cannot begin leaves none.
    world.set_up()?;
    match (destination, &arguments.out) {
        (None, Some(path)) => {
            let request = Request {
                threads: arguments.threads.as_ref().map(in_words),
                warnings: warnings.iter().map(ToString::to_string).collect(),
                values: arguments.values.assignments(),
                again: arguments.again,
            };
            let folder = RunFolder::create(path, world.scene(), &request)?;
            in_folder(path, &folder, &mut world, interruption)
        }
        (Some(destination), _) => {
            probes_alone(&arguments.probes, destination, &mut world, interruption)
        }
        (None, None) => Ok(()),
    }
}

/// Checks that a run of a scene, or a replay by a log, may write into a folder, and prints a message if it replaces an
/// earlier one.
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
            "{shown}: the files of an incomplete run in it will be removed"
        )),
    }
    Ok(())
}

/// Runs a world into its folder and prints the outcome.
pub(crate) fn in_folder(
    path: &Path,
    folder: &RunFolder,
    world: &mut World,
    interruption: Interruption,
) -> Result<(), Failure> {
    let mut onlooker = onlooker(world.scene(), interruption);
    let end = folder.run(world, &mut onlooker);
    onlooker.finish();
    let end = end?;
    for line in summary_of(world.scene(), &end, path) {
        complain(&line);
    }
    Failure::of_end(end.ended, world.scene(), || {
        format!("; `sinew resume {}` continues it", path.display())
    })
}

/// Onlooker for a whole run.
fn onlooker(simulation: &Simulation, interruption: Interruption) -> Onlooker {
    let (steps, duration) = (simulation.run().steps, simulation.settings().duration);
    Onlooker::new(interruption, steps, duration)
}

/// Runs a scene into an empty folder, which only the calling command reads.
pub(crate) fn run_for_reader(
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
    let integrator = integrator(&simulation, None)?;
    let mut world = World::following(simulation, integrator)?;
    world.set_up()?;
    let folder = RunFolder::create(folder, world.scene(), &Request::default())?;
    let mut onlooker = onlooker(world.scene(), interruption);
    let end = folder.run(&mut world, &mut onlooker);
    onlooker.finish();
    Failure::of_end(end?.ended, world.scene(), String::new)
}

/// Runs a world and writes the motion of its probes alone.
fn probes_alone(
    path: &Path,
    destination: Destination,
    world: &mut World,
    interruption: Interruption,
) -> Result<(), Failure> {
    let voice = Voice::apart_from(&destination);
    let scene = Arc::clone(world.scene());
    let rows = ProbeRows::new(world.body());
    let steps = scene.run().steps;
    let schedule = words::schedule(&scene, &rows, (steps, scene.dt()), destination.is_kept())?;
    let mut csv = ProbeCsv::new(destination.open()?, rows, schedule)?;
    let mut onlooker = onlooker(&scene, interruption);
    let mut growth = EnergyGrowth::new(&scene);
    let mut looks = FrameLooks::new(&scene);
    let mut loss = EnergyLoss::new(&scene, world.integrator());
    let mut recorders = Recorders::new()
        .with(&mut csv)
        .with(&mut looks)
        .with(&mut onlooker);
    if world.cutter().is_none() {
        recorders = recorders.with(&mut growth).with(&mut loss);
    }
    let mut shown = world.show(&mut recorders);
    let ended = world.advance_shown(steps, &mut shown);
    let (taken, work) = (shown.steps(), shown.work());
    drop(recorders);
    onlooker.finish();
    let (body, state) = (world.body(), world.state());
    let outrun = body.outrun(world.integrator(), scene.dt(), state);
    let mut left = body.left_by_tools(state);
    left.extend(
        world
            .cutter()
            .map_or_else(Vec::new, Cutter::left_by_strokes),
    );
    // Where the reader of the motion closed its pipe, nobody wants a summary.
    let is_wanted = ended.is_err() || csv.finish()? == Delivery::Whole;
    let of_motion = looks.into_looked().warnings().into_iter();
    let of_motion = growth
        .in_words()
        .map(str::to_owned)
        .into_iter()
        .chain(of_motion)
        .chain(loss.in_words());
    for warning in of_motion.chain(outrun).chain(left).filter(|_| is_wanted) {
        complain(&format!("warning: {warning}"));
    }
    let ended = ended.map_err(|error| Failure::of_advance(error, state.t()))?;
    if is_wanted {
        voice.say(&summary(&scene, body, taken, work))?;
        if let Some(cutter) = world.cutter() {
            let words = words_of_cuts(cutter.totals(), cutter.pieces());
            voice.say(&format!("cut: {words}"))?;
        }
        let method = world.integrator();
        for remark in method.computed_by().iter().chain(&method.remarks()) {
            voice.say(remark)?;
        }
        let displaced = |probe: &&Probe| probe.quantity == Quantity::Displacement;
        for probe in body.probes().iter().filter(displaced) {
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
        let reactions = match ended {
            Ended::Diverged { .. } => Vec::new(),
            _ => world.reactions()?,
        };
        for Reaction { by, on, force, .. } in reactions {
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
    match ended {
        Ended::Diverged { t, place } => Err(Failure::Diverged {
            t,
            place,
            remedy: scene.after_divergence(),
        }),
        Ended::Stopped if onlooker.is_interrupted() => Err(Failure::Interrupted {
            t: state.t(),
            remedy: String::new(),
        }),
        Ended::Finished | Ended::Stopped => Ok(()),
    }
}

/// The scene's integrator with the requested number of threads, or that of the scene, or one that helps. Methods that
/// no machine runs have none.
pub(crate) fn integrator(
    simulation: &Simulation,
    threads: Option<&OptionValue>,
) -> Result<Box<dyn Stepper>, OptionError> {
    let id = &simulation.settings().integrator;
    let options = sinew_integrators::with_threads(id, &simulation.options(), threads);
    sinew_integrators::build(id, &options)
}

/// An option as written on a command line.
fn in_words(threads: &OptionValue) -> String {
    match threads {
        OptionValue::Number(count) => count.to_string(),
        OptionValue::Text(text) => text.clone(),
        other => format!("{other:?}"),
    }
}
