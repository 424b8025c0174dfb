//! The log of a session.

mod error;
mod journal;
mod read;
mod text;
mod words;

pub use error::{LogError, LogFault};
pub use journal::{Journal, JournalError};

use serde::{Deserialize, Serialize};
use sinew_core::Revision;
use sinew_scene::Scene;

use crate::command::Command;
use crate::input_file::{InputFile, InputFileError, sha256};
use crate::scene_identity::SceneIdentity;

/// Identity of the program and the scene of a log.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of the program.
    pub program: String,
    /// SHA-256 of the scene's text, values of the command line included, in hexadecimal digits.
    pub scene: String,
    /// The other files that the scene reads.
    pub inputs: Vec<InputFile>,
    /// Values that were set in the scene's file to get its text, as `KEY=VALUE`, for the user who repeats it.
    pub values: Vec<String>,
}

impl Header {
    /// Identity of the scene.
    pub(crate) fn scene_identity(&self) -> SceneIdentity {
        let hashes = self.inputs.iter().map(|file| file.sha256.as_str());
        let hashes: Vec<&str> = std::iter::once(self.scene.as_str()).chain(hashes).collect();
        let sha256 = sha256(hashes.join("\n").as_bytes());
        SceneIdentity::of(sha256)
    }

    /// Header of a scene and this program.
    ///
    /// # Errors
    /// [`InputFileError`] if a file of the scene cannot be read.
    pub fn of(scene: &Scene) -> Result<Self, InputFileError> {
        // The scene is known by its text.
        let others = scene.input_files().into_iter().skip(1);
        Ok(Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            scene: sha256(scene.source().text().as_bytes()),
            inputs: others
                .map(|path| InputFile::of(scene.source(), path))
                .collect::<Result<_, _>>()?,
            values: Vec::new(),
        })
    }
}

/// A command of a log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Steps taken before it.
    pub step: usize,
    /// Time (s) of the state at that step.
    pub t: f64,
    /// The command.
    pub command: Command,
}

/// A return of a session to an earlier moment, after which another motion follows. A replay ignores it, as the log has
/// the commands of the motion that was kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WentBack {
    /// Number of commands before the moment.
    pub before: usize,
    /// Steps taken before the moment.
    pub step: usize,
    /// Time (s) of the moment.
    pub t: f64,
    /// Number of commands after the moment that left the log.
    pub commands: usize,
    /// Number of steps after the moment that were taken back.
    pub steps: usize,
}

/// All commands of a session, each with the number of steps before it, and the number of steps at its end.
#[derive(Clone, Debug, Serialize)]
pub struct Log {
    header: Header,
    entries: Vec<Entry>,
    went_back: Vec<WentBack>,
    steps: usize,
    #[serde(skip)]
    is_cut_off: bool,
    /// Revision that stays the same as long as commands are only appended, so that a file needs only the new ones.
    #[serde(skip)]
    beginning: Revision,
    /// Earlier revisions since the commands were last replaced, each with the number of commands that were kept of it.
    #[serde(skip)]
    shortened: Vec<(Revision, usize)>,
}

/// The beginning of a log.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    beginning: Revision,
    entries: usize,
    steps: usize,
}

impl PartialEq for Log {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            header,
            entries,
            went_back,
            steps,
            is_cut_off,
            beginning: _,
            shortened: _,
        } = self;
        (header, entries, went_back) == (&other.header, &other.entries, &other.went_back)
            && (steps, is_cut_off) == (&other.steps, &other.is_cut_off)
    }
}

impl Log {
    pub(crate) fn new(header: Header) -> Self {
        Self {
            header,
            entries: Vec::new(),
            went_back: Vec::new(),
            steps: 0,
            is_cut_off: false,
            beginning: Revision::new(),
            shortened: Vec::new(),
        }
    }

    /// Adds a command. Of several poses of a tool, or forces on nodes, before a step the last ones apply.
    pub(crate) fn add(&mut self, step: usize, t: f64, command: Command) {
        self.steps = step;
        if let Command::Pose { tool, .. } = &command {
            let of_step = self
                .entries
                .iter_mut()
                .rev()
                .take_while(|entry| entry.step == step);
            let mut poses =
                of_step.take_while(|entry| matches!(entry.command, Command::Pose { .. }));
            let same = poses.find(|entry| matches!(&entry.command, Command::Pose { tool: other, .. } if other == tool));
            if let Some(entry) = same {
                entry.command = command;
                return;
            }
        }
        if let (Command::Forces(_), Some(last)) = (&command, self.entries.last_mut())
            && last.step == step
            && matches!(last.command, Command::Forces(_))
        {
            last.command = command;
            return;
        }
        self.entries.push(Entry { step, t, command });
    }

    /// The commands up to and including the last reset; empty without one.
    pub(crate) fn up_to_last_reset(&self) -> &[Entry] {
        let reset = |entry: &Entry| entry.command == Command::Reset;
        let last = self.entries.iter().rposition(reset);
        &self.entries[..last.map_or(0, |last| last + 1)]
    }

    /// Replaces its commands by these, of a session whose number of steps is that before the last command.
    pub(crate) fn begin_with(&mut self, entries: &[Entry]) {
        self.restore(entries, entries.last().map_or(0, |last| last.step));
    }

    /// Sets the number of steps of the session.
    pub(crate) fn ends_after(&mut self, steps: usize) {
        self.steps = steps;
    }

    /// Replaces its commands by these, of a session with this number of steps.
    pub(crate) fn restore(&mut self, entries: &[Entry], steps: usize) {
        self.entries = entries.to_vec();
        self.went_back.clear();
        self.steps = steps;
        self.beginning = Revision::new();
        self.shortened.clear();
    }

    /// Marks its present end.
    pub(crate) fn mark(&self) -> Mark {
        Mark {
            beginning: self.beginning,
            entries: self.entries.len(),
            steps: self.steps,
        }
    }

    /// True if it still begins with the commands before a mark.
    pub(crate) fn has(&self, mark: &Mark) -> bool {
        let since = match self.beginning == mark.beginning {
            true => Some(self.shortened.len()),
            false => {
                (self.shortened.iter()).position(|(beginning, _)| *beginning == mark.beginning)
            }
        };
        let kept = since.map(|since| &self.shortened[since..]);
        kept.is_some_and(|kept| kept.iter().all(|(_, kept)| mark.entries <= *kept))
    }

    /// Discards the commands after a mark at a time (s), which it must have, and notes how many they were.
    pub(crate) fn shorten(&mut self, mark: &Mark, t: f64) {
        let is_kept = |back: &WentBack| (back.before, back.step) <= (mark.entries, mark.steps);
        self.went_back.retain(is_kept);
        self.went_back.push(WentBack {
            before: mark.entries,
            step: mark.steps,
            t,
            commands: self.entries.len() - mark.entries,
            steps: self.steps.saturating_sub(mark.steps),
        });
        self.entries.truncate(mark.entries);
        self.steps = mark.steps;
        self.shortened.push((self.beginning, mark.entries));
        self.beginning = Revision::new();
    }

    pub(crate) fn note_values(&mut self, values: Vec<String>) {
        self.header.values = values;
    }

    /// True if its end is missing, for example because the session was killed: it then ends with its last command.
    #[must_use]
    pub fn is_cut_off(&self) -> bool {
        self.is_cut_off
    }

    /// Returns to earlier moments, in the order of the commands.
    #[must_use]
    pub fn went_back(&self) -> &[WentBack] {
        &self.went_back
    }

    /// Identity of the program and the scene that it belongs to.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The commands in the order in which they were given.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Steps of the session.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }
}
