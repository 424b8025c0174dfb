//! End of a run.

use serde::{Deserialize, Serialize};
use sinew_scene::CutTotals;
use sinew_scene::output::Replaced;

use crate::stepping::Stepping;

/// The end of a run, in short.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunEnd {
    /// Reason for the end.
    pub ended: Ended,
    /// Number of steps taken, those of an earlier process included.
    pub steps: usize,
    /// Methods and lengths of the steps.
    pub stepping: Stepping,
    /// Number of steps that this process took, and its total wall time (s).
    pub own: (usize, f64),
    /// Frames of fields written.
    pub frames: usize,
    /// Number of evaluations over all cells, and of solutions with a factor.
    pub work: (u64, u64),
    /// Share of velocities that were saturated.
    pub saturated: f64,
    /// Number of steps that were repeated with shorter substeps.
    pub retaken: u64,
    /// The largest displacement (m), its time (s) and the tag of its node, among the fields; 0 for an oscillator.
    pub largest: (f64, f64, u64),
    /// Totals of the cuts, and the number of pieces at the end, if the body may be cut.
    pub cuts: Option<(CutTotals, usize)>,
    /// Remarks of the integrator at the end, one sentence each: for a continued run, those since the checkpoint.
    pub remarks: Vec<String>,
    /// Warnings about the motion, one sentence each.
    pub warnings: Vec<String>,
    /// Fate of the results that the folder had before.
    pub replaced: Replaced,
}

/// End of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ended {
    /// All steps were taken.
    Finished,
    /// A displacement was not finite or passed [`sinew_scene::Simulation::divergence_limit`].
    Diverged {
        /// Time (s).
        t: f64,
        /// The degree of freedom with the largest displacement, in the terms of the system.
        place: String,
    },
    /// A law refused a state, or a step found no equilibrium.
    Refused {
        /// Time (s).
        t: f64,
        /// The element and the reason.
        reason: String,
    },
    /// A run that was stopped before its end, with a checkpoint if it writes checkpoints.
    Interrupted {
        /// Time (s).
        t: f64,
    },
}

impl Ended {
    /// The end of a world's motion at a time (s).
    pub(crate) fn of(ended: sinew_world::Ended, t: f64) -> Self {
        match ended {
            sinew_world::Ended::Finished => Self::Finished,
            sinew_world::Ended::Stopped => Self::Interrupted { t },
            sinew_world::Ended::Diverged { t, place } => Self::Diverged { t, place },
        }
    }
}
