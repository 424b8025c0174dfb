//! Logs read from text.

use std::fs;
use std::path::Path;

use sinew_core::Revision;

use super::error::{LogError, LogFault};
use super::text::{KIND, VERSION};
use super::words::Words;
use super::{Entry, Header, Log, WentBack};
use crate::command::Command;
use crate::input_file::InputFile;

/// Names of the commands.
const COMMANDS: &str =
    "pose, grasp, release, factor, forces, integrator, dt, reset, cut, went-back or end";

/// Begins the line of a return to an earlier moment.
const WENT_BACK: &str = "went-back";

impl Log {
    /// Reads a file with the text of [`Log::to_text`].
    ///
    /// # Errors
    /// [`LogError`] with file and line of the fault.
    pub fn read(path: &Path) -> Result<Self, LogError> {
        let text = fs::read_to_string(path).map_err(|source| LogError::File {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(path, &text)
    }

    /// Reads a text of [`Log::to_text`]; messages name it by a path.
    ///
    /// # Errors
    /// [`LogError::Line`] with the line of the fault.
    pub fn parse(path: &Path, text: &str) -> Result<Self, LogError> {
        let mut reader = Reading::default();
        let at = |(line, fault)| LogError::Line {
            path: path.to_owned(),
            line,
            fault,
        };
        let mut last = 0;
        // A line that was written in part has another meaning, or none; of lines without a line break only the final
        // `end` is complete.
        let (whole, rest) = text.split_at(text.rfind('\n').map_or(0, |end| end + 1));
        let rest = (whole.is_empty() || rest.trim().ends_with("end")).then_some(rest);
        for (number, line) in (1..).zip(whole.lines().chain(rest)) {
            last = number;
            reader
                .line(number, line)
                .map_err(|fault| at((number, fault)))?;
        }
        reader.finish().map_err(|fault| at((last.max(1), fault)))
    }
}

/// The part of a log that was read so far.
#[derive(Default)]
struct Reading {
    /// True if the first line is that of a log.
    is_log: bool,
    program: Option<String>,
    scene: Option<String>,
    inputs: Vec<InputFile>,
    values: Vec<String>,
    entries: Vec<Entry>,
    went_back: Vec<WentBack>,
    end: Option<usize>,
}

impl Reading {
    fn line(&mut self, number: usize, line: &str) -> Result<(), LogFault> {
        if number == 1 {
            first(line)?;
            self.is_log = true;
            return Ok(());
        }
        if let Some(end) = self.end {
            return Err(LogFault::AfterEnd { end });
        }
        let mut words = Words::of(line);
        if self.program.is_none() {
            keyword(&mut words, "program", "program \"VERSION\"")?;
            self.program = Some(words.quoted("the version of the program in quotes")?);
            return words.end();
        }
        if self.scene.is_none() {
            keyword(&mut words, "scene", "scene HASH")?;
            self.scene = Some(hash(&mut words)?);
            return words.end();
        }
        let mut ahead = words;
        if ahead.word() == "file" && self.entries.is_empty() {
            let sha256 = hash(&mut ahead)?;
            let path = ahead.quoted("the path of the file in quotes")?.into();
            self.inputs.push(InputFile { path, sha256 });
            return ahead.end();
        }
        let mut ahead = words;
        if ahead.word() == "value" && self.entries.is_empty() {
            self.values.push(ahead.quoted("KEY=VALUE in quotes")?);
            return ahead.end();
        }
        self.command(words)
    }

    fn command(&mut self, mut words: Words<'_>) -> Result<(), LogFault> {
        let step = words.count("the number of steps before the command")?;
        let last = self.entries.last();
        if let Some(last) = last.filter(|last| step < last.step) {
            let last = last.step;
            return Err(LogFault::Step { found: step, last });
        }
        let mut ahead = words;
        if ahead.word() == "end" {
            self.end = Some(step);
            return ahead.end();
        }
        let t = words.number("the time (s) of the state, or end")?;
        if let Some(last) = last
            && last.command != Command::Reset
            && (t < last.t || (step == last.step && t != last.t))
        {
            let last = last.t;
            return Err(LogFault::Time { found: t, last });
        }
        let word = words.word();
        if word == WENT_BACK {
            self.went_back.push(WentBack {
                before: self.entries.len(),
                step,
                t,
                commands: words.count("the number of commands that were taken back")?,
                steps: words.count("the number of steps that were taken back")?,
            });
            return words.end();
        }
        let command = match word {
            "pose" => Command::Pose {
                tool: words.quoted("the name of a tool in quotes")?.into(),
                position: words
                    .vector("six finite numbers, position (m) and rotation vector (rad)")?,
                rotation_vector: words
                    .vector("six finite numbers, position (m) and rotation vector (rad)")?,
            },
            "factor" => Command::LoadFactor {
                load: words.quoted("the name of a load in quotes")?.into(),
                factor: words.number("a finite factor")?,
            },
            "grasp" => Command::Grasp {
                tool: words.quoted("the name of a tool in quotes")?.into(),
            },
            "release" => Command::Release {
                tool: words.quoted("the name of a tool in quotes")?.into(),
            },
            "forces" => {
                let mut forces = Vec::new();
                while !words.is_empty() {
                    let node = words.count("the number of a node")?;
                    let force = words.vector("three finite numbers, the force (N) on a node")?;
                    forces.push((node, force));
                }
                Command::Forces(forces)
            }
            "integrator" => Command::Integrator {
                id: words.quoted("the name of an integrator in quotes")?,
                options: words.options()?,
            },
            "dt" => Command::Dt(words.number("a finite step (s)")?),
            "reset" => Command::Reset,
            "cut" => {
                const ENDS: &str = "twelve finite numbers, both ends of the blade (m) twice";
                let mut ends = || Ok([words.vector(ENDS)?, words.vector(ENDS)?]);
                Command::Cut {
                    from: ends()?,
                    to: ends()?,
                }
            }
            _ => {
                return Err(LogFault::Word {
                    found: word.to_owned(),
                    expected: COMMANDS,
                });
            }
        };
        words.end()?;
        self.entries.push(Entry { step, t, command });
        Ok(())
    }

    fn finish(self) -> Result<Log, LogFault> {
        let least = self.entries.last().map_or(0, |entry| entry.step);
        let (Some(program), Some(scene)) = (self.program, self.scene) else {
            return Err(match self.is_log {
                true => LogFault::NoHead,
                false => LogFault::Kind {
                    expected: format!("{KIND} {VERSION}"),
                },
            });
        };
        Ok(Log {
            header: Header {
                program,
                scene,
                inputs: self.inputs,
                values: self.values,
            },
            went_back: self.went_back,
            steps: self.end.unwrap_or(least),
            is_cut_off: self.end.is_none(),
            beginning: Revision::new(),
            shortened: Vec::new(),
            entries: self.entries,
        })
    }
}

/// Checks the first line.
fn first(line: &str) -> Result<(), LogFault> {
    let version = line.strip_prefix(KIND).map(str::trim);
    match version.map(str::parse::<usize>) {
        Some(Ok(VERSION)) => Ok(()),
        Some(Ok(found)) if found > VERSION => Err(LogFault::Newer {
            found,
            known: VERSION,
        }),
        _ => Err(LogFault::Kind {
            expected: format!("{KIND} {VERSION}"),
        }),
    }
}

fn keyword(words: &mut Words<'_>, key: &str, expected: &'static str) -> Result<(), LogFault> {
    let word = words.word();
    if word == key {
        return Ok(());
    }
    Err(LogFault::Word {
        found: word.to_owned(),
        expected,
    })
}

/// A hash in hexadecimal digits.
fn hash(words: &mut Words<'_>) -> Result<String, LogFault> {
    let word = words.word();
    if word.len() == 64 && word.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Ok(word.to_owned());
    }
    Err(LogFault::Word {
        found: word.chars().take(80).collect(),
        expected: "a hash of 64 hexadecimal digits",
    })
}
