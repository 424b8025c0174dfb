//! A scene in motion.

use std::cell::OnceCell;
use std::sync::Arc;

use sinew_core::{
    Batch, Channel, Inputs, OptionError, Options, Outcome, RecordedSteps, Run, SimulateError,
    StableStep, State, StepError, StepReport, System,
};
use sinew_integrators::Stepper;
use sinew_scene::{
    CutTotals, Cutter, CuttingError, DrivenLoadError, Overlap, OverlapWatch, Scene, SceneError,
    Simulation,
};
use sinew_tools::{Pose, Steering};

use crate::command::{Command, CommandError};
use crate::error::{AdvanceError, RestoreError, WorldError, WorldStepError};
use crate::log::{Entry, Header, Log};
use crate::recorder::{BodyCut, Recorder, Shown};

/// Largest number of a pose (m or rad): far beyond any body, and far from what overflows.
const FARTHEST: f64 = 1e6;

/// Largest factor of a load.
const STRONGEST: f64 = 1e6;

/// A scene in motion: the only thing that takes its steps.
///
/// It holds the scene as it was built, the body after its cuts, state, integrator, tools and inputs. A [`Recorder`]
/// observes the motion of [`World::advance`]; [`Command`]s between steps steer tools, scale loads, cut, and switch
/// methods.
///
/// A world of [`World::new`] takes commands, and its [`Log`] repeats it bit for bit. Without commands it takes the
/// steps of [`World::following`], with the same bits, unless a tool is smaller than the surface triangles somewhere off
/// its path: it may be steered there, and meets triangles from the beginning.
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
    /// The scene as it was built.
    scene: Arc<Simulation>,
    /// The scene on the body after its cuts, with its own loads.
    body: Arc<Simulation>,
    /// The scene as it runs: its loads follow inputs from the first load factor on. Until then they are known in
    /// advance, which some methods need, and every sum has the bits of a run.
    simulation: Arc<Simulation>,
    cutter: Option<Cutter>,
    /// Sheets that the next step begins with.
    sheets: Vec<Sheet>,
    /// The last position of the blade of the last sheet.
    blade: Option<[[f64; 3]; 2]>,
    /// The cut at the beginning of the last step.
    change: Option<BodyCut>,
    method: Method,
    /// Channels without values.
    fresh: Inputs,
    inputs: Inputs,
    tools: Vec<Hand>,
    loads: Vec<Knob>,
    state: State,
    /// Buffer for a step that is tried.
    trial: State,
    steps: usize,
    /// Time (s) after the last step that was taken whole; a step that fails may leave a part of it behind.
    reached: f64,
    failure: Option<WorldStepError>,
    /// Displacement (m) beyond which the motion counts as diverged.
    limit: f64,
    log: Log,
    /// True if tools and loads have their courses alone.
    follows: bool,
}

/// End of [`World::advance`].
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// All steps were taken.
    Finished,
    /// The recorder stopped it.
    Stopped,
    /// A displacement was not finite or passed the limit. The step counts.
    Diverged {
        /// Time (s).
        t: f64,
        /// The degree of freedom that went farthest, in the system's words.
        place: String,
    },
}

/// All that the motion of a world continues from.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// The cutter, as bytes; empty if nothing can cut.
    pub cuts: Vec<u8>,
    /// The state, see [`State::to_bytes`].
    pub state: Vec<u8>,
}

/// The ends (m) of a blade before and after.
type Sheet = [[[f64; 3]; 2]; 2];

/// An integrator with its step.
struct Method {
    integrator: Box<dyn Stepper>,
    dt: f64,
    /// Its id and options, as they were asked for.
    asked: (String, Options),
    stable_step: OnceCell<Option<f64>>,
}

/// A tool that commands may steer.
struct Hand {
    steering: Steering,
    /// Position (m) and rotation vector (rad) to which it moves, and where it stays; `None` while it follows the scene.
    target: Option<([f64; 3], [f64; 3])>,
    /// True if it was given a pose.
    is_steered: bool,
}

/// A load that commands may scale.
struct Knob {
    name: String,
    channel: Channel,
    /// The factor that applies from the next step on.
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

impl World {
    /// Builds a scene that takes commands, and checks that a step can be taken.
    ///
    /// # Errors
    /// [`WorldError`] for a scene that `sinew run` refuses as well, and for files of it that cannot be read again.
    pub fn new(scene: Scene) -> Result<Self, WorldError> {
        let header = Header::of(&scene)?;
        Self::with_header(scene, header)
    }

    /// Like [`World::new`], with a header that is known already.
    pub(crate) fn with_header(scene: Scene, header: Header) -> Result<Self, WorldError> {
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
        let method = Method::of_scene(&simulation)?;
        let mut world = Self {
            tools: tools.collect(),
            loads: loads.collect(),
            fresh: inputs.clone(),
            inputs,
            log: Log::new(header),
            follows: false,
            ..Self::still(simulation, method)?
        };
        let Self {
            simulation,
            inputs,
            state,
            trial,
            method,
            ..
        } = &mut world;
        try_step(simulation.system(), inputs, state, trial, method)?;
        Ok(world)
    }

    /// A world that follows its scene, by an integrator that is set up for it: tools and loads have their courses, and
    /// commands to them are refused.
    ///
    /// # Errors
    /// [`CuttingError`] for a body that cannot be cut, which building the scene rules out.
    pub fn following(
        simulation: Simulation,
        integrator: Box<dyn Stepper>,
    ) -> Result<Self, CuttingError> {
        let settings = simulation.settings();
        let method = Method {
            integrator,
            dt: simulation.dt(),
            asked: (settings.integrator.clone(), settings.options.clone()),
            stable_step: OnceCell::new(),
        };
        Self::still(simulation, method)
    }

    /// The beginning of a motion without inputs.
    fn still(simulation: Simulation, method: Method) -> Result<Self, CuttingError> {
        let state = simulation.initial_state().clone();
        let limit = simulation.run().divergence_limit;
        let simulation = Arc::new(simulation);
        Ok(Self {
            method,
            tools: Vec::new(),
            loads: Vec::new(),
            cutter: simulation.cutter()?,
            sheets: Vec::new(),
            blade: None,
            change: None,
            scene: Arc::clone(&simulation),
            body: Arc::clone(&simulation),
            simulation,
            fresh: Inputs::new(),
            inputs: Inputs::new(),
            trial: state.clone(),
            reached: state.t(),
            state,
            steps: 0,
            failure: None,
            limit,
            log: Log::new(Header::default()),
            follows: true,
        })
    }

    /// The same session, whose log says which values, as `KEY=VALUE`, were set in the scene's file to get the scene.
    #[must_use]
    pub fn with_values(mut self, values: &[String]) -> Self {
        self.log.note_values(values.to_vec());
        self
    }

    /// The scene as it is driven: mesh, tools, loads, title. It is replaced at the first factor of a load, with the
    /// same mesh and tools, and after each cut.
    #[must_use]
    pub fn simulation(&self) -> &Arc<Simulation> {
        &self.simulation
    }

    /// The scene with loads that follow inputs.
    fn driven(&self) -> Result<Simulation, DrivenLoadError> {
        let channels: Vec<Channel> = self.loads.iter().map(|load| load.channel).collect();
        self.body.with_driven_loads(&channels)
    }

    /// External inputs as given so far.
    #[must_use]
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Checks a command, which takes effect with the next step, and keeps it in the log.
    ///
    /// # Errors
    /// [`CommandError`] for a command that cannot be followed: the session continues as before.
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

    /// Begins in the state in which the last of these commands, a reset, left a session: the motion before it is only
    /// in the log.
    pub(crate) fn begin_at_reset(&mut self, commands: &[Entry]) -> Result<(), CommandError> {
        self.command(Command::Reset)?;
        self.log.begin_with(commands);
        self.steps = self.log.steps();
        Ok(())
    }

    /// Checks a command as far as possible before it is given: its names, its numbers and, for the first factor of a
    /// load, whether the method supports loads that are not known in advance. Whether another method can take a step is
    /// found only when it is given.
    ///
    /// # Errors
    /// [`CommandError`] for a command that [`World::command`] refuses as well.
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
            Command::Pose { .. } | Command::LoadFactor { .. } if self.follows => {
                Err(CommandError::Follows)
            }
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

    /// The number of a tool by its name.
    ///
    /// # Errors
    /// [`CommandError::NoTool`].
    pub fn tool(&self, name: &str) -> Result<usize, CommandError> {
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

    /// True if loads follow inputs.
    fn drives_loads(&self) -> bool {
        !Arc::ptr_eq(&self.simulation, &self.body)
    }

    /// The scene with loads that follow inputs, and the method, after a check that it can take a step.
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

    /// Takes one step of [`World::dt`].
    ///
    /// # Errors
    /// [`WorldStepError`] if the motion diverges, a law refuses a state or a method finds no solution: only
    /// [`Command::Reset`] continues from there, and every other step gives the same error.
    pub fn step(&mut self) -> Result<StepReport, WorldStepError> {
        self.guarded(|world| {
            world.begin_step()?;
            let system = world.simulation.system();
            let mut batch = Batch::new(system, &world.inputs, world.method.dt, 1);
            batch = batch.with_divergence_limit(world.limit);
            let taken = batch.take(&mut *world.method.integrator, &mut world.state);
            let (count, work, diverged) = (batch.taken(), batch.work(), batch.diverged());
            world.count(count);
            taken?;
            match diverged {
                Some(dof) => Err(world.diverged(dof)),
                None => Ok(work),
            }
        })
    }

    /// Takes steps under the eyes of a recorder, which sees the present state first.
    ///
    /// # Errors
    /// [`AdvanceError`].
    pub fn advance<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        recorder: &mut R,
    ) -> Result<Ended, AdvanceError> {
        let mut shown = self.show(recorder);
        self.advance_shown(steps, &mut shown)
    }

    /// Takes the steps of [`World::dt`] that cover the time up to `t` (s).
    ///
    /// # Errors
    /// [`AdvanceError`].
    pub fn advance_to<R: Recorder + ?Sized>(
        &mut self,
        t: f64,
        recorder: &mut R,
    ) -> Result<Ended, AdvanceError> {
        let steps = Run::covering(t - self.t(), self.dt()).steps;
        self.advance(steps, recorder)
    }

    /// A recorder that has not seen the present state.
    pub fn show<'r, R: Recorder + ?Sized>(&self, recorder: &'r mut R) -> Shown<'r, R> {
        Shown {
            steps: RecordedSteps::new(recorder),
            simulation: Arc::clone(&self.simulation),
        }
    }

    /// A recorder that saw the motion up to the present state earlier, in so many steps.
    pub fn show_again<'r, R: Recorder + ?Sized>(
        &self,
        recorder: &'r mut R,
        steps: usize,
    ) -> Shown<'r, R> {
        Shown {
            steps: RecordedSteps::resumed(recorder, steps),
            simulation: Arc::clone(&self.simulation),
        }
    }

    /// Takes steps under the eyes of a recorder that may have seen others.
    ///
    /// Between two acts of a blade steps are taken in batches, as by [`sinew_core::simulate()`].
    ///
    /// # Errors
    /// [`AdvanceError`] where a step or the recorder fails. A step that fails is counted as in [`World::step`].
    pub fn advance_shown<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        shown: &mut Shown<'_, R>,
    ) -> Result<Ended, AdvanceError> {
        let end = shown.steps() + steps;
        // The body before any cut is what stands at the beginning.
        let ended = self.take(0, shown)?;
        if steps == 0 || ended != Ended::Finished {
            return Ok(ended);
        }
        loop {
            let span = self.guarded(Self::begin_step)?;
            shown.follow(&self.simulation, &self.inputs, self.change.as_ref())?;
            let ended = self.take(span.min(end - shown.steps()), shown)?;
            if ended != Ended::Finished || shown.steps() >= end {
                return Ok(ended);
            }
        }
    }

    /// Takes steps within which nothing is cut or steered.
    fn take<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        shown: &mut Shown<'_, R>,
    ) -> Result<Ended, AdvanceError> {
        shown.follow(&self.simulation, &self.inputs, None)?;
        let run = Run {
            dt: self.method.dt,
            steps,
            divergence_limit: self.limit,
        };
        let before = shown.steps();
        let system = (self.simulation.system(), &self.inputs);
        let taken = shown
            .steps
            .take(system, &mut *self.method.integrator, &mut self.state, &run);
        self.count(shown.steps() - before);
        match taken {
            Ok(Outcome::Finished) => Ok(Ended::Finished),
            Ok(Outcome::Stopped) => Ok(Ended::Stopped),
            Ok(Outcome::Diverged { dof, .. }) => {
                let failure = self.diverged(dof);
                self.failure = Some(failure.clone());
                match failure {
                    WorldStepError::Diverged { t, place } => Ok(Ended::Diverged { t, place }),
                    failure => Err(failure.into()),
                }
            }
            Err(SimulateError::Step(error)) => {
                let failure = WorldStepError::from(error);
                self.failure = Some(failure.clone());
                Err(failure.into())
            }
            Err(SimulateError::Record(error)) => Err(error.into()),
        }
    }

    /// Keeps the failure of a step.
    fn guarded<T>(
        &mut self,
        act: impl FnOnce(&mut Self) -> Result<T, WorldStepError>,
    ) -> Result<T, WorldStepError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let acted = act(self);
        if let Err(failure) = &acted {
            self.failure = Some(failure.clone());
        }
        acted
    }

    /// Counts steps that were taken.
    fn count(&mut self, steps: usize) {
        self.steps += steps;
        self.reached = self.state.t();
        self.log.ends_after(self.steps);
    }

    fn diverged(&self, dof: usize) -> WorldStepError {
        WorldStepError::Diverged {
            t: self.state.t(),
            place: self.simulation.system().cell_name(dof),
        }
    }

    /// Steers, turns loads and cuts at the beginning of a step; the number of steps until it must be called again.
    fn begin_step(&mut self) -> Result<usize, WorldStepError> {
        let dt = self.method.dt;
        let mut clock = self.state.clock;
        clock.advance(dt);
        let (t, end) = (self.state.t(), clock.time());
        if end <= t {
            return Err(WorldStepError::Time { t, dt });
        }
        self.steer(t, end)?;
        for load in &mut self.loads {
            if let Some(factor) = load.next.take() {
                self.inputs.set(load.channel, t, factor)?;
            }
        }
        self.cut_before(end)?;
        if self.tools.iter().any(|hand| hand.target.is_some()) {
            return Ok(1);
        }
        let idle = match &self.cutter {
            // A stroke that is met late is followed from its beginning all the same.
            Some(cutter) => (cutter.idle_until(t) - t) / dt,
            None => f64::INFINITY,
        };
        Ok((idle as usize).max(1))
    }

    /// Cuts what hands and the scene cut at the beginning of a step that ends at `end` (s).
    fn cut_before(&mut self, end: f64) -> Result<(), WorldStepError> {
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
                return Err(WorldStepError::Cutting(error));
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
            let driven = driven.map_err(|error| WorldStepError::Driven(error.to_string()))?;
            self.simulation = Arc::new(driven);
        }
        self.method.stable_step = OnceCell::new();
        Ok(())
    }

    /// Gives the channels of all tools in hand their poses at the end (s) of a step that begins at `t` (s).
    fn steer(&mut self, t: f64, end: f64) -> Result<(), WorldStepError> {
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

    /// Sets the integrator up for the body and the step.
    ///
    /// # Errors
    /// [`SceneError`] at the key for which it is refused.
    pub fn set_up(&mut self) -> Result<StepReport, SceneError> {
        self.simulation.set_up(&mut *self.method.integrator)
    }

    /// All that the motion continues from, on the same scene.
    #[must_use]
    pub fn save(&self) -> Saved {
        Saved {
            cuts: self.cutter.as_ref().map_or_else(Vec::new, Cutter::to_bytes),
            state: self.state.to_bytes(self.body.system()),
        }
    }

    /// Continues from what [`World::save`] returned in a world that follows the same scene, which has taken no step.
    ///
    /// # Errors
    /// [`RestoreError`] for the bytes of another scene.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), RestoreError> {
        if let Some(cutter) = &mut self.cutter
            && let Some(cut) = cutter.restore(&saved.cuts, &self.scene)?
        {
            self.body = Arc::new(cut);
            self.simulation = Arc::clone(&self.body);
        }
        self.state = State::from_bytes(&saved.state, self.body.system())?;
        self.reached = self.state.t();
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

    /// The largest stable step (s) of the integrator on the body at rest, computed at the first request; `None` if
    /// every step is stable or no limit is known.
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

    /// Deepest overlap now of parts or surfaces of the body, between which there is no contact. A check costs some
    /// microseconds per triangle of the surface: a session makes none automatically.
    #[must_use]
    pub fn overlap(&self) -> Option<Overlap> {
        let mut watch = OverlapWatch::new(self.simulation.model().body()?);
        watch.look_at_state(&self.state).ok()?;
        watch.into_deepest()
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
