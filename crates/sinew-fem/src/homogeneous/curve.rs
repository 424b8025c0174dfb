//! Curves of loads, from rest in both directions.

use nalgebra::DVector;

use super::axes::Axes;
use super::equilibrium::Loaded;
use super::load::Load;
use super::solid::Solid;
use super::stability::least_stiffness;
use crate::hyperelastic::{Deformation, Tensor};

/// The curve of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The load.
    pub load: Load,
    /// Its states by their amounts, rising.
    pub states: Vec<LoadState>,
    /// The least and the largest amount asked for.
    pub asked: [f64; 2],
    /// Ends of the stable range about rest, in pressing and in pulling direction.
    pub ends: [End; 2],
}

/// A state of a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadState {
    /// The stretch, or the amount of shear.
    pub amount: f64,
    /// Nominal stress (first Piola-Kirchhoff) (Pa) along the first axis, on the face across it; in simple shear on that
    /// across the second axis.
    pub nominal: f64,
    /// Nominal stress (Pa) along the second axis on the face across it.
    pub nominal_across: f64,
    /// Cauchy stress (Pa) at the nominal stress `nominal`: on deformed faces.
    pub cauchy: f64,
    /// J, the ratio of volumes.
    pub volume_ratio: f64,
    /// True within the stable range about rest.
    pub is_stable: bool,
}

/// An end of the stable range about rest, with other limits on that side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct End {
    /// The last stable amount, if the curve continues beyond it.
    pub limit: Option<f64>,
    /// The amount beyond which the size of the nominal stress falls, if it does. A law that is stable may have it: a
    /// bar pulled by a force then necks.
    pub falls_from: Option<f64>,
    /// The amount beyond which no equilibrium was found, if the curve stops before the amount asked for.
    pub lost: Option<f64>,
}

/// Step from one state to the next, in the logarithm of a stretch, or approximately in the amount of shear.
const STEP: f64 = 0.005;
/// The most steps to one side, at which a stretch is 5e-5 or 2e4: no step of a logarithm leads to a stretch of 0 or less.
const STEPS: usize = 2000;
/// Halvings of the step to the next state before the curve ends.
const HALVINGS: u32 = 12;
/// Halvings by which the limit of stability is found.
const BISECTIONS: usize = 40;
/// Golden sections by which a dip of the stiffness between states, or the top of the stress, is found.
const SECTIONS: usize = 40;
/// The golden section, the root of `x^2 + x = 1`.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Solid {
    /// The curve of a load between two amounts. States are found one after the other, starting at rest, at steps that
    /// do not depend on the range. So the results on stability do not depend on it either. The curve ends if no next
    /// state is found. The amounts `at` are also states.
    #[must_use]
    pub fn curve(&self, load: Load, axes: &Axes, between: [f64; 2], at: &[f64]) -> Curve {
        let solid = self;
        let loaded = Loaded { solid, axes, load };
        let [low, high] = between;
        let rest = load.rest();
        let asked = [low.min(high).min(rest), low.max(high).max(rest)];
        let [pressed, pulled] = asked.map(|to| loaded.branch(&amounts(load, to, at)));
        let ends = [pressed.end, pulled.end];
        let mut states = pressed.states;
        states.reverse();
        states.extend(loaded.state(rest, &loaded.at_rest()));
        states.extend(pulled.states);
        Curve {
            load,
            states,
            asked,
            ends,
        }
    }
}

/// The amounts of the states from rest to one side, without that of rest.
fn amounts(load: Load, to: f64, at: &[f64]) -> Vec<f64> {
    let (rest, side) = (load.rest(), if to < load.rest() { -1.0 } else { 1.0 });
    let step = |number: usize| match load.is_shear() {
        true => (side * STEP * number as f64).sinh(),
        false => (side * STEP * number as f64).exp(),
    };
    let is_within = |amount: &f64| (amount - rest) * side > 0.0 && (to - amount) * side > 0.0;
    let mut amounts: Vec<f64> = (1..=STEPS).map(step).take_while(is_within).collect();
    amounts.extend(at.iter().copied().filter(is_within));
    if to != rest {
        amounts.push(to);
    }
    amounts.sort_by(|a, b| (side * a).total_cmp(&(side * b)));
    amounts.dedup();
    amounts
}

/// States from rest to one side, without that at rest.
struct Branch {
    states: Vec<LoadState>,
    end: End,
}

/// An amount with its free strains and the least stiffness (Pa) there.
#[derive(Clone)]
struct Found {
    amount: f64,
    free: DVector<f64>,
    least: f64,
}

impl Loaded<'_> {
    fn branch(&self, amounts: &[f64]) -> Branch {
        let mut states: Vec<LoadState> = Vec::with_capacity(amounts.len());
        let mut strains = Vec::with_capacity(amounts.len());
        let mut end = End::default();
        let mut last = self.found(self.load.rest(), self.at_rest());
        let mut before: Option<Found> = None;
        for amount in amounts {
            let next = last.as_ref().and_then(|last| {
                let free = self.follow(last, before.as_ref(), *amount)?;
                self.found(*amount, free)
            });
            let state = next
                .as_ref()
                .and_then(|next| self.state(*amount, &next.free));
            let (Some(next), Some(mut state), Some(here)) = (next, state, last) else {
                let rest = self.load.rest();
                end.lost = Some(states.last().map_or(rest, |state| state.amount));
                break;
            };
            if end.limit.is_none() {
                let dip = before
                    .as_ref()
                    .and_then(|before| self.dip(before, &here, &next));
                end.limit = match dip {
                    Some(unstable) => before.as_ref().map(|before| self.limit(before, unstable)),
                    None if next.least > 0.0 => None,
                    None => Some(self.limit(&here, next.amount)),
                };
            }
            state.is_stable = end.limit.is_none();
            states.push(state);
            strains.push(next.free.clone());
            before = Some(here);
            last = Some(next);
        }
        if let Some(limit) = end.limit {
            // A dip may have ended before the last states that were looked at.
            for state in &mut states {
                let is_within =
                    (state.amount - self.load.rest()).abs() <= (limit - self.load.rest()).abs();
                state.is_stable = is_within;
            }
        }
        end.falls_from = self.falls_from(&states, &strains);
        Branch { states, end }
    }

    fn found(&self, amount: f64, free: DVector<f64>) -> Option<Found> {
        let least = least_stiffness(self.solid, self.gradient(amount, &free))?;
        Some(Found {
            amount,
            free,
            least,
        })
    }

    /// An unstable amount between three stable states of which the one in the middle is the least stiff, if there is one.
    fn dip(&self, a: &Found, b: &Found, c: &Found) -> Option<f64> {
        if !(b.least > 0.0 && c.least > 0.0 && b.least < a.least && b.least < c.least) {
            return None;
        }
        let at = |amount: f64| self.found(amount, self.solve(amount, &b.free)?);
        let (mut low, mut high) = (a.amount, c.amount);
        for _ in 0..SECTIONS {
            let way = GOLDEN * (high - low);
            let (left, right) = (at(high - way)?, at(low + way)?);
            let unstable = [&left, &right].into_iter().find(|found| found.least <= 0.0);
            if let Some(found) = unstable {
                return Some(found.amount);
            }
            match left.least < right.least {
                true => high = right.amount,
                false => low = left.amount,
            }
        }
        None
    }

    /// The free strains at an amount, through states between it and the last one if it cannot be reached directly.
    fn follow(&self, last: &Found, before: Option<&Found>, amount: f64) -> Option<DVector<f64>> {
        let ahead = before.and_then(|before| {
            let share = (amount - last.amount) / (last.amount - before.amount);
            self.solve(amount, &(&last.free + share * (&last.free - &before.free)))
        });
        if let Some(free) = ahead.or_else(|| self.solve(amount, &last.free)) {
            return Some(free);
        }
        let mut at = (last.amount, last.free.clone());
        let mut step = amount - last.amount;
        for _ in 0..HALVINGS {
            step *= 0.5;
            while let Some(free) = self.solve(at.0 + step, &at.1) {
                at = (at.0 + step, free);
                let left = amount - at.0;
                if left.abs() <= step.abs() {
                    return self.solve(amount, &at.1);
                }
            }
        }
        None
    }

    fn state(&self, amount: f64, free: &DVector<f64>) -> Option<LoadState> {
        let h = self.gradient(amount, free);
        let stress = self.solid.stress(h)?;
        let nominal = self.axes.of_mesh(stress);
        let deformation = Deformation::of(h);
        let volume_ratio = deformation.volume_ratio;
        let cauchy = if self.solid.is_linear() {
            nominal
        } else {
            let f = h + Tensor::identity();
            let kirchhoff = stress.times_transposed(f);
            self.axes.of_mesh(kirchhoff.scaled(volume_ratio.recip()))
        };
        let (row, column) = self.load.working();
        Some(LoadState {
            amount,
            nominal: nominal[row][column],
            nominal_across: nominal[1][1],
            cauchy: cauchy[row][column],
            volume_ratio,
            is_stable: true,
        })
    }

    /// The amount between a stable state and an unstable one at which stability ends.
    fn limit(&self, stable: &Found, unstable: f64) -> f64 {
        let (mut inside, mut outside) = (stable.clone(), unstable);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (inside.amount + outside);
            let free = self.solve(middle, &inside.free);
            match free.and_then(|free| self.found(middle, free)) {
                Some(found) if found.least > 0.0 => inside = found,
                Some(_) => outside = middle,
                None => break,
            }
        }
        inside.amount
    }
}

/// Smallest relative fall of the stress that is not rounding.
const FALL: f64 = 1e-9;

impl Loaded<'_> {
    /// The amount beyond which the size of the nominal stress falls for the first time.
    fn falls_from(&self, states: &[LoadState], strains: &[DVector<f64>]) -> Option<f64> {
        let falls = |pair: &[LoadState]| {
            let way = pair[1].amount - pair[0].amount;
            let fall = (pair[0].nominal - pair[1].nominal) * way.signum();
            fall > FALL * pair[0].nominal.abs()
        };
        let first = states.windows(2).position(falls)?;
        let (mut low, mut high) = match first.checked_sub(1) {
            Some(before) => (states[before].amount, states[first + 1].amount),
            None => (self.load.rest(), states[first + 1].amount),
        };
        let way = (high - low).signum();
        let pull = |amount: f64| {
            let free = self.solve(amount, &strains[first])?;
            Some(way * self.state(amount, &free)?.nominal)
        };
        for _ in 0..SECTIONS {
            let part = GOLDEN * (high - low);
            let (left, right) = (high - part, low + part);
            let (Some(at_left), Some(at_right)) = (pull(left), pull(right)) else {
                return Some(states[first].amount);
            };
            match at_left > at_right {
                true => high = right,
                false => low = left,
            }
        }
        Some(0.5 * (low + high))
    }
}

impl Curve {
    /// The stable range about rest, as far as the curve shows it.
    #[must_use]
    pub fn stable(&self) -> [f64; 2] {
        let first = self.states.first().map(|state| state.amount);
        let last = self.states.last().map(|state| state.amount);
        let rest = self.load.rest();
        let [low, high] = self.ends.map(|end| end.limit);
        [low.or(first).unwrap_or(rest), high.or(last).unwrap_or(rest)]
    }

    /// Nominal stress (Pa) at an amount, on a straight line between states; `None` beyond them.
    #[must_use]
    pub fn at(&self, amount: f64) -> Option<f64> {
        let after = self.states.partition_point(|state| state.amount < amount);
        let next = self.states.get(after)?;
        if next.amount == amount {
            return Some(next.nominal);
        }
        let before = self.states.get(after.checked_sub(1)?)?;
        let share = (amount - before.amount) / (next.amount - before.amount);
        Some(before.nominal + share * (next.nominal - before.nominal))
    }
}
