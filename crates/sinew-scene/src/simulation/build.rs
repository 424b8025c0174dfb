//! The construction of a simulation from a scene.

use std::sync::{Arc, OnceLock};

use sinew_core::{LinearModel, LinearOperators, LinearSystem, Load, OperatorError, Ramp, State};

use super::Simulation;
use super::body;
use super::meshed::MeshedScene;
use super::model::SceneModel;
use super::scene_body::SceneBody;
use super::{probe, start, step, tool, touched_steps};
use crate::error::{Fault, MOST_STEPS, SceneError};
use crate::scene::{Oscillator, Subject, TimeStep};

impl MeshedScene {
    /// Assembles the matrices and finds the state at t = 0.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that cannot be fulfilled.
    pub fn build(self) -> Result<Simulation, SceneError> {
        let Self { scene, mesh } = self;
        let mut cutting = None;
        let (model, initial, probes) = match scene.subject() {
            Subject::Body(body) => {
                let model = body::build(body, mesh, scene.places())?;
                cutting = body::cut_plan(body, scene.places())?;
                let initial = start::state(body, scene.places(), &model)?;
                let model = tool::added_to(
                    model,
                    body,
                    scene.places(),
                    &initial,
                    scene.settings().duration,
                )?;
                let probes = probe::of_body(&body.probes, scene.places(), &model)?;
                (SceneModel::Body(Arc::new(model)), initial, probes)
            }
            Subject::Oscillator(oscillator) => {
                let model = oscillator_model(oscillator).map_err(|error| {
                    let place = scene.places().oscillator.as_ref();
                    let place = place.unwrap_or(&scene.places().document);
                    place.fault(Fault::Oscillator(error))
                })?;
                let initial = State::new(vec![oscillator.displacement], vec![oscillator.velocity]);
                (
                    SceneModel::Oscillator(model),
                    initial,
                    vec![probe::of_oscillator()],
                )
            }
        };
        // Blades touch nothing.
        if model.system().contact().is_some() {
            touched_steps::check(scene.settings(), &scene.places().run)?;
        }
        let has_bounds = || {
            let body = model.body();
            body.is_some_and(|body| body.model.operators().element_bounds().is_some())
        };
        let is_linear = model.system().as_linear().is_some();
        if cutting.is_some() && is_linear && scene.settings().dt == TimeStep::Auto && !has_bounds()
        {
            return Err(scene.places().run.value_fault("dt", Fault::NoStepOverCuts));
        }
        let stable_step = OnceLock::new();
        let stable = || {
            let found = stable_step.get_or_init(|| step::stable(scene.settings(), model.system()));
            found.clone()
        };
        let dt = step::seconds(scene.settings(), model.system(), stable)
            .map_err(|fault| scene.places().run.value_fault("dt", fault.into()))?;
        let duration = scene.settings().duration;
        if duration / dt > MOST_STEPS {
            let fault = Fault::TooManySteps { dt, duration };
            return Err(scene.places().run.value_fault("dt", fault));
        }
        Ok(Simulation {
            dt,
            body: Arc::new(SceneBody {
                scene: Arc::new(scene),
                model,
                probes: probes.into(),
                held: OnceLock::new(),
            }),
            initial,
            stable_step,
            cutting,
        })
    }
}

fn oscillator_model(oscillator: &Oscillator) -> Result<LinearModel, OperatorError> {
    let Oscillator {
        mass,
        stiffness,
        damping,
        force,
        ..
    } = *oscillator;
    let mut operators = LinearOperators::oscillator(mass, stiffness, damping)?;
    if force != 0.0 {
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(0, force)],
        };
        operators = operators.with_loads(vec![load])?;
    }
    Ok(LinearModel::new(operators))
}
