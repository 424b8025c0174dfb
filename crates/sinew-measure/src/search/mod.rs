//! The cheapest runs for an error, found without measuring every method at every step.
//!
//! Each candidate is followed from its longest stable step to shorter ones, by the order it declares and the errors
//! measured so far, for as long as it can still become cheaper than the best run so far; the most promising candidate
//! is first. Steps divide the time between two instants of the comparison, so that all errors are taken at the same
//! instants; those of methods that need loads to change between steps meet these changes too, anywhere in the scene.

mod candidate;
mod candidates;
mod goal;
mod pilots;
mod trail;

pub use candidate::Candidate;
pub use candidates::candidates;
pub use goal::Goal;
pub(crate) use pilots::ramps;
pub use pilots::{CasePilots, Pilot, PilotError, Pilots, UnfitLoads};

use sinew_core::Options;
use sinew_integrators::LEAST_F32_ROUNDING;

use crate::method_choice::MethodChoice;
use crate::timing::Effort;
use crate::{Row, Span};
use trail::{Aim, Trail};

/// Costs that differ by less than this share count as equal: times are not reproducible more accurately.
const NOISE: f64 = 0.1;

/// Largest number of pilots of one candidate for one goal.
const MOST_PILOTS: usize = 16;

/// Largest number of repeated runs for one goal.
const MOST_AGAIN: usize = 4;

/// A search over candidates; measurements for one goal are reused for the next.
#[derive(Debug)]
pub struct Search<P> {
    pilots: P,
    span: Span,
    duration: f64,
    trails: Vec<Trail>,
    others: Vec<Pilot>,
    count: usize,
    cut_short: bool,
}

impl<P: Pilots> Search<P> {
    /// A search with pilots over `span`, for runs over `duration` (s): set-up counts once per run.
    pub fn new(pilots: P, span: Span, duration: f64) -> Self {
        Self {
            pilots,
            span,
            duration,
            trails: Vec::new(),
            others: Vec::new(),
            count: 0,
            cut_short: false,
        }
    }

    /// Adds a candidate, unless its method is already a candidate.
    pub fn add(&mut self, candidate: Candidate) {
        let known = |trail: &Trail| trail.candidate.method == candidate.method;
        if !self.trails.iter().any(known) {
            let unit = self
                .pilots
                .parts_for_loads(&candidate.method, self.span.interval());
            self.trails.push(Trail::new(candidate, self.span, unit));
        }
    }

    /// Follows all candidates towards a goal, always the one that may reach it at the lowest cost.
    pub fn seek(&mut self, goal: Goal) {
        self.pursue(goal, |search, _| search.lowest_cost(goal, |_| true));
    }

    /// Follows every integrator to its own cheapest run for a goal, as long as that may cost less than `times` times
    /// the cheapest of all.
    pub fn survey(&mut self, goal: Goal, times: f64) {
        self.pursue(goal, |search, trail| {
            let integrator = &trail.candidate.method.integrator;
            let own = search.lowest_cost(goal, |pilot| pilot.method.integrator == *integrator);
            own.min(times * search.lowest_cost(goal, |_| true))
        });
    }

    /// Follows candidates towards a goal while they may cost less than a limit (s).
    fn pursue(&mut self, goal: Goal, limit: impl Fn(&Self, &Trail) -> f64) {
        let mut pilots_left = vec![MOST_PILOTS; self.trails.len()];
        loop {
            let step = |(index, trail): (usize, &Trail)| {
                let aim = Aim {
                    goal,
                    best: limit(self, trail),
                    duration: self.duration,
                    least_step: self.pilots.least_step_cpu_s(),
                };
                if pilots_left[index] == 0 || self.begins_too_costly(trail, aim.best) {
                    return None;
                }
                Some((index, trail.next(&aim)?))
            };
            let steps = self.trails.iter().enumerate().filter_map(step);
            let Some((index, next)) =
                steps.min_by(|(_, a), (_, b)| a.promise.total_cmp(&b.promise))
            else {
                return;
            };
            pilots_left[index] -= 1;
            if !self.follow(index, next.parts) {
                pilots_left[index] = 0;
            }
        }
    }

    /// Takes every candidate to the shortest step that a budget (CPU s per simulated s) allows.
    pub fn spend(&mut self, budget: f64) {
        for index in 0..self.trails.len() {
            if let Some(parts) = self.trails[index].parts_within(budget) {
                self.follow(index, parts);
            }
        }
    }

    /// Measures one more run, with any stable step (s).
    ///
    /// # Errors
    /// [`PilotError`] when the method cannot run with it.
    pub fn include(&mut self, method: &MethodChoice, dt: f64) -> Result<Pilot, PilotError> {
        let pilot = self.show(method, dt)?;
        self.others.push(pilot.clone());
        Ok(pilot)
    }

    /// Measures a run that must not be chosen, with any step (s).
    ///
    /// # Errors
    /// Same as [`Search::include`].
    pub fn show(&mut self, method: &MethodChoice, dt: f64) -> Result<Pilot, PilotError> {
        let row = self.pilots.measure(method, dt, Effort::QUICK)?;
        self.count += 1;
        Ok(Pilot {
            method: method.clone(),
            row,
        })
    }

    /// Repeats the cheapest runs for a goal in single precision, if its rounding error may be accepted: kernels then
    /// need half the memory, and errors are measured as usual.
    pub fn try_single_precision(&mut self, goal: Goal) {
        // Errors of rounding add to the method's own.
        if goal.error < 2.0 * LEAST_F32_ROUNDING {
            return;
        }
        // Twice as fast is the most.
        let within = 2.0 * self.lowest_cost(goal, |_| true);
        let duration = self.duration;
        let mut close: Vec<Pilot> = self.meeting(goal).cloned().collect();
        close.retain(|pilot| pilot.row.total_cpu_s(duration) <= within);
        close.sort_by(|a, b| {
            let cost = |pilot: &Pilot| pilot.row.total_cpu_s(duration);
            cost(a).total_cmp(&cost(b))
        });
        let close = close.into_iter().filter_map(|pilot| {
            let single = in_single_precision(&pilot.method)?;
            Some((single, pilot.row))
        });
        for (method, row) in close.take(MOST_AGAIN) {
            let known = |run: &Pilot| run.method == method && run.row.dt == row.dt;
            if !self.runs().any(known) && self.can_repeat(&row, 0.0) {
                // What refuses single precision stays as it is.
                let _ = self.include(&method, row.dt);
            }
        }
    }

    /// True if there is time to repeat a run like this one, timed for `least` (s) or more.
    fn can_repeat(&mut self, row: &Row, least: f64) -> bool {
        let run = row.cpu_s_per_s * self.span.duration;
        let can = row.setup_cpu_s + (2.0 * run).max(least) <= self.pilots.left();
        self.cut_short |= !can;
        can
    }

    /// Measures the cost of the cheapest runs for a goal again and longer, so that the choice between them does not
    /// depend on one short time.
    pub fn confirm(&mut self, goal: Goal) {
        const EFFORT: Effort = Effort {
            repeats: 5,
            budget: 0.1,
        };
        let within = 1.5 * self.lowest_cost(goal, |_| true);
        let duration = self.duration;
        let close = self.by_method(goal).into_iter();
        let close = close.filter(|pilot| pilot.row.total_cpu_s(duration) <= within);
        let close: Vec<Pilot> = close.take(MOST_AGAIN).cloned().collect();
        for pilot in close {
            let row = &pilot.row;
            if !self.can_repeat(row, EFFORT.budget) {
                continue;
            }
            if let Ok(mut again) = self.pilots.measure(&pilot.method, row.dt, EFFORT) {
                again.setup_cpu_s = again.setup_cpu_s.min(row.setup_cpu_s);
                let trails = self.trails.iter_mut().flat_map(Trail::runs_mut);
                for known in trails.chain(&mut self.others) {
                    if known.method == pilot.method && known.row.dt == row.dt {
                        known.row = again.clone();
                    }
                }
            }
        }
    }

    /// The runs so far that may be chosen.
    pub fn runs(&self) -> impl Iterator<Item = &Pilot> {
        self.trails.iter().flat_map(Trail::runs).chain(&self.others)
    }

    /// The cheapest run for a goal, set-up included; of several with indistinguishable times,
    /// the one with the smallest error.
    #[must_use]
    pub fn cheapest(&self, goal: Goal) -> Option<&Pilot> {
        let within = (1.0 + NOISE) * self.lowest_cost(goal, |_| true);
        self.meeting(goal)
            .filter(|pilot| pilot.row.total_cpu_s(self.duration) <= within)
            .min_by(|a, b| {
                let error =
                    |pilot: &Pilot| pilot.row.sound_error_over_scene().unwrap_or(f64::INFINITY);
                error(a).total_cmp(&error(b))
            })
    }

    /// The cheapest run of each integrator for a goal, the cheapest first.
    #[must_use]
    pub fn by_method(&self, goal: Goal) -> Vec<&Pilot> {
        let mut pilots: Vec<&Pilot> = self.meeting(goal).collect();
        let cost = |pilot: &Pilot| pilot.row.total_cpu_s(self.duration);
        pilots.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let mut seen: Vec<&str> = Vec::new();
        pilots.retain(|pilot| {
            let id = pilot.method.integrator.as_str();
            let new = !seen.contains(&id);
            seen.push(id);
            new
        });
        pilots
    }

    /// Candidates that could not run at all, with the reason.
    #[must_use]
    pub fn into_refused(self) -> Vec<(MethodChoice, PilotError)> {
        let trails = self.trails.into_iter();
        trails
            .filter(|trail| trail.runs().next().is_none())
            .filter_map(|trail| Some((trail.candidate.method, trail.reason?)))
            .collect()
    }

    /// Number of runs measured.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// True if a candidate was abandoned because the time for pilots had run out.
    #[must_use]
    pub fn cut_short(&self) -> bool {
        self.cut_short
    }

    /// CPU time (s) left for pilots.
    #[must_use]
    pub fn left(&self) -> f64 {
        self.pilots.left()
    }

    fn meeting(&self, goal: Goal) -> impl Iterator<Item = &Pilot> {
        self.runs().filter(move |pilot| goal.is_met_by(&pilot.row))
    }

    fn lowest_cost(&self, goal: Goal, counts: impl Fn(&Pilot) -> bool) -> f64 {
        self.meeting(goal)
            .filter(|pilot| counts(pilot))
            .map(|pilot| pilot.row.total_cpu_s(self.duration))
            .fold(f64::INFINITY, f64::min)
    }

    /// True if the set-up of a candidate that factorises costs more than the best run, judged by another candidate that
    /// factorised and has run.
    fn begins_too_costly(&self, trail: &Trail, best: f64) -> bool {
        let costly =
            |pilot: &Pilot| pilot.row.work.factorizations > 0 && pilot.row.setup_cpu_s > best;
        trail.candidate.factorises && trail.runs().next().is_none() && self.runs().any(costly)
    }

    /// Measures a candidate in `parts` parts of the interval; returns false if no time is left for it.
    fn follow(&mut self, index: usize, parts: u32) -> bool {
        let trail = &mut self.trails[index];
        let price = trail.price(parts, self.span.duration, self.pilots.least_step_cpu_s());
        if price >= self.pilots.left() {
            self.cut_short = true;
            return false;
        }
        let dt = self.span.interval() / f64::from(parts);
        let measured = self
            .pilots
            .measure(&trail.candidate.method, dt, Effort::QUICK);
        self.count += usize::from(measured.is_ok());
        trail.insert(parts, measured);
        true
    }
}

/// A method in single precision; `None` if no machine runs it, or if its options name one.
fn in_single_precision(method: &MethodChoice) -> Option<MethodChoice> {
    let entry = sinew_integrators::entry(&method.integrator)?;
    let chosen = ["precision", "machine"];
    let is_chosen = chosen.iter().any(|key| method.options.get(key).is_some());
    (entry.programs && !is_chosen).then(|| {
        let single = Options::new().with_text("precision", "f32");
        method.clone().with_options(&single)
    })
}

#[cfg(test)]
mod tests;
