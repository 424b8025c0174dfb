//! Clocks by which the cost of a run is measured.

/// The clock that measures the cost of a run, named by the integrator that takes its steps
/// ([`crate::Integrator::cost_clock`]). This crate reads no clock: the caller measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CostClock {
    /// CPU time of the calling thread: other processes do not count, and neither do threads that help it.
    #[default]
    CallingThread,
    /// CPU time of all threads of the process, for steps that threads share evenly.
    AllThreads,
    /// Wall time, for work that no CPU clock measures.
    Wall {
        /// Reason why no CPU clock measures the cost, such as `the steps run on a graphics processor`.
        reason: &'static str,
    },
}

impl CostClock {
    /// Description for reports, such as `CPU time of the calling thread`.
    #[must_use]
    pub fn in_words(self) -> String {
        match self {
            Self::CallingThread => "CPU time of the calling thread".to_owned(),
            Self::AllThreads => "CPU time of all threads".to_owned(),
            Self::Wall { reason } => format!("wall time, since {reason}"),
        }
    }
}
