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
    /// Cauchy stress (Pa) where the nominal one is `nominal`: on faces as they are deformed.
    pub cauchy: f64,
    /// J, the ratio of volumes.
    pub volume_ratio: f64,
    /// True within the stable range about rest.
    pub is_stable: bool,
}

/// An end of the stable range about rest, and what else happens on that side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct End {
    /// The last stable amount, if the curve goes on beyond it.
    pub limit: Option<f64>,
    /// The amount beyond which the size of the nominal stress falls, if it does. A law that is stable may have it: a
    /// bar pulled by a force then necks.
    pub falls_from: Option<f64>,
    /// The amount beyond which no equilibrium was found, if the curve stops before the amount asked for.
    pub lost: Option<f64>,
}

/// Halvings of the way to the next state before the curve ends.
const HALVINGS: u32 = 12;
/// Halvings by which the limit of stability is found.
const BISECTIONS: usize = 40;

impl Solid {
    /// The curve of a load between two amounts, with `intervals` states on the way from rest to the farther one. States
    /// are found one after the other, from rest on; the
    /// curve ends where there is no next one.
    #[must_use]
    pub fn curve(&self, load: Load, axes: &Axes, between: [f64; 2], intervals: usize) -> Curve {
        let solid = self;
        let loaded = Loaded { solid, axes, load };
        let [low, high] = between;
        let rest = load.rest();
        let asked = [low.min(high).min(rest), low.max(high).max(rest)];
        let longest = (asked[1] - rest).max(rest - asked[0]);
        let [pressed, pulled] = asked.map(|to| {
            let share = (to - rest).abs() / longest;
            let count = (share * intervals as f64).ceil();
            let count = if count.is_finite() { count as usize } else { 0 };
            loaded.branch(to, count)
        });
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

/// States from rest to one side, without that at rest.
struct Branch {
    states: Vec<LoadState>,
    end: End,
}

impl Loaded<'_> {
    fn branch(&self, to: f64, count: usize) -> Branch {
        let rest = self.load.rest();
        let mut states: Vec<LoadState> = Vec::with_capacity(count);
        let mut end = End::default();
        let mut last = (rest, self.at_rest());
        let mut before = None;
        for number in 1..=count {
            let share = number as f64 / count as f64;
            let amount = if number == count {
                to
            } else {
                rest + share * (to - rest)
            };
            let free = self.follow(&last, before.as_ref(), amount);
            let state = free.as_ref().and_then(|free| self.state(amount, free));
            let (Some(free), Some(mut state)) = (free, state) else {
                end.lost = Some(last.0);
                break;
            };
            if end.limit.is_none() && !state.is_stable {
                end.limit = Some(self.limit(&last, (amount, &free)));
            }
            state.is_stable = end.limit.is_none();
            states.push(state);
            before = Some(std::mem::replace(&mut last, (amount, free)));
        }
        end.falls_from = falls_from(&states);
        Branch { states, end }
    }

    /// The free strains at an amount, by way of states between it and the last one where it cannot be reached at once.
    fn follow(
        &self,
        last: &(f64, DVector<f64>),
        before: Option<&(f64, DVector<f64>)>,
        amount: f64,
    ) -> Option<DVector<f64>> {
        let ahead = before.and_then(|before| {
            let share = (amount - last.0) / (last.0 - before.0);
            self.solve(amount, &(&last.1 + share * (&last.1 - &before.1)))
        });
        if let Some(free) = ahead.or_else(|| self.solve(amount, &last.1)) {
            return Some(free);
        }
        let mut at = last.clone();
        let mut step = amount - last.0;
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
            is_stable: least_stiffness(self.solid, h)? > 0.0,
        })
    }

    /// The amount between a stable state and an unstable one at which stability ends.
    fn limit(&self, stable: &(f64, DVector<f64>), unstable: (f64, &DVector<f64>)) -> f64 {
        let (mut inside, mut outside) = (stable.clone(), unstable.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (inside.0 + outside);
            let Some(free) = self.solve(middle, &inside.1) else {
                break;
            };
            let h = self.gradient(middle, &free);
            if least_stiffness(self.solid, h).is_some_and(|least| least > 0.0) {
                inside = (middle, free);
            } else {
                outside = middle;
            }
        }
        inside.0
    }
}

/// A fall of the stress over its size that is no rounding.
const FALL: f64 = 1e-9;

/// The amount beyond which the size of the nominal stress falls for the first time: the vertex of a parabola through
/// three states.
fn falls_from(states: &[LoadState]) -> Option<f64> {
    let falls = |pair: &[LoadState]| {
        let way = pair[1].amount - pair[0].amount;
        let fall = (pair[0].nominal - pair[1].nominal) * way.signum();
        fall > FALL * pair[0].nominal.abs()
    };
    let first = states.windows(2).position(falls)?;
    let Some([a, b, c]) = first
        .checked_sub(1)
        .and_then(|from| states.get(from..from + 3))
    else {
        return Some(states[first].amount);
    };
    let (before, after) = (b.amount - a.amount, c.amount - b.amount);
    let [rise, fall] = [
        (b.nominal - a.nominal) / before,
        (c.nominal - b.nominal) / after,
    ];
    // The slope is that of each stretch at its middle.
    let share = rise / (rise - fall);
    let middle = a.amount + 0.5 * before;
    Some(middle + share * 0.5 * (before + after))
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
