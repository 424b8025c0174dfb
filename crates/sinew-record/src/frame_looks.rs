//! What frames would show of a motion, where none are written.

use sinew_core::{Moment, RecordError, Recorder, State, Verdict};
use sinew_fem::Model;
use sinew_scene::{OverlapWatch, Schedule, Simulation};

use crate::error::RecordRunError;
use crate::progress::Seen;
use crate::recorder::Schedules;
use crate::summary;

/// Extremes of a motion as frames would show them: what warns is the same as in a run with a folder.
#[derive(Debug, Clone, Default)]
pub struct Looked {
    seen: Seen,
}

impl Looked {
    /// Warnings of deformations beyond small-strain theory, of tetrahedra inside out, and of parts or surfaces in each other.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        summary::warnings(&self.seen)
    }
}

/// A recorder that looks at the deformation of a body, and for parts and surfaces of it in each other, at the instants at which a folder has frames.
#[derive(Debug)]
pub struct FrameLooks<'a> {
    /// None for an oscillator.
    watch: Option<Watch<'a>>,
    looked: Looked,
}

#[derive(Debug)]
struct Watch<'a> {
    schedule: Schedule,
    model: &'a Model,
    overlaps: OverlapWatch<'a>,
    u: Vec<[f64; 3]>,
}

impl<'a> FrameLooks<'a> {
    /// Looks at a run of this simulation, or at a stretch of it on the body as cuts left it after what was looked at before.
    #[must_use]
    pub fn new(simulation: &'a Simulation, looked: Looked) -> Self {
        Self::with(simulation, Schedules::of(simulation), looked)
    }

    /// Looks at a session that is repeated, or at a stretch of it, of so many steps of this length (s) on average.
    #[must_use]
    pub fn of_steps(simulation: &'a Simulation, (steps, dt): (usize, f64), looked: Looked) -> Self {
        Self::with(
            simulation,
            Schedules::of_steps(simulation, steps, dt),
            looked,
        )
    }

    fn with(simulation: &'a Simulation, schedules: Schedules, looked: Looked) -> Self {
        let body = simulation.model().body();
        let watch = schedules.fields.zip(body).map(|(schedule, body)| Watch {
            schedule,
            model: &body.model,
            overlaps: OverlapWatch::new(body),
            u: vec![[0.0; 3]; body.mesh.points.len()],
        });
        Self { watch, looked }
    }

    /// What was looked at.
    #[must_use]
    pub fn into_looked(self) -> Looked {
        self.looked
    }

    fn look(&mut self, state: &State) -> Result<(), RecordRunError> {
        let Some(watch) = &mut self.watch else {
            return Ok(());
        };
        let (t, seen) = (state.t(), &mut self.looked.seen);
        watch.model.displacements_at(t, &state.u, &mut watch.u)?;
        let body = watch.model.with_memory(&state.internal);
        let tags = &watch.model.mesh().tet_tags;
        let mut inverted = 0;
        for (number, tet) in body.deformed_tets(&watch.u)?.enumerate() {
            seen.see_tet(t, &tet, || tags[number]);
            inverted += usize::from(tet.is_inverted);
        }
        seen.inverted = seen.inverted.max(inverted);
        watch.overlaps.look(t, &watch.u);
        seen.see_overlap(watch.overlaps.deepest());
        Ok(())
    }
}

impl Recorder for FrameLooks<'_> {
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
