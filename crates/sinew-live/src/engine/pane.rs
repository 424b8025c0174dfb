//! One pane: a session and its measurements.

use std::sync::Arc;
use std::time::Instant;

use sinew_core::vectors::weighted_dot;
use sinew_core::{BytesError, Energy, Inputs, LoadTime, Options, StableStep, System};
use sinew_scene::{BodyModel, CutTotals, SceneBody, Simulation};
use sinew_tools::{Pose, Tools};
use sinew_world::{Command, CommandError, Log, Moment, RestoreError, Trial, World};

use super::course::Course;
use super::due::Due;
use super::grip::{Grip, HELD, Patch, late_in};
use super::lights::{Bounds, Light, error_light, packed};
use super::places::place_of;
use super::shown::{Budget, Shown};
use super::sums::Sums;
use super::{options, stability};
use crate::error::LiveError;
use crate::picture::{Plane, Section, Surface};
use crate::protocol::{
    CutHead, Field, FrameWriter, OptionFacts, PaneFacts, PaneHead, SectionHead, StepFacts, ToolHead,
};
use crate::scene_values::SceneValues;

/// Share of a step by which times may differ by rounding.
const SLACK: f64 = 1e-6;

/// The option of an integrator that limits velocities.
pub(super) const GUARD: &str = "saturation";

/// A session and the measurements of its motion.
pub(crate) struct Pane {
    session: World,
    due: Due,
    /// The requested integrator and step, which a reset keeps.
    method: (String, Options, f64),
    /// The method that was chosen, if another one runs in its place.
    replaced: Option<Chosen>,
    /// Reason for which it cannot continue.
    pub(crate) stopped: Option<String>,
    /// Error relative to the trusted run, and time (s) by which the trusted run is behind.
    pub(crate) error: f64,
    pub(crate) lag: f64,
    /// The last integrator and options of the session.
    given: (String, Options),
    step_facts: StepFacts,
    options: Vec<OptionFacts>,
    /// The body in the form for pages; `None` before the first picture.
    shown: Option<Shown>,
    measured: Budget,
    looked: Budget,
    /// True if parts or surfaces of the body overlapped at the last check.
    overlaps: bool,
    sums: Sums,
    ms_per_step: f64,
    /// The tissue that the user pulls.
    held: Option<Held>,
    /// True if forces of the user act.
    is_pulled: bool,
}

/// A method that was chosen for a pane.
#[derive(Clone, Debug)]
enum Chosen {
    /// The method of its scene.
    OfScene,
    /// An integrator with its options and a step (s).
    Method((String, Options, f64)),
}

/// The tools and the tissue that the user moves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hands {
    /// Steered path of each tool; `None` as long as it follows its own motion.
    pub(crate) tools: Vec<Option<Course>>,
    /// Tissue that is pulled without a tool.
    pub(crate) grip: Option<Grip>,
}

/// Tissue that the user pulls.
struct Held {
    patch: Patch,
    /// Trials of the next step, and the way (m/N) along each axis by which a force moves the patch in it, where a step is
    /// as long as a force stays constant.
    trial: Option<(Trial, [f64; 3])>,
    /// Largest stiffness (N/m) of the spring here.
    most: f64,
    /// The force (N), and the time (s) at which it changes.
    force: [f64; 3],
    until: f64,
}

/// A moment of the motion of a pane.
pub(crate) struct PaneMoment {
    session: Moment,
    sums: Sums,
}

impl PaneMoment {
    /// Number of bytes of its fields.
    pub(super) fn bytes(&self) -> usize {
        self.session.bytes()
    }
}

impl Pane {
    /// A pane with its own session of a scene.
    pub(crate) fn of(scene: &SceneValues) -> Result<Self, LiveError> {
        let session = World::new(scene.scene.clone())?.with_values(&scene.values());
        scene.check_files(session.log())?;
        Self::new(session)
    }

    /// A pane with a session of this scene that has not taken a command yet.
    pub(crate) fn new(session: World) -> Result<Self, LiveError> {
        let body = body(&session).ok_or(LiveError::NoBody)?;
        let tools = body.tools.as_ref().map_or(0, |tools| tools.tools().len());
        let dofs = body.model.dofs();
        let mut pane = Self {
            shown: None,
            session,
            due: Due::default(),
            method: (String::new(), Options::new(), 0.0),
            replaced: None,
            stopped: None,
            error: f64::NAN,
            lag: 0.0,
            given: (String::new(), Options::new()),
            step_facts: StepFacts::default(),
            options: Vec::new(),
            measured: Budget::default(),
            looked: Budget::of_overlap(),
            overlaps: false,
            sums: Sums::new(dofs, tools),
            ms_per_step: f64::NAN,
            held: None,
            is_pulled: false,
        };
        pane.given = pane.of_scene();
        let (id, options) = pane.given.clone();
        pane.method = (id, options, pane.session.dt());
        pane.take_first_energy();
        pane.learn();
        Ok(pane)
    }

    /// A pane of another scene at its beginning, with the method that was chosen.
    pub(crate) fn on(&self, scene: &SceneValues) -> Result<Self, String> {
        let mut pane = Self::of(scene).map_err(|error| error.to_string())?;
        if let Chosen::Method(method) = self.chosen() {
            let switched = pane.switch(method);
            switched.map_err(|error| error.to_string())?;
        }
        Ok(pane)
    }

    /// The method that was chosen for it, which another one may have replaced.
    fn chosen(&self) -> Chosen {
        if let Some(replaced) = &self.replaced {
            return replaced.clone();
        }
        let (id, options, dt) = &self.method;
        let (own, dt_of_scene) = (self.of_scene(), self.session.scene().dt());
        match (id, options, *dt) == (&own.0, &own.1, dt_of_scene) {
            true => Chosen::OfScene,
            false => Chosen::Method(self.method.clone()),
        }
    }

    /// Notes that its method replaces the one that was chosen for another pane, which it returns to with [`Self::on`].
    pub(crate) fn is_in_place_of(&mut self, other: &Self) {
        self.replaced = Some(other.chosen());
    }

    /// The integrator and the options of the scene.
    fn of_scene(&self) -> (String, Options) {
        let settings = self.session.scene().settings();
        (settings.integrator.clone(), settings.options.clone())
    }

    /// Switches to another integrator. The scene's options and limit of velocities apply if it is the integrator of the
    /// scene.
    pub(crate) fn use_integrator(&mut self, name: &str) -> Result<(), CommandError> {
        let settings = self.session.scene().settings();
        let own = &settings.options;
        let takes_guard = || {
            let help = sinew_integrators::entry(name).map(|entry| entry.all_options());
            help.is_some_and(|help| help.iter().any(|help| help.key == GUARD))
        };
        let mut options = Options::new();
        if settings.integrator == name {
            options = own.clone();
        } else if let Some(limit) = own.get(GUARD).filter(|_| takes_guard()) {
            options.insert(GUARD, limit.clone());
        }
        let dt = self.method.2;
        let refused = match self.switch((name.to_owned(), options.clone(), dt)) {
            Err(refused) => refused,
            Ok(()) => return Ok(()),
        };
        let entry = sinew_integrators::entry(name).filter(|_| self.tools().is_some());
        let others = entry.map_or_else(Vec::new, |entry| options::alternatives(&entry, &options));
        for options in others {
            if self.switch((name.to_owned(), options, dt)).is_ok() {
                return Ok(());
            }
        }
        Err(refused)
    }

    /// Sets another step (s).
    pub(crate) fn use_step(&mut self, dt: f64) -> Result<(), CommandError> {
        let (id, options, _) = self.method.clone();
        self.switch((id, options, dt))
    }

    /// Sets another value of an option of the integrator: a word, a number, or both.
    pub(crate) fn use_option(
        &mut self,
        key: &str,
        word: Option<String>,
        number: Option<f64>,
    ) -> Result<(), String> {
        let (id, mut options, dt) = self.method.clone();
        let value = options::value_of((&id, &options), key, word, number)?;
        options.insert(key, value);
        self.switch((id, options, dt))
            .map_err(|error| error.to_string())
    }

    /// Switches to another integrator with its own options, and at the same time to another step (s).
    pub(crate) fn use_method(&mut self, name: &str, dt: f64) -> Result<(), CommandError> {
        self.switch((name.to_owned(), Options::new(), dt))
    }

    /// The largest stable step (s) of an integrator on this body, if it has one.
    pub(crate) fn stable_step_of(&self, name: &str) -> Result<Option<f64>, LiveError> {
        let integrator = sinew_integrators::build(name, &Options::new())?;
        let found = integrator.stable_step(self.session.body().system());
        Ok(match found {
            Ok(StableStep::UpTo(step)) => Some(step),
            _ => None,
        })
    }

    /// Continues with another method; a stopped pane starts from the beginning, since its session takes no other
    /// command.
    fn switch(&mut self, method: (String, Options, f64)) -> Result<(), CommandError> {
        if self.stopped.is_some() {
            self.method = method;
            return self.reset();
        }
        self.replaced = None;
        // Its trials are those of the method before.
        self.held = None;
        // The method has to take them as well.
        while self.take_due()? {}
        self.apply(&method)?;
        self.method = method;
        self.learn();
        Ok(())
    }

    /// Sets the method of the session.
    fn apply(&mut self, (id, options, dt): &(String, Options, f64)) -> Result<(), CommandError> {
        let integrator = Command::Integrator {
            id: id.clone(),
            options: options.clone(),
        };
        let is_other = self.given != (id.clone(), options.clone());
        if *dt != self.session.dt() {
            self.session.command(Command::Dt(*dt))?;
        }
        if is_other {
            self.session.command(integrator)?;
            self.given = (id.clone(), options.clone());
        }
        Ok(())
    }

    /// Determines the stable step of the integrator, and its options.
    pub(crate) fn learn(&mut self) {
        let (system, integrator) = (self.session.body().system(), self.session.integrator());
        let found = integrator.stable_step(system);
        let (id, options) = &self.given;
        self.step_facts = stability::facts(
            integrator,
            &self.session.scene().options_of(id, options),
            system,
            found.unwrap_or(StableStep::Unknown),
        );
        self.options = options::facts(id, options);
    }

    /// The limit of velocities (m/s), if any.
    fn limit(&self) -> Option<f64> {
        let guard = self.options.iter().find(|option| option.key == GUARD)?;
        guard.value.filter(|_| guard.word.is_none())
    }

    /// Resets to the beginning, with the current integrator and step, or with those of the scene if these are
    /// refused.
    pub(crate) fn reset(&mut self) -> Result<(), CommandError> {
        self.due.clear();
        self.session.command(Command::Reset)?;
        self.given = self.of_scene();
        self.stopped = None;
        (self.error, self.lag) = (f64::NAN, 0.0);
        self.measured = Budget::default();
        (self.looked, self.overlaps) = (Budget::of_overlap(), false);
        let (dofs, tools) = (self.session.state().u.len(), self.sums.led.len());
        self.sums = Sums::new(dofs, tools);
        self.sums.settling.disturbed(self.session.t());
        (self.held, self.is_pulled) = (None, false);
        self.take_first_energy();
        let applied = self.apply(&self.method.clone());
        if applied.is_err() {
            let (id, options) = self.given.clone();
            self.method = (id, options, self.session.dt());
        }
        self.learn();
        applied
    }

    fn take_first_energy(&mut self) {
        let state = self.session.state();
        let energy = self.session.body().system().energy(&state.u, &state.v);
        self.sums.kinetic = energy.as_ref().map_or(0.0, |energy| energy.kinetic);
        self.sums.load_work = 0.0;
        self.sums.energies.first = energy.map_or(0.0, Energy::total);
    }

    /// The present moment of its motion.
    pub(crate) fn moment(&self) -> PaneMoment {
        PaneMoment {
            session: self.session.moment(),
            sums: self.sums.clone(),
        }
    }

    /// Goes back to a moment since its last reset and its last change of method; commands that wait are dropped.
    pub(crate) fn go_back(&mut self, to: &PaneMoment) -> Result<(), RestoreError> {
        self.session.go_back(&to.session)?;
        self.sums.clone_from(&to.sums);
        self.due.clear();
        self.stopped = None;
        (self.error, self.lag) = (f64::NAN, 0.0);
        self.held = None;
        self.is_pulled = self.session.inputs().forces().next().is_some();
        self.sums.settling.disturbed(self.session.t());
        Ok(())
    }

    /// Adds a command that takes effect with the first step from a simulated time (s) on. A stopped pane takes no more
    /// steps.
    pub(crate) fn command_at(&mut self, t: f64, command: Command) {
        if self.stopped.is_none() {
            self.due.add(t, command);
        }
    }

    /// Number of cuts that wait for a step.
    pub(crate) fn waiting_cuts(&self) -> usize {
        self.due.cuts()
    }

    /// Gives the session a command that is due; returns true if there was one.
    fn take_due(&mut self) -> Result<bool, CommandError> {
        let t = self.session.t();
        let Some(command) = self.due.next_until(t + SLACK * self.session.dt()) else {
            return Ok(false);
        };
        self.sums.settling.disturbed(t);
        self.session.command(command).map(|()| true)
    }

    /// True if it has stepped up to a simulated time (s), or takes no more steps.
    pub(crate) fn is_at(&self, until: f64) -> bool {
        let (t, dt) = (self.session.t(), self.session.dt());
        self.stopped.is_some() || t + dt > until + SLACK * dt
    }

    /// Steps up to a simulated time (s), but not beyond, as long as it `may` continue; returns an error message if a
    /// command was refused.
    pub(crate) fn follow(
        &mut self,
        until: f64,
        hands: &Hands,
        may: impl Fn() -> bool,
    ) -> Option<String> {
        let mut refused = None;
        while !self.is_at(until) && may() {
            loop {
                match self.take_due() {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(error) => refused = Some(error.to_string()),
                }
            }
            if let Err(reason) = self.step(hands) {
                self.stopped = Some(reason);
            }
        }
        refused
    }

    fn step(&mut self, hands: &Hands) -> Result<(), String> {
        let (t, dt) = (self.session.t(), self.session.dt());
        self.pull(hands.grip.as_ref(), t, dt)
            .map_err(|error| error.to_string())?;
        for (tool, hand) in self.session.tools().zip(&hands.tools) {
            let Some(hand) = hand else {
                continue;
            };
            let pose = hand.at(t + dt);
            if self.sums.led[tool.index()] == Some(pose) {
                continue;
            }
            let [x, y, z, a, b, c] = pose;
            self.sums.led[tool.index()] = Some(pose);
            self.sums.settling.disturbed(t);
            let steered = self.session.steer(tool, [x, y, z], [a, b, c]);
            steered.map_err(|error| error.to_string())?;
        }
        self.sums.before.copy_from_slice(&self.session.state().u);
        self.receive();
        let begun = Instant::now();
        let stepped = self.session.step();
        self.sums.fit(&self.session.state().u);
        let report = stepped.map_err(|error| error.to_string())?;
        if let Some(change) = self.session.change() {
            self.sums.before.copy_from_slice(&change.after.u);
            self.sums.settling.disturbed(t);
        }
        let ms = 1e3 * begun.elapsed().as_secs_f64();
        self.ms_per_step = match self.ms_per_step.is_nan() {
            true => ms,
            false => 0.95 * self.ms_per_step + 0.05 * ms,
        };
        self.sums.saturated += report.saturated;
        self.sums.steps += 1;
        self.sums.has_stepped = true;
        self.sums.span += dt;
        self.look(dt);
        Ok(())
    }

    /// Pulls the tissue before a step of `dt` from `t` (s) on.
    fn pull(&mut self, grip: Option<&Grip>, t: f64, dt: f64) -> Result<(), CommandError> {
        let Some(grip) = grip else {
            self.held = None;
            if std::mem::take(&mut self.is_pulled) {
                self.session.command(Command::Forces(Vec::new()))?;
            }
            return Ok(());
        };
        self.sums.settling.disturbed(t);
        let Some(body) = body(&self.session) else {
            return Ok(());
        };
        if self
            .held
            .as_ref()
            .is_none_or(|held| !held.patch.is_of(grip, body))
        {
            let patch = Patch::of(grip, body);
            let trial = match late_in(dt) {
                None if patch.has_nodes() => {
                    let mut trial = self.session.trial()?;
                    let compliance = patch.compliance(&self.session, &mut trial)?;
                    Some((trial, compliance))
                }
                _ => None,
            };
            self.held = Some(Held {
                most: patch.stiffness(body, late_in(dt)),
                patch,
                trial,
                force: [0.0; 3],
                until: t,
            });
        }
        let Some(held) = self.held.as_mut().filter(|held| held.patch.has_nodes()) else {
            return Ok(());
        };
        if t >= held.until - SLACK * dt {
            held.until = t + HELD;
            held.force = match &mut held.trial {
                Some((trial, compliance)) => {
                    let free = held.patch.place(body, &trial.next(&self.session, &[])?.u);
                    grip.force_at_end(t + dt, free, *compliance)
                }
                None => {
                    let place = held.patch.place(body, &self.session.state().u);
                    grip.force(t + dt, place, held.most)
                }
            };
            let forces = Command::Forces(held.patch.forces(held.force));
            self.is_pulled = true;
            self.session.command(forces)?;
        }
        for (pulled, force) in self.sums.pulled.iter_mut().zip(held.force) {
            *pulled += dt * force;
        }
        Ok(())
    }

    /// A grip at a point of its surface, with a number and its client.
    ///
    /// # Errors
    /// A sentence for a point that it does not have, and for tissue that does not move.
    pub(crate) fn grip(&self, who: (u64, u32), point: usize) -> Result<Grip, String> {
        let (body, surface) = self.seen_body().ok_or("nothing is shown yet")?;
        let node = *surface
            .nodes
            .get(point)
            .ok_or_else(|| format!("there is no point {point}"))?;
        let grip = Grip::at(who, body, node);
        let patch = Patch::of(&grip, body);
        if !patch.has_nodes() {
            return Err("this tissue is fixed: pull it elsewhere".to_owned());
        }
        Ok(grip.placed_at(self.t(), patch.place(body, &self.session.state().u)))
    }

    /// The largest stiffness (N/m) of the spring of a grip on its body.
    ///
    /// # Errors
    /// A sentence if its method takes no forces that are not known in advance.
    pub(crate) fn stiffness_of(&self, grip: &Grip) -> Result<f64, String> {
        let Some(body) = body(&self.session) else {
            return Ok(f64::INFINITY);
        };
        let patch = Patch::of(grip, body);
        if !patch.has_nodes() {
            return Ok(f64::INFINITY);
        }
        let forces = Command::Forces(patch.forces([0.0, 0.0, f64::EPSILON]));
        let checked = self.session.check(&forces);
        checked.map_err(|error| error.to_string())?;
        Ok(patch.stiffness(body, late_in(self.dt())))
    }

    /// Records the impulses that tools have received before a step.
    fn receive(&mut self) {
        for (tool, received) in self.session.tools().zip(&mut self.sums.received) {
            let report = self.session.tool_report(tool);
            *received = report.map_or([0.0; 3], |report| report.impulse);
        }
    }

    /// Adds a step to impulses, work and other sums.
    fn look(&mut self, dt: f64) {
        let (system, state) = (self.session.body().system(), self.session.state());
        let all = self.sums.impulses.iter_mut().zip(&self.sums.received);
        for (tool, (impulse, before)) in self.session.tools().zip(all) {
            let report = self.session.tool_report(tool);
            let after = report.map_or(*before, |report| report.impulse);
            for axis in 0..3 {
                impulse[axis] += after[axis] - before[axis];
            }
        }
        for ((middle, before), u) in self
            .sums
            .middle
            .iter_mut()
            .zip(&self.sums.before)
            .zip(&state.u)
        {
            *middle = 0.5 * (before + u);
        }
        let when = LoadTime::at(state.t() - 0.5 * dt).under(self.session.inputs());
        system.external_force(when, &self.sums.middle, &mut self.sums.force);
        let moved = self.sums.before.iter().zip(&state.u).zip(&self.sums.force);
        self.sums.load_work += moved
            .map(|((before, after), force)| force * (after - before))
            .sum::<f64>();
        let kinetic = 0.5 * weighted_dot(system.mass(), &state.v, &state.v);
        self.sums.kinetic = kinetic;
        self.sums.settling.step(state.t(), dt, kinetic);
    }

    /// Computes the energies; the elastic one halfway through the last step, the time of its velocity.
    fn measure(&mut self) {
        if !self.measured.is_due() {
            return;
        }
        let begun = Instant::now();
        let state = self.session.state();
        let u = match self.sums.has_stepped {
            true => &self.sums.middle,
            false => &state.u,
        };
        let energy = self.session.body().system().energy(u, &state.v);
        let energies = &mut self.sums.energies;
        (energies.kinetic, energies.loads) = (self.sums.kinetic, self.sums.load_work);
        energies.tools = self.session.work_of_tools();
        energies.cuts = self.session.cuts().map_or(0.0, CutTotals::energy);
        energies.elastic = energy.map_or(f64::NAN, |energy| energy.elastic);
        let total = energies.kinetic + energies.elastic;
        energies.scale = [total, energies.loads.abs(), energies.tools.abs()]
            .into_iter()
            .fold(energies.scale, f64::max);
        self.measured.spent_since(begun);
    }

    /// Checks its body for self-overlap.
    fn look_for_overlap(&mut self) {
        if self.looked.is_due() {
            let begun = Instant::now();
            self.overlaps = self.session.overlap().is_some();
            self.looked.spent_since(begun);
        }
    }

    /// True if its body differs from the one that pages have received, so that a new one must be sent.
    pub(crate) fn see_body(&mut self, uncut: &Surface) -> bool {
        let Some(body) = body(&self.session) else {
            return false;
        };
        if self.shown.as_ref().is_some_and(|shown| shown.is_of(body)) {
            return false;
        }
        self.shown = Some(Shown::of(&self.session, body, uncut));
        true
    }

    /// True if its body was cut.
    pub(crate) fn is_cut(&self) -> bool {
        body(&self.session).is_some_and(|body| body.cut.is_some())
    }

    /// Its body with the surface shown on pages.
    pub(crate) fn seen_body(&self) -> Option<(&BodyModel, &Surface)> {
        Some((body(&self.session)?, &self.shown.as_ref()?.surface))
    }

    /// Writes it into a picture, with the depth of tools in the body at rest before all cuts, and the user's tool
    /// poses.
    pub(crate) fn write(
        &mut self,
        frame: &mut FrameWriter,
        (uncut, hands): (&Surface, &Hands),
        (field, plane): (Field, Option<Plane>),
        anew: bool,
    ) {
        self.measure();
        self.look_for_overlap();
        let t = self.session.t();
        let limit = self.limit();
        if let Some(shown) = &mut self.shown {
            shown.paint(&self.session, (field, limit), anew);
            shown.cut(plane);
        }
        let lights = self.lights();
        let (colours, reasons) = packed(lights);
        let cuts = self.cuts();
        let (body, Some(shown)) = (body(&self.session), &self.shown) else {
            return;
        };
        let state = self.session.state();
        let tools = body.and_then(|body| body.tools.as_deref());
        let saturated = match self.sums.steps * state.v.len() as u64 {
            0 => 0.0,
            all => self.sums.saturated as f64 / all as f64,
        };
        let reports =
            (0..self.sums.impulses.len()).filter_map(|tool| Some(tools?.report(state, tool)));
        let contacts: usize = reports.map(|report| report.contacts).sum();
        let held = self.held.as_ref().filter(|held| held.patch.has_nodes());
        let head = PaneHead {
            step: self.session.steps() as u64,
            t,
            dt: self.session.dt(),
            kinetic: self.sums.energies.kinetic,
            elastic: self.sums.energies.elastic,
            tool_work: self.sums.energies.tools,
            load_work: self.sums.energies.loads,
            ms_per_step: self.ms_per_step,
            error: self.error,
            lag: self.lag,
            saturated,
            settling: self.sums.settling.ratio(),
            lights: colours,
            reasons,
            inverted: shown.inverted(),
            contacts: contacts as u32,
            balance: self.sums.energies.balance(),
            nodes: body.map_or(0, |body| body.mesh.points.len()) as u32,
            tets: body.map_or(0, |body| body.mesh.tets.len()) as u32,
            cuts,
            pull: match (held, self.sums.span > 0.0) {
                (Some(_), true) => self.sums.pulled.map(|impulse| impulse / self.sums.span),
                _ => [0.0; 3],
            },
            grip: match (held, body) {
                (Some(held), Some(body)) => held.patch.place(body, &self.session.state().u),
                _ => [f64::NAN; 3],
            },
            section: plane.map_or_else(SectionHead::default, |plane| SectionHead {
                axis: plane.axis as u32,
                triangles: (shown.section.values.len() / 3) as u32,
                at: plane.at,
            }),
        };
        frame.pane(&head, shown.surface.points.len(), self.sums.impulses.len());
        let all = self.session.tools().zip(&mut self.sums.impulses);
        for ((tool, impulse), hand) in all.zip(&hands.tools) {
            let (Some(tools), Some(report)) = (tools, self.session.tool_report(tool)) else {
                continue;
            };
            let pose = self.session.tool_pose(tool);
            let ([x, y, z], [a, b, c]) = (pose.position(), pose.rotation_vector());
            let own = [x, y, z, a, b, c];
            let force = match self.sums.span > 0.0 {
                true => impulse.map(|impulse| impulse / self.sums.span),
                false => report.force,
            };
            let shape = &tools.tools()[tool.index()].shape;
            frame.tool(&ToolHead {
                pose: own,
                force,
                depth: uncut.depth(shape, &pose),
                gap: (self.session.tool_gap(tool)).map_or(f64::INFINITY, |depth| depth.gap),
                hand: hand.as_ref().map_or(own, Course::end),
            });
            *impulse = [0.0; 3];
        }
        (self.sums.span, self.sums.saturated, self.sums.steps) = (0.0, 0, 0);
        self.sums.pulled = [0.0; 3];
        frame.points(shown.places(), shown.values());
        let Section { places, values } = &shown.section;
        frame.points(places.iter().copied(), values);
    }

    /// Totals of all cuts.
    fn cuts(&self) -> CutHead {
        let (Some(totals), Some(shown)) = (self.session.cuts(), &self.shown) else {
            return CutHead {
                area: f64::NAN,
                energy: f64::NAN,
                blade_work: f64::NAN,
                pieces: 1,
                ..CutHead::default()
            };
        };
        let report = &totals.report;
        let energy = report.energy_gained.map_or(f64::NAN, Energy::total);
        CutHead {
            area: report.area,
            // Nothing is known of the energy of what was not cut yet but that it stays.
            energy: if totals.changes == 0 { 0.0 } else { energy },
            blade_work: totals.blade_work,
            new_nodes: report.new_nodes as u32,
            pieces: shown.pieces as u32,
            removed: report.removed_tets as u32,
            changes: totals.changes as u32,
        }
    }

    fn lights(&self) -> [Light; 3] {
        let bounded = match self.sums.has_stepped {
            false => Light::GREY,
            true => Bounds {
                stopped: self.stopped.is_some(),
                is_saturated: self.sums.saturated > 0,
                inverted: self.shown.as_ref().map_or(0, Shown::inverted),
                overlaps: self.overlaps,
                balance: self.sums.energies.balance(),
                scale: self.sums.energies.scale,
            }
            .light(),
        };
        [
            bounded,
            self.sums.settling.light(self.session.t()),
            error_light(self.error),
        ]
    }

    /// Its state as a checkpoint.
    pub(crate) fn state_bytes(&self) -> Result<Vec<u8>, BytesError> {
        let system = self.session.body().system();
        self.session.state().to_bytes(system)
    }

    /// All commands so far.
    pub(crate) fn log(&self) -> &Log {
        self.session.log()
    }

    /// All commands so far, after its end.
    pub(crate) fn into_log(self) -> Log {
        self.session.into_log()
    }

    /// Checks a command before it is given.
    pub(crate) fn check(&self, command: &Command) -> Result<(), CommandError> {
        self.session.check(command)
    }

    /// Its settings.
    pub(crate) fn facts(&self) -> PaneFacts {
        PaneFacts {
            integrator: self.session.integrator().id().to_owned(),
            dt: self.session.dt(),
            step: self.step_facts,
            options: self.options.clone(),
            stopped: self.stopped.clone(),
        }
    }

    /// Its scene.
    pub(crate) fn scene(&self) -> &Arc<Simulation> {
        self.session.scene()
    }

    /// Its current body.
    pub(crate) fn body(&self) -> &Arc<SceneBody> {
        self.session.body()
    }

    /// The largest stable step (s) of its integrator on its current body, if it has one.
    pub(crate) fn stable_step(&self) -> Option<f64> {
        self.session.stable_step()
    }

    /// False if its step is known to be unstable.
    pub(crate) fn has_stable_step(&self) -> bool {
        let stable_step = self.step_facts.stable_step;
        stable_step.is_none_or(|stable_step| self.dt() <= stable_step)
    }

    /// Simulated time (s).
    pub(crate) fn t(&self) -> f64 {
        self.session.t()
    }

    /// Step (s).
    pub(crate) fn dt(&self) -> f64 {
        self.session.dt()
    }

    /// Displacement (m) of the degrees of freedom.
    pub(crate) fn u(&self) -> &[f64] {
        &self.session.state().u
    }

    /// Displacement (m) before the last step.
    pub(crate) fn u_before(&self) -> &[f64] {
        &self.sums.before
    }

    /// Position (m) and rotation vector (rad) of a tool now.
    pub(crate) fn tool_pose(&self, tool: usize) -> [f64; 6] {
        let id = self.session.tools().nth(tool);
        let pose = id.map_or(Pose::identity(), |id| self.session.tool_pose(id));
        let ([x, y, z], [a, b, c]) = (pose.position(), pose.rotation_vector());
        [x, y, z, a, b, c]
    }

    /// The place (m) of the element that the message of a failed step names, in the last complete state.
    pub(crate) fn place_in(&self, reason: &str) -> Option<[f64; 3]> {
        let (_, after) = reason.split_once("element ")?;
        let digits = after
            .split(|letter: char| !letter.is_ascii_digit())
            .next()?;
        let element: usize = digits.parse().ok()?;
        let body = body(&self.session)?;
        let nodes = body.mesh.tets.get(element)?;
        let u = &self.session.state().u;
        let mut middle = [0.0; 3];
        for place in nodes.map(|node| place_of(body, u, node)) {
            for axis in 0..3 {
                middle[axis] += 0.25 * place[axis];
            }
        }
        middle.iter().all(|own| own.is_finite()).then_some(middle)
    }

    /// The place (m) of a tool at the beginning, along `x` and `y`.
    pub(crate) fn first_tool_place(&self, tool: usize) -> [f64; 2] {
        let state = self.session.scene().initial_state();
        let pose = self
            .tools()
            .map(|tools| tools.pose(state, Inputs::none(), tool));
        let [x, y, _] = pose.unwrap_or(Pose::identity()).position();
        [x, y]
    }

    /// Distance (m) of the farthest point of a tool from its place; 0 without one.
    pub(crate) fn reach_of(&self, tool: usize) -> f64 {
        let tool = self.tools().and_then(|tools| tools.tools().get(tool));
        let reach = tool.map_or(0.0, |tool| tool.shape.reach());
        if reach.is_finite() { reach } else { 0.0 }
    }

    /// The tools that touch its body.
    pub(crate) fn tools(&self) -> Option<&Arc<Tools>> {
        self.session.body().model().tools()
    }
}

/// The body of a session.
fn body(session: &World) -> Option<&BodyModel> {
    session.body().model().body().map(|body| &**body)
}
