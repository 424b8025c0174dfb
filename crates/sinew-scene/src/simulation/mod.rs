//! A scene as a system for integrators.

mod at_rest;
mod body;
mod build;
mod cut_beforehand;
mod cut_from;
mod cut_plan;
mod cutter;
mod driven;
mod footprint;
mod held_place;
mod load_problems;
mod loads;
mod mesh;
mod meshed;
mod model;
mod motion_table;
mod probe;
mod reaction;
mod refined;
mod rough_strokes;
mod scene_body;
mod selected;
mod set_up;
mod start;
mod step;
mod tool;
mod tool_end;
mod tool_surface;
mod touched_steps;
mod warnings;

use std::sync::{Arc, OnceLock};

use sinew_core::{OptionError, Options, Run, StableStep, State, StepReport, System};
use sinew_integrators::Stepper;

pub use at_rest::AtRestError;
pub use cut_from::CutFrom;
use cut_plan::CutPlan;
pub use cutter::{CutTotals, Cutter, CuttingError, SavedCuts};
pub use driven::DrivenLoadError;
pub use footprint::Footprint;
pub use held_place::{HeldPlace, ReactionOf};
pub use load_problems::{LoadRemedy, RefusedLoad, UnresolvedLoad};
pub use meshed::MeshedScene;
pub use model::{BodyModel, SceneModel};
pub use probe::{NearestNode, Probe, ProbeNode};
pub use reaction::{HeldParts, Reaction, ReactionError};
pub use refined::RefinementError;
pub use rough_strokes::RoughStrokes;
pub use scene_body::SceneBody;
pub use selected::SelectedPart;

pub use warnings::{Warning, WarningKind};

use crate::error::{Fault, SceneError, StableStepError};
use crate::scene::{RunSettings, Scene};

/// A scene that is ready to run: files read, matrices assembled, step chosen. It does not change while its body moves.
#[derive(Clone, Debug)]
pub struct Simulation {
    body: Arc<SceneBody>,
    initial: State,
    dt: f64,
    stable_step: OnceLock<Result<StableStep, StableStepError>>,
    /// The cutting of the body, if anything cuts it.
    cutting: Option<Arc<CutPlan>>,
}

impl Simulation {
    /// The scene that it was built from.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        self.body.scene()
    }

    /// The body at the beginning of the motion.
    #[must_use]
    pub fn body(&self) -> &Arc<SceneBody> {
        &self.body
    }

    /// Mesh, matrices and tools of the body at the beginning.
    #[must_use]
    pub fn model(&self) -> &SceneModel {
        self.body.model()
    }

    /// The system to integrate.
    #[must_use]
    pub fn system(&self) -> &dyn System {
        self.body.system()
    }

    /// The state at t = 0.
    #[must_use]
    pub fn initial_state(&self) -> &State {
        &self.initial
    }

    /// Duration, integrator and steps that the scene states.
    #[must_use]
    pub fn settings(&self) -> &RunSettings {
        self.scene().settings()
    }

    /// The step (s): the given one, or the one found for dt = "auto".
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Refuses a step that is longer than the duration. A run takes one step that ends with the duration instead; a
    /// session, which continues beyond, would take the long steps.
    ///
    /// # Errors
    /// [`SceneError`] at the step of the scene.
    pub fn check_step_within_duration(&self) -> Result<(), SceneError> {
        let (dt, duration) = (self.dt, self.settings().duration);
        if dt <= duration {
            return Ok(());
        }
        let fault = Fault::LongStep { dt, duration };
        Err(self.scene().places().run.value_fault("dt", fault))
    }

    /// Shortens all steps equally so that a whole number of them ends at the duration; returns the step (s) before,
    /// if it changed.
    pub fn end_at_duration(&mut self) -> Option<f64> {
        let before = self.dt;
        let (duration, steps) = (self.settings().duration, self.run().steps.max(1) as f64);
        let even = duration / steps;
        // Steps that divide the duration but for rounding stay as they are written.
        let divides = (before - even).abs() <= 4.0 * f64::EPSILON * before;
        if !divides {
            self.dt = even;
        }
        // No time that is written lies past the duration, by however little.
        while self.dt * steps > duration {
            self.dt = self.dt.next_down();
        }
        (!divides).then_some(before)
    }

    /// Points whose motion is recorded; for an oscillator, its mass.
    #[must_use]
    pub fn probes(&self) -> &Arc<[Probe]> {
        self.body.probes()
    }

    /// A new integrator with the scene's options.
    ///
    /// # Errors
    /// [`OptionError`] for an option that the integrator refuses. They were checked when the scene was read.
    pub fn integrator(&self) -> Result<Box<dyn Stepper>, OptionError> {
        sinew_integrators::build(&self.settings().integrator, &self.options())
    }

    /// The options of the integrator: those of the scene, with substeps added if
    /// [`Simulation::follows_stiffness`].
    #[must_use]
    pub fn options(&self) -> Options {
        let settings = self.settings();
        self.options_of(&settings.integrator, &settings.options)
    }

    /// The options of an integrator other than the scene's, with the substeps that are added if
    /// [`Simulation::follows_stiffness`].
    #[must_use]
    pub fn options_of(&self, integrator: &str, options: &Options) -> Options {
        step::options((integrator, options), self.follows_stiffness())
    }

    /// True if the current stiffness determines the substeps: dt = "auto" on a body that is not linear.
    #[must_use]
    pub fn follows_stiffness(&self) -> bool {
        step::follows_stiffness(self.settings(), self.system())
    }

    /// The largest stable step of the scene's integrator. The first call computes it, later ones return the cached
    /// value; with dt = "auto" it was computed when the scene was built.
    ///
    /// # Errors
    /// [`StableStepError`] when the system lacks a needed property.
    pub fn stable_step(&self) -> Result<StableStep, StableStepError> {
        let found = || step::stable(self.settings(), self.system());
        self.stable_step.get_or_init(found).clone()
    }

    /// Sets the scene's integrator up for its body and step.
    ///
    /// # Errors
    /// [`SceneError`] at the key for which it is refused.
    pub fn set_up(&self, integrator: &mut dyn Stepper) -> Result<StepReport, SceneError> {
        self.body.set_up(integrator, self.dt)
    }

    /// The steps that cover the duration, up to [`Simulation::divergence_limit`].
    #[must_use]
    pub fn run(&self) -> Run {
        let run = Run::covering(self.settings().duration, self.dt);
        match self.divergence_limit() {
            Some(limit) => run.with_divergence_limit(limit),
            None => run,
        }
    }

    /// The displacement (m) at which a body counts as diverged: 100 times its size. The factor is 1e6 for a body that
    /// may fly off, since no support fixes it along an axis or cuts may detach pieces: free fall is not divergence, and
    /// a motion that grows at every step soon reaches this limit as well.
    #[must_use]
    pub fn divergence_limit(&self) -> Option<f64> {
        let extent = self.system().extent()?;
        let fixed = &self.model().body()?.problem.fixed;
        let is_held = (0..3).all(|axis| fixed.iter().any(|fixed| fixed.axes[axis]));
        let sizes = match is_held && self.cutting.is_none() {
            true => 100.0,
            false => 1e6,
        };
        Some(sizes * extent)
    }

    /// The times (s) at which errors are measured, from 0 to the duration.
    pub fn sample_times(&self) -> impl ExactSizeIterator<Item = f64> {
        let RunSettings {
            duration, samples, ..
        } = *self.settings();
        (0..samples + 1).map(move |j| j as f64 * duration / samples as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SceneSource;

    fn oscillator(dt: &str) -> Simulation {
        let text = format!(
            "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 1.0\n[run]\nduration = 1.0\n\
             integrator = \"central-difference\"\ndt = {dt}\n"
        );
        let scene = Scene::parse(SceneSource::new("spring.toml", text)).unwrap();
        scene.build().unwrap()
    }

    #[test]
    fn the_stable_step_is_solved_for_once_and_only_where_it_is_asked_for() {
        let automatic = oscillator("\"auto\"");
        let solved = automatic.stable_step.get().cloned();
        assert_eq!(solved, Some(automatic.stable_step()), "with dt = \"auto\"");
        let given = oscillator("0.01");
        assert_eq!(given.stable_step.get(), None, "building needs none");
        assert_eq!(given.stable_step(), automatic.stable_step());
        assert!(given.stable_step.get().is_some());
    }

    #[test]
    fn no_run_ends_past_its_duration_by_a_rounding() {
        for n in 1..400 {
            for dt in [
                1.0 / f64::from(n),
                (1.0 / f64::from(n)).next_up(),
                0.999 / f64::from(n),
            ] {
                let mut simulation = oscillator(&format!("{dt:e}"));
                simulation.end_at_duration();
                let end = simulation.dt() * simulation.run().steps as f64;
                assert!((1.0 - 1e-13..=1.0).contains(&end), "{dt:e}: {end:e}");
            }
        }
    }

    #[test]
    fn more_steps_than_can_be_counted_are_one_error_with_their_number() {
        for (dt, duration, steps) in [
            ("1e-300", "1.0", "1.000e300"),
            ("0.01", "1e300", "1.000e302"),
        ] {
            let text = format!(
                "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = 1.0\n[run]\nduration = {duration}\n\
                 integrator = \"newmark\"\ndt = {dt}\n"
            );
            let scene = Scene::parse(SceneSource::new("spring.toml", text)).unwrap();
            let error = scene.build().unwrap_err().to_string();
            assert!(error.contains(&format!("takes {steps} steps")), "{error}");
            assert!(error.starts_with("spring.toml:9: [run]"), "{error}");
        }
    }
}
