//! A scene that is driven while it runs.

use std::cell::OnceCell;
use std::sync::Arc;

use sinew_core::{
    Batch, Channel, Inputs, OptionError, Options, StableStep, State, StepError, StepReport, System,
};
use sinew_integrators::Stepper;
use sinew_scene::{CutTotals, Cutter, DrivenLoadError, Overlap, OverlapWatch, Scene, Simulation};
use sinew_tools::{Pose, Steering};

use crate::command::{Command, CommandError};
use crate::error::{SessionError, SessionStepError};
use crate::log::{Entry, Header, Log};

/// Largest number of a pose (m or rad): far beyond any body, and far from what overflows.
const FARTHEST: f64 = 1e6;

/// Largest factor of a load.
const STRONGEST: f64 = 1e6;

/// A scene that is driven while it runs: [`Command`]s between its steps, and a [`Log`] of them that repeats it bit for bit.
///
/// Without commands it takes the steps that `sinew run` takes, with the same bits, unless a tool is finer than the surface somewhere off its path: it may be
/// led there, and meets triangles from the beginning.
///
/// ```
/// use sinew_scene::{Scene, SceneSource};
/// use sinew_session::{Command, Session};
///
/// let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
///             [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";
/// let scene = Scene::parse(SceneSource::new("spring.toml", text))?;
/// let mut session = Session::new(scene)?;
/// session.step()?;
/// session.command(Command::Dt(0.005))?;
/// session.step()?;
/// assert!((session.t() - 0.015).abs() < 1e-12);
/// assert_eq!(session.log().entries().len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Session {
    /// The scene in the beginning.
    scene: Arc<Simulation>,
    /// The scene on the body as cuts left it, with its loads as it has them.
    body: Arc<Simulation>,
    /// The scene as it runs: from the first factor of a load on one whose loads follow inputs. Until then they are known beforehand, which some
    /// methods need, and every sum has the bits of a run.
    simulation: Arc<Simulation>,
    cutter: Option<Cutter>,
    /// Sheets that the next step begins with: both ends (m) of a blade before and after.
    sheets: Vec<Sheet>,
    /// Where the blade of the last sheet came to.
    blade: Option<[[f64; 3]; 2]>,
    /// The change of the body in the last step.
    change: Option<BodyCut>,
    method: Method,
    /// Channels without values.
    fresh: Inputs,
    inputs: Inputs,
    tools: Vec<Hand>,
    loads: Vec<Knob>,
    state: State,
    /// Room for a step that is tried.
    trial: State,
    steps: usize,
    /// Time (s) after the last step that was taken whole; a step that fails may leave a part of it behind.
    reached: f64,
    failure: Option<SessionStepError>,
    log: Log,
}

/// The ends (m) of a blade before and after.
type Sheet = [[[f64; 3]; 2]; 2];

/// A body that became another one at the beginning of the last step.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyCut {
    /// The state before the cut.
    pub before: State,
    /// The state after it, before the step.
    pub after: State,
    /// The energy (J) that it brought in.
    pub energy: f64,
}

/// An integrator with its step.
struct Method {
    integrator: Box<dyn Stepper>,
    dt: f64,
    /// Its id and options, as they were asked for.
    asked: (String, Options),
    stable_step: OnceCell<Option<f64>>,
}

/// A tool in a hand.
struct Hand {
    steering: Steering,
    /// Position (m) and rotation vector (rad) where it goes, and then stays; `None` while it follows the scene.
    target: Option<([f64; 3], [f64; 3])>,
    /// Whether it was given a pose.
    is_steered: bool,
}

/// A load that is turned up and down.
struct Knob {
    name: String,
    channel: Channel,
    /// The factor that it is to have from the next step on.
    next: Option<f64>,
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

    /// The method that the scene asks for.
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

impl Session {
    /// Builds a scene and checks that a step can be taken.
    ///
    /// # Errors
    /// [`SessionError`] for a scene that `sinew run` refuses as well, and for files of it that cannot be read again.
    pub fn new(scene: Scene) -> Result<Self, SessionError> {
        let header = Header::of(&scene)?;
        Self::with_header(scene, header)
    }

    /// As [`Session::new`], with what is known of the scene's files already.
    pub(crate) fn with_header(scene: Scene, header: Header) -> Result<Self, SessionError> {
        let mut simulation = scene.build()?;
        if let Some(refused) = simulation.refused_load() {
            return Err(refused.into());
        }
        simulation.check_step_within_duration()?;
        simulation.end_at_duration();
        let mut inputs = Inputs::new();
        let tools = simulation.steer_tools(&mut inputs)?.into_iter();
        let tools = tools.map(|steering| Hand {
            steering,
            target: None,
            is_steered: false,
        });
        let channels = simulation.add_load_channels(&mut inputs)?;
        let names = simulation.load_names().into_iter();
        let loads = names.zip(channels).map(|(name, channel)| Knob {
            name,
            channel,
            next: None,
        });
        let state = simulation.initial_state().clone();
        let simulation = Arc::new(simulation);
        let mut session = Self {
            tools: tools.collect(),
            method: Method::of_scene(&simulation)?,
            loads: loads.collect(),
            cutter: simulation.cutter()?,
            sheets: Vec::new(),
            blade: None,
            change: None,
            scene: Arc::clone(&simulation),
            body: Arc::clone(&simulation),
            simulation,
            fresh: inputs.clone(),
            inputs,
            trial: state.clone(),
            reached: state.t(),
            state,
            steps: 0,
            failure: None,
            log: Log::new(header),
        };
        let Self {
            simulation,
            inputs,
            state,
            trial,
            method,
            ..
        } = &mut session;
        try_step(simulation.system(), inputs, state, trial, method)?;
        Ok(session)
    }

    /// The same session, whose log says which values, as `KEY=VALUE`, were set in the scene's file to get the scene.
    #[must_use]
    pub fn with_values(mut self, values: &[String]) -> Self {
        self.log.note_values(values.to_vec());
        self
    }

    /// The scene as it is driven: mesh, tools, loads, title. Another one from the first factor of a load on, with the same mesh and tools, and after each cut.
    #[must_use]
    pub fn simulation(&self) -> &Arc<Simulation> {
        &self.simulation
    }

    /// The scene whose forces under [`Session::inputs`] are those of the session from its last reset on, for a recorder that sees all of it: also where loads
    /// are driven later.
    ///
    /// # Errors
    /// [`DrivenLoadError`] where loads cannot be driven.
    pub fn recorded(&self, drives_loads: bool) -> Result<Arc<Simulation>, DrivenLoadError> {
        if drives_loads {
            return Ok(Arc::new(self.driven()?));
        }
        Ok(Arc::clone(&self.body))
    }

    /// The scene with loads that follow inputs.
    fn driven(&self) -> Result<Simulation, DrivenLoadError> {
        let channels: Vec<Channel> = self.loads.iter().map(|load| load.channel).collect();
        self.body.with_driven_loads(&channels)
    }

    /// Inputs from outside as they were given so far.
    #[must_use]
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Checks a command, which takes effect with the next step, and keeps it in the log.
    ///
    /// # Errors
    /// [`CommandError`] for a command that cannot be followed: the session goes on as before.
    pub fn command(&mut self, command: Command) -> Result<(), CommandError> {
        if self.failure.is_some() && command != Command::Reset {
            return Err(CommandError::Failed);
        }
        self.check_words(&command)?;
        let reached = self.reached;
        match &command {
            Command::Pose {
                tool,
                position,
                rotation_vector,
            } => {
                let tool = self.tool(tool)?;
                self.tools[tool].target = Some((*position, *rotation_vector));
            }
            Command::LoadFactor { load, factor } => self.turn(load, *factor)?,
            Command::Integrator { id, options } => {
                let method = Method::new(&self.simulation, id, options, self.method.dt)?;
                self.switch(method)?;
            }
            Command::Dt(dt) => {
                let (id, options) = &self.method.asked;
                let method = Method::new(&self.simulation, id, options, *dt)?;
                self.switch(method)?;
            }
            Command::Reset => {
                self.cutter = self.scene.cutter()?;
                self.sheets.clear();
                (self.blade, self.change) = (None, None);
                self.body = Arc::clone(&self.scene);
                self.simulation = Arc::clone(&self.scene);
                self.method = Method::of_scene(&self.simulation)?;
                self.inputs.clone_from(&self.fresh);
                for load in &mut self.loads {
                    load.next = None;
                }
                for tool in &mut self.tools {
                    (tool.target, tool.is_steered) = (None, false);
                }
                self.state.clone_from(self.simulation.initial_state());
                self.reached = self.state.t();
                self.failure = None;
            }
            Command::Cut { from, to } => self.sheets.push([*from, *to]),
        }
        self.log.add(self.steps, reached, command);
        Ok(())
    }

    /// Stands, in the beginning, where the last of these commands, a reset, left a session: all that it did before is told by the log alone.
    pub(crate) fn begin_at_reset(&mut self, commands: &[Entry]) -> Result<(), CommandError> {
        self.command(Command::Reset)?;
        self.log.begin_with(commands);
        self.steps = self.log.steps();
        Ok(())
    }

    /// Checks what can be told of a command before it is given: its names, its numbers and, for the first factor of a load, whether the method takes
    /// loads that are not known beforehand. Whether a step can be taken by another method shows when that is given.
    ///
    /// # Errors
    /// [`CommandError`] for a command that [`Session::command`] refuses as well.
    pub fn check(&self, command: &Command) -> Result<(), CommandError> {
        self.check_words(command)?;
        if matches!(command, Command::LoadFactor { .. }) && !self.drives_loads() {
            self.driven_method()?;
        }
        Ok(())
    }

    /// Checks names and numbers of a command.
    fn check_words(&self, command: &Command) -> Result<(), CommandError> {
        match command {
            Command::Pose {
                tool,
                position,
                rotation_vector,
            } => {
                self.tool(tool)?;
                let numbers = position.iter().chain(rotation_vector);
                // What is not a number is not within the range either.
                let beyond = |value: &&f64| !(-FARTHEST..=FARTHEST).contains(*value);
                numbers.into_iter().find(beyond).map_or(Ok(()), |value| {
                    Err(CommandError::Pose {
                        tool: tool.clone(),
                        value: *value,
                        most: FARTHEST,
                    })
                })
            }
            Command::LoadFactor { load, factor } => {
                self.load(load)?;
                match (-STRONGEST..=STRONGEST).contains(factor) {
                    true => Ok(()),
                    false => Err(CommandError::Factor {
                        load: load.clone(),
                        factor: *factor,
                        most: STRONGEST,
                    }),
                }
            }
            Command::Dt(dt) => {
                let t = self.t();
                match dt.is_finite() && *dt > 0.0 && t + dt > t {
                    true => Ok(()),
                    false => Err(CommandError::Dt { dt: *dt, t }),
                }
            }
            Command::Cut { .. } if self.cutter.is_none() => Err(CommandError::Whole),
            Command::Cut { from, to } => {
                let numbers = from.as_flattened().iter().chain(to.as_flattened());
                let beyond = |value: &&f64| !(-FARTHEST..=FARTHEST).contains(*value);
                numbers.into_iter().find(beyond).map_or(Ok(()), |value| {
                    Err(CommandError::Cut {
                        value: *value,
                        most: FARTHEST,
                    })
                })
            }
            Command::Integrator { .. } | Command::Reset => Ok(()),
        }
    }

    /// The place of a tool by its name.
    fn tool(&self, name: &str) -> Result<usize, CommandError> {
        let tools = self.simulation.model().tools();
        let names = || {
            tools
                .iter()
                .flat_map(|tools| tools.tools())
                .map(|tool| &tool.name)
        };
        let place = names().position(|known| known == name);
        place.ok_or_else(|| CommandError::NoTool {
            name: name.to_owned(),
            known: names().cloned().collect(),
        })
    }

    /// The place of a load by its name.
    fn load(&self, name: &str) -> Result<usize, CommandError> {
        let place = self.loads.iter().position(|load| load.name == name);
        place.ok_or_else(|| CommandError::NoLoad {
            name: name.to_owned(),
            known: self.loads.iter().map(|load| load.name.clone()).collect(),
        })
    }

    fn turn(&mut self, name: &str, factor: f64) -> Result<(), CommandError> {
        let place = self.load(name)?;
        if !self.drives_loads() {
            (self.simulation, self.method) = self.driven_method()?;
            // These loads give the forces that led to the state.
            self.state.loads = None;
        }
        self.loads[place].next = Some(factor);
        Ok(())
    }

    /// Whether loads follow inputs.
    fn drives_loads(&self) -> bool {
        !Arc::ptr_eq(&self.simulation, &self.body)
    }

    /// The scene with loads that follow inputs, and the method, which can take a step of it.
    fn driven_method(&self) -> Result<(Arc<Simulation>, Method), CommandError> {
        let driven = Arc::new(self.driven()?);
        let (id, options) = &self.method.asked;
        let mut method = Method::new(&driven, id, options, self.method.dt)?;
        let mut state = self.state.clone();
        state.loads = None;
        let mut trial = state.clone();
        try_step(
            driven.system(),
            &self.inputs,
            &state,
            &mut trial,
            &mut method,
        )?;
        Ok((driven, method))
    }

    /// Goes on with another method, if a step can be taken with it.
    fn switch(&mut self, mut method: Method) -> Result<(), CommandError> {
        let Self {
            simulation,
            inputs,
            state,
            trial,
            ..
        } = self;
        try_step(simulation.system(), inputs, state, trial, &mut method)?;
        self.method = method;
        Ok(())
    }

    /// Takes one step of [`Session::dt`].
    ///
    /// # Errors
    /// [`SessionStepError`] where the motion diverges, a law refuses a state or a method finds no solution: only [`Command::Reset`] goes on from
    /// there, and every other step gives the same error.
    pub fn step(&mut self) -> Result<StepReport, SessionStepError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let stepped = self.advance();
        if let Err(failure) = &stepped {
            self.failure = Some(failure.clone());
        }
        stepped
    }

    fn advance(&mut self) -> Result<StepReport, SessionStepError> {
        let dt = self.method.dt;
        let mut clock = self.state.clock;
        clock.advance(dt);
        let (t, end) = (self.state.t(), clock.time());
        if end <= t {
            return Err(SessionStepError::Time { t, dt });
        }
        self.steer(t, end)?;
        for load in &mut self.loads {
            if let Some(factor) = load.next.take() {
                self.inputs.set(load.channel, t, factor)?;
            }
        }
        self.cut_before(end)?;
        let system = self.simulation.system();
        let limit = self.simulation.run().divergence_limit;
        let mut batch = Batch::new(system, &self.inputs, dt, 1).with_divergence_limit(limit);
        batch.take(&mut *self.method.integrator, &mut self.state)?;
        self.steps += batch.taken();
        self.reached = self.state.t();
        self.log.ends_after(self.steps);
        if let Some(dof) = batch.diverged() {
            let (t, place) = (self.state.t(), system.cell_name(dof));
            return Err(SessionStepError::Diverged { t, place });
        }
        Ok(batch.work())
    }

    /// Cuts what hands and the scene cut at the beginning of a step that ends at `end` (s).
    fn cut_before(&mut self, end: f64) -> Result<(), SessionStepError> {
        self.change = None;
        let drives_loads = self.drives_loads();
        let Some(cutter) = &mut self.cutter else {
            return Ok(());
        };
        let t = self.state.t();
        if self.sheets.is_empty() && cutter.idle_until(t) >= end {
            return Ok(());
        }
        let (energy, before) = (cutter.totals().energy(), self.state.clone());
        let (state, inputs) = (&mut self.state, &self.inputs);
        let mut all_acts = || {
            let mut changed: Option<Simulation> = None;
            for sheet in self.sheets.drain(..) {
                if self.blade.replace(sheet[1]) != Some(sheet[0]) {
                    cutter.lift();
                }
                let now = changed.as_ref().unwrap_or(&self.body);
                changed = cutter.cut(sheet, now, state, inputs)?.or(changed);
            }
            let now = changed.as_ref().unwrap_or(&self.body);
            Ok(cutter.follow(now, state, inputs, end)?.or(changed))
        };
        let changed = match all_acts() {
            Ok(Some(changed)) => changed,
            Ok(None) => return Ok(()),
            Err(error) => {
                // What is shown of a session that failed is one body with its own state.
                self.state = before;
                return Err(SessionStepError::Cutting(error));
            }
        };
        self.change = Some(BodyCut {
            before,
            after: self.state.clone(),
            energy: cutter.totals().energy() - energy,
        });
        self.body = Arc::new(changed);
        self.simulation = Arc::clone(&self.body);
        if drives_loads {
            let driven = self.driven();
            let driven = driven.map_err(|error| SessionStepError::Driven(error.to_string()))?;
            self.simulation = Arc::new(driven);
        }
        self.method.stable_step = OnceCell::new();
        Ok(())
    }

    /// Gives the channels of all tools in hand their poses at the end (s) of a step that begins at `t` (s).
    fn steer(&mut self, t: f64, end: f64) -> Result<(), SessionStepError> {
        let last = self.state.clock.last_step().unwrap_or(0.0);
        for (index, hand) in self.tools.iter_mut().enumerate() {
            let Some((position, rotation_vector)) = hand.target else {
                continue;
            };
            if !hand.is_steered {
                // Of a tool that is a body of its own it is the hand that is steered.
                let own = self.simulation.model().tools();
                let own = own.and_then(|tools| tools.tools().get(index));
                let own = own.map_or(Pose::identity(), |tool| tool.motion.at(t, &self.inputs));
                hand.steering
                    .set(&mut self.inputs, t, own.position(), own.rotation_vector())?;
                hand.is_steered = true;
            }
            hand.steering
                .set(&mut self.inputs, end, position, rotation_vector)?;
            // Contact looks back by the step before.
            hand.steering
                .forget_before(&mut self.inputs, t - 2.0 * last);
        }
        Ok(())
    }

    /// The state after the last step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Steps taken since the session began; a reset counts on.
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

    /// The largest stable step (s) of the integrator on the body at rest, found at the first request; `None` where every step is stable or none is known.
    #[must_use]
    pub fn stable_step(&self) -> Option<f64> {
        *self.method.stable_step.get_or_init(|| {
            match self.method.integrator.stable_step(self.simulation.system()) {
                Ok(StableStep::UpTo(limit)) => Some(limit),
                _ => None,
            }
        })
    }

    /// The pose of a tool at the time of the state.
    ///
    /// # Panics
    /// Where the scene has no tool of this number.
    #[must_use]
    pub fn tool_pose(&self, tool: usize) -> Pose {
        let tools = self.simulation.model().tools();
        tools.map_or(Pose::identity(), |tools| {
            tools.pose(&self.state, &self.inputs, tool)
        })
    }

    /// Time (s) after the last step that was taken whole.
    pub(crate) fn reached(&self) -> f64 {
        self.reached
    }

    /// The failure of the last step, from which only a reset goes on.
    #[must_use]
    pub fn failure(&self) -> Option<&SessionStepError> {
        self.failure.as_ref()
    }

    /// What was cut since the last reset; `None` where the scene has no `[cutting]`.
    #[must_use]
    pub fn cuts(&self) -> Option<&CutTotals> {
        self.cutter.as_ref().map(Cutter::totals)
    }

    /// What cuts the body, where something may.
    #[must_use]
    pub fn cutter(&self) -> Option<&Cutter> {
        self.cutter.as_ref()
    }

    /// The change of the body at the beginning of the last step; `None` where it stayed as it was.
    #[must_use]
    pub fn change(&self) -> Option<&BodyCut> {
        self.change.as_ref()
    }

    /// Where parts or surfaces of the body are deepest in each other now, which nothing keeps from it. A look costs some microseconds for each triangle of
    /// the surface: a session takes none by itself.
    #[must_use]
    pub fn overlap(&self) -> Option<Overlap> {
        let mut watch = OverlapWatch::new(self.simulation.model().body()?);
        watch.look_at_state(&self.state).ok()?;
        watch.into_deepest()
    }

    /// All commands so far.
    #[must_use]
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// All commands of a session that has ended.
    #[must_use]
    pub fn into_log(self) -> Log {
        self.log
    }
}

/// Takes a step on a copy of a state, which sets the method up and shows whether it can go on from there.
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
