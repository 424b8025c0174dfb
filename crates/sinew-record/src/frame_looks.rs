//! Checks at the instants of frames, in runs without frames.

use std::sync::Arc;

use sinew_core::{Moment, RecordError, State, Verdict};
use sinew_scene::{BodyModel, OverlapWatch, Schedule, Simulation};
use sinew_world::{BodyChange, Recorder};

use crate::error::RecordRunError;
use crate::progress::Seen;
use crate::recorder::Schedules;
use crate::summary;

/// Extremes of a motion at the instants of frames: warnings are the same as in a run with a folder.
#[derive(Debug, Clone, Default)]
pub struct Looked {
    seen: Seen,
}

impl Looked {
    /// Warnings of deformations beyond small-strain theory, inverted tetrahedra, and overlapping parts or surfaces.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        summary::warnings(&self.seen)
    }
}

/// A recorder that checks the deformation of a body, and its parts and surfaces for overlap, at the instants of the
/// frames of a folder.
#[derive(Debug)]
pub struct FrameLooks {
    /// The checks; `None` for an oscillator.
    watch: Option<Watch>,
    looked: Looked,
}

#[derive(Debug)]
struct Watch {
    schedule: Schedule,
    body: Arc<BodyModel>,
    overlaps: OverlapWatch,
    u: Vec<[f64; 3]>,
}

impl Watch {
    fn new(schedule: Schedule, body: &Arc<BodyModel>) -> Self {
        Self {
            schedule,
            body: Arc::clone(body),
            overlaps: OverlapWatch::new(body),
            u: vec![[0.0; 3]; body.mesh.points.len()],
        }
    }
}

impl FrameLooks {
    /// Checks of a run of this scene.
    #[must_use]
    pub fn new(simulation: &Simulation) -> Self {
        Self::with(simulation, Schedules::of(simulation))
    }

    /// Checks of a replay of `steps` steps, `dt` (s) long on average.
    #[must_use]
    pub fn of_steps(simulation: &Simulation, (steps, dt): (usize, f64)) -> Self {
        Self::with(simulation, Schedules::of_steps(simulation, steps, dt))
    }

    fn with(simulation: &Simulation, schedules: Schedules) -> Self {
        let body = simulation.model().body();
        let watch = schedules.fields.zip(body);
        Self {
            watch: watch.map(|(schedule, body)| Watch::new(schedule, body)),
            looked: Looked::default(),
        }
    }

    /// The extremes found by the checks.
    #[must_use]
    pub fn into_looked(self) -> Looked {
        self.looked
    }

    fn look(&mut self, state: &State) -> Result<(), RecordRunError> {
        let Some(watch) = &mut self.watch else {
            return Ok(());
        };
        let (t, seen) = (state.t(), &mut self.looked.seen);
        watch
            .body
            .model
            .displacements_at(t, &state.u, &mut watch.u)?;
        let (model, tags) = (&watch.body.model, &watch.body.mesh.tet_tags);
        let mut inverted = 0;
        for (number, tet) in model.tet_deformations(&watch.u)?.enumerate() {
            // Warnings tell nothing else of tissue that may deform as it likes.
            inverted += usize::from(tet.is_inverted());
            if !tet.is_hyperelastic {
                seen.see_linear_tet(t, (&tet.strain(), tet.rotation()), || tags[number]);
            }
        }
        seen.inverted = seen.inverted.max(inverted);
        watch.overlaps.look(t, &watch.u);
        seen.see_overlap(watch.overlaps.deepest());
        Ok(())
    }
}

impl sinew_core::Recorder for FrameLooks {
    fn next(&mut self, step: usize) -> Option<usize> {
        self.watch.as_ref()?.schedule.next(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let looked = self.look(moment.state);
        looked.map_err(|error| RecordError {
            t: moment.state.t(),
            source: Box::new(error),
        })?;
        Ok(Verdict::Continue)
    }
}

impl Recorder for FrameLooks {
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        if let (Some(watch), Some(body)) = (&mut self.watch, change.body.model().body()) {
            *watch = Watch::new(watch.schedule, body);
        }
        Ok(())
    }
}
