//! `generalized-alpha`: implicit, with damping of what the step does not resolve.

use sinew_core::{
    Acceleration, Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs,
    OptionError, OptionValue, Options, OtherDamping, Properties, SetupError, StableStep, State,
    StepError, StepReport, System, VelocityTime,
};

use super::engine::Engine;
use crate::evaluate::begin;
use crate::{Method, OptionHelp};

/// The generalised-alpha method (Chung and Hulbert, J. Appl. Mech. 60, 1993): the equation of motion
/// holds for `(1 - a_m) a+ + a_m a` and `(1 - a_f)` of everything else at t + dt with `a_f` of it at t,
/// on Newmark's displacements and velocities with `gamma = 1/2 - a_m + a_f` and
/// `beta = (1 - a_m + a_f)^2/4`. Order 2, stable at any step.
///
/// `rho_inf` is what is left of a motion far too fast for the step after one of them:
/// `a_m = (2 rho - 1)/(rho + 1)`, `a_f = rho/(rho + 1)`; 1 keeps it, 0 removes it. `hht = alpha` gives
/// the method of Hilber, Hughes and Taylor (Earthq. Eng. Struct. Dyn. 5, 1977): `a_m = 0`, `a_f = alpha`.
#[derive(Debug)]
pub struct GeneralizedAlpha {
    of_mass: f64,
    of_forces: f64,
    engine: Engine,
    load: Vec<f64>,
}

impl GeneralizedAlpha {
    /// With this spectral radius at infinite frequency, from 0 to 1.
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
            engine: Engine::default(),
            load: Vec::new(),
        }
    }

    fn gamma(&self) -> f64 {
        0.5 - self.of_mass + self.of_forces
    }

    fn beta(&self) -> f64 {
        (1.0 - self.of_mass + self.of_forces).powi(2) / 4.0
    }
}

const RHO: &str = "rho_inf";
const HHT: &str = "hht";

impl Method for GeneralizedAlpha {
    const ID: &'static str = "generalized-alpha";
    const SUMMARY: &'static str =
        "implicit, order 2, one sparse solve a step, damps what the step does not resolve";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: RHO,
            help: "what is left of the fastest motion after a step, 0 to 1; default 0.8",
            shown_default: None,
        },
        OptionHelp {
            key: HHT,
            help: "alpha of Hilber, Hughes and Taylor, 0 to 1/3, instead of rho_inf",
            shown_default: None,
        },
    ];

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        if options.get(HHT).is_none() {
            let unit = |rho: f64| (0.0..=1.0).contains(&rho);
            let rho = options.number(Self::ID, RHO, 0.8, "a number from 0 to 1", unit)?;
            return Ok(Self::with_spectral_radius(rho));
        }
        if let Some(found) = options.get(RHO) {
            return Err(OptionError::Value {
                integrator: Self::ID.into(),
                key: RHO.into(),
                found: OptionValue::clone(found),
                expected: "nothing beside hht: one of the two says all",
            });
        }
        let third = |alpha: f64| (0.0..=1.0 / 3.0).contains(&alpha);
        let alpha = options.number(Self::ID, HHT, 0.0, "a number from 0 to 1/3", third)?;
        Ok(Self::hht(alpha))
    }
}

impl Integrator for GeneralizedAlpha {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(2),
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::order(2),
            energy: if self.beta() == 0.25 && self.gamma() == 0.5 {
                EnergyBehaviour::Conserved
            } else {
                EnergyBehaviour::Falls
            },
            other_damping: OtherDamping::order(2),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        let share = (1.0 - self.of_forces) / (1.0 - self.of_mass);
        let coefficients = (share * self.gamma() * dt, share * self.beta() * dt * dt);
        self.load.resize(system.dofs(), 0.0);
        self.engine.prepare(Self::ID, system, dt, coefficients)
    }

    fn stable_step(&self, _system: &dyn System) -> Result<StableStep, SetupError> {
        Ok(StableStep::Any)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        let (beta, gamma) = (self.beta(), self.gamma());
        let (old, new) = (self.of_forces, 1.0 - self.of_forces);
        let ends = |t, dt| LoadTime::at_both_ends(t, dt, 0.5);
        work += self.engine.keep_acceleration(system, state, dt, ends)?;
        for i in 0..state.u.len() {
            let (u, v, a) = (state.u[i], state.v[i], state.a[i]);
            let predicted = u + dt * v + dt * dt * (0.5 - beta) * a;
            self.engine.u[i] = new * predicted + old * u;
            self.engine.v[i] = new * (v + dt * (1.0 - gamma) * a) + old * v;
        }
        let [start, end] = ends(state.t(), dt);
        work += self.engine.evaluate(system, end, dt)?;
        if old != 0.0 {
            // The load was taken at t + dt whole; a share of it belongs to t.
            for (when, sign) in [(start, old), (end, -old)] {
                system.external_force(when, &mut self.load);
                for (force, load) in self.engine.a.iter_mut().zip(&self.load) {
                    *force += sign * load;
                }
            }
        }
        let divide = 1.0 / (1.0 - self.of_mass);
        for (i, force) in self.engine.a.iter_mut().enumerate() {
            *force = divide * (*force - self.of_mass * system.mass()[i] * state.a[i]);
        }
        work += self.engine.solve();
        for (i, a) in self.engine.a.iter().enumerate() {
            let (v, before) = (state.v[i], state.a[i]);
            state.u[i] += dt * v + dt * dt * ((0.5 - beta) * before + beta * a);
            state.v[i] += dt * ((1.0 - gamma) * before + gamma * a);
            state.a[i] = *a;
        }
        state.end_step(dt, VelocityTime::Same, Acceleration::Same);
        system.accept(state);
        Ok(work)
    }
}
