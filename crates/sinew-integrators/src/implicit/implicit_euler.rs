//! `implicit-euler`: both halves from the new state.

use sinew_core::{
    DampedAt, EnergyBehaviour, LoadTime, Needs, OptionError, Options, Properties, SetupError,
    State, Step, StepError, Stepped, System,
};

use super::effective_mass::{EffectiveMass, ImplicitSteps, OneAcceleration, Sought};
use super::newton::{FACTOR, ITERATIONS, NewtonSettings, TOLERANCE, ViscousPlace};
use crate::{Method, NumericalDissipation, OptionHelp, Scheme, SetUp};

/// `v+ = v + dt a+`, `u+ = u + dt v+` with `(M + dt D + dt^2 K) a+ = F(t + dt) - K (u + dt v) - D v`
/// (Baraff and Witkin, Large steps in cloth simulation, 1998, for a linear system). Stable at any
/// step and strongly damped by it. On nonlinear laws a+ solves `M a+ = net(u+, v+)` by Newton's method.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitEuler {
    newton: NewtonSettings,
}

impl ImplicitEuler {
    /// The method with these settings of Newton's method, for nonlinear laws.
    #[must_use]
    pub fn with_newton(newton: NewtonSettings) -> Self {
        Self { newton }
    }
}

impl Method for ImplicitEuler {
    const SUMMARY: &'static str =
        "implicit, order 1, one sparse solve a step or Newton iteration; damps what it moves";
    const OPTIONS: &'static [OptionHelp] = &[TOLERANCE, ITERATIONS, FACTOR];

    const FACTORISES: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let newton = NewtonSettings::from_options(options, Self::ID)?;
        Ok(Self::with_newton(newton))
    }
}

impl Scheme for ImplicitEuler {
    const ID: &'static str = "implicit-euler";

    type ByHand = ImplicitSteps<Self>;

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Tangents, EnergyBehaviour::Falls)
    }

    fn refuses_contact(&self) -> bool {
        true
    }

    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        Some(NumericalDissipation::ImplicitEuler)
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        before: Option<ImplicitSteps<Self>>,
    ) -> Result<SetUp<ImplicitSteps<Self>>, SetupError> {
        ImplicitSteps::set_up(self, system, dt, before)
    }
}

impl OneAcceleration for ImplicitEuler {
    fn coefficients(&self, dt: f64) -> [f64; 2] {
        [dt, dt * dt]
    }

    fn newton(&self) -> NewtonSettings {
        self.newton
    }

    fn step(
        &self,
        effective: &mut EffectiveMass,
        step: &Step<'_>,
        state: &mut State,
    ) -> Result<Stepped, StepError> {
        let dt = step.dt;
        for (predicted, (u, v)) in effective.u.iter_mut().zip(state.u.iter().zip(&state.v)) {
            *predicted = u + dt * v;
        }
        effective.v.copy_from_slice(&state.v);
        let t = state.t();
        let loads = [LoadTime::start_of(t, dt), LoadTime::end_of(t, dt)];
        let sought = Sought {
            viscosity: ViscousPlace {
                load: LoadTime::middle_of(t, dt),
                before: 0.5 * dt,
            },
            ..Sought::at_end(self.coefficients(dt), loads)
        };
        let work = effective.solve(step, state, sought, |_, _| ())?;
        for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&effective.a) {
            *v += dt * a;
            *u += dt * *v;
        }
        Ok(Stepped {
            damped: DampedAt::WAY_OF_STEP,
            ..Stepped::at_same_time(work)
        })
    }
}
