//! The observer of a run.

/// An observer of a run: shows its progress, and may end it.
pub trait Companion {
    /// True if the run must stop, with a checkpoint if it writes any; called several times a second.
    fn is_interrupted(&self) -> bool {
        false
    }

    /// Receives the number of steps taken and the time (s) of the state, several times a second.
    fn progress(&mut self, _steps: usize, _t: f64) {}
}

/// An observer that does nothing.
impl Companion for () {}
