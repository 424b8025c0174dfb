//! The body of a scene during its motion.

use std::sync::{Arc, OnceLock};

use sinew_core::{State, StepReport, System};
use sinew_integrators::Stepper;

use super::held_place::HeldPlace;
use super::model::SceneModel;
use super::probe::Probe;
use super::{set_up, step, tool_end};
use crate::error::SceneError;
use crate::scene::Scene;

/// The current body of a scene. A cut replaces it, and so do loads that follow inputs; the scene does not change.
#[derive(Clone, Debug)]
pub struct SceneBody {
    pub(super) scene: Arc<Scene>,
    pub(super) model: SceneModel,
    pub(super) probes: Arc<[Probe]>,
    /// Its parts that are fixed or moved, after they were first requested.
    pub(super) held: OnceLock<Arc<[HeldPlace]>>,
}

impl SceneBody {
    /// The scene that describes it.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Mesh, matrices and tools.
    #[must_use]
    pub fn model(&self) -> &SceneModel {
        &self.model
    }

    /// The system to integrate.
    #[must_use]
    pub fn system(&self) -> &dyn System {
        self.model.system()
    }

    /// Points whose motion is recorded; for an oscillator, its mass.
    #[must_use]
    pub fn probes(&self) -> &Arc<[Probe]> {
        &self.probes
    }

    /// Sets up an integrator with the scene's options for this body and a step (s).
    ///
    /// # Errors
    /// [`SceneError`] at the key for which it is refused.
    pub fn set_up(&self, integrator: &mut dyn Stepper, dt: f64) -> Result<StepReport, SceneError> {
        let prepared = integrator.prepare(self.system(), dt);
        prepared.map_err(|refused| set_up::refused(&self.scene, refused, self.system(), dt))
    }

    /// A sentence if a step (s) is longer than the stable one about a state of a body that is not linear. For a linear
    /// body, whose stable step is the same in all states, the scene's warnings say so.
    #[must_use]
    pub fn outrun(&self, integrator: &dyn Stepper, dt: f64, state: &State) -> Option<String> {
        step::outrun(self.system(), dt, integrator, state)
    }

    /// Sentences about failures of contact with tools and between the faces of cuts, up to this state.
    #[must_use]
    pub fn left_by_tools(&self, state: &State) -> Vec<String> {
        let size = self.system().extent().unwrap_or(0.0);
        let tools = self.model.contact();
        let cuts = |tool: usize| self.scene.is_cut_by(tool);
        let mut said = tools.map_or_else(Vec::new, |tools| {
            tool_end::sentences(tools, size, state, cuts)
        });
        let lips = self.model.body();
        said.extend(lips.and_then(|body| tool_end::of_lips(body, state)));
        said
    }
}
