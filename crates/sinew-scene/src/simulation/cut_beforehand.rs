//! Bodies that are cut before they move.

use std::sync::{Arc, OnceLock};

use sinew_core::Inputs;

use super::Simulation;
use super::cut_plan::CutPlan;
use super::cutter::CuttingError;
use crate::scene::Blade;

impl CutPlan {
    /// True if the scene cuts after a time (s).
    fn cuts_after(&self, t: f64) -> bool {
        let last = self.strokes.as_ref().and_then(sinew_cutting::Strokes::span);
        let by_tool = self.cutting.remove.is_some() || matches!(self.cutting.blade, Blade::Tool(_));
        by_tool || last.is_some_and(|[_, end]| end > t)
    }
}

impl Simulation {
    /// True if the scene cuts its body after the beginning of the motion, so that the body changes during the motion.
    #[must_use]
    pub fn is_cut_later(&self) -> bool {
        let t = self.initial.t();
        self.cutting.as_ref().is_some_and(|plan| plan.cuts_after(t))
    }

    /// The scene on the body after all strokes that end by the beginning of the motion; nothing cuts it later.
    ///
    /// # Errors
    /// [`CuttingError`].
    pub fn cut_beforehand(self) -> Result<Self, CuttingError> {
        let Some(mut cutter) = self.cutter()? else {
            return Ok(self);
        };
        let mut state = self.initial_state().clone();
        let t = state.t();
        let cut = cutter.follow(&self.body, &mut state, Inputs::none(), t)?;
        Ok(Self {
            body: cut.map_or(self.body, Arc::new),
            initial: state,
            dt: self.dt,
            stable_step: OnceLock::new(),
            cutting: None,
        })
    }
}
