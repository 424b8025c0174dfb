//! Sessions repeated by their logs.

use std::sync::Arc;

use sinew_core::{Moment, RecordError, Recorder, StepReport, Verdict};
use sinew_scene::{DrivenLoadError, Scene, Simulation};

use crate::command::CommandError;
use crate::course::Course;
use crate::error::{SessionError, SessionStepError};
use crate::log::{Header, Log};
use crate::session::{BodyCut, Session};

/// A session that is repeated by its log, step by step and bit for bit, from its last reset on: what came before left no trace but its number of steps.
///
/// ```
/// use sinew_scene::{Scene, SceneSource};
/// use sinew_session::{Command, Replay, Session};
///
/// let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
///             [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
/// let scene = Scene::parse(SceneSource::new("spring.toml", text))?;
/// let mut session = Session::new(scene.clone())?;
/// session.step()?;
/// session.command(Command::Dt(0.005))?;
/// session.step()?;
///
/// let mut replay = Replay::new(scene, session.log().clone())?;
/// while replay.step()?.is_some() {}
/// assert_eq!(replay.session().state(), session.state());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Replay {
    session: Session,
    log: Log,
    /// Commands given so far, or left out since a reset came after them.
    given: usize,
}

/// Reasons for which a session cannot be repeated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// A scene that cannot be driven.
    #[error(transparent)]
    Session(#[from] SessionError),
    /// A log of another scene.
    #[error(
        "the log is that of another scene: {what}; give the scene, and the values of the command line, with which the session ran"
    )]
    OtherScene {
        /// What differs.
        what: String,
    },
    /// A command that is refused, which it was not in the session.
    #[error("command {number} of the log, after step {step}: {source}")]
    Command {
        /// Its number, counted from 1.
        number: usize,
        /// Steps before it.
        step: usize,
        /// The reason.
        source: Box<CommandError>,
    },
    /// A step that fails, which it did not in the session.
    #[error(
        "step {step}: {source}; it did not fail in the session: another version of the program or another processor computes it"
    )]
    Step {
        /// The step.
        step: usize,
        /// The reason.
        source: SessionStepError,
    },
    /// A session that takes another course.
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

/// The end of a session that was repeated and recorded.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Followed {
    /// Steps that were recorded.
    pub steps: usize,
    /// Their work.
    pub work: StepReport,
    /// Whether a recorder stopped it.
    pub is_stopped: bool,
    /// The time (s) and the place at which it diverged in the end, if it did.
    pub diverged: Option<(f64, String)>,
    /// The change of the body at which it stands, with which another scene begins.
    pub change: Option<BodyCut>,
}

impl Replay {
    /// Begins to repeat the session of a scene: it stands where the last reset left it, or at its beginning.
    ///
    /// # Errors
    /// [`ReplayError`] for the log of another scene, or a scene that cannot be driven.
    pub fn new(scene: Scene, log: Log) -> Result<Self, ReplayError> {
        let header = Header::of(&scene).map_err(SessionError::from)?;
        log.header().check(&header)?;
        let mut session = Session::with_header(scene, header)?;
        let before = log.up_to_last_reset();
        let given = before.len();
        if let Some(reset) = before.last() {
            let failed = |source| ReplayError::Command {
                number: given,
                step: reset.step,
                source: Box::new(source),
            };
            session.begin_at_reset(before).map_err(failed)?;
        }
        let mut replay = Self {
            session,
            log,
            given,
        };
        replay.give()?;
        Ok(replay)
    }

    /// Sentences where another version of the program wrote the log, so that bits may differ, and where its end is missing.
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
    /// [`ReplayError`] where the session did not fail. A step that diverged then is repeated, and counts.
    pub fn step(&mut self) -> Result<Option<StepReport>, ReplayError> {
        let step = self.session.steps();
        if step >= self.log.steps() {
            return Ok(None);
        }
        let work = match self.session.step() {
            Ok(work) => work,
            // No reset comes after it any more, so that it was the last.
            Err(_) if self.session.steps() == step + 1 && step + 1 == self.log.steps() => {
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
        let step = self.session.steps();
        while let Some(entry) = self.log.entries().get(self.given) {
            if entry.step != step {
                break;
            }
            let found = self.session.reached();
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
            self.session
                .command(entry.command.clone())
                .map_err(|source| ReplayError::Command {
                    number,
                    step,
                    source: Box::new(source),
                })?;
        }
        Ok(())
    }

    /// The motion that [`Replay::follow`] shows.
    #[must_use]
    pub fn course(&self) -> Course {
        Course::of(&self.log, self.session.simulation(), self.log.steps())
    }

    /// As much of [`Replay::course`] as is repeated.
    #[must_use]
    pub fn course_so_far(&self) -> Course {
        Course::of(&self.log, self.session.simulation(), self.session.steps())
    }

    /// The scene under whose forces [`Replay::follow`] shows the motion.
    ///
    /// # Errors
    /// [`DrivenLoadError`] where loads cannot be driven.
    pub fn recorded_scene(&self) -> Result<Arc<Simulation>, DrivenLoadError> {
        self.session.recorded(self.course().drives_loads)
    }

    /// Repeats what is left up to the next change of the body, and shows it to a recorder, with its steps counted from where this is called. Time rises in
    /// it. `simulation` is [`Replay::recorded_scene`], which is another one after each change.
    ///
    /// # Errors
    /// [`FollowError`] for a session that takes another course than its log, and for a recorder that fails.
    pub fn follow(
        &mut self,
        simulation: &Simulation,
        recorder: &mut dyn Recorder,
    ) -> Result<Followed, FollowError> {
        let begins = self.session.steps();
        let watches = recorder.watches();
        let mut watched = Vec::with_capacity(watches.len());
        let mut work = StepReport::default();
        let mut is_stopped = false;
        loop {
            let session = &self.session;
            let (step, state) = (session.steps() - begins, session.state());
            let diverged = match session.failure() {
                Some(SessionStepError::Diverged { t, place }) => Some((*t, place.clone())),
                _ => None,
            };
            if diverged.is_none() {
                if !watches.is_empty() {
                    watched.clear();
                    watched.extend(watches.iter().map(|dof| state.u[*dof as usize]));
                    is_stopped |= recorder.watched(state.t(), &watched)? == Verdict::Stop;
                }
                if recorder.next(step) == Some(step) {
                    let moment = Moment {
                        system: simulation.system(),
                        inputs: session.inputs(),
                        state,
                        step,
                        work,
                    };
                    is_stopped |= recorder.record(&moment)? == Verdict::Stop;
                }
            }
            let taken = match is_stopped || diverged.is_some() {
                true => None,
                false => self.step()?,
            };
            work += taken.unwrap_or_default();
            let change = taken.and_then(|_| self.session.change().cloned());
            if taken.is_none() || change.is_some() {
                return Ok(Followed {
                    steps: self.session.steps() - begins,
                    work,
                    is_stopped,
                    diverged,
                    change,
                });
            }
        }
    }

    /// The session as far as it is repeated.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The log.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
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
