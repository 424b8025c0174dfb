//! The thread that simulates.

mod beside;
mod common;
mod course;
#[cfg(test)]
mod drags;
mod due;
mod grip;
mod lights;
mod moments;
mod options;
mod pace;
mod pane;
mod places;
mod saved;
mod shown;
mod stability;
mod sums;
mod survey;
mod tools;
mod topology;
mod trusted;

use std::sync::Arc;
use std::time::{Duration, Instant};

use sinew_core::Clock;
use sinew_world::{Command, CommandError, Journal, JournalError, Log, World};

use self::beside::{choose, choose_beside};
use self::course::{Course, Limits};
use self::moments::{Moment, Moments};
use self::pace::Pace;
use self::pane::{Hands, Pane};
pub(crate) use self::survey::Survey;
use self::topology::Topology;
use self::trusted::Trusted;
use crate::clients::Picture;
use crate::ended::Ended;
use crate::error::LiveError;
use crate::inbox::{Place, Request, Waiting};
use crate::new_tool::AddedTool;
use crate::pane_choice::PaneChoice;
use crate::picture::{Plane, Surface};
use crate::protocol::{Event, Field, FrameHead, FrameWriter, Order, Scenery};
use crate::scene_values::SceneValues;
use crate::scenery::Presented;
use crate::server::Shared;

/// Shortest simulated time (s) in which a tool moves to the user's tool pose: a jump within one step would be an impact.
const GLIDE: f64 = 0.004;

/// Simulated time (s) after a return to an earlier moment in which poses are ignored: they were meant for tools at
/// other places.
const DEAF: f64 = 0.15;

/// Time of stepping before commands and pictures are checked again.
const LOOK: Duration = Duration::from_millis(10);

/// Shortest time between two pictures, for any requests of pages.
const BETWEEN_PICTURES: Duration = Duration::from_millis(2);

/// Shortest time between two settings messages, so that one page's commands do not flood the others.
const BETWEEN_TELLINGS: Duration = Duration::from_millis(15);

/// Longer than until any picture is due.
const FAR: Duration = Duration::from_secs(1);

/// Longest wait without work.
const IDLE: Duration = Duration::from_millis(100);

/// Wait after the last cut before stable steps are recomputed, which may take longer than a cut.
const CALM: Duration = Duration::from_millis(500);

/// Time between two checks of missing journal entries.
const BETWEEN_ENTRIES: Duration = Duration::from_secs(1);

/// Largest number of cuts that wait for a step, which makes all of them: a blade that moves while the simulation is
/// paused would add cuts without limit.
const MOST_CUTS: usize = 256;

/// Farthest place (m) of a pull along an axis.
const FARTHEST: f64 = 1e6;

/// Largest number of panes.
const MOST_PANES: usize = 2;

/// The sessions and their control.
pub(crate) struct Engine {
    scene: SceneValues,
    presented: Presented,
    /// The tools that pages added, which are the last ones of the scene.
    added: Vec<AddedTool>,
    panes: Vec<Pane>,
    /// Choice of the second pane, if it is opened.
    second: PaneChoice,
    hands: Hands,
    /// Number of grips so far.
    grips: u64,
    /// Simulated time (s) until which poses are ignored.
    deaf_until: f64,
    moments: Moments,
    /// Names and factors of the loads.
    loads: Vec<String>,
    factors: Vec<f64>,
    /// True for each tool whose jaws a user closed.
    grasped: Vec<bool>,
    /// The surface of the body before all cuts.
    uncut: Surface,
    topology: Topology,
    /// Time at which a body changed whose stable steps have not been computed yet.
    cut_at: Option<Instant>,
    /// True if the known stable steps belong to a cut body.
    knows_cut: bool,
    /// False if the integrators have not been surveyed on the present scene.
    surveyed: bool,
    /// The fields of the body, and the one shown as colours.
    fields: Vec<Field>,
    field: Field,
    /// The section whose values pictures contain.
    section: Option<Plane>,
    repaint: bool,
    trusted: Option<Trusted>,
    paused: bool,
    /// True if a page asked for the start page.
    goes_to_start: bool,
    /// Simulated time up to which all panes have stepped, with the same rounding.
    clock: Clock,
    /// Span that the panes are stepping through.
    ahead: Option<Span>,
    pace: Pace,
    pictures: u32,
    last_picture: Option<Instant>,
    /// Number of visible changes.
    changes: u64,
    /// News that pages have not received: changed settings, and a return to the beginning.
    news: News,
    /// Commands that no step has taken yet.
    under_way: Vec<UnderWay>,
    /// Files of the logs of the panes, and the time of their last update.
    journals: Vec<Journal>,
    last_entries: Instant,
}

/// A span of simulated time (s).
#[derive(Clone, Copy, Debug)]
struct Span {
    until: f64,
    length: f64,
}

/// The last command of a client that steps have taken from a simulated time (s) on.
#[derive(Clone, Copy, Debug)]
struct UnderWay {
    client: u32,
    id: u32,
    arrival: f64,
}

/// News that pages have not received yet.
#[derive(Clone, Copy, Debug, Default)]
struct News {
    settings: bool,
    went_back: bool,
    last_told: Option<Instant>,
}

/// Inputs of a new engine.
pub(crate) struct Beginning {
    pub(crate) scene: SceneValues,
    pub(crate) panes: Vec<PaneChoice>,
    pub(crate) second: PaneChoice,
    pub(crate) scenery: Scenery,
    pub(crate) presented: Presented,
}

impl Engine {
    /// Builds the sessions.
    pub(crate) fn new(
        beginning: Beginning,
        session: World,
        uncut: Surface,
    ) -> Result<Self, LiveError> {
        let Beginning {
            scene,
            panes: choices,
            second,
            scenery,
            presented,
        } = beginning;
        let Scenery { fields, loads, .. } = scenery;
        let loads: Vec<String> = loads.into_iter().map(|load| load.name).collect();
        let from_start = presented.from_start.is_some();
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
            presented,
            added: Vec::new(),
            panes,
            second,
            hands: Hands {
                tools: vec![None; tools],
                grip: None,
            },
            grips: 0,
            grasped: vec![false; tools],
            deaf_until: f64::NEG_INFINITY,
            moments: Moments::default(),
            factors: vec![1.0; loads.len()],
            loads,
            uncut,
            topology: Topology::default(),
            cut_at: None,
            knows_cut: false,
            surveyed: true,
            field: fields.first().copied().unwrap_or(Field::Displacement),
            fields,
            section: None,
            repaint: true,
            trusted: None,
            paused: from_start,
            goes_to_start: false,
            clock: Clock::at(t),
            ahead: None,
            pace: Pace::new(t),
            pictures: 0,
            last_picture: None,
            changes: 1,
            news: News::default(),
            under_way: Vec::new(),
            journals: Vec::new(),
            last_entries: Instant::now(),
        };
        engine.keep_moment();
        Ok(engine)
    }

    /// Writes the logs of the panes to files, beginning with their headers.
    pub(crate) fn keep_logs(&mut self, journals: Vec<Journal>) -> Result<(), JournalError> {
        self.journals = journals;
        self.keep_up()
    }

    /// Simulates until the end is requested.
    pub(crate) fn run(mut self, shared: &Arc<Shared>, mut survey: Survey) -> Ended {
        let (mut waiting, mut is_done) = (Waiting::default(), true);
        self.pace = Pace::new(self.t());
        loop {
            let patience = match is_done {
                true => self.patience(shared),
                false => Duration::ZERO,
            };
            shared.inbox.take(&mut waiting, patience);
            if waiting.ends {
                return self.end();
            }
            is_done = self.obey(&mut waiting, shared);
            if self.goes_to_start {
                shared.clients.tell_all(&Event::Scenes);
                return self.end();
            }
            self.tell(shared);
            self.advance(shared);
            self.show(shared);
            self.learn_after_cuts(shared, &mut survey);
            if self.last_entries.elapsed() >= BETWEEN_ENTRIES {
                self.last_entries = Instant::now();
                let kept = self.keep_up();
                self.report_journals(kept, shared);
            }
        }
    }

    fn end(self) -> Ended {
        let logs: Vec<Log> = self.panes.into_iter().map(Pane::into_log).collect();
        let finished = self.journals.into_iter().zip(&logs);
        let unkept = finished.filter_map(|(journal, log)| journal.finish(log).err());
        Ended {
            t: self.clock.time(),
            goes_to_start: self.goes_to_start,
            values: self.scene.values(),
            scene: self.scene.scene,
            unkept: unkept.collect(),
            logs,
        }
    }

    /// Updates the files of the logs.
    fn keep_up(&mut self) -> Result<(), JournalError> {
        let mut journals = self.journals.iter_mut().zip(&self.panes);
        journals.try_for_each(|(journal, pane)| journal.keep_up(pane.log()))
    }

    /// Reports to pages a file that can no longer record commands; it is tried once more at the end.
    fn report_journals(&self, kept: Result<(), JournalError>, shared: &Shared) {
        if let Err(error) = kept {
            let reason = format!("commands are kept in memory alone from now on: {error}");
            shared.clients.tell_all(&Event::Refused { reason });
        }
    }

    /// Time for which there is nothing to do, unless a command arrives.
    fn patience(&self, shared: &Shared) -> Duration {
        let until_step = match (self.ahead, self.paused) {
            (Some(_), _) => Duration::ZERO,
            (None, true) => IDLE,
            (None, false) => self.until_next_step(),
        };
        let until_picture = self
            .next_picture(shared)
            .map_or(IDLE, |due| due.saturating_duration_since(Instant::now()));
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

    /// Simulated time (s) up to which all panes have stepped.
    fn t(&self) -> f64 {
        self.clock.time()
    }

    /// The span that all panes step through next.
    fn next_span(&self) -> Span {
        let length = self.tick();
        let mut end = self.clock;
        end.advance(length);
        let until = end.time();
        Span { until, length }
    }

    /// Simulated time (s) from which on commands take effect.
    fn now(&self) -> f64 {
        self.ahead.map_or(self.t(), |span| span.until)
    }

    /// Steps up to wall time, but not longer than commands may wait.
    fn advance(&mut self, shared: &Shared) {
        let begun = Instant::now();
        let may = || begun.elapsed() < LOOK;
        while may() {
            let is_due = || !self.paused && self.next_span().until <= self.pace.target();
            if self.ahead.is_none() && !is_due() {
                break;
            }
            self.take_tick(shared, may);
        }
        if !self.paused {
            self.pace.note(self.t(), self.tick());
        }
    }

    /// Steps through the current span of the panes, or through the next one, as long as it `may`.
    fn take_tick(&mut self, shared: &Shared, may: impl Fn() -> bool) {
        let next = self.next_span();
        let Span { until, length } = *self.ahead.get_or_insert(next);
        let (mut oldest, mut failed) = (until, None);
        for (number, pane) in self.panes.iter_mut().enumerate() {
            let was_stopped = pane.stopped.is_some();
            if let Some(reason) = pane.follow(until, &self.hands, &may) {
                shared.clients.tell_all(&Event::Refused { reason });
            }
            if let Some(reason) = pane.stopped.clone().filter(|_| !was_stopped) {
                failed.get_or_insert((number, reason));
            }
            if pane.stopped.is_none() {
                oldest = oldest.min(pane.t());
            }
        }
        self.changes += 1;
        if let Some((pane, reason)) = failed {
            let place = self.panes.get(pane).and_then(|pane| pane.place_in(&reason));
            if self.go_back_before_failure(pane, &reason, place, shared) {
                return;
            }
            shared.clients.tell_all(&Event::Stopped {
                pane,
                reason,
                place,
            });
            self.news.settings = true;
        }
        if !self.panes.iter().all(|pane| pane.is_at(until)) {
            return;
        }
        self.ahead = None;
        if let Some(trusted) = &mut self.trusted {
            for (number, pane) in self.panes.iter_mut().enumerate() {
                (pane.error, pane.lag) = trusted.error(number, pane.t());
            }
            if let Err(reason) = trusted.span(until, length, &self.hands, &self.panes) {
                self.distrust(reason, shared);
            }
        }
        self.clock.advance(length);
        for hand in self.hands.tools.iter_mut().flatten() {
            hand.forget_before(oldest);
        }
        if let Some(grip) = &mut self.hands.grip {
            grip.forget_before(oldest);
        }
        if self.moments.is_due(self.t()) {
            self.keep_moment();
        }
        self.tell_applied(shared);
    }

    /// Keeps the present moment of the panes that have not stopped.
    fn keep_moment(&mut self) {
        let t = self.t();
        self.moments.keep(Moment {
            clock: self.clock,
            panes: (self.panes.iter())
                .map(|pane| pane.stopped.is_none().then(|| pane.moment()))
                .collect(),
            hands: (self.hands.tools.iter())
                .map(|hand| hand.as_ref().map(|hand| hand.at(t)))
                .collect(),
            factors: self.factors.clone(),
            grasped: self.grasped.clone(),
        });
    }

    /// Takes all panes back to a moment before one of them failed, with resting tools. False if the motion fails
    /// without a command, or cannot go back.
    fn go_back_before_failure(
        &mut self,
        pane: usize,
        reason: &str,
        place: Option<[f64; 3]>,
        shared: &Shared,
    ) -> bool {
        let failed_at = self.panes.get(pane).map_or(self.t(), Pane::t);
        let Some(moment) = self.moments.before_failure(failed_at) else {
            return false;
        };
        let t = moment.clock.time();
        if !self.go_back_to_last(Some(pane), shared) {
            return false;
        }
        shared.clients.tell_all(&Event::WentBack {
            pane,
            by: failed_at - t,
            to: t,
            reason: reason.to_owned(),
            place,
        });
        true
    }

    /// Continues from the last moment that is kept up to a simulated time (s): another branch of the motion.
    fn go_on_from(&mut self, t: f64, shared: &Shared) -> Result<(), String> {
        let was = self.t();
        let moment = self.moments.up_to(t).map(|moment| moment.clock.time());
        let from = moment.ok_or_else(|| {
            format!(
                "no moment up to t = {t:?} s is kept: it is before the last reset or change of a method"
            )
        })?;
        if !self.go_back_to_last(None, shared) {
            return Err("a pane cannot go back to that moment: reset".to_owned());
        }
        self.deaf_until = f64::NEG_INFINITY;
        shared.clients.tell_all(&Event::WentOnFrom {
            t: from,
            back: was - from,
        });
        Ok(())
    }

    /// Takes the panes back to the last moment that is kept, with resting tools: all of them, or all but those that had
    /// stopped before this one failed. False if one of them cannot.
    fn go_back_to_last(&mut self, failed: Option<usize>, shared: &Shared) -> bool {
        let Some(moment) = self.moments.last() else {
            return false;
        };
        let both = self.panes.iter_mut().zip(&moment.panes).enumerate();
        let mut both = both.filter_map(|(number, (pane, to))| {
            let has_ended = pane.stopped.is_some() && failed.is_some_and(|it| it != number);
            Some((pane, to.as_ref().filter(|_| !has_ended)?))
        });
        if both.any(|(pane, to)| pane.go_back(to).is_err()) {
            return false;
        }
        let t = moment.clock.time();
        self.clock = moment.clock;
        self.factors.clone_from(&moment.factors);
        self.grasped.clone_from(&moment.grasped);
        let poses = moment.hands.iter();
        self.hands = Hands {
            tools: poses
                .map(|pose| pose.map(|pose| Course::at_rest(t, pose)))
                .collect(),
            grip: None,
        };
        self.deaf_until = t + DEAF;
        self.ahead = None;
        self.pace = Pace::new(t);
        for command in &mut self.under_way {
            command.arrival = t;
        }
        self.tell_applied(shared);
        self.news.settings = true;
        if self.trusted.is_some() {
            self.distrust(
                "the panes went back to an earlier moment, which it cannot".to_owned(),
                shared,
            );
        }
        true
    }

    /// Notifies clients of commands that steps have taken.
    fn tell_applied(&mut self, shared: &Shared) {
        let t = self.t();
        self.under_way.retain(|command| {
            let is_there = command.arrival <= t + 1e-12;
            if is_there {
                shared.clients.applied(command.client, command.id);
            }
            !is_there
        });
    }

    /// Keeps a command of a client until steps have taken it; it replaces commands that are not taken earlier. A client
    /// is notified of its last one only.
    fn is_under_way(&mut self, client: u32, id: u32, arrival: f64) {
        self.under_way
            .retain(|other| other.client != client || other.arrival < arrival);
        self.under_way.push(UnderWay {
            client,
            id,
            arrival,
        });
    }

    /// Time at which the next picture must be made, if there is a change and a client to show it to.
    fn next_picture(&self, shared: &Shared) -> Option<Instant> {
        let due = shared.clients.next_picture(self.changes)?;
        let due = match due <= self.newest_until() {
            true => Instant::now(),
            false => due,
        };
        let soonest = self.last_picture.map(|last| last + BETWEEN_PICTURES);
        Some(soonest.map_or(due, |soonest| due.max(soonest)))
    }

    /// Time until which the current state is the newest, so that waiting would not improve a picture.
    fn newest_until(&self) -> Instant {
        let left = match self.paused {
            true => FAR,
            false => self.until_next_step(),
        };
        Instant::now() + left
    }

    /// Time until the next span is due.
    fn until_next_step(&self) -> Duration {
        self.pace.until(self.next_span().until)
    }

    fn show(&mut self, shared: &Shared) {
        let due = self.next_picture(shared);
        if due.is_none_or(|due| Instant::now() < due) {
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
        let mut frame = FrameWriter::new(&head, &points, self.hands.tools.len());
        for pane in &mut self.panes {
            pane.write(
                &mut frame,
                (&self.uncut, &self.hands),
                (self.field, self.section),
                self.repaint,
            );
        }
        let picture = Picture {
            message: frame.finish(),
            changes: self.changes,
            topology: &self.topology.message,
            epoch: self.topology.epoch,
        };
        shared.clients.show(picture, self.newest_until());
        self.repaint = false;
        self.last_picture = Some(Instant::now());
    }

    /// Requests the stable steps on changed bodies, after cutting has ended.
    fn learn_after_cuts(&mut self, shared: &Arc<Shared>, survey: &mut Survey) {
        let is_calm = self.cut_at.is_some_and(|last| last.elapsed() >= CALM) || !self.surveyed;
        let Some(first) = self
            .panes
            .first()
            .filter(|_| is_calm && survey.is_finished())
        else {
            return;
        };
        // Without a thread pages keep what they know.
        if let Ok(begun) = Survey::start(shared, first.scene(), first.body()) {
            *survey = begun;
        }
        (self.cut_at, self.knows_cut, self.surveyed) = (None, first.is_cut(), true);
        for pane in &mut self.panes {
            pane.learn();
        }
        self.news.settings = true;
    }

    /// Executes the requests of pages, but not longer than pictures may wait; returns true if none remains.
    fn obey(&mut self, waiting: &mut Waiting, shared: &Shared) -> bool {
        let begun = Instant::now();
        waiting.forget(|client| !shared.clients.is_here(client));
        let grip = self.hands.grip.as_ref();
        if grip.is_some_and(|grip| !shared.clients.is_here(grip.client)) {
            self.hands.grip = None;
        }
        for client in waiting.entered.drain(..) {
            shared.clients.tell(client, &self.settings());
        }
        while begun.elapsed() < LOOK
            && let Some(Request { client, id, what }) = waiting.orders.pop_front()
        {
            let is_pose = matches!(what, Order::Pose { .. } | Order::Pull { .. });
            let waits = is_pose
                || matches!(
                    what,
                    Order::Load { .. }
                        | Order::Cut { .. }
                        | Order::Grasp { .. }
                        | Order::Snip { .. }
                );
            // What colours show stays as it is under the others, and to paint may take longer than a step.
            let repaints = match &what {
                Order::Field { name } => *name != self.field,
                Order::Save | Order::Grip { .. } | Order::LetGo | Order::Section { .. } => false,
                _ => !waits,
            };
            let outcome = self.carry_out(client, id, what, shared);
            if outcome.is_err() || !waits {
                shared.clients.applied(client, id);
            }
            self.repaint |= self.news.went_back || (repaints && outcome.is_ok());
            if let Err(reason) = outcome {
                shared.clients.tell(client, &Event::Refused { reason });
            }
            if !is_pose {
                self.news.settings = true;
                self.changes += 1;
            }
        }
        let is_done = waiting.orders.is_empty();
        // Those that came behind orders that are left continue to wait with them.
        let poses = if is_done { waiting.poses.len() } else { 0 };
        for Request { client, id, what } in waiting.poses.drain(..poses) {
            if let Err(reason) = self.lead(client, id, what) {
                shared.clients.applied(client, id);
                shared.clients.tell(client, &Event::Refused { reason });
                self.changes += 1;
            }
        }
        self.tell_applied(shared);
        is_done
    }

    /// Sends changes to pages, but not too often.
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

    /// Steers a tool to a pose.
    fn lead(&mut self, client: u32, id: u32, place: Place) -> Result<(), String> {
        let Place { tool, pose } = place;
        let [x, y, z, a, b, c] = pose;
        let name = self.tool_name(tool)?;
        let (Some(first), Some(hand)) = (self.panes.first(), self.hands.tools.get(tool)) else {
            return Err(format!("there is no tool {tool}"));
        };
        let here = hand.is_none().then(|| first.tool_pose(tool));
        let limits = self.limits(first.reach_of(tool));
        self.check(&Command::Pose {
            tool: name,
            position: [x, y, z],
            rotation_vector: [a, b, c],
        })?;
        let t = self.now();
        self.is_under_way(client, id, t + self.tick());
        if t < self.deaf_until {
            return Ok(());
        }
        self.moments.note_command(t);
        let course = self.hands.tools[tool]
            .get_or_insert_with(|| Course::at_rest(t, here.unwrap_or_default()));
        course.go(t, pose, limits);
        Ok(())
    }

    /// Limits of the hand's motion, with a tool of this reach (m).
    fn limits(&self, reach: f64) -> Limits {
        Limits {
            shortest: GLIDE.max(self.tick()),
            speed: self.presented.hand_speed,
            reach,
        }
    }

    fn tool_name(&self, tool: usize) -> Result<Arc<str>, String> {
        let tools = self.panes.first().and_then(Pane::tools);
        let tool_of = tools.and_then(|tools| tools.tools().get(tool));
        let name = tool_of.map(|tool| tool.name.as_str().into());
        name.ok_or_else(|| format!("there is no tool {tool}"))
    }

    /// Closes or opens the jaws of a tool.
    fn grasp(&mut self, client: u32, id: u32, tool: usize, on: bool) -> Result<(), String> {
        let name = self.tool_name(tool)?;
        let command = match on {
            true => Command::Grasp { tool: name },
            false => Command::Release { tool: name },
        };
        self.give(client, id, command)?;
        if let Some(grasped) = self.grasped.get_mut(tool) {
            *grasped = on;
        }
        Ok(())
    }

    /// Grips the tissue around a point of the surface of a pane.
    fn grip(&mut self, client: u32, pane: usize, point: usize, epoch: u32) -> Result<(), String> {
        self.pane(pane)?;
        if epoch != self.topology.epoch {
            return Err("the body was cut in this moment: grip it once more".to_owned());
        }
        self.grips += 1;
        let who = (self.grips, client);
        let mut grip = self.pane(pane)?.grip(who, point)?;
        for pane in &self.panes {
            grip.soften(pane.stiffness_of(&grip)?);
        }
        self.hands.grip = Some(grip);
        Ok(())
    }

    /// Pulls the tissue that is gripped to a place (m).
    fn pull(&mut self, client: u32, id: u32, to: [f64; 3]) -> Result<(), String> {
        // What is not a number is not within the range either.
        if !to
            .iter()
            .all(|place| (-FARTHEST..=FARTHEST).contains(place))
        {
            return Err(format!(
                "a pull to {to:?}: expected finite numbers, at most {FARTHEST:e} m in size"
            ));
        }
        let limits = self.limits(0.0);
        let t = self.now();
        self.is_under_way(client, id, t + self.tick());
        // One that is gone: the motion went back.
        if let Some(grip) = &mut self.hands.grip {
            grip.pull(t, to, limits);
            self.moments.note_command(t);
        }
        Ok(())
    }

    /// Gives all panes a command that takes effect with their next steps.
    fn give(&mut self, client: u32, id: u32, command: Command) -> Result<(), String> {
        self.check(&command)?;
        if matches!(command, Command::Cut { .. }) && self.waiting_cuts() >= MOST_CUTS {
            return Err(format!(
                "{MOST_CUTS} cuts wait for the next step, which is the most: let time go on"
            ));
        }
        let t = self.now();
        for pane in &mut self.panes {
            pane.command_at(t, command.clone());
        }
        if let Some(trusted) = &mut self.trusted {
            trusted.command_at(t, command);
        }
        self.moments.note_command(t);
        self.is_under_way(client, id, t + self.tick());
        Ok(())
    }

    /// Cuts that wait for a step.
    fn waiting_cuts(&self) -> usize {
        let of_panes = self.panes.iter().map(Pane::waiting_cuts);
        let of_trusted = self.trusted.iter().map(Trusted::waiting_cuts);
        of_panes.chain(of_trusted).max().unwrap_or(0)
    }

    /// Changes the method of a pane. A pane that had stopped starts again from the beginning, and all others with it.
    fn change_method(
        &mut self,
        number: usize,
        change: impl FnOnce(&mut Pane) -> Result<(), String>,
    ) -> Result<(), String> {
        let pane = self.pane(number)?;
        let was_stopped = pane.stopped.is_some();
        let changed = change(pane);
        if was_stopped && pane.stopped.is_none() {
            self.restart()?;
        } else {
            // Those with another method are gone.
            self.begin_moments();
        }
        changed
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
            Order::Grip { pane, point, epoch } => self.grip(client, pane, point, epoch)?,
            Order::Pull { to } => self.pull(client, id, to)?,
            Order::LetGo => self.hands.grip = None,
            Order::Grasp { tool, on } => self.grasp(client, id, tool, on)?,
            Order::Load { load, factor } => {
                let place = self.loads.iter().position(|name| *name == load);
                let command = Command::LoadFactor {
                    load: load.into(),
                    factor,
                };
                self.give(client, id, command)?;
                if let Some(factor_of) = place.and_then(|place| self.factors.get_mut(place)) {
                    *factor_of = factor;
                }
            }
            Order::Cut { from, to } => self.give(client, id, Command::Cut { from, to })?,
            Order::Shape { tool, shape } => self.reshape(tool, shape, shared)?,
            Order::AddTool { kind } => self.add_tool(kind, shared)?,
            Order::RemoveTool { tool } => self.remove_tool(tool, shared)?,
            Order::Snip { tool } => self.snip(client, id, tool)?,
            Order::Integrator { pane, name } => {
                self.change_method(pane, |pane| pane.use_integrator(&name).map_err(words))?;
            }
            Order::Dt { pane, dt } => {
                if !(1e-6..=1.0).contains(&dt) {
                    return Err(format!("a step of {dt} s: expected 1e-6 to 1 s"));
                }
                self.change_method(pane, |pane| pane.use_step(dt).map_err(words))?;
            }
            Order::Option {
                pane,
                key,
                word,
                number,
            } => self.change_method(pane, |pane| pane.use_option(&key, word, number))?,
            Order::Pause { on } => {
                self.paused = on;
                self.pace = Pace::new(self.t());
            }
            Order::Step => {
                self.paused = true;
                let next = self.next_span();
                self.ahead.get_or_insert(next);
            }
            Order::Reset => self.restart()?,
            Order::GoOnFrom { t } => self.go_on_from(t, shared)?,
            Order::Panes { count } => {
                if count == 0 || count > MOST_PANES {
                    return Err(format!("{count} panes: expected 1 or {MOST_PANES}"));
                }
                if count > self.panes.len() {
                    let mut second = Pane::of(&self.scene).map_err(|error| error.to_string())?;
                    let first = self.panes.first().map(Pane::facts);
                    let first = first.map_or_else(String::new, |facts| facts.integrator);
                    let other = choose_beside(&mut second, &self.second, &first)?;
                    if let Some(reason) = other {
                        shared.clients.tell_all(&Event::Refused { reason });
                    }
                    self.panes.push(second);
                }
                self.panes.truncate(count);
                self.trusted = None;
                // That of the second pane is another session's, or nobody's.
                let emptied = self.journals.get_mut(1).map_or(Ok(()), Journal::begin_anew);
                self.report_journals(emptied, shared);
                // From the beginning, so that both have been given the same.
                self.go_back()?;
            }
            Order::Field { name } if self.fields.contains(&name) => self.field = name,
            Order::Field { .. } => return Err("this body has no such field".to_owned()),
            Order::Section { axis: None, .. } => self.section = None,
            Order::Section {
                axis: Some(axis),
                at,
            } => {
                if axis > 2 || !(-FARTHEST..=FARTHEST).contains(&at) {
                    return Err(format!(
                        "a section across axis {axis} at {at} m: expected axis 0, 1 or 2 and at most {FARTHEST:e} m"
                    ));
                }
                self.section = Some(Plane { axis, at });
            }
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
            Order::Scenes if self.presented.from_start.is_some() => self.goes_to_start = true,
            Order::Scenes => return Err("this scene was not chosen on a start page".to_owned()),
        }
        Ok(())
    }

    /// Refuses a command that the panes would refuse at its time.
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

    /// Resets all panes and the trusted run to the beginning.
    fn restart(&mut self) -> Result<(), String> {
        let trusted = self.trusted.take().map(|_| self.begin_trusted());
        let trusted = trusted.transpose().map(|trusted| self.trusted = trusted);
        self.go_back().and(trusted)
    }

    /// Resets all panes to the beginning; returns an error message if one continues with another method there.
    fn go_back(&mut self) -> Result<(), String> {
        let mut outcome = Ok(());
        for pane in &mut self.panes {
            if let Err(refused) = pane.reset() {
                outcome = Err(refused.to_string());
            }
        }
        self.begin_anew();
        outcome
    }

    /// Releases all tools, with panes at the beginning.
    fn begin_anew(&mut self) {
        self.hands.tools.fill(None);
        self.hands.grip = None;
        self.clock = Clock::at(self.panes.first().map_or(0.0, Pane::t));
        // What was under way comes to nothing, and nobody has to wait for it.
        for command in &mut self.under_way {
            command.arrival = self.clock.time();
        }
        self.ahead = None;
        self.pace = Pace::new(self.t());
        self.factors.fill(1.0);
        self.grasped.fill(false);
        self.begin_moments();
        (self.news.settings, self.news.went_back) = (true, true);
    }

    /// Forgets all moments but the present one.
    fn begin_moments(&mut self) {
        self.moments = Moments::default();
        self.deaf_until = f64::NEG_INFINITY;
        self.keep_moment();
    }

    fn settings(&self) -> Event {
        Event::Settings {
            panes: self.panes.iter().map(Pane::facts).collect(),
            paused: self.paused,
            field: self.field,
            factors: self.factors.clone(),
            grasped: self.grasped.clone(),
            trusted: self.trusted.is_some(),
        }
    }
}
