//! The motion of a session that can be recorded.

use sinew_core::Options;
use sinew_scene::Simulation;

use crate::command::Command;
use crate::log::{Entry, Log};

/// The motion of a session since its last reset. Time rises in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Number of steps before it.
    pub first: usize,
    /// Number of its steps.
    pub steps: usize,
    /// The mean length (s) of its steps.
    pub dt: f64,
    /// True if all its steps have that length.
    pub has_one_length: bool,
    /// The integrators that took its steps, in the order of their first ones, with the options as given; at least one.
    pub methods: Vec<(String, Options)>,
    /// True if commands scale loads in it.
    pub drives_loads: bool,
}

/// Steps that one method took, of one length.
struct Leg {
    method: (String, Options),
    dt: f64,
    steps: usize,
}

impl Course {
    /// The motion of a session up to this number of steps.
    pub(crate) fn of(log: &Log, simulation: &Simulation, steps: usize) -> Self {
        let before = log.up_to_last_reset();
        let first = before.last().map_or(0, |reset| reset.step);
        let steps = steps.saturating_sub(first);
        let since = &log.entries()[before.len()..];
        let legs = legs(since, simulation, first, steps);
        let mut methods: Vec<(String, Options)> = Vec::new();
        for leg in &legs {
            if !methods.contains(&leg.method) {
                methods.push(leg.method.clone());
            }
        }
        let dt = legs.first().map_or(simulation.dt(), |first| first.dt);
        let has_one_length = legs.iter().all(|leg| leg.dt == dt);
        let sum = legs.iter().map(|leg| leg.steps as f64 * leg.dt);
        let is_factor = |entry: &Entry| matches!(entry.command, Command::LoadFactor { .. });
        Self {
            first,
            steps,
            // No sum, whose rounding would move rows, where all steps are equal.
            dt: match has_one_length {
                true => dt,
                false => sum.sum::<f64>() / steps as f64,
            },
            has_one_length,
            methods,
            drives_loads: since.iter().any(is_factor),
        }
    }

    /// True if one method takes all its steps, of one length.
    #[must_use]
    pub fn is_even(&self) -> bool {
        self.has_one_length && self.methods.len() == 1
    }
}

/// The legs of `steps` steps after the `first` ones, with the commands after them. If there are no steps, the result is
/// one leg without steps.
fn legs(since: &[Entry], simulation: &Simulation, first: usize, steps: usize) -> Vec<Leg> {
    let settings = simulation.settings();
    let mut method = (settings.integrator.clone(), settings.options.clone());
    let (mut dt, mut from, end) = (simulation.dt(), first, first + steps);
    let mut legs = Vec::new();
    for entry in since {
        let to = entry.step.min(end);
        let is_switch = matches!(entry.command, Command::Dt(_) | Command::Integrator { .. });
        if is_switch && to > from {
            legs.push(Leg {
                method: method.clone(),
                dt,
                steps: to - from,
            });
            from = to;
        }
        match &entry.command {
            Command::Dt(other) => dt = *other,
            Command::Integrator { id, options } => method = (id.clone(), options.clone()),
            _ => {}
        }
    }
    if end > from || legs.is_empty() {
        legs.push(Leg {
            method,
            dt,
            steps: end - from,
        });
    }
    legs
}
