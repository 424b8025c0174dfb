//! From a scene to a system that integrators can move.

mod body;
mod loads;
mod probe;
mod start;
mod step;

use sinew_core::{
    Integrator, LinearModel, LinearOperators, Load, OptionError, Ramp, Run, State, System,
};
use sinew_mesh::TetMesh;

pub(crate) use body::cells_of;
pub use probe::{NearestNode, Probe};

use crate::error::{Fault, SceneError};
use crate::plan::Plan;
use crate::scene::{Body, Oscillator, Places, RunSettings, Scene, Subject};

/// A mesh and what its reader accepted but a user should know.
type MeshAndWarnings = (TetMesh, Vec<String>);

/// A scene made ready to run. All its files are read.
#[derive(Debug)]
pub struct Simulation {
    scene: Scene,
    model: SceneModel,
    initial: State,
    probes: Vec<Probe>,
    dt: f64,
}

/// What moves, with its matrices.
#[derive(Debug)]
pub enum SceneModel {
    /// A body of tetrahedra.
    Body(Box<BodyModel>),
    /// One mass on a spring.
    Oscillator(LinearModel),
}

/// A body of tetrahedra: its mesh and its matrices.
#[derive(Debug)]
pub struct BodyModel {
    /// The mesh.
    pub mesh: TetMesh,
    /// What the reader of the mesh file accepted but a user should know.
    pub mesh_warnings: Vec<String>,
    /// The system.
    pub model: sinew_fem::Model,
}

impl SceneModel {
    /// The system to integrate.
    #[must_use]
    pub fn system(&self) -> &dyn System {
        match self {
            Self::Body(body) => &body.model,
            Self::Oscillator(model) => model,
        }
    }

    /// Mesh and matrices, where a body moves.
    #[must_use]
    pub fn body(&self) -> Option<&BodyModel> {
        match self {
            Self::Body(body) => Some(body),
            Self::Oscillator(_) => None,
        }
    }
}

impl Scene {
    /// Reads the mesh, assembles the matrices and finds the state at t = 0.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that asks for what cannot be had.
    pub fn build(self) -> Result<Simulation, SceneError> {
        self.assemble(body::mesh)
    }

    /// As [`Scene::build`], on a mesh at hand (m) in place of the one that `[mesh]` names. An
    /// oscillator has no use for it.
    ///
    /// # Errors
    /// [`SceneError`] with the line of the scene that asks for what this mesh does not have.
    pub fn build_on(self, mesh: TetMesh) -> Result<Simulation, SceneError> {
        self.assemble(|_, _| Ok((mesh, Vec::new())))
    }

    fn assemble(
        self,
        mesh: impl FnOnce(&Body, &Places) -> Result<MeshAndWarnings, SceneError>,
    ) -> Result<Simulation, SceneError> {
        let (model, initial, probes) = match self.subject() {
            Subject::Body(body) => {
                let mesh = mesh(body, self.places())?;
                let model = body::build(body, mesh, self.places())?;
                let initial = start::state(body, self.places(), &model)?;
                let probes = probe::of_body(&body.probes, &model);
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
        let dt = step::seconds(self.run(), model.system())
            .map_err(|fault| self.places().run.value_fault("dt", fault))?;
        Ok(Simulation {
            dt,
            scene: self,
            model,
            initial,
            probes,
        })
    }
}

fn oscillator_model(oscillator: &Oscillator) -> Result<LinearModel, sinew_core::OperatorError> {
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

impl Simulation {
    /// The scene it was made from.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What moves.
    #[must_use]
    pub fn model(&self) -> &SceneModel {
        &self.model
    }

    /// The system to integrate.
    #[must_use]
    pub fn system(&self) -> &dyn System {
        self.model.system()
    }

    /// The state at t = 0.
    #[must_use]
    pub fn initial_state(&self) -> &State {
        &self.initial
    }

    /// How long, by which integrator and in which steps.
    #[must_use]
    pub fn settings(&self) -> &RunSettings {
        self.scene.run()
    }

    /// The step (s), also where the scene leaves it to the integrator.
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Points whose motion is written down; of an oscillator, its mass.
    #[must_use]
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    /// A fresh integrator with the scene's options.
    ///
    /// # Errors
    /// [`OptionError`]; the scene was refused before if there is one.
    pub fn integrator(&self) -> Result<Box<dyn Integrator>, OptionError> {
        let settings = self.settings();
        sinew_integrators::build(&settings.integrator, &settings.options)
    }

    /// The steps that cover the duration. A body has diverged when a displacement passes 100
    /// times its size.
    #[must_use]
    pub fn run(&self) -> Run {
        let run = Run::covering(self.settings().duration, self.dt);
        match self.system().extent() {
            Some(extent) => run.with_divergence_limit(100.0 * extent),
            None => run,
        }
    }

    /// The times (s) at which the error is taken, from 0 to the duration.
    pub fn sample_times(&self) -> impl ExactSizeIterator<Item = f64> {
        let RunSettings {
            duration, samples, ..
        } = *self.settings();
        (0..samples + 1).map(move |j| j as f64 * duration / samples as f64)
    }

    /// What was built and what was left out, for people.
    #[must_use]
    pub fn plan(&self) -> Plan {
        Plan::of(self)
    }
}
