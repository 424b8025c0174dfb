//! `generalized-alpha`: implicit, with damping of motions that the step does not resolve.

use std::ops::Bound;

use sinew_core::{
    Acceleration, EnergyBehaviour, LoadTime, Needs, OptionError, Options, Properties, SetupError,
    State, Step, StepError, Stepped, System,
};

use super::effective_mass::{EffectiveMass, ImplicitSteps, OneAcceleration, Sought};
use super::newton::{FACTOR, ITERATIONS, NewtonSettings, TOLERANCE, ViscousPlace};
use crate::{Method, NumericalDissipation, OptionDefault, OptionHelp, OptionKind, Scheme, SetUp};

/// The generalised-alpha method (Chung and Hulbert, J. Appl. Mech. 60, 1993): the equation of motion
/// holds for `(1 - a_m) a+ + a_m a` and `(1 - a_f)` of everything else at t + dt with `a_f` of it at t,
/// on Newmark's displacements and velocities with `gamma = 1/2 - a_m + a_f` and
/// `beta = (1 - a_m + a_f)^2/4`. Order 2, stable at any step on linear systems. Nonlinear laws are applied at both ends, and
/// a+ is found by Newton's method.
///
/// `rho_inf` is the amplitude, after one step, of a motion far too fast for the step, as a share of that before:
/// `a_m = (2 rho - 1)/(rho + 1)`, `a_f = rho/(rho + 1)`; 1 keeps it, 0 removes it. `hht = alpha` gives
/// the method of Hilber, Hughes and Taylor (Earthq. Eng. Struct. Dyn. 5, 1977): `a_m = 0`, `a_f = alpha`.
#[derive(Clone, Copy, Debug)]
pub struct GeneralizedAlpha {
    of_mass: f64,
    of_forces: f64,
    newton: NewtonSettings,
}

impl GeneralizedAlpha {
    /// The method with this spectral radius at infinite frequency, from 0 to 1.
    #[must_use]
    pub fn with_spectral_radius(rho: f64) -> Self {
        Self::new((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// The method of Hilber, Hughes and Taylor with `alpha` from 0 to 1/3.
    #[must_use]
    pub fn hht(alpha: f64) -> Self {
        Self::new(0.0, alpha)
    }

    fn new(of_mass: f64, of_forces: f64) -> Self {
        Self {
            of_mass,
            of_forces,
            newton: NewtonSettings::default(),
        }
    }

    /// The method with these settings of Newton's method, for nonlinear laws.
    #[must_use]
    pub fn with_newton(self, newton: NewtonSettings) -> Self {
        Self { newton, ..self }
    }

    fn gamma(&self) -> f64 {
        0.5 - self.of_mass + self.of_forces
    }

    fn beta(&self) -> f64 {
        (1.0 - self.of_mass + self.of_forces).powi(2) / 4.0
    }
}

const RHO: OptionHelp = OptionHelp {
    key: "rho_inf",
    help: "what is left of the fastest motion after a step",
    expected: "a number from 0 to 1",
    kind: OptionKind::SHARE,
    default: OptionDefault::Value("0.8"),
    example: "rho_inf = 0.5",
    shown_default: None,
};

const HHT: OptionHelp = OptionHelp {
    key: "hht",
    help: "alpha of Hilber, Hughes and Taylor, instead of rho_inf",
    expected: "a number from 0 to 1/3",
    kind: OptionKind::Number(Bound::Included(0.0), Bound::Included(1.0 / 3.0)),
    default: OptionDefault::InWords("rho_inf says all"),
    example: "hht = 0.1",
    shown_default: None,
};

impl Method for GeneralizedAlpha {
    const SUMMARY: &'static str = "implicit, order 2, one sparse solve a step or Newton iteration, damps what the step does not resolve";
    const OPTIONS: &'static [OptionHelp] = &[RHO, HHT, TOLERANCE, ITERATIONS, FACTOR];

    const FACTORISES: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let newton = NewtonSettings::from_options(options, Self::ID)?;
        let Some(alpha) = HHT.number(options, Self::ID)? else {
            let rho = RHO.number(options, Self::ID)?;
            return Ok(Self::with_spectral_radius(rho.unwrap_or(0.8)).with_newton(newton));
        };
        let expected = "nothing beside hht: one of the two says all";
        options.read(Self::ID, RHO.key, expected, |_| None::<()>)?;
        Ok(Self::hht(alpha).with_newton(newton))
    }
}

impl Scheme for GeneralizedAlpha {
    const ID: &'static str = "generalized-alpha";

    type ByHand = ImplicitSteps<Self>;

    fn properties(&self) -> Properties {
        let energy = if self.beta() == 0.25 && self.gamma() == 0.5 {
            EnergyBehaviour::Conserved
        } else {
            EnergyBehaviour::Falls
        };
        Properties::of_order(2, Needs::Tangents, energy)
    }

    fn refuses_contact(&self) -> bool {
        true
    }

    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        Some(NumericalDissipation::Newmark {
            beta: self.beta(),
            gamma: self.gamma(),
            of_mass: self.of_mass,
            of_forces: self.of_forces,
            load_shift: 0.0,
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
}

impl OneAcceleration for GeneralizedAlpha {
    fn coefficients(&self, dt: f64) -> [f64; 2] {
        let share = (1.0 - self.of_forces) / (1.0 - self.of_mass);
        [share * self.gamma() * dt, share * self.beta() * dt * dt]
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
        let (system, dt) = (step.system, step.dt);
        let (beta, gamma) = (self.beta(), self.gamma());
        let (old, new) = (self.of_forces, 1.0 - self.of_forces);
        let ends = |t, dt| LoadTime::at_both_ends(t, dt, 0.5);
        let mut work = effective.keep_acceleration(step, state, ends)?;
        // Matrices are applied once, to the mixture of both ends; laws at each end.
        let [of_old, of_new] = if effective.is_linear() {
            [old, new]
        } else {
            [0.0, 1.0]
        };
        for i in 0..state.u.len() {
            let (u, v, a) = (state.u[i], state.v[i], state.a[i]);
            let predicted = u + dt * v + dt * dt * (0.5 - beta) * a;
            effective.u[i] = of_new * predicted + of_old * u;
            effective.v[i] = of_new * (v + dt * (1.0 - gamma) * a) + of_old * v;
        }
        let [start, end] = ends(state.t(), dt);
        let divide = 1.0 / (1.0 - self.of_mass);
        let sought = Sought {
            coefficients: self.coefficients(dt),
            of_forces: divide * new,
            of_last_inertia: divide * self.of_mass,
            of_old_forces: divide * old,
            loads: [start, end],
            viscosity: ViscousPlace::at_end([start, end]),
        };
        work += effective.solve(step, state, sought, |forces, spare| {
            if old != 0.0 {
                // The load was taken at t + dt whole; a share of it belongs to t.
                for (when, sign) in [(start, old), (end, -old)] {
                    let when = when.under(step.inputs);
                    system.external_force(when, &state.u, spare);
                    for (force, load) in forces.iter_mut().zip(&*spare) {
                        *force += sign * load;
                    }
                }
            }
            for (i, force) in forces.iter_mut().enumerate() {
                *force = divide * (*force - self.of_mass * system.mass()[i] * state.a[i]);
            }
        })?;
        for (i, a) in effective.a.iter().enumerate() {
            let (v, before) = (state.v[i], state.a[i]);
            state.u[i] += dt * v + dt * dt * ((0.5 - beta) * before + beta * a);
            state.v[i] += dt * ((1.0 - gamma) * before + gamma * a);
            state.a[i] = *a;
        }
        Ok(Stepped {
            acceleration: Acceleration::Same,
            ..Stepped::at_same_time(work)
        })
    }
}
