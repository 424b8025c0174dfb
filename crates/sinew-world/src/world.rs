//! A scene in motion.

mod advance;
mod commands;
mod forces;
mod moment;
mod report;
mod saved;
mod trial;

use std::cell::OnceCell;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::{
    Batch, Channel, Inputs, OptionError, Options, StableStep, State, StepError, StepReport, System,
};
use sinew_fem::NodalForces;
use sinew_integrators::Stepper;
use sinew_scene::{
    CutTotals, Cutter, CuttingError, DrivenLoadError, Scene, SceneBody, SceneError, Simulation,
};
use sinew_tools::Steering;

use crate::error::{WorldError, WorldStepError};
use crate::log::{Header, Log};
use crate::recorder::BodyCut;
use crate::scene_identity::SceneIdentity;

pub use moment::Moment;
pub use saved::Saved;
pub use trial::Trial;

/// A scene in motion; only a world takes the steps of a scene.
///
/// It owns the scene, which is constant, and the body, state, integrator, tools and inputs, which change. A
/// [`Recorder`](crate::Recorder) observes the motion of [`World::advance`]; [`Command`](crate::Command)s between
/// steps steer tools, scale loads, cut, and switch methods.
///
/// A world of [`World::new`] takes commands, and its [`Log`] repeats it bit for bit. Without commands it takes the
/// steps of [`World::following`], with the same bits, unless a tool is smaller than surface triangles away from its
/// path: it may be steered there, and has contact with triangles from the beginning.
///
/// ```
/// use sinew_scene::{Scene, SceneSource};
/// use sinew_world::{Command, World};
///
/// let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
///             [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
/// let scene = Scene::parse(SceneSource::new("spring.toml", text))?;
/// let mut world = World::new(scene)?;
/// world.step()?;
/// world.command(Command::Dt(0.005))?;
/// world.advance(1, &mut ())?;
/// assert!((world.t() - 0.015).abs() < 1e-12);
/// assert_eq!(world.log().entries().len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct World {
    /// The scene, unchanged since it was built.
    scene: Arc<Simulation>,
    identity: SceneIdentity,
    /// The current body: its loads follow inputs from the first load factor on. Until then they are known in advance,
    /// which some methods need, and every sum has the same bits as in a run.
    body: Arc<SceneBody>,
    /// The same body with the loads of the scene.
    undriven: Arc<SceneBody>,
    cutter: Option<Cutter>,
    /// Sheets that the next step begins with.
    sheets: Vec<Sheet>,
    /// The last position of the blade of the last sheet.
    blade: Option<[[f64; 3]; 2]>,
    /// The cut at the beginning of the last step.
    change: Option<BodyCut>,
    /// Number of meshes so far; it grows with each change of the mesh.
    topology_epoch: u64,
    /// Buffer for a field over the degrees of freedom.
    field: Vec<f64>,
    method: Method,
    /// The method before the last change of the step, which is often reversed.
    parked: Option<Method>,
    /// Channels without values.
    fresh: Inputs,
    inputs: Inputs,
    tools: Vec<Hand>,
    loads: Vec<Knob>,
    forces: Forces,
    state: State,
    /// Buffer for a trial step, and for the state before a cut.
    trial: State,
    steps: usize,
    /// Time (s) after the last complete step; a step that fails may leave the state in the middle of the step.
    reached: f64,
    failure: Option<WorldStepError>,
    /// Displacement (m) beyond which the motion counts as diverged.
    limit: f64,
    log: Log,
    /// True if tools and loads follow their own courses only.
    follows: bool,
}

/// End of [`World::advance`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ended {
    /// All steps were taken.
    Finished,
    /// The recorder stopped it.
    Stopped,
    /// A displacement was not finite or passed the limit. The step counts.
    Diverged {
        /// Time (s).
        t: f64,
        /// The degree of freedom with the largest displacement, in the terms of the system.
        place: String,
    },
}

/// Steps of [`World::advance_by`].
#[derive(Clone, Debug, PartialEq)]
pub struct Advanced {
    /// Their end.
    pub ended: Ended,
    /// Steps that were taken.
    pub steps: usize,
    /// Their length (s), if it was less than [`World::dt`].
    pub shortened: Option<f64>,
}

/// The ends (m) of a blade before and after.
type Sheet = [[[f64; 3]; 2]; 2];

/// An integrator with its step.
struct Method {
    integrator: Box<dyn Stepper>,
    dt: f64,
    /// Its id and options, as requested.
    asked: (String, Options),
    stable_step: OnceCell<Option<f64>>,
}

/// A tool that commands may steer.
struct Hand {
    name: Arc<str>,
    steering: Steering,
    /// Position (m) and rotation vector (rad) to which it moves and then stays; `None` while it follows the scene.
    target: Option<([f64; 3], [f64; 3])>,
    /// True if it was given a pose.
    is_steered: bool,
    /// True to close its jaws with the next step, false to open them.
    next_jaws: Option<bool>,
}

/// A load that commands may scale.
struct Knob {
    name: Arc<str>,
    channel: Channel,
    /// The factor that applies from the next step on.
    next: Option<f64>,
}

/// Forces on nodes that the next step begins with.
#[derive(Debug, Default)]
struct Forces {
    next: NodalForces,
    is_new: bool,
}

impl Method {
    fn new(
        simulation: &Simulation,
        id: &str,
        options: &Options,
        dt: f64,
    ) -> Result<Self, OptionError> {
        let own = simulation.options_of(id, options);
        let own = sinew_integrators::with_threads(id, &own, None);
        Ok(Self {
            integrator: sinew_integrators::build(id, &own)?,
            dt,
            asked: (id.to_owned(), options.clone()),
            stable_step: OnceCell::new(),
        })
    }

    /// The method that the scene states.
    fn of_scene(simulation: &Simulation) -> Result<Self, OptionError> {
        let settings = simulation.settings();
        Self::new(
            simulation,
            &settings.integrator,
            &settings.options,
            simulation.dt(),
        )
    }
}

impl World {
    /// Builds a world of a scene that takes commands, and checks that a step can be taken.
    ///
    /// # Errors
    /// [`WorldError`] for a scene that `sinew run` refuses as well, and for files of it that cannot be read again.
    pub fn new(scene: Scene) -> Result<Self, WorldError> {
        let header = Header::of(&scene)?;
        Self::with_header(scene, header)
    }

    /// Same as [`World::new`], with a header that is already known.
    pub(crate) fn with_header(scene: Scene, header: Header) -> Result<Self, WorldError> {
        let identity = header.scene_identity();
        let mut simulation = scene.build()?;
        if let Some(refused) = simulation.refused_load() {
            return Err(refused.into());
        }
        simulation.check_step_within_duration()?;
        simulation.end_at_duration();
        let mut inputs = Inputs::new();
        let tools = simulation.steer_tools(&mut inputs)?.into_iter();
        let names = simulation.model().tools().cloned();
        let names = names.iter().flat_map(|tools| tools.tools());
        let tools = tools.zip(names).map(|(steering, tool)| Hand {
            name: tool.name.as_str().into(),
            steering,
            target: None,
            is_steered: false,
            next_jaws: None,
        });
        let channels = simulation.body().add_load_channels(&mut inputs)?;
        let names = simulation.body().load_names().into_iter();
        let loads = names.zip(channels).map(|(name, channel)| Knob {
            name: name.into(),
            channel,
            next: None,
        });
        let method = Method::of_scene(&simulation)?;
        let mut world = Self {
            tools: tools.collect(),
            loads: loads.collect(),
            fresh: inputs.clone(),
            inputs,
            log: Log::new(header),
            follows: false,
            ..Self::still(simulation, method, identity)?
        };
        let Self {
            body,
            inputs,
            state,
            trial,
            method,
            ..
        } = &mut world;
        try_step(body.system(), inputs, state, trial, method)?;
        Ok(world)
    }

    /// A world that follows its scene, with an integrator that is set up for it: tools and loads have their courses,
    /// and commands are refused.
    ///
    /// # Errors
    /// [`WorldError`] for a file of the scene that cannot be read again, and for a body that cannot be cut, which building
    /// the scene rules out.
    pub fn following(
        simulation: Simulation,
        integrator: Box<dyn Stepper>,
    ) -> Result<Self, WorldError> {
        let identity = Header::of(simulation.scene())?.scene_identity();
        let settings = simulation.settings();
        let method = Method {
            integrator,
            dt: simulation.dt(),
            asked: (settings.integrator.clone(), settings.options.clone()),
            stable_step: OnceCell::new(),
        };
        Ok(Self::still(simulation, method, identity)?)
    }

    /// The beginning of a motion without inputs.
    fn still(
        simulation: Simulation,
        method: Method,
        identity: SceneIdentity,
    ) -> Result<Self, CuttingError> {
        let state = simulation.initial_state().clone();
        let limit = simulation.run().divergence_limit;
        let simulation = Arc::new(simulation);
        Ok(Self {
            identity,
            method,
            parked: None,
            tools: Vec::new(),
            loads: Vec::new(),
            forces: Forces::default(),
            cutter: simulation.cutter()?,
            sheets: Vec::new(),
            blade: None,
            change: None,
            topology_epoch: 0,
            field: Vec::new(),
            body: Arc::clone(simulation.body()),
            undriven: Arc::clone(simulation.body()),
            scene: simulation,
            fresh: Inputs::new(),
            inputs: Inputs::new(),
            trial: State::at_rest(0),
            reached: state.t(),
            state,
            steps: 0,
            failure: None,
            limit,
            log: Log::new(Header::default()),
            follows: true,
        })
    }

    /// The same world, whose log records the values, as `KEY=VALUE`, that were set in the scene's file to get the
    /// scene.
    #[must_use]
    pub fn with_values(mut self, values: &[String]) -> Self {
        self.log.note_values(values.to_vec());
        self
    }

    /// The scene, which does not change.
    #[must_use]
    pub fn scene(&self) -> &Arc<Simulation> {
        &self.scene
    }

    /// The current body: mesh, matrices, tools, probes. It is replaced at the first factor of a load, with the same
    /// mesh and tools, and by each cut.
    #[must_use]
    pub fn body(&self) -> &Arc<SceneBody> {
        &self.body
    }

    /// A body of the scene with loads that follow inputs.
    fn driven(&self, undriven: &SceneBody) -> Result<Arc<SceneBody>, DrivenLoadError> {
        let channels: Vec<Channel> = self.loads.iter().map(|load| load.channel).collect();
        Ok(Arc::new(undriven.with_driven_loads(&channels)?))
    }

    /// External inputs as given so far.
    #[must_use]
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Sets the integrator up for the body and the step.
    ///
    /// # Errors
    /// [`SceneError`] at the key for which it is refused.
    pub fn set_up(&mut self) -> Result<StepReport, SceneError> {
        self.body
            .set_up(&mut *self.method.integrator, self.method.dt)
    }

    /// The state after the last step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Number of steps since the session began; a reset does not reset this count.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The step (s).
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.method.dt
    }

    /// Time (s) of the state.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.state.t()
    }

    /// The integrator.
    #[must_use]
    pub fn integrator(&self) -> &dyn Stepper {
        &*self.method.integrator
    }

    /// The largest stable step (s) of the integrator on the body at rest, computed at the first request; `None` if
    /// every step is stable or no limit is known.
    #[must_use]
    pub fn stable_step(&self) -> Option<f64> {
        *self.method.stable_step.get_or_init(|| {
            match self.method.integrator.stable_step(self.body.system()) {
                Ok(StableStep::UpTo(limit)) => Some(limit),
                _ => None,
            }
        })
    }

    /// Time (s) after the last complete step.
    pub(crate) fn reached(&self) -> f64 {
        self.reached
    }

    /// The failure of the last step, from which only a reset continues.
    #[must_use]
    pub fn failure(&self) -> Option<&WorldStepError> {
        self.failure.as_ref()
    }

    /// Totals of the cuts since the last reset; `None` if the scene has no `[cutting]`.
    #[must_use]
    pub fn cuts(&self) -> Option<&CutTotals> {
        self.cutter.as_ref().map(Cutter::totals)
    }

    /// The cutter of the body, if it may be cut.
    #[must_use]
    pub fn cutter(&self) -> Option<&Cutter> {
        self.cutter.as_ref()
    }

    /// The change of the body at the beginning of the last step; `None` if it did not change.
    #[must_use]
    pub fn change(&self) -> Option<&BodyCut> {
        self.change.as_ref()
    }

    /// All commands so far; none in a world that follows its scene.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// All commands of a motion that has ended.
    #[must_use]
    pub fn into_log(self) -> Log {
        self.log
    }
}

impl AsRef<World> for World {
    fn as_ref(&self) -> &World {
        self
    }
}

/// Takes a step on a copy of a state. This sets up the method and checks that it can continue from this state.
fn try_step(
    system: &dyn System,
    inputs: &Inputs,
    state: &State,
    trial: &mut State,
    method: &mut Method,
) -> Result<(), StepError> {
    trial.clone_from(state);
    let mut batch = Batch::new(system, inputs, method.dt, 1);
    batch.take(&mut *method.integrator, trial)
}
