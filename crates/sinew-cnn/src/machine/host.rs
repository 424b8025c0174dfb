//! Values computed once for all cells before a sweep: its loads and the weights that depend on them.

use std::sync::Arc;

use sinew_core::{Inputs, LinearOperators, Load, LoadTime, Step};

use crate::program::{LoadAt, Loads, Moments, Program, Sweep, Weight, When};

/// The time span of a sweep's step.
#[derive(Clone, Copy, Debug)]
pub struct StepTime<'a> {
    inputs: &'a Inputs,
    /// Its beginning (s).
    t: f64,
    /// Its length (s).
    dt: f64,
}

impl<'a> StepTime<'a> {
    /// A step from `t` (s) on.
    #[must_use]
    pub fn new(step: &Step<'a>, t: f64) -> Self {
        Self {
            inputs: step.inputs,
            t,
            dt: step.dt,
        }
    }

    /// True if the step needs a sweep.
    #[must_use]
    pub fn needs(self, when: When, operators: Option<&LinearOperators>) -> bool {
        let Some(operators) = operators else {
            return when == When::Always;
        };
        let (t, dt) = (self.t, self.dt);
        match when {
            When::Always => true,
            When::LoadChanges(load) => {
                let load = operators.loads().get(load as usize);
                let constant =
                    |load: &Load| load.ramp.known(self.inputs).is_constant_between(t, t + dt);
                load.is_some_and(|load| !constant(load))
            }
            When::LoadsJump => {
                let mut loads = operators.loads_between(self.inputs, t - 0.5 * dt, t + 0.5 * dt);
                loads.any(|load| self.half_jump(load) != 0.0)
            }
        }
    }

    /// Half the jump of a load's factor between the steps before and after its beginning, over which it is
    /// constant.
    fn half_jump(self, load: &Load) -> f64 {
        let ramp = load.ramp.known(self.inputs);
        0.5 * (ramp.value(self.t + 0.5 * self.dt) - ramp.value(self.t - 0.5 * self.dt))
    }

    /// Time at which a sweep takes its loads.
    #[must_use]
    pub fn load_time(self, at: LoadAt) -> LoadTime<'static> {
        let (t, dt) = (self.t, self.dt);
        match at {
            LoadAt::StartOf => LoadTime::start_of(t, dt),
            LoadAt::Within(share) => LoadTime::within(t, dt, share),
            LoadAt::Around => LoadTime::around(t, dt, dt),
            LoadAt::From => LoadTime::around(t, 0.0, dt),
            LoadAt::Smooth => LoadTime::smooth_in(t, t, dt),
        }
    }

    /// Calls `add` with every load of a sweep, in order, and the factor by which it enters.
    pub fn for_each_load<'o>(
        self,
        loads: Loads,
        operators: &'o LinearOperators,
        mut add: impl FnMut(&'o Load, f64),
    ) where
        'a: 'o,
    {
        let mut add = |load, factor| {
            if factor != 0.0 {
                add(load, factor);
            }
        };
        let (t, dt) = (self.t, self.dt);
        match loads {
            Loads::None => {}
            Loads::All { factor, at } => {
                let when = self.load_time(at).under(self.inputs);
                let (from, to) = when.span();
                for load in operators.loads_between(self.inputs, from, to) {
                    add(load, factor * load.ramp.factor(when));
                }
            }
            Loads::HalfJump => {
                for load in operators.loads_between(self.inputs, t - 0.5 * dt, t + 0.5 * dt) {
                    add(load, self.half_jump(load));
                }
            }
            Loads::One(number) => {
                if let Some(load) = operators.loads().get(number as usize) {
                    add(load, 1.0);
                }
            }
        }
    }
}

/// The load on which the weights of a program depend, over the current step.
#[derive(Clone, Debug, Default)]
pub struct FollowedLoad {
    /// The load, by its number, and the step's beginning (s).
    of: Option<(u32, f64)>,
    moments: Option<Arc<Moments>>,
    /// The factor less its value at the beginning, at the times of the program's moments.
    changes: Vec<f64>,
}

impl FollowedLoad {
    /// Storage for a program.
    #[must_use]
    pub fn of(program: &Program) -> Self {
        let moments = program.moments.clone();
        let times = moments.as_ref().map_or(0, |moments| moments.times.len());
        Self {
            of: None,
            moments,
            changes: vec![0.0; times],
        }
    }

    /// Discards the last step.
    pub fn forget(&mut self) {
        self.of = None;
    }

    /// Computes the change of the load on which the weights of a sweep depend, over a step.
    pub fn follow(
        &mut self,
        sweep: &Sweep,
        operators: Option<&LinearOperators>,
        step: StepTime<'_>,
    ) {
        let Some(moments) = &self.moments else {
            return;
        };
        let terms = sweep.updates.iter().flat_map(|update| &update.terms);
        let mut followed = terms.filter_map(|term| match term.weight {
            Weight::OfLoad { load, .. } => Some(load),
            Weight::Number(_) => None,
        });
        let (t, dt) = (step.t, step.dt);
        if let (Some(number), Some(operators)) = (followed.next(), operators)
            && self.of != Some((number, t))
            && let Some(load) = operators.loads().get(number as usize)
        {
            let ramp = load.ramp.known(step.inputs);
            let start = ramp.value_within(t, t + dt, t);
            for (value, time) in self.changes.iter_mut().zip(&moments.times) {
                *value = ramp.value_within(t, t + dt, t + time) - start;
            }
            self.of = Some((number, t));
        }
    }

    /// A weight in the current step.
    #[must_use]
    pub fn weight(&self, weight: Weight) -> f64 {
        match (weight, &self.moments) {
            (Weight::Number(number), _) => number,
            (Weight::OfLoad { moment, .. }, Some(moments)) => {
                let weights = moments.weights[moment as usize].iter();
                weights.zip(&self.changes).map(|(w, c)| w * c).sum()
            }
            (Weight::OfLoad { .. }, None) => 0.0,
        }
    }
}
