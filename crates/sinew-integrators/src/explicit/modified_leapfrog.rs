//! `modified-leapfrog`: leapfrog with the modified equation's correction.

use sinew_core::{
    Acceleration, Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LinearOperators,
    LinearSystem, LoadTime, Needs, OptionError, Options, OtherDamping, Prepared, Properties,
    SetupError, StableStep, State, StepError, StepReport, System, VelocityTime,
};

use super::GuardOption;
use crate::Method;
use crate::evaluate::{prepare_buffers, synchronise};
use crate::limits;

/// Central difference with `a = M^-1 (F(t) - K u)` replaced by `a - dt^2/12 M^-1 K a`, which cancels
/// its leading error (Shubin and Bell, SIAM J. Sci. Stat. Comput. 8, 1987; Dablain, Geophysics 51,
/// 1986): two sweeps a step, order 4, stable up to 3.46/omega_max. Mass damping enters at the
/// middle of the step and lowers the order to 2 with a small constant; other damping lags.
///
/// The correction takes loads as constant, so that loads that change cost order 2.
///
/// Started from the Taylor series: `v_half = v0 + dt/2 a0 + dt^2/6 j0 + dt^3/24 q0` with
/// `a0 = M^-1 (F - K u0 - D v0)`, `j0 = -M^-1 (K v0 + D a0)`, `q0 = -M^-1 K a0`.
#[derive(Debug, Default)]
pub struct ModifiedLeapfrog {
    prepared: Prepared,
    a: Vec<f64>,
    correction: Vec<f64>,
}

impl Method for ModifiedLeapfrog {
    const ID: &'static str = "modified-leapfrog";
    const SUMMARY: &'static str = "explicit, order 4 where damping is small, two sweeps a step";
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::Any;

    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }
}

impl ModifiedLeapfrog {
    /// The velocity half a step after the start.
    fn start(&mut self, operators: &LinearOperators, state: &mut State, dt: f64) -> StepReport {
        let mass = operators.mass();
        let divide = |out: &mut [f64]| {
            for (value, mass) in out.iter_mut().zip(mass) {
                *value /= mass;
            }
        };
        operators.net_force(
            LoadTime::around(state.t(), 0.0, dt),
            &state.u,
            &state.v,
            &mut self.a,
        );
        divide(&mut self.a);
        self.correction.fill(0.0);
        operators
            .stiffness()
            .subtract_product(&state.v, &mut self.correction);
        operators.subtract_damping(&self.a, &mut self.correction);
        divide(&mut self.correction);
        let of_jerk = dt * dt / 6.0;
        for ((v, a), j) in state.v.iter_mut().zip(&self.a).zip(&self.correction) {
            *v += dt / 2.0 * a + of_jerk * j;
        }
        self.correction.fill(0.0);
        operators
            .stiffness()
            .subtract_product(&self.a, &mut self.correction);
        divide(&mut self.correction);
        let of_snap = dt * dt * dt / 24.0;
        for (v, q) in state.v.iter_mut().zip(&self.correction) {
            *v += of_snap * q;
        }
        StepReport {
            sweeps: 3,
            force_evaluations: 1,
            ..StepReport::default()
        }
    }

    /// The velocity one step further.
    fn kick(&mut self, operators: &LinearOperators, state: &mut State, dt: f64) -> StepReport {
        let mass = operators.mass();
        operators.external_force(LoadTime::around(state.t(), dt, dt), &mut self.a);
        operators
            .stiffness()
            .subtract_product(&state.u, &mut self.a);
        for (a, mass) in self.a.iter_mut().zip(mass) {
            *a /= mass;
        }
        // -K a dt^2/12 and the lagging damping, both still to be divided by the mass.
        self.correction.fill(0.0);
        let damping = operators.damping();
        operators.stiffness().subtract_scaled_product(
            dt * dt / 12.0,
            &self.a,
            &mut self.correction,
        );
        let mut sweeps = 2;
        if damping.stiffness != 0.0 {
            operators.stiffness().subtract_scaled_product(
                damping.stiffness,
                &state.v,
                &mut self.correction,
            );
            sweeps += 1;
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_product(&state.v, &mut self.correction);
            sweeps += 1;
        }
        let half = damping.mass * dt / 2.0;
        let (keep, divide) = (1.0 - half, 1.0 + half);
        for (i, v) in state.v.iter_mut().enumerate() {
            let w = self.a[i] + self.correction[i] / mass[i];
            *v = (keep * *v + dt * w) / divide;
        }
        StepReport {
            sweeps,
            force_evaluations: 1,
            ..StepReport::default()
        }
    }
}

impl Integrator for ModifiedLeapfrog {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::OrderByDamping {
                undamped: 4,
                damped: 2,
            },
            needs: Needs::Matrices,
            energy: EnergyBehaviour::Bounded,
            changing_loads: ChangingLoads::order(2),
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if system.as_linear().is_none() {
            return Err(Needs::Matrices.lacking(Self::ID));
        }
        let buffers = &mut [&mut self.a, &mut self.correction];
        prepare_buffers(&mut self.prepared, Self::ID, system, dt, buffers)
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        limits::modified_leapfrog(Self::ID, system)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = self.prepare(system, dt)?;
        Prepared::check_state(Self::ID, system, state)?;
        let running = state.is_staggered_by(dt);
        if !running {
            work += synchronise(system, state)?;
        }
        if let Some(operators) = system.as_linear().map(LinearSystem::operators) {
            work += if running {
                self.kick(operators, state, dt)
            } else {
                self.start(operators, state, dt)
            };
        }
        for (u, v) in state.u.iter_mut().zip(&state.v) {
            *u += dt * v;
        }
        state.end_step(dt, VelocityTime::MiddleOfStep, Acceleration::None);
        system.accept(state);
        Ok(work)
    }
}
