//! `rk4`: the classical Runge-Kutta method.

use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs, OptionError, Options,
    OtherDamping, Prepared, Properties, SetupError, StableStep, State, StepError, StepReport,
    System, Trial,
};

use super::GuardOption;
use crate::Method;
use crate::evaluate::{begin, net_force, prepare_buffers};
use crate::limits;

/// The classical fourth-order method (Kutta 1901) on (u, v): four sweeps a step.
///
/// Order 4 also while loads change smoothly. A load that jumps or has a kink inside a step is
/// replaced there by a line of the same impulse and first moment, which costs order 2 at most.
#[derive(Debug, Default)]
pub struct Rk4 {
    prepared: Prepared,
    stage_u: Vec<f64>,
    stage_v: Vec<f64>,
    a: Vec<f64>,
    sum_u: Vec<f64>,
    sum_v: Vec<f64>,
}

/// (time and increment of the stage, its weight in the sum), both in steps.
const STAGES: [(f64, f64); 4] = [
    (0.0, 1.0 / 6.0),
    (0.5, 1.0 / 3.0),
    (0.5, 1.0 / 3.0),
    (1.0, 1.0 / 6.0),
];

impl Method for Rk4 {
    const ID: &'static str = "rk4";
    const SUMMARY: &'static str = "explicit, order 4, four sweeps a step";
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::Any;

    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }
}

impl Integrator for Rk4 {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(4),
            needs: Needs::Forces,
            energy: EnergyBehaviour::Falls,
            changing_loads: ChangingLoads::Order {
                smooth: 4,
                broken: 2,
            },
            other_damping: OtherDamping::order(4),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        let buffers = &mut [
            &mut self.stage_u,
            &mut self.stage_v,
            &mut self.a,
            &mut self.sum_u,
            &mut self.sum_v,
        ];
        prepare_buffers(&mut self.prepared, Self::ID, system, dt, buffers)
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        limits::rk4(Self::ID, system)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        self.stage_u.copy_from_slice(&state.u);
        self.stage_v.copy_from_slice(&state.v);
        self.sum_u.fill(0.0);
        self.sum_v.fill(0.0);
        for (stage, (time, weight)) in STAGES.into_iter().enumerate() {
            let trial = Trial {
                load: LoadTime::within(state.t(), dt, time),
                dt: time * dt,
                u: &self.stage_u,
                v: &self.stage_v,
            };
            work += net_force(system, &trial, &mut self.a)?;
            let next = STAGES.get(stage + 1).map_or(0.0, |(time, _)| time * dt);
            for (i, (force, mass)) in self.a.iter().zip(system.mass()).enumerate() {
                let (v, a) = (self.stage_v[i], force / mass);
                self.sum_u[i] += weight * v;
                self.sum_v[i] += weight * a;
                self.stage_u[i] = state.u[i] + next * v;
                self.stage_v[i] = state.v[i] + next * a;
            }
        }
        for (u, sum) in state.u.iter_mut().zip(&self.sum_u) {
            *u += dt * sum;
        }
        for (v, sum) in state.v.iter_mut().zip(&self.sum_v) {
            *v += dt * sum;
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }
}
