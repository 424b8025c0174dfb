//! A log as text.

use std::fmt::Write;
use std::ops::Range;

use super::words::{push_number, push_options, push_quoted};
use super::{Entry, Header, Log, WentBack};
use crate::command::Command;

/// First line of a log, before its version.
pub(super) const KIND: &str = "sinew session log";

/// Version of logs.
pub(super) const VERSION: usize = 1;

/// The lines before the commands.
pub(super) fn head(header: &Header) -> String {
    let mut text = format!("{KIND} {VERSION}\nprogram ");
    push_quoted(&mut text, &header.program);
    let _ = writeln!(text, "\nscene {}", header.scene);
    for file in &header.inputs {
        let _ = write!(text, "file {} ", file.sha256);
        push_quoted(&mut text, &file.path.to_string_lossy());
        text.push('\n');
    }
    for value in &header.values {
        text.push_str("value ");
        push_quoted(&mut text, value);
        text.push('\n');
    }
    text
}

/// The last line.
pub(super) fn end(log: &Log) -> String {
    format!("{} end\n", log.steps)
}

/// Adds the lines of commands with these numbers, and of those returns to earlier moments, from one on, that come before
/// the end of them; the number of returns that are there then is left in `returns`.
pub(super) fn push_entries(
    out: &mut String,
    log: &Log,
    numbers: Range<usize>,
    returns: &mut usize,
) {
    let end = numbers.end;
    let mut push_returns = |out: &mut String, until: usize| {
        while let Some(back) = log.went_back.get(*returns)
            && back.before <= until
        {
            push_went_back(out, back);
            *returns += 1;
        }
    };
    for number in numbers {
        push_returns(out, number);
        if let Some(entry) = log.entries.get(number) {
            push_entry(out, entry);
        }
    }
    push_returns(out, end);
}

fn push_went_back(out: &mut String, back: &WentBack) {
    let _ = write!(out, "{} ", back.step);
    push_number(out, back.t);
    let _ = writeln!(out, " went-back {} {}", back.commands, back.steps);
}

/// Adds the line of a command.
fn push_entry(out: &mut String, entry: &Entry) {
    let _ = write!(out, "{} ", entry.step);
    push_number(out, entry.t);
    match &entry.command {
        Command::Pose {
            tool,
            position,
            rotation_vector,
        } => {
            out.push_str(" pose ");
            push_quoted(out, tool);
            push_numbers(out, position.iter().chain(rotation_vector));
        }
        Command::LoadFactor { load, factor } => {
            out.push_str(" factor ");
            push_quoted(out, load);
            push_numbers(out, [factor]);
        }
        Command::Grasp { tool } => {
            out.push_str(" grasp ");
            push_quoted(out, tool);
        }
        Command::Release { tool } => {
            out.push_str(" release ");
            push_quoted(out, tool);
        }
        Command::Forces(forces) => {
            out.push_str(" forces");
            for (node, force) in forces {
                // Writing to a string does not fail.
                let _ = write!(out, " {node}");
                push_numbers(out, force);
            }
        }
        Command::Integrator { id, options } => {
            out.push_str(" integrator ");
            push_quoted(out, id);
            push_options(out, options.iter());
        }
        Command::Dt(dt) => {
            out.push_str(" dt");
            push_numbers(out, [dt]);
        }
        Command::Reset => out.push_str(" reset"),
        Command::Cut { from, to } => {
            out.push_str(" cut");
            push_numbers(out, from.iter().chain(to).flatten());
        }
    }
    out.push('\n');
}

fn push_numbers<'n>(out: &mut String, numbers: impl IntoIterator<Item = &'n f64>) {
    for number in numbers {
        out.push(' ');
        push_number(out, *number);
    }
}

impl Log {
    /// The log as text, from which [`Log::parse`] reads all commands back without loss.
    ///
    /// The first lines identify program and scene; then there is a line for each command: the steps taken before it,
    /// the time (s) of the state at that step, and the command; a return to an earlier moment has a line as well, with
    /// the numbers of the commands and steps that were taken back; the last line has the number of all steps.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = head(&self.header);
        push_entries(&mut text, self, 0..self.entries.len(), &mut 0);
        text.push_str(&end(self));
        text
    }
}
