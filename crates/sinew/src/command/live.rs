//! `sinew live`.

mod cards;
mod from_start;
mod papers_cube;
mod recording;

use std::path::{Path, PathBuf};

use sinew_live::{Door, Live, PaneChoice, Settings};
use sinew_scene::output::{Voice, complain};

use self::papers_cube::BESIDE;
use self::recording::Recording;
use super::Failure;
use super::interruption::Interruption;
use super::scene_with::Values;

/// A scene and the port of its page.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file [default: a start page, which offers the ready scenes and the paper's cube]
    scene: Option<PathBuf>,
    /// The port of this computer, or 0 for a free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// A second pane next to the first, with this integrator and the same commands
    #[arg(long, value_name = "ID")]
    beside: Option<String>,
    /// The largest speed of tools that you lead, in m/s [default: a tenth of that of waves in the body]
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true)]
    hand_speed: Option<f64>,
    /// At the end write what `sinew run --out` writes: the motion since the last reset, into DIR, and that of a second pane into DIR-second
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
    #[command(flatten)]
    values: Values,
}

impl Arguments {
    /// The first option that is for a given scene only.
    fn of_scene(&self) -> Option<&'static str> {
        let beside = self.beside.as_ref().map(|_| "--beside");
        let record = self.record.as_ref().map(|_| "--record");
        beside.or(record).or(self.values.first_option())
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    match (&arguments.scene, arguments.of_scene()) {
        (Some(scene), _) => session(arguments, scene, &interruption),
        (None, Some(option)) => Err(Failure::NoScene { option }),
        (None, None) => from_start::run(arguments.port, arguments.hand_speed, &interruption),
    }
}

/// A session with a scene of the user.
fn session(arguments: &Arguments, path: &Path, interruption: &Interruption) -> Result<(), Failure> {
    let scene = arguments.values.load(path)?;
    let pane = |id: &str| PaneChoice {
        integrator: Some(id.to_owned()),
        dt: None,
    };
    let beside = arguments.beside.as_deref().map(pane);
    let recording = arguments
        .record
        .as_ref()
        .map(|path| Recording::new(path, &scene))
        .transpose()?;
    let door = Door::open(arguments.port)?;
    let settings = Settings {
        scene,
        values: arguments.values.assignments(),
        panes: [PaneChoice::default()]
            .into_iter()
            .chain(beside.clone())
            .collect(),
        second: beside.unwrap_or_else(|| pane(BESIDE)),
        hand_speed: arguments.hand_speed,
        from_start: None,
    };
    let mut live = Live::open(&door, settings)?;
    if let Some(recording) = &recording {
        let journals = recording.journals()?;
        let kept = live.keep_logs(journals);
        kept.inspect_err(|_| recording.remove_journals())?;
    }
    let said = Voice::StandardOutput.say(&door.url());
    // Nobody gave a command yet.
    said.inspect_err(|_| recording.iter().for_each(Recording::remove_journals))?;
    complain("open this address in a browser on this computer; Ctrl-C ends");
    let session = live
        .run(|| interruption.is_asked_for())
        .inspect_err(|_| recording.iter().for_each(Recording::name_journals))?;
    interruption.is_followed();
    complain(&format!("the session ended at t = {:.6} s", session.t));
    match recording {
        Some(recording) => recording.write(session, interruption),
        None => Ok(()),
    }
}

/// A speed (m/s) of the command line.
fn speed(text: &str) -> Result<f64, String> {
    let speed = text.parse::<f64>().ok();
    let expected = || "expected a speed in m/s above 0, at most 100, such as 0.2".to_owned();
    speed
        .filter(|speed| *speed > 0.0 && *speed <= 100.0)
        .ok_or_else(expected)
}
