//! Sessions repeated from their logs.

use sinew_core::{RecordError, StepReport};
use sinew_scene::Scene;

use crate::command::CommandError;
use crate::course::Course;
use crate::error::{AdvanceError, WorldError, WorldStepError};
use crate::log::{Header, Log};
use crate::recorder::{Recorder, Shown};
use crate::world::{Ended, World};

/// A session that is repeated from its log, step by step and bit for bit, from its last reset on: earlier motion has no
/// effect except for its number of steps.
///
/// ```
/// use sinew_scene::{Scene, SceneSource};
/// use sinew_world::{Command, Replay, World};
///
/// let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
///             [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
/// let scene = Scene::parse(SceneSource::new("spring.toml", text))?;
/// let mut session = World::new(scene.clone())?;
/// session.step()?;
/// session.command(Command::Dt(0.005))?;
/// session.step()?;
///
/// let mut replay = Replay::new(scene, session.log().clone())?;
/// while replay.step()?.is_some() {}
/// assert_eq!(replay.world().state(), session.state());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Replay {
    world: World,
    log: Log,
    /// Number of commands given so far, or skipped because a reset follows them.
    given: usize,
}

/// Reasons for which a session cannot be repeated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// A scene that cannot be set in motion.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A log of another scene.
    #[error(
        "the log is that of another scene: {what}; give the scene, and the values of the command line, with which the session ran"
    )]
    OtherScene {
        /// Description of the difference.
        what: String,
    },
    /// A command that is refused, but was not refused in the session.
    #[error("command {number} of the log, after step {step}: {source}")]
    Command {
        /// Its number, counted from 1.
        number: usize,
        /// Steps before it.
        step: usize,
        /// The reason.
        source: Box<CommandError>,
    },
    /// A step that fails, but did not fail in the session.
    #[error(
        "step {step}: {source}; it did not fail in the session: another version of the program or another processor computes it"
    )]
    Step {
        /// The step.
        step: usize,
        /// The reason.
        source: WorldStepError,
    },
    /// A session whose motion differs from the log.
    #[error(
        "after step {step} the time is {found} s, and {expected} s in the log: it was changed, or another version of the program wrote it"
    )]
    Course {
        /// Steps taken.
        step: usize,
        /// Time (s) of the state.
        found: f64,
        /// Time (s) in the log.
        expected: f64,
    },
}

/// Reasons for which a session cannot be repeated and recorded.
#[derive(Debug, thiserror::Error)]
pub enum FollowError {
    /// A session that cannot be repeated.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A recorder that failed.
    #[error(transparent)]
    Record(#[from] RecordError),
}

impl Replay {
    /// Prepares the repetition of the session of a scene, starting after its last reset, or at its beginning.
    ///
    /// # Errors
    /// [`ReplayError`] for the log of another scene, or a scene that cannot be set in motion.
    pub fn new(scene: Scene, log: Log) -> Result<Self, ReplayError> {
        let header = Header::of(&scene).map_err(WorldError::from)?;
        log.header().check(&header)?;
        let mut world = World::with_header(scene, header)?;
        let before = log.up_to_last_reset();
        let given = before.len();
        if let Some(reset) = before.last() {
            let failed = |source| ReplayError::Command {
                number: given,
                step: reset.step,
                source: Box::new(source),
            };
            world.begin_at_reset(before).map_err(failed)?;
        }
        let mut replay = Self { world, log, given };
        replay.give()?;
        Ok(replay)
    }

    /// Sentences if another version of the program wrote the log, so that bits may differ, and if its end is missing.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let (theirs, own) = (&self.log.header().program, env!("CARGO_PKG_VERSION"));
        let mut warnings = Vec::new();
        if theirs != own {
            warnings.push(format!("the log was written by sinew {theirs}, and this is {own}: the motion may differ by rounding, or take another course"));
        }
        if self.log.is_cut_off() {
            let steps = self.log.steps();
            warnings.push(format!("the log has no end, as if its session had been killed: it is repeated as far as its last command, after step {steps}"));
        }
        warnings
    }

    /// Takes the next step, and gives the commands that came after it; `None` at the end.
    ///
    /// # Errors
    /// [`ReplayError`] if the session did not fail. A step that diverged in the session is repeated, and counts.
    pub fn step(&mut self) -> Result<Option<StepReport>, ReplayError> {
        let step = self.world.steps();
        if step >= self.log.steps() {
            return Ok(None);
        }
        let work = match self.world.step() {
            Ok(work) => work,
            // No reset comes after it any more, so that it was the last.
            Err(_) if self.world.steps() == step + 1 && step + 1 == self.log.steps() => {
                StepReport::default()
            }
            Err(source) => {
                return Err(ReplayError::Step {
                    step: step + 1,
                    source,
                });
            }
        };
        self.give()?;
        Ok(Some(work))
    }

    /// Gives the commands that came after the steps taken so far.
    fn give(&mut self) -> Result<(), ReplayError> {
        let step = self.world.steps();
        while let Some(entry) = self.log.entries().get(self.given) {
            if entry.step != step {
                break;
            }
            let found = self.world.reached();
            if found.to_bits() != entry.t.to_bits() {
                let expected = entry.t;
                return Err(ReplayError::Course {
                    step,
                    found,
                    expected,
                });
            }
            self.given += 1;
            let number = self.given;
            self.world
                .command(entry.command.clone())
                .map_err(|source| ReplayError::Command {
                    number,
                    step,
                    source: Box::new(source),
                })?;
        }
        Ok(())
    }

    /// The motion that [`Replay::advance`] passes to the recorder.
    #[must_use]
    pub fn course(&self) -> Course {
        Course::of(&self.log, self.world.scene(), self.log.steps())
    }

    /// The part of [`Replay::course`] that is already repeated.
    #[must_use]
    pub fn course_so_far(&self) -> Course {
        Course::of(&self.log, self.world.scene(), self.world.steps())
    }

    /// Repeats the rest, and passes it to a recorder. Time rises in it.
    ///
    /// # Errors
    /// [`FollowError`] for a motion that differs from its log, and for a recorder that fails.
    pub fn advance<R: Recorder + ?Sized>(
        &mut self,
        shown: &mut Shown<'_, R>,
    ) -> Result<Ended, FollowError> {
        loop {
            let (step, end) = (self.world.steps(), self.log.steps());
            if let (true, Some(WorldStepError::Diverged { t, place })) =
                (step >= end, self.world.failure())
            {
                let (t, place) = (*t, place.clone());
                return Ok(Ended::Diverged { t, place });
            }
            let next = self.log.entries().get(self.given);
            let next = next.map_or(end, |entry| entry.step.min(end));
            let ended = match self.world.advance_shown(next.saturating_sub(step), shown) {
                Ok(ended) => ended,
                Err(AdvanceError::Record(error)) => return Err(error.into()),
                Err(AdvanceError::Step(source)) => {
                    let step = self.world.steps() + 1;
                    return Err(ReplayError::Step { step, source }.into());
                }
            };
            match ended {
                // No reset comes after the last step, which may have diverged then too.
                Ended::Diverged { t, place } if self.world.steps() < end => {
                    let (step, source) =
                        (self.world.steps(), WorldStepError::Diverged { t, place });
                    return Err(ReplayError::Step { step, source }.into());
                }
                Ended::Finished => {
                    self.give()?;
                    if self.world.steps() >= end {
                        return Ok(Ended::Finished);
                    }
                }
                ended => return Ok(ended),
            }
        }
    }

    /// The world at the current point of the replay.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world at the end of the replay, ready to continue.
    #[must_use]
    pub fn into_world(self) -> World {
        self.world
    }

    /// The log.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
    }
}

impl AsRef<World> for Replay {
    fn as_ref(&self) -> &World {
        &self.world
    }
}

impl Header {
    /// Refuses another scene.
    fn check(&self, scene: &Self) -> Result<(), ReplayError> {
        let other = |what: String| Err(ReplayError::OtherScene { what });
        if self.scene != scene.scene {
            let values = self.values.iter().map(|value| format!(" --set '{value}'"));
            let values: String = values.collect();
            return other(match values.is_empty() {
                true => "its text differs".to_owned(),
                false => format!("its text differs, and the session ran with{values}"),
            });
        }
        if self.inputs.len() != scene.inputs.len() {
            return other("it reads other files".to_owned());
        }
        let mut files = self.inputs.iter().zip(&scene.inputs);
        match files.find(|(then, now)| then.sha256 != now.sha256) {
            Some((_, now)) => other(format!("{} has changed", now.path.display())),
            None => Ok(()),
        }
    }
}
