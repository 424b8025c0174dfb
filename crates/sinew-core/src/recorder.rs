//! Who wants to see states while a simulation runs.

use crate::{State, System};

/// Whether a simulation goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// On.
    Continue,
    /// No further.
    Stop,
}

/// A recorder could not record.
#[derive(Debug, thiserror::Error)]
#[error("recording at t = {t} s failed: {source}")]
pub struct RecordError {
    /// Time of the state (s).
    pub t: f64,
    /// What went wrong.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// Sees states of a running simulation; says beforehand which, so that nobody pays for copies.
pub trait Recorder {
    /// Whether it wants the state after `step` steps (0: the initial state), at time `t` (s).
    fn wants(&mut self, step: usize, t: f64) -> bool;

    /// A state it wanted. `state.v` may be staggered: ask [`State::velocity_at_t`].
    ///
    /// # Errors
    /// [`RecordError`] when it could not keep what it saw; the simulation ends.
    fn record(&mut self, system: &dyn System, state: &State) -> Result<Verdict, RecordError>;
}

/// Wants nothing.
impl Recorder for () {
    fn wants(&mut self, _step: usize, _t: f64) -> bool {
        false
    }

    fn record(&mut self, _system: &dyn System, _state: &State) -> Result<Verdict, RecordError> {
        Ok(Verdict::Continue)
    }
}

/// Wants every state.
impl<F> Recorder for F
where
    F: FnMut(&dyn System, &State) -> Result<Verdict, RecordError>,
{
    fn wants(&mut self, _step: usize, _t: f64) -> bool {
        true
    }

    fn record(&mut self, system: &dyn System, state: &State) -> Result<Verdict, RecordError> {
        self(system, state)
    }
}

/// Several recorders as one: each sees the states it wants; one that stops stops all.
#[derive(Default)]
pub struct Recorders<'a> {
    list: Vec<(Box<dyn Recorder + 'a>, bool)>,
}

impl<'a> Recorders<'a> {
    /// None yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One more.
    #[must_use]
    pub fn with(mut self, recorder: impl Recorder + 'a) -> Self {
        self.list.push((Box::new(recorder), false));
        self
    }
}

impl Recorder for Recorders<'_> {
    fn wants(&mut self, step: usize, t: f64) -> bool {
        for (recorder, wanted) in &mut self.list {
            *wanted = recorder.wants(step, t);
        }
        self.list.iter().any(|(_, wanted)| *wanted)
    }

    fn record(&mut self, system: &dyn System, state: &State) -> Result<Verdict, RecordError> {
        let mut verdict = Verdict::Continue;
        for (recorder, wanted) in &mut self.list {
            if *wanted && recorder.record(system, state)? == Verdict::Stop {
                verdict = Verdict::Stop;
            }
        }
        Ok(verdict)
    }
}
