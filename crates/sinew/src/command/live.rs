//! `sinew live`.

mod recording;

use std::path::PathBuf;

use sinew_live::{Live, PaneChoice, Settings};
use sinew_scene::SceneSource;
use sinew_scene::output::{Voice, complain};

use self::recording::Recording;
use super::Failure;
use super::interruption::Interruption;
use super::scene_with::Values;

/// The default scene: the paper's cube.
const CUBE: &str = include_str!("live/cube.toml");

/// The methods that run side by side without a scene: the paper's, and one that is stable with its step.
const SIDE_BY_SIDE: [&str; 2] = ["cnn", "cnn-stabilised"];

/// A scene and the port of its page.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file [default: the paper's cube in steps of 20 ms, by two methods side by side]
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

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interruption = Interruption::listen().map_err(Failure::Signals)?;
    let own = PaneChoice::default();
    let beside = |id: &str| PaneChoice {
        integrator: Some(id.to_owned()),
        dt: None,
    };
    let (scene, mut panes) = match &arguments.scene {
        Some(path) => (arguments.values.load(path)?, vec![own]),
        None => {
            let scene = arguments
                .values
                .apply(&SceneSource::new("cube.toml", CUBE))?;
            (scene, SIDE_BY_SIDE.map(beside).to_vec())
        }
    };
    if let Some(id) = &arguments.beside {
        panes.truncate(1);
        panes.push(beside(id));
    }
    let recording = arguments
        .record
        .as_ref()
        .map(|path| Recording::new(path, &scene))
        .transpose()?;
    let second = panes.get(1).cloned();
    let mut live = Live::open(Settings {
        scene,
        values: arguments.values.assignments(),
        panes,
        second: second.unwrap_or_else(|| beside(SIDE_BY_SIDE[1])),
        hand_speed: arguments.hand_speed,
        port: arguments.port,
    })?;
    if let Some(recording) = &recording {
        let journals = recording.journals()?;
        let kept = live.keep_logs(journals);
        kept.inspect_err(|_| recording.remove_journals())?;
    }
    let said = Voice::StandardOutput.say(&live.url());
    // Nobody gave a command yet.
    said.inspect_err(|_| recording.iter().for_each(Recording::remove_journals))?;
    complain("open this address in a browser on this computer; Ctrl-C ends");
    let session = live
        .run(|| interruption.is_asked_for())
        .inspect_err(|_| recording.iter().for_each(Recording::name_journals))?;
    interruption.is_followed();
    complain(&format!("the session ended at t = {:.6} s", session.t));
    match recording {
        Some(recording) => recording.write(session, &interruption),
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
