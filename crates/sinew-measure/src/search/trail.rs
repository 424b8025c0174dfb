//! The runs of one candidate, from long steps to shorter ones.

use std::collections::{BTreeMap, BTreeSet};

use super::{Candidate, Goal, Pilot, PilotError};
use crate::{Row, Span};

/// Parts of the interval that are tried after the longest steps were refused.
const RUNGS: [u32; 15] = [1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 32, 50, 64, 100];

/// Number of refusals after which a candidate is abandoned.
const MOST_REFUSALS: usize = 8;

/// Numbers of parts that save less than this share of the steps are not tried.
const WORTH_IT: f64 = 0.02;

/// Order below which the error of an exact method is its own tolerance, not the step's.
const STALLED: f64 = 0.5;

/// The aim of following a candidate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    pub(super) goal: Goal,
    /// Total cost (s) of the cheapest run that keeps to the goal so far.
    pub(super) best: f64,
    /// Simulated time (s) over which set-up is spread.
    pub(super) duration: f64,
    /// Minimum CPU time (s) of a step.
    pub(super) least_step: f64,
}

impl Aim {
    /// Total cost (s) of a method in `parts` that ran in `at` parts, its cost per step unchanged; none if it cannot
    /// win.
    fn promise(&self, row: &Row, at: u32, parts: f64) -> Option<f64> {
        let cost = row.cpu_s_per_s * parts / f64::from(at);
        let total = row.setup_cpu_s + cost * self.duration;
        (cost <= self.goal.budget && total < self.best).then_some(total)
    }
}

/// A step worth trying.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Next {
    /// Parts of the interval.
    pub(super) parts: u32,
    /// Total cost (s) at which the goal may be met.
    pub(super) promise: f64,
}

/// A candidate's runs by the number of parts into which they divide the interval.
#[derive(Debug)]
pub(super) struct Trail {
    pub(super) candidate: Candidate,
    /// Reason of the last refusal.
    pub(super) reason: Option<PilotError>,
    interval: f64,
    /// Every number of parts is a multiple of this one.
    unit: u32,
    first: Option<u32>,
    runs: BTreeMap<u32, Pilot>,
    refused: BTreeSet<u32>,
}

impl Trail {
    /// A candidate whose steps are the interval in multiples of `unit` parts, or the reason why it has none.
    pub(super) fn new(candidate: Candidate, span: Span, unit: Result<u32, PilotError>) -> Self {
        // The subtrahend as in `Run::covering`.
        let parts = (span.interval() / candidate.stable_step - 1e-9)
            .ceil()
            .max(1.0);
        let first = (parts <= f64::from(u32::MAX)).then_some(parts as u32);
        let (unit, reason) = match unit {
            Ok(unit) => (unit, None),
            Err(reason) => (1, Some(reason)),
        };
        Self {
            candidate,
            interval: span.interval(),
            unit,
            first: first
                .filter(|_| reason.is_none())
                .and_then(|parts| parts.checked_next_multiple_of(unit)),
            reason,
            runs: BTreeMap::new(),
            refused: BTreeSet::new(),
        }
    }

    pub(super) fn runs(&self) -> impl Iterator<Item = &Pilot> {
        self.runs.values()
    }

    pub(super) fn runs_mut(&mut self) -> impl Iterator<Item = &mut Pilot> {
        self.runs.values_mut()
    }

    pub(super) fn insert(&mut self, parts: u32, measured: Result<Row, PilotError>) {
        match measured {
            Ok(row) => {
                let method = self.candidate.method.clone();
                self.runs.insert(parts, Pilot { method, row });
            }
            Err(reason) => {
                self.refused.insert(parts);
                self.reason = Some(reason);
            }
        }
    }

    /// CPU time (s) that a pilot of `simulated` s will take: a run to compare and a run to time.
    pub(super) fn price(&self, parts: u32, simulated: f64, least_step: f64) -> f64 {
        let Some((&at, pilot)) = self.nearest(parts) else {
            return 2.0 * simulated * self.least_cost(parts, least_step);
        };
        let run = pilot.row.cpu_s_per_s * f64::from(parts) / f64::from(at) * simulated;
        pilot.row.setup_cpu_s + 2.0 * run
    }

    /// CPU time (s) per simulated second of steps with the minimum cost.
    fn least_cost(&self, parts: u32, least_step: f64) -> f64 {
        f64::from(parts) * least_step / self.interval
    }

    fn nearest(&self, parts: u32) -> Option<(&u32, &Pilot)> {
        let longer = self.runs.range(..=parts).next_back();
        longer.or_else(|| self.runs.first_key_value())
    }

    /// The largest number of untried parts that keeps within a budget (CPU s per simulated s).
    pub(super) fn parts_within(&self, budget: f64) -> Option<u32> {
        let affordable = |(_, pilot): &(&u32, &Pilot)| pilot.row.cpu_s_per_s <= budget;
        let (&at, pilot) = self.runs.iter().rfind(affordable)?;
        // A little below, so that the run keeps to the budget when its time repeats.
        let parts = (0.95 * f64::from(at) * budget / pilot.row.cpu_s_per_s) as u32;
        let parts = parts - parts % self.unit;
        let new = parts > at && !self.runs.contains_key(&parts) && !self.refused.contains(&parts);
        new.then_some(parts)
    }

    /// The step to try next; none if the candidate has nothing more to try for this aim.
    pub(super) fn next(&self, aim: &Aim) -> Option<Next> {
        let met = |(_, pilot): &(&u32, &Pilot)| {
            let error = pilot.row.sound_error_over_scene();
            error.is_some_and(|error| error <= aim.goal.error)
        };
        let enough = self.runs.iter().find(met);
        let enough = enough.map(|(&parts, pilot)| (parts, &pilot.row));
        let below = enough.map_or(u32::MAX, |(parts, _)| parts);
        let short = self.runs.range(..below).next_back();
        let short = short.map(|(&parts, pilot)| (parts, &pilot.row));
        let mut next = match (short, enough) {
            (None, None) => self.start(aim)?,
            (None, Some(_)) => return None,
            (Some(short), None) => self.shorter(short, aim)?,
            (Some(short), Some(enough)) => between(short, enough, aim)?,
        };
        next.parts = next.parts.checked_next_multiple_of(self.unit)?;
        while self.refused.contains(&next.parts) {
            next.parts = next.parts.checked_add(self.unit)?;
        }
        (next.parts < below && self.refused.len() < MOST_REFUSALS).then_some(next)
    }

    /// The first step. The cost of a candidate is known once it has run; before, only a lower bound is known.
    /// Candidates that factorise come last: the bound does not include set-up, and one run may show that all cost too
    /// much.
    fn start(&self, aim: &Aim) -> Option<Next> {
        let parts = match self.refused.last() {
            None => self.first?,
            Some(last) => {
                let mut rungs = RUNGS.into_iter().map(|rung| rung * self.unit);
                rungs.find(|rung| rung > last)?
            }
        };
        let cost = self.least_cost(parts, aim.least_step);
        let total = cost * aim.duration;
        // Steps of exact methods may cost less than a sweep.
        let hopeless = cost > aim.goal.budget || total >= aim.best;
        if hopeless && self.candidate.order.is_some() {
            return None;
        }
        let promise = if self.candidate.factorises {
            f64::MAX
        } else {
            total
        };
        Some(Next { parts, promise })
    }

    /// The step that should meet the error, limited to a change that can be extrapolated.
    fn shorter(&self, (at, row): (u32, &Row), aim: &Aim) -> Option<Next> {
        let Some(error) = row.sound_error_over_scene() else {
            let parts = at.checked_mul(2)?;
            let promise = aim.promise(row, at, f64::from(parts))?;
            return Some(Next { parts, promise });
        };
        let longer = self.runs.range(..at).next_back();
        let observed = longer.and_then(|(&parts, pilot)| {
            let before = pilot.row.sound_error_over_scene()?;
            Some((before / error).ln() / (f64::from(at) / f64::from(parts)).ln())
        });
        let declared = f64::from(self.candidate.order.unwrap_or(2));
        if self.candidate.order.is_none() && observed.is_some_and(|order| order < STALLED) {
            return None;
        }
        let parts_by = |order: f64| {
            let parts = f64::from(at) * (error / aim.goal.error).powf(1.0 / order);
            parts.ceil().max(f64::from(at) + 1.0)
        };
        // Before two errors are known a method may turn out better than it declares.
        let hopeful = observed.map_or(declared + 1.0, |order| order.max(declared));
        let promise = aim.promise(row, at, parts_by(hopeful))?;
        let likely = observed.map_or(declared, |order| order.clamp(STALLED, declared + 1.0));
        let reach = if observed.is_some() { 4 } else { 2 };
        let farthest = f64::from(at.checked_mul(reach)?);
        let parts = parts_by(likely).min(farthest) as u32;
        Some(Next { parts, promise })
    }
}

/// The step between a run that falls short and one that is accurate enough, if the errors of both enclose the goal;
/// none if nothing can be gained.
fn between(short: (u32, &Row), enough: (u32, &Row), aim: &Aim) -> Option<Next> {
    let (low, high) = (short.0, enough.0);
    let least = low + 1;
    let gain = 1.0 - f64::from(least) / f64::from(high);
    if gain < WORTH_IT {
        return None;
    }
    let promise = aim.promise(enough.1, high, f64::from(least))?;
    let errors = short.1.sound_error_over_scene();
    let errors = errors.zip(enough.1.sound_error_over_scene());
    let parts = errors.map_or(f64::from(low.midpoint(high)), |(larger, smaller)| {
        let ratio = f64::from(high) / f64::from(low);
        let order = (larger / smaller).ln() / ratio.ln();
        f64::from(low) * (larger / aim.goal.error).powf(1.0 / order)
    });
    let parts = (parts.ceil() as u32).clamp(least, high - 1);
    Some(Next { parts, promise })
}
