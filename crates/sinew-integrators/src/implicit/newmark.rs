//! `newmark`: Newmark's family.

use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Acceleration, Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs,
    OptionError, Options, OtherDamping, Properties, SetupError, StableStep, State, StepError,
    StepReport, System, VelocityTime,
};

use super::engine::Engine;
use crate::evaluate::begin;
use crate::{Method, OptionHelp};

/// Newmark's method (J. Eng. Mech. Div. ASCE 85, 1959) in its acceleration form (Hughes, The
/// Finite Element Method, section 9.1): with `u* = u + dt v + dt^2 (1/2 - beta) a` and
/// `v* = v + dt (1 - gamma) a`,
/// `(M + gamma dt D + beta dt^2 K) a+ = F(t + dt) - K u* - D v*`, `u+ = u* + beta dt^2 a+`,
/// `v+ = v* + gamma dt a+`. The first acceleration is the consistent one.
///
/// The default, beta = 1/4 and gamma = 1/2, is stable at any step and conserves energy.
#[derive(Debug)]
pub struct Newmark {
    beta: f64,
    gamma: f64,
    engine: Engine,
}

impl Newmark {
    /// With these parameters.
    #[must_use]
    pub fn new(beta: f64, gamma: f64) -> Self {
        Self {
            beta,
            gamma,
            engine: Engine::default(),
        }
    }
}

impl Default for Newmark {
    fn default() -> Self {
        Self::new(0.25, 0.5)
    }
}

impl Method for Newmark {
    const ID: &'static str = "newmark";
    const SUMMARY: &'static str = "implicit, order 2, one sparse solve a step, stable at any step";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: "beta",
            help: "0 to 1; default 0.25",
            shown_default: None,
        },
        OptionHelp {
            key: "gamma",
            help: "0 to 1; default 0.5, above it motion is damped and the order is 1",
            shown_default: None,
        },
    ];

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let share = |key, default| {
            options.number(Self::ID, key, default, "a number from 0 to 1", |value| {
                (0.0..=1.0).contains(&value)
            })
        };
        Ok(Self::new(share("beta", 0.25)?, share("gamma", 0.5)?))
    }
}

impl Integrator for Newmark {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(if self.gamma == 0.5 { 2 } else { 1 }),
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::order(if self.gamma == 0.5 { 2 } else { 1 }),
            energy: match (self.beta, self.gamma) {
                (0.25, 0.5) => EnergyBehaviour::Conserved,
                (_, 0.5) => EnergyBehaviour::Bounded,
                (_, gamma) if gamma > 0.5 => EnergyBehaviour::Falls,
                _ => EnergyBehaviour::Grows,
            },
            other_damping: OtherDamping::order(if self.gamma == 0.5 { 2 } else { 1 }),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        let coefficients = (self.gamma * dt, self.beta * dt * dt);
        self.engine.prepare(Self::ID, system, dt, coefficients)
    }

    /// Any where 2 beta >= gamma >= 1/2; otherwise `1/(w sqrt(gamma/2 - beta))`, a lower bound with
    /// damping, and none where gamma < 1/2 (Hughes, section 9.1).
    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        if self.gamma < 0.5 {
            return Ok(StableStep::UpTo(0.0));
        }
        if 2.0 * self.beta >= self.gamma {
            return Ok(StableStep::Any);
        }
        let spectrum = Spectrum::of_system(system, Self::ID)?;
        let limit = (self.gamma / 2.0 - self.beta).sqrt().recip() / spectrum.omega_max;
        Ok(StableStep::UpTo(limit))
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        let (beta, gamma) = (self.beta, self.gamma);
        let ends = |t, dt| LoadTime::at_both_ends(t, dt, gamma);
        work += self.engine.keep_acceleration(system, state, dt, ends)?;
        for i in 0..state.u.len() {
            let (u, v, a) = (state.u[i], state.v[i], state.a[i]);
            self.engine.u[i] = u + dt * v + dt * dt * (0.5 - beta) * a;
            self.engine.v[i] = v + dt * (1.0 - gamma) * a;
        }
        let [_, end] = ends(state.t(), dt);
        work += self.engine.evaluate(system, end, dt)?;
        work += self.engine.solve();
        for (i, a) in self.engine.a.iter().enumerate() {
            state.u[i] = self.engine.u[i] + beta * dt * dt * a;
            state.v[i] = self.engine.v[i] + gamma * dt * a;
            state.a[i] = *a;
        }
        state.end_step(dt, VelocityTime::Same, Acceleration::Same);
        system.accept(state);
        Ok(work)
    }
}
