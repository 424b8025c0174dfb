//! The one who watches a run.

/// Watches a run: shows how far it is, and may end it.
pub trait Companion {
    /// Whether the run is to stop, with a checkpoint where it leaves any; asked several times a second.
    fn is_interrupted(&self) -> bool {
        false
    }

    /// Told how many steps are taken and the time (s) of the state, several times a second.
    fn progress(&mut self, _steps: usize, _t: f64) {}
}

/// Watches nothing.
impl Companion for () {}
