//! The motion of a session that can be recorded.

use sinew_scene::Simulation;

use crate::command::Command;
use crate::log::Log;

/// The motion of a session since its last reset, in which time rises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Steps before it.
    pub first: usize,
    /// Its steps.
    pub steps: usize,
    /// The mean length (s) of its steps.
    pub dt: f64,
    /// Whether loads are turned up or down in it.
    pub drives_loads: bool,
    /// Whether one method takes all its steps, of one length.
    pub is_even: bool,
}

impl Course {
    pub(crate) fn of(log: &Log, simulation: &Simulation) -> Self {
        let entries = log.entries();
        let reset = entries
            .iter()
            .rposition(|entry| entry.command == Command::Reset);
        let first = reset.map_or(0, |reset| entries[reset].step);
        let since = &entries[reset.map_or(0, |reset| reset + 1)..];
        let (mut dt, mut from, mut sum) = (simulation.dt(), first, 0.0);
        for entry in since {
            if let Command::Dt(other) = entry.command {
                sum += (entry.step - from) as f64 * dt;
                (dt, from) = (other, entry.step);
            }
        }
        let steps = log.steps() - first;
        // No sum, whose rounding would move rows, where all steps are equal.
        if from > first {
            dt = (sum + (log.steps() - from) as f64 * dt) / steps as f64;
        }
        let is_switch =
            |command: &Command| matches!(command, Command::Dt(_) | Command::Integrator { .. });
        let is_factor = |command: &Command| matches!(command, Command::LoadFactor { .. });
        Self {
            first,
            steps,
            dt,
            drives_loads: since.iter().any(|entry| is_factor(&entry.command)),
            is_even: !since.iter().any(|entry| is_switch(&entry.command)),
        }
    }
}
