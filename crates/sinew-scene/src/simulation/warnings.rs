//! Warnings before a run.

use sinew_core::StableStep;

use super::Simulation;
use crate::number::short;
use crate::scene::Subject;

impl Simulation {
    /// Warnings about the scene's mesh, motions, stable step, loads and duration, in this order. Costs no more
    /// than [`Simulation::stable_step`].
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if let Some(body) = self.model().body() {
            let notes = &body.model.report().notes;
            warnings.extend(body.mesh_warnings.iter().chain(notes).cloned());
        }
        warnings.extend(self.motion_warnings());
        warnings.extend(self.unstable_step());
        warnings.extend(self.refused_load().map(|load| load.to_string()));
        warnings.extend(self.unresolved_load().map(|load| load.to_string()));
        let (dt, duration) = (self.dt(), self.settings().duration);
        if dt > duration {
            warnings.push(format!(
                "dt = {dt} s is longer than the duration, {duration} s"
            ));
        }
        warnings
    }

    /// What a user of prescribed motions may not expect.
    fn motion_warnings(&self) -> Vec<String> {
        let (Subject::Body(body), Some(built)) = (self.scene().subject(), self.model().body())
        else {
            return Vec::new();
        };
        let mut warnings = Vec::new();
        for (index, facts) in built.model.report().moves.iter().enumerate() {
            let motion = body.motion_in_words(index);
            warnings.extend(facts.jump.map(|instant| {
                format!(
                    "{motion} jumps at t = {instant} s, at infinite speed: waves start from it that no mesh \
                     resolves; a rise takes time"
                )
            }));
            warnings.extend(facts.loads.iter().map(|load| {
                format!(
                    "{} falls on nodes of {motion}: there it changes the reaction and no motion",
                    body.load_in_words(*load)
                )
            }));
        }
        warnings
    }

    /// Why the motion may grow at the scene's step; `None` where the step is stable.
    fn unstable_step(&self) -> Option<String> {
        let (dt, id) = (self.dt(), &self.settings().integrator);
        let stable_step = match self.stable_step() {
            Ok(stable_step) => stable_step,
            Err(error) => return Some(error.to_string()),
        };
        match (stable_step, stable_step.allows(dt)) {
            (_, Some(true)) => None,
            (StableStep::UpTo(limit), _) if limit > 0.0 => Some(format!(
                "dt = {dt} s is {} times the stable step of `{id}`, {} s",
                short(dt / limit),
                short(limit)
            )),
            (_, Some(false)) => Some(format!("`{id}` is unstable on this scene at any dt")),
            (_, None) => Some(format!(
                "nothing is known about the step up to which `{id}` is stable here: its motion may grow at \
                 dt = {dt} s; `central-difference` knows its step"
            )),
        }
    }
}
