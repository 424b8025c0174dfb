//! Bodies that pass through each other, where no frames are written.

use sinew_core::{Moment, RecordError, Recorder, Verdict};
use sinew_scene::{Overlap, OverlapWatch, Simulation};

use crate::recorder::Schedules;
use crate::schedule::Schedule;

/// A recorder that looks for parts and surfaces of a body in each other, at the instants at which a folder has frames.
#[derive(Debug)]
pub struct OverlapLooks<'a> {
    /// None for an oscillator.
    watch: Option<(Schedule, OverlapWatch<'a>)>,
}

impl<'a> OverlapLooks<'a> {
    /// Looks at a run of this simulation, or at a stretch of it on the body as cuts left it.
    #[must_use]
    pub fn new(simulation: &'a Simulation) -> Self {
        Self::with(simulation, Schedules::of(simulation))
    }

    /// Looks at a session that is repeated, or at a stretch of it, of so many steps of this length (s) on average.
    #[must_use]
    pub fn of_steps(simulation: &'a Simulation, steps: usize, dt: f64) -> Self {
        Self::with(simulation, Schedules::of_steps(simulation, steps, dt))
    }

    fn with(simulation: &'a Simulation, schedules: Schedules) -> Self {
        let body = simulation.model().body();
        Self {
            watch: schedules.fields.zip(body.map(OverlapWatch::new)),
        }
    }

    /// The deepest overlap that was seen.
    #[must_use]
    pub fn into_deepest(self) -> Option<Overlap> {
        self.watch.and_then(|(_, watch)| watch.into_deepest())
    }
}

impl Recorder for OverlapLooks<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        let (schedule, _) = self.watch.as_ref()?;
        schedule.next(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        if let Some((_, watch)) = &mut self.watch {
            let state = moment.state;
            watch.look_at_state(state).map_err(|error| RecordError {
                t: state.t(),
                source: Box::new(error),
            })?;
        }
        Ok(Verdict::Continue)
    }
}
