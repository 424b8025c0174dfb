//! From a scene to a simulation.

use std::sync::OnceLock;

use sinew_core::{LinearModel, LinearOperators, LinearSystem, Load, OperatorError, Ramp, State};
use sinew_mesh::TetMesh;

use super::Simulation;
use super::body;
use super::mesh::{self, MeshAndWarnings};
use super::model::SceneModel;
use super::motion_table;
use super::{probe, start, step, tool, touched_steps};
use crate::error::{Fault, MOST_STEPS, SceneError};
use crate::scene::{Body, Oscillator, Places, Scene, Subject, TimeStep};

impl Scene {
    /// Reads the mesh, assembles the matrices and finds the state at t = 0.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that cannot be fulfilled.
    pub fn build(self) -> Result<Simulation, SceneError> {
        self.assemble(mesh::of_body)
    }

    /// As [`Scene::build`], on the given mesh (m) in place of the one that `[mesh]` names. An
    /// oscillator ignores it.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that does not fit this mesh.
    pub fn build_on(self, mesh: TetMesh) -> Result<Simulation, SceneError> {
        self.assemble(|_, _| Ok((mesh, Vec::new())))
    }

    fn assemble(
        self,
        make_mesh: impl FnOnce(&Body, &Places) -> Result<MeshAndWarnings, SceneError>,
    ) -> Result<Simulation, SceneError> {
        let scene = self.with_factors(|path| Ok(motion_table::read_factor(path)?))?;
        scene.assemble_with_factors(make_mesh)
    }

    fn assemble_with_factors(
        self,
        make_mesh: impl FnOnce(&Body, &Places) -> Result<MeshAndWarnings, SceneError>,
    ) -> Result<Simulation, SceneError> {
        let mut cutting = None;
        let (model, initial, probes) = match self.subject() {
            Subject::Body(body) => {
                let mesh = make_mesh(body, self.places())?;
                let model = body::build(body, mesh, self.places())?;
                cutting = body::cut_plan(body, self.places())?;
                let initial = start::state(body, self.places(), &model)?;
                let model = tool::added_to(
                    model,
                    body,
                    self.places(),
                    &initial,
                    self.settings().duration,
                )?;
                let probes = probe::of_body(&body.probes, self.places(), &model)?;
                (SceneModel::Body(Box::new(model)), initial, probes)
            }
            Subject::Oscillator(oscillator) => {
                let model = oscillator_model(oscillator).map_err(|error| {
                    let place = self.places().oscillator.as_ref();
                    let place = place.unwrap_or(&self.places().document);
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
            touched_steps::check(self.settings(), &self.places().run)?;
        }
        let has_bounds = || {
            let body = model.body();
            body.is_some_and(|body| body.model.operators().element_bounds().is_some())
        };
        let is_linear = model.system().as_linear().is_some();
        if cutting.is_some() && is_linear && self.settings().dt == TimeStep::Auto && !has_bounds() {
            return Err(self.places().run.value_fault("dt", Fault::NoStepOverCuts));
        }
        let stable_step = OnceLock::new();
        let stable = || {
            let found = stable_step.get_or_init(|| step::stable(self.settings(), model.system()));
            found.clone()
        };
        let dt = step::seconds(self.settings(), model.system(), stable)
            .map_err(|fault| self.places().run.value_fault("dt", fault.into()))?;
        let duration = self.settings().duration;
        if duration / dt > MOST_STEPS {
            let fault = Fault::TooManySteps { dt, duration };
            return Err(self.places().run.value_fault("dt", fault));
        }
        Ok(Simulation {
            dt,
            scene: self,
            model,
            initial,
            probes,
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
