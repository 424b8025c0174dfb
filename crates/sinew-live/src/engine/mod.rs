//! The thread that simulates.

mod common;
mod course;
mod lights;
mod options;
mod pace;
mod pane;
mod saved;
mod shown;
mod stability;
mod survey;
mod topology;
mod trusted;

use std::sync::Arc;
use std::time::{Duration, Instant};

use sinew_scene::Scene;
use sinew_session::{Command, CommandError, Session};

use self::course::Course;
use self::pace::Pace;
use self::pane::Pane;
pub(crate) use self::survey::Survey;
use self::topology::Topology;
use self::trusted::Trusted;
use crate::ended::Ended;
use crate::error::LiveError;
use crate::inbox::{Place, Request, Waiting};
use crate::pane_choice::PaneChoice;
use crate::picture::Surface;
use crate::protocol::{Event, Field, FrameHead, FrameWriter, Order};
use crate::server::Shared;

/// Simulated time (s) in which a tool goes to where the hand is: a jump within one step would be a blow.
const GLIDE: f64 = 0.004;

/// Time for which it steps before it looks at commands and pictures again.
const LOOK: Duration = Duration::from_millis(10);

/// Shortest time between two pictures: with a credit to spare, the second is fresh when the screen is drawn.
const BETWEEN_PICTURES: Duration = Duration::from_millis(8);

/// Shortest time between two tellings of the settings, so that one page's commands do not flood the others.
const BETWEEN_TELLINGS: Duration = Duration::from_millis(15);

/// Longest wait where there is nothing to do.
const IDLE: Duration = Duration::from_millis(100);

/// Time without a cut after which the stable steps of a body that was cut are asked for: that may take longer than a cut.
const CALM: Duration = Duration::from_millis(500);

/// Most panes.
const MOST_PANES: usize = 2;

/// The sessions, and who drives them.
pub(crate) struct Engine {
    scene: Scene,
    panes: Vec<Pane>,
    /// The other pane, where one comes.
    second: PaneChoice,
    /// Where each tool is led; `None` as long as it goes its own way.
    hands: Vec<Option<Course>>,
    /// Names and factors of the loads, and those at the beginning.
    loads: Vec<String>,
    factors: Vec<f64>,
    first_factors: Vec<f64>,
    /// The surface of the body before all cuts.
    uncut: Surface,
    topology: Topology,
    /// When a body became another one whose stable steps were not asked for yet.
    cut_at: Option<Instant>,
    /// Whether those that are known are of a body that was cut.
    knows_cut: bool,
    field: Field,
    repaint: bool,
    trusted: Option<Trusted>,
    paused: bool,
    /// Simulated time (s) up to which commands are known.
    t: f64,
    pace: Pace,
    pictures: u32,
    last_picture: Option<Instant>,
    changed: bool,
    /// Whether settings are other than pages know, and whether all went back to the beginning.
    news: News,
    /// Poses under way: client, number of the command, simulated time (s) of the arrival.
    under_way: Vec<(u32, u32, f64)>,
}

/// What pages have not been told yet.
#[derive(Clone, Copy, Debug, Default)]
struct News {
    settings: bool,
    went_back: bool,
    last_told: Option<Instant>,
}

/// What an engine begins with.
pub(crate) struct Beginning {
    pub(crate) scene: Scene,
    pub(crate) panes: Vec<PaneChoice>,
    pub(crate) second: PaneChoice,
    pub(crate) field: Field,
    pub(crate) loads: Vec<String>,
    pub(crate) factors: Vec<f64>,
}

impl Engine {
    /// Builds the sessions.
    pub(crate) fn new(
        beginning: Beginning,
        session: Session,
        uncut: Surface,
    ) -> Result<Self, LiveError> {
        let Beginning {
            scene,
            panes: choices,
            second,
            field,
            loads,
            factors,
        } = beginning;
        let mut panes = vec![Pane::new(session)?];
        while panes.len() < choices.len() {
            panes.push(Pane::of(&scene)?);
        }
        for (pane, choice) in panes.iter_mut().zip(&choices) {
            choose(pane, choice)?;
        }
        let tools = panes
            .first()
            .and_then(Pane::tools)
            .map_or(0, |tools| tools.tools().len());
        let t = panes.first().map_or(0.0, Pane::t);
        let mut engine = Self {
            scene,
            panes,
            second,
            hands: vec![None; tools],
            loads,
            first_factors: factors.clone(),
            factors,
            uncut,
            topology: Topology::default(),
            cut_at: None,
            knows_cut: false,
            field,
            repaint: true,
            trusted: None,
            paused: false,
            t,
            pace: Pace::new(t),
            pictures: 0,
            last_picture: None,
            changed: true,
            news: News::default(),
            under_way: Vec::new(),
        };
        engine.set_first_factors();
        Ok(engine)
    }

    /// Simulates until it is told to end.
    pub(crate) fn run(mut self, shared: &Arc<Shared>, mut survey: Survey) -> Ended {
        let mut waiting = Waiting::default();
        self.pace = Pace::new(self.t);
        loop {
            shared.inbox.take(&mut waiting, self.patience(shared));
            if waiting.ends {
                return Ended {
                    t: self.t,
                    logs: self.panes.into_iter().map(Pane::into_log).collect(),
                };
            }
            self.obey(&mut waiting, shared);
            self.tell(shared);
            if !self.paused {
                self.advance(shared);
            }
            self.show(shared);
            self.learn_after_cuts(shared, &mut survey);
        }
    }

    /// How long nothing is to be done, unless something comes.
    fn patience(&self, shared: &Shared) -> Duration {
        let until_step = match self.paused {
            true => IDLE,
            false => self.pace.until(self.t + self.tick()),
        };
        let until_picture = match (self.changed, self.last_picture) {
            (true, Some(last)) if shared.clients.want_a_frame() => {
                BETWEEN_PICTURES.saturating_sub(last.elapsed())
            }
            (true, None) if shared.clients.want_a_frame() => Duration::ZERO,
            _ => IDLE,
        };
        let until_told = match (self.news.settings, self.news.last_told) {
            (true, Some(last)) => BETWEEN_TELLINGS.saturating_sub(last.elapsed()),
            _ => IDLE,
        };
        until_step.min(until_picture).min(until_told).min(IDLE)
    }

    /// Length (s) of the spans that all panes step through together: the longest of their steps.
    fn tick(&self) -> f64 {
        let steps = self.panes.iter().map(Pane::dt);
        steps.fold(0.0, f64::max)
    }

    fn advance(&mut self, shared: &Shared) {
        let begun = Instant::now();
        let tick = self.tick();
        while self.t + tick <= self.pace.target() && begun.elapsed() < LOOK {
            self.take_tick(tick, shared);
        }
        self.pace.note(self.t);
    }

    fn take_tick(&mut self, tick: f64, shared: &Shared) {
        let until = self.t + tick;
        let mut oldest = until;
        for (number, pane) in self.panes.iter_mut().enumerate() {
            let was_stopped = pane.stopped.is_some();
            if let Some(reason) = pane.follow(until, &self.hands) {
                shared.clients.tell_all(&Event::Refused { reason });
            }
            if let Some(reason) = pane.stopped.clone().filter(|_| !was_stopped) {
                let pane = number;
                shared.clients.tell_all(&Event::Stopped { pane, reason });
                self.news.settings = true;
            }
            if pane.stopped.is_none() {
                oldest = oldest.min(pane.t());
            }
        }
        if let Some(trusted) = &mut self.trusted {
            for (number, pane) in self.panes.iter_mut().enumerate() {
                (pane.error, pane.lag) = trusted.error(number, pane.t());
            }
            if let Err(reason) = trusted.span(until, tick, &self.hands, &self.panes) {
                self.distrust(reason, shared);
            }
        }
        self.t = until;
        for hand in self.hands.iter_mut().flatten() {
            hand.forget_before(oldest);
        }
        self.under_way.retain(|(client, id, arrival)| {
            let is_there = *arrival <= until + 1e-12;
            if is_there {
                shared.clients.applied(*client, *id);
            }
            !is_there
        });
        self.changed = true;
    }

    fn show(&mut self, shared: &Shared) {
        let is_early = self
            .last_picture
            .is_some_and(|last| last.elapsed() < BETWEEN_PICTURES);
        if !self.changed || is_early || !shared.clients.want_a_frame() {
            return;
        }
        self.pictures = self.pictures.wrapping_add(1);
        if self.topology.follow(&mut self.panes, &self.uncut) {
            self.repaint = true;
            if self.knows_cut || self.panes.iter().any(Pane::is_cut) {
                self.cut_at = Some(Instant::now());
            }
        }
        let head = FrameHead {
            frame: self.pictures,
            epoch: self.topology.epoch,
            panes: self.panes.len() as u32,
            field: self.field as u32,
            pace: self.pace.mean(),
        };
        let seen = self.panes.iter().filter_map(Pane::seen_body);
        let points: Vec<usize> = seen.map(|(_, surface)| surface.points.len()).collect();
        let mut frame = FrameWriter::new(&head, &points, self.hands.len());
        for pane in &mut self.panes {
            pane.write(&mut frame, &self.uncut, self.field, self.repaint);
        }
        let Topology { epoch, message } = &self.topology;
        shared.clients.show(frame.finish(), *epoch, message);
        (self.changed, self.repaint) = (false, false);
        self.last_picture = Some(Instant::now());
    }

    /// Asks for the stable steps on bodies that became other ones, once nothing cuts any more.
    fn learn_after_cuts(&mut self, shared: &Arc<Shared>, survey: &mut Survey) {
        let is_calm = self.cut_at.is_some_and(|last| last.elapsed() >= CALM);
        let Some(first) = self
            .panes
            .first()
            .filter(|_| is_calm && survey.is_finished())
        else {
            return;
        };
        // Without a thread pages keep what they know.
        if let Ok(begun) = Survey::start(shared, first.simulation()) {
            *survey = begun;
        }
        (self.cut_at, self.knows_cut) = (None, first.is_cut());
        for pane in &mut self.panes {
            pane.learn();
        }
        self.news.settings = true;
    }

    fn obey(&mut self, waiting: &mut Waiting, shared: &Shared) {
        for client in waiting.entered.drain(..) {
            shared.clients.tell(client, &self.settings());
            self.changed = true;
        }
        for Request { client, id, what } in waiting.orders.drain(..) {
            let is_pose = matches!(what, Order::Pose { .. });
            match self.carry_out(client, id, what, shared) {
                Ok(()) => {}
                Err(reason) => shared.clients.tell(client, &Event::Refused { reason }),
            }
            if !is_pose {
                shared.clients.applied(client, id);
                self.news.settings = true;
                (self.changed, self.repaint) = (true, true);
            }
        }
        for Request { client, id, what } in waiting.poses.drain(..) {
            if let Err(reason) = self.lead(client, id, what) {
                shared.clients.tell(client, &Event::Refused { reason });
            }
        }
    }

    /// Tells pages what is new, but not too often.
    fn tell(&mut self, shared: &Shared) {
        let is_early = |last: Instant| last.elapsed() < BETWEEN_TELLINGS;
        if !self.news.settings || self.news.last_told.is_some_and(is_early) {
            return;
        }
        if self.news.went_back {
            shared.clients.tell_all(&Event::Reset);
        }
        shared.clients.tell_all(&self.settings());
        self.news = News {
            last_told: Some(Instant::now()),
            ..News::default()
        };
    }

    /// Leads a tool to a pose.
    fn lead(&mut self, client: u32, id: u32, place: Place) -> Result<(), String> {
        let Place { tool, pose } = place;
        let [x, y, z, a, b, c] = pose;
        let first = self.panes.first();
        let name = first.and_then(|pane| Some(pane.tools()?.tools().get(tool)?.name.clone()));
        let (Some(name), Some(hand)) = (name, self.hands.get(tool)) else {
            return Err(format!("there is no tool {tool}"));
        };
        let is_new = hand.is_none();
        self.check(&Command::Pose {
            tool: name,
            position: [x, y, z],
            rotation_vector: [a, b, c],
        })?;
        let (t, arrival) = (self.t, self.t + GLIDE.max(self.tick()));
        let here = first.filter(|_| is_new).map(|pane| pane.tool_pose(tool));
        let course =
            self.hands[tool].get_or_insert_with(|| Course::at_rest(t, here.unwrap_or_default()));
        course.go(t, pose, arrival);
        // Also while time stops it holds no more than one of each client at a time.
        self.under_way
            .retain(|(other, _, then)| *other != client || *then < arrival);
        self.under_way.push((client, id, arrival));
        Ok(())
    }

    fn carry_out(
        &mut self,
        client: u32,
        id: u32,
        order: Order,
        shared: &Shared,
    ) -> Result<(), String> {
        let words = |error: CommandError| error.to_string();
        match order {
            Order::Pose {
                tool,
                position: [x, y, z],
                rotation: [a, b, c],
            } => {
                let pose = [x, y, z, a, b, c];
                return self.lead(client, id, Place { tool, pose });
            }
            Order::Load { load, factor } => {
                let place = self.loads.iter().position(|name| *name == load);
                let command = Command::LoadFactor { load, factor };
                self.check(&command)?;
                if let Some(factor_of) = place.and_then(|place| self.factors.get_mut(place)) {
                    *factor_of = factor;
                }
                for pane in &mut self.panes {
                    pane.command_at(self.t, command.clone());
                }
                if let Some(trusted) = &mut self.trusted {
                    trusted.command_at(self.t, command);
                }
            }
            Order::Cut { from, to } => {
                let command = Command::Cut { from, to };
                self.check(&command)?;
                for pane in &mut self.panes {
                    pane.command_at(self.t, command.clone());
                }
                if let Some(trusted) = &mut self.trusted {
                    trusted.command_at(self.t, command);
                }
            }
            Order::Integrator { pane, name } => {
                self.pane(pane)?.use_integrator(&name).map_err(words)?;
            }
            Order::Dt { pane, dt } => {
                if !(1e-6..=1.0).contains(&dt) {
                    return Err(format!("a step of {dt} s: expected 1e-6 to 1 s"));
                }
                self.pane(pane)?.use_step(dt).map_err(words)?;
            }
            Order::Option {
                pane,
                key,
                word,
                number,
            } => self.pane(pane)?.use_option(&key, word, number)?,
            Order::Pause { on } => {
                self.paused = on;
                self.pace = Pace::new(self.t);
            }
            Order::Step => {
                self.paused = true;
                self.take_tick(self.tick(), shared);
            }
            Order::Reset => {
                if self.trusted.is_some() {
                    self.trusted = Some(self.begin_trusted()?);
                }
                self.go_back()?;
            }
            Order::Panes { count } => {
                if count == 0 || count > MOST_PANES {
                    return Err(format!("{count} panes: expected 1 or {MOST_PANES}"));
                }
                if count > self.panes.len() {
                    let mut second = Pane::of(&self.scene).map_err(|error| error.to_string())?;
                    choose(&mut second, &self.second).map_err(words)?;
                    self.panes.push(second);
                }
                self.panes.truncate(count);
                self.trusted = None;
                // From the beginning, so that both have been given the same.
                self.go_back()?;
            }
            Order::Field { name } => self.field = name,
            Order::Trusted { on } => {
                self.trusted = match on {
                    true => Some(self.begin_trusted()?),
                    false => None,
                };
                // From the beginning, as it needs all commands.
                self.go_back()?;
            }
            Order::Save => {
                let saved = saved::save(&self.scene, &self.panes);
                shared
                    .clients
                    .tell_all(&saved.map_err(|error| error.to_string())?);
            }
        }
        Ok(())
    }

    /// Refuses a command that the panes would refuse when its time comes.
    fn check(&self, command: &Command) -> Result<(), String> {
        let mut panes = self.panes.iter();
        panes
            .try_for_each(|pane| pane.check(command))
            .map_err(|error| error.to_string())
    }

    fn pane(&mut self, number: usize) -> Result<&mut Pane, String> {
        self.panes
            .get_mut(number)
            .ok_or_else(|| format!("there is no pane {number}"))
    }

    fn begin_trusted(&self) -> Result<Trusted, String> {
        Trusted::begin(&self.scene, self.panes.len(), self.tick())
    }

    /// Ends the trusted run.
    fn distrust(&mut self, reason: String, shared: &Shared) {
        self.trusted = None;
        for pane in &mut self.panes {
            (pane.error, pane.lag) = (f64::NAN, 0.0);
        }
        shared.clients.tell_all(&Event::TrustedEnded { reason });
        self.news.settings = true;
    }

    /// Takes all panes back to the beginning.
    fn go_back(&mut self) -> Result<(), String> {
        for pane in &mut self.panes {
            pane.reset().map_err(|error| error.to_string())?;
        }
        self.hands.fill(None);
        self.under_way.clear();
        self.t = self.panes.first().map_or(0.0, Pane::t);
        self.pace = Pace::new(self.t);
        self.set_first_factors();
        (self.news.settings, self.news.went_back) = (true, true);
        Ok(())
    }

    /// The factors of loads as they are at the beginning.
    fn set_first_factors(&mut self) {
        self.factors.clone_from(&self.first_factors);
        for (load, factor) in self.loads.iter().zip(&self.factors) {
            if *factor == 1.0 {
                continue;
            }
            for pane in &mut self.panes {
                let (load, factor) = (load.clone(), *factor);
                pane.command_at(self.t, Command::LoadFactor { load, factor });
            }
            if let Some(trusted) = &mut self.trusted {
                let (load, factor) = (load.clone(), *factor);
                trusted.command_at(self.t, Command::LoadFactor { load, factor });
            }
        }
    }

    fn settings(&self) -> Event {
        Event::Settings {
            panes: self.panes.iter().map(Pane::facts).collect(),
            paused: self.paused,
            field: self.field,
            factors: self.factors.clone(),
            trusted: self.trusted.is_some(),
        }
    }
}

/// Gives a pane its integrator and step.
fn choose(pane: &mut Pane, choice: &PaneChoice) -> Result<(), CommandError> {
    if let Some(dt) = choice.dt {
        pane.use_step(dt)?;
    }
    match &choice.integrator {
        Some(name) => pane.use_integrator(name),
        None => Ok(()),
    }
}
