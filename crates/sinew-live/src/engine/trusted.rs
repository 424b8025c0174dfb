//! A trusted run in parallel with the panes, for their errors.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use sinew_scene::SceneBody;
use sinew_world::Command;

use super::common::Common;
use super::due::Due;
use super::pane::{Hands, Pane};
use crate::scene_values::SceneValues;

/// The method of the trusted run, which takes short steps.
const METHOD: &str = "central-difference";

/// Step as a share of the stable step.
const SHARE: f64 = 0.9;

/// Largest number of spans by which it may be behind.
const MOST_BEHIND: usize = 1024;

/// Largest number of displacements of a pane that wait for comparison: those of a body of 20,000 nodes take half a
/// megabyte, and a delayed trusted run would keep a thousand of them.
const MOST_LOOKS: usize = 8;

/// Decay factor of the shown error per span: a recent maximum is shown.
const FADES: f64 = 0.99;

/// A span that the panes have stepped through.
struct Span {
    /// Its end (s), and its length (s): a whole number of the trusted run's steps.
    until: f64,
    length: f64,
    hands: Hands,
    commands: Vec<(f64, Command)>,
    looks: Vec<Look>,
}

/// A pane's displacement at a time, to be compared.
struct Look {
    pane: usize,
    /// Its time (s).
    t: f64,
    /// Its displacement (m), and the body that it belongs to.
    u: Vec<f64>,
    body: Arc<SceneBody>,
}

/// Results so far.
#[derive(Debug, Default)]
struct Known {
    errors: Vec<f64>,
    failure: Option<String>,
}

/// A session on a separate thread, which takes the same commands.
pub(crate) struct Trusted {
    spans: SyncSender<Span>,
    known: Arc<Mutex<Known>>,
    /// Simulated time (s), as bits.
    t: Arc<AtomicU64>,
    commands: Due,
    /// Buffers for displacements, which are returned after the comparison.
    spare: Receiver<Vec<f64>>,
    /// True if the run is no longer needed.
    is_over: Arc<AtomicBool>,
}

impl Drop for Trusted {
    fn drop(&mut self) {
        // Spans that still wait would be stepped through for nobody.
        self.is_over.store(true, Ordering::Relaxed);
    }
}

impl Trusted {
    /// Begins at the beginning of the panes, or returns a sentence if that is impossible.
    pub(crate) fn begin(scene: &SceneValues, panes: usize, tick: f64) -> Result<Self, String> {
        let words = |error: &dyn std::error::Error| error.to_string();
        let mut pane = Pane::of(scene).map_err(|error| words(&error))?;
        // In a step that suits it, for the switch tries one.
        let dt = pane.stable_step_of(METHOD).map_err(|error| words(&error))?;
        let stable_step =
            dt.ok_or_else(|| format!("{METHOD} has no stable step here that could be trusted"))?;
        pane.use_method(METHOD, step_within(tick, stable_step))
            .map_err(|error| words(&error))?;
        let (spans, received) = sync_channel(MOST_BEHIND);
        let known = Arc::new(Mutex::new(Known {
            errors: vec![f64::NAN; panes],
            failure: None,
        }));
        let t = Arc::new(AtomicU64::new(pane.t().to_bits()));
        let (compared, spare) = sync_channel(MOST_LOOKS);
        for _ in 0..MOST_LOOKS {
            // The channel has space for all of them.
            let _ = compared.try_send(Vec::new());
        }
        let is_over = Arc::new(AtomicBool::new(false));
        let follower = Follower {
            pane,
            is_over: Arc::clone(&is_over),
            known: Arc::clone(&known),
            t: Arc::clone(&t),
            largest: 0.0,
            stable_step,
            common: (0..panes).map(|_| None).collect(),
            compared,
        };
        thread::Builder::new()
            .name("trusted".to_owned())
            .spawn(move || follower.run(&received))
            .map_err(|error| words(&error))?;
        Ok(Self {
            spans,
            known,
            t,
            commands: Due::default(),
            spare,
            is_over,
        })
    }

    /// Adds a command that the panes received for a simulated time (s).
    pub(crate) fn command_at(&mut self, t: f64, command: Command) {
        self.commands.add(t, command);
    }

    /// Number of cuts that wait for the end of a span.
    pub(crate) fn waiting_cuts(&self) -> usize {
        self.commands.cuts()
    }

    /// Notifies the run that the panes have stepped to the end (s) of a span; returns a sentence if it cannot follow.
    pub(crate) fn span(
        &mut self,
        until: f64,
        tick: f64,
        hands: &Hands,
        panes: &[Pane],
    ) -> Result<(), String> {
        let mut looks = Vec::new();
        for (number, pane) in panes.iter().enumerate() {
            if pane.stopped.is_some() {
                continue;
            }
            // Where too many wait, these are not compared.
            let Ok(mut u) = self.spare.try_recv() else {
                break;
            };
            u.clear();
            u.extend_from_slice(pane.u());
            looks.push(Look {
                pane: number,
                t: pane.t(),
                u,
                body: Arc::clone(pane.body()),
            });
        }
        let span = Span {
            until,
            length: tick,
            hands: hands.clone(),
            commands: self.commands.take(),
            looks,
        };
        match self.spans.try_send(span) {
            Ok(()) => Ok(()),
            Err(TrySendError::Full(_)) => Err(
                "the trusted run takes longer than real time here, so that it was ended".to_owned(),
            ),
            Err(TrySendError::Disconnected(_)) => {
                let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
                let reason = known.failure.as_deref();
                let reason = reason.unwrap_or("by a fault of this program; please report it");
                Err(format!("the trusted run ended: {reason}"))
            }
        }
    }

    /// The error of a pane, and the age (s) of this value.
    pub(crate) fn error(&self, pane: usize, t: f64) -> (f64, f64) {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let error = known.errors.get(pane).copied().unwrap_or(f64::NAN);
        (error, t - f64::from_bits(self.t.load(Ordering::Relaxed)))
    }
}

/// The longest step (s) that divides a span into a whole number of steps and is short for the trusted method.
fn step_within(span: f64, stable_step: f64) -> f64 {
    span / (span / (SHARE * stable_step)).ceil().max(1.0)
}

struct Follower {
    pane: Pane,
    is_over: Arc<AtomicBool>,
    known: Arc<Mutex<Known>>,
    t: Arc<AtomicU64>,
    /// The largest displacement (m) so far.
    largest: f64,
    stable_step: f64,
    /// Cells that the body of each pane has in common with its own body.
    common: Vec<Option<Common>>,
    /// Channel that returns displacements after the comparison.
    compared: SyncSender<Vec<f64>>,
}

impl Follower {
    fn run(mut self, spans: &Receiver<Span>) {
        while let Ok(span) = spans.recv() {
            if let Err(failure) = self.follow(span) {
                let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
                known.failure = Some(failure);
                return;
            }
            self.t.store(self.pane.t().to_bits(), Ordering::Relaxed);
        }
    }

    fn follow(&mut self, span: Span) -> Result<(), String> {
        let dt = step_within(span.length, self.stable_step);
        if self.pane.dt() != dt {
            self.pane.use_step(dt).map_err(|error| error.to_string())?;
        }
        for (t, command) in span.commands {
            self.pane.command_at(t, command);
        }
        let mut looks = span.looks;
        looks.sort_by(|a, b| a.t.total_cmp(&b.t));
        for look in looks {
            let (number, t) = (look.pane, look.t);
            self.go(t, &span.hands)?;
            let own = self.pane.t();
            if t - own > 1e-6 * dt {
                self.go(own + dt, &span.hands)?;
            }
            let error = self.error(&look);
            // Nobody waits for it where the panes have ended.
            let _ = self.compared.try_send(look.u);
            let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            let late = FADES * known.errors[number];
            known.errors[number] = if late > error { late } else { error };
        }
        self.go(span.until, &span.hands)
    }

    fn go(&mut self, until: f64, hands: &Hands) -> Result<(), String> {
        let is_over = Arc::clone(&self.is_over);
        let may = || !is_over.load(Ordering::Relaxed);
        let refused = self.pane.follow(until, hands, may);
        if !self.pane.is_at(until) {
            return Err("nobody asks for it any more".to_owned());
        }
        if let Some(reason) = self.pane.stopped.clone().or(refused) {
            return Err(reason);
        }
        // Of a body that was cut it may be another one.
        if let Some(stable_step) = self.pane.stable_step() {
            self.stable_step = stable_step;
        }
        Ok(())
    }

    /// The largest distance of a pane from this run, at cells that both bodies have, over the largest displacement so
    /// far; NaN if there are none.
    fn error(&mut self, look: &Look) -> f64 {
        let own = self.pane.body().model().body();
        let (Some(own), Some(other)) = (own, look.body.model().body()) else {
            return f64::NAN;
        };
        let common = &mut self.common[look.pane];
        let common = match common.take().filter(|common| common.is_of(own, other)) {
            Some(known) => common.insert(known),
            None => common.insert(Common::of(own, other)),
        };
        // The time lies within the last step.
        let share = 1.0 - (self.pane.t() - look.t) / self.pane.dt();
        let (before, after) = (self.pane.u_before(), self.pane.u());
        let u = |dof: usize| before[dof] + share * (after[dof] - before[dof]);
        let Some([largest, away]) = common.largest(u, &look.u) else {
            return f64::NAN;
        };
        self.largest = self.largest.max(largest);
        if self.largest > 0.0 {
            away / self.largest
        } else {
            f64::NAN
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_fill_a_span_and_stay_below_the_stable_one() {
        for (span, stable, expected) in [
            (0.02, 0.0018, 13.0),
            (0.001, 0.0018, 1.0),
            (0.00162, 0.0018, 1.0),
        ] {
            let dt = step_within(span, stable);
            assert!(dt <= SHARE * stable * (1.0 + 1e-12));
            assert!((span / dt - expected).abs() < 1e-9, "{span} {dt}");
        }
    }
}
