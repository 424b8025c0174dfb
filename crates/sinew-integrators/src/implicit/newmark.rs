//! `newmark`: Newmark's family.

use sinew_core::{
    Acceleration, DampedAt, EnergyBehaviour, LoadTime, Needs, OptionError, Options, Properties,
    SetupError, StableStep, State, Step, StepError, Stepped, System,
};

use super::effective_mass::{EffectiveMass, ImplicitSteps, OneAcceleration, Sought};
use super::newton::{FACTOR, ITERATIONS, NewtonSettings, TOLERANCE};
use crate::{Method, NumericalDissipation, OptionDefault, OptionHelp, OptionKind, Scheme, SetUp};

/// Newmark's method (J. Eng. Mech. Div. ASCE 85, 1959) in its acceleration form (Hughes, The
/// Finite Element Method, section 9.1): with `u* = u + dt v + dt^2 (1/2 - beta) a` and
/// `v* = v + dt (1 - gamma) a`,
/// `(M + gamma dt D + beta dt^2 K) a+ = F(t + dt) - K u* - D v*`, `u+ = u* + beta dt^2 a+`,
/// `v+ = v* + gamma dt a+`. The first acceleration is the consistent one.
///
/// On nonlinear laws the same equations are solved for a+ by Newton's method.
///
/// The default, beta = 1/4 and gamma = 1/2, is stable at any step and conserves energy on linear systems; on nonlinear
/// ones the energy may grow in long steps, which the method reports.
#[derive(Clone, Copy, Debug)]
pub struct Newmark {
    beta: f64,
    gamma: f64,
    newton: NewtonSettings,
}

impl Newmark {
    /// Newmark's method with these parameters.
    #[must_use]
    pub fn new(beta: f64, gamma: f64) -> Self {
        Self {
            beta,
            gamma,
            newton: NewtonSettings::default(),
        }
    }

    /// The method with these settings of Newton's method, for nonlinear laws.
    #[must_use]
    pub fn with_newton(self, newton: NewtonSettings) -> Self {
        Self { newton, ..self }
    }
}

impl Default for Newmark {
    fn default() -> Self {
        Self::new(0.25, 0.5)
    }
}

const BETA: OptionHelp = OptionHelp {
    key: "beta",
    help: "weight of the acceleration at the end of a step in its displacement",
    expected: "a number from 0 to 1",
    kind: OptionKind::SHARE,
    default: OptionDefault::Value("0.25"),
    example: "beta = 0.3",
    shown_default: None,
};

const GAMMA: OptionHelp = OptionHelp {
    key: "gamma",
    help: "weight of the acceleration at the end of a step in its velocity; above 0.5 motion is damped and the order is 1",
    expected: "a number from 0 to 1",
    kind: OptionKind::SHARE,
    default: OptionDefault::Value("0.5"),
    example: "gamma = 0.6",
    shown_default: None,
};

impl Method for Newmark {
    const SUMMARY: &'static str =
        "implicit, order 2, one sparse solve a step or Newton iteration, stable at any step";
    const OPTIONS: &'static [OptionHelp] = &[BETA, GAMMA, TOLERANCE, ITERATIONS, FACTOR];

    const FACTORISES: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let Self { beta, gamma, .. } = Self::default();
        let method = Self::new(
            BETA.number(options, Self::ID)?.unwrap_or(beta),
            GAMMA.number(options, Self::ID)?.unwrap_or(gamma),
        );
        Ok(method.with_newton(NewtonSettings::from_options(options, Self::ID)?))
    }
}

impl Scheme for Newmark {
    const ID: &'static str = "newmark";

    type ByHand = ImplicitSteps<Self>;

    fn properties(&self) -> Properties {
        let order = if self.gamma == 0.5 { 2 } else { 1 };
        let energy = match (self.beta, self.gamma) {
            (0.25, 0.5) => EnergyBehaviour::Conserved,
            (_, 0.5) => EnergyBehaviour::Bounded,
            (_, gamma) if gamma > 0.5 => EnergyBehaviour::Falls,
            _ => EnergyBehaviour::Grows,
        };
        Properties::of_order(order, Needs::Tangents, energy)
    }

    fn refuses_contact(&self) -> bool {
        true
    }

    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        Some(NumericalDissipation::Newmark {
            beta: self.beta,
            gamma: self.gamma,
            of_mass: 0.0,
            of_forces: 0.0,
            load_shift: 0.5 - self.gamma,
        })
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        before: Option<ImplicitSteps<Self>>,
    ) -> Result<SetUp<ImplicitSteps<Self>>, SetupError> {
        ImplicitSteps::set_up(self, system, dt, before)
    }

    /// Any step if 2 beta >= gamma >= 1/2; otherwise `1/(w sqrt(gamma/2 - beta))`, a lower bound with damping. If gamma
    /// < 1/2, no step is stable without damping, and the limit is unknown with damping (Hughes, section 9.1).
    fn stable_step(
        &self,
        system: &dyn System,
        about: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        if 2.0 * self.beta >= self.gamma && self.gamma >= 0.5 {
            return Ok(StableStep::Any);
        }
        let Some(spectrum) = system.spectrum(about) else {
            return Ok(StableStep::Unknown);
        };
        if self.gamma < 0.5 {
            let damping = spectrum.mass_damping + spectrum.damping_max;
            return Ok(match damping {
                0.0 => StableStep::UpTo(0.0),
                _ => StableStep::Unknown,
            });
        }
        let limit = (self.gamma / 2.0 - self.beta).sqrt().recip() / spectrum.omega_max;
        Ok(StableStep::UpTo(limit))
    }
}

impl OneAcceleration for Newmark {
    fn coefficients(&self, dt: f64) -> [f64; 2] {
        [self.gamma * dt, self.beta * dt * dt]
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
        let (beta, gamma) = (self.beta, self.gamma);
        let ends = |t, dt| LoadTime::at_both_ends(t, dt, gamma);
        let mut work = effective.keep_acceleration(step, state, ends)?;
        for i in 0..state.u.len() {
            let (u, v, a) = (state.u[i], state.v[i], state.a[i]);
            effective.u[i] = u + dt * v + dt * dt * (0.5 - beta) * a;
            effective.v[i] = v + dt * (1.0 - gamma) * a;
        }
        let sought = Sought::at_end(self.coefficients(dt), ends(state.t(), dt));
        work += effective.solve(step, state, sought, |_, _| ())?;
        for (i, a) in effective.a.iter().enumerate() {
            state.u[i] = effective.u[i] + beta * dt * dt * a;
            state.v[i] = effective.v[i] + gamma * dt * a;
            state.a[i] = *a;
        }
        Ok(Stepped {
            acceleration: Acceleration::Same,
            damped: DampedAt::supports(0.5 - gamma),
            ..Stepped::at_same_time(work)
        })
    }
}
