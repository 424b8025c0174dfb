//! `cnn-stabilised`: the network with a stabilising matrix in template B.

use sinew_cnn::{Blend, DampingShare, GammaRule, Inner, Stabiliser};
use sinew_core::{
    Acceleration, Accuracy, ChangingLoads, EnergyBehaviour, Fact, Integrator, LinearSystem,
    LoadTime, Needs, OptionError, OptionValue, Options, OtherDamping, Prepared, Properties,
    SetupError, StableStep, State, StepError, StepReport, System, Trial, VelocityTime,
};

use crate::evaluate::{net_force, synchronise};
use crate::explicit::{CentralDifference, GuardOption};
use crate::{Method, OptionHelp};

/// `P (v+ - v-) = dt (F(t) - K u - D v-)`, `u += dt v+`, the velocity half a step behind, started with
/// `P v_half = M v0 + dt/2 (F(0) - K u0 - D_lag v0)`, D_lag being the part of D that is not in P: the
/// network's sweep with `B = P^-1` in place of `M^-1`.
///
/// With `P > dt/2 D + dt^2/4 K`, `E = v'(P - dt/2 D - dt^2/4 K) v/2 + u' K u/2`, u the mean of two
/// displacements, falls by `dt v' D v` a step: stable at any step, with the exact equilibrium
/// K u = F. (Multiply the step by the mean of both velocities; the products with K telescope. The
/// idea of adding stiffness to the mass is that of Chen and Ricles, J. Eng. Mech. 134, 2008, and of
/// mass scaling.) Below .99 of central difference's limit nothing has to be added to M. Beyond it, as
/// the inner iteration grows, it becomes Newmark's method with beta = s/4.
///
/// Order 2 undamped and with mass damping. With stiffness damping or dashpots:
///
/// * one block per cell (the default; also one iteration of `jacobi` or `chebyshev`): order 1. Within
///   .99 of central difference's limit it *is* central difference, whose damping lags by half a step;
///   beyond, the share `s = 1 - .99^2/mu` of `dt/2 D' + dt^2/4 K` is added and the rest lags, D' being
///   that damping and mu the largest eigenvalue of `M^-1 (dt/2 D' + dt^2/4 K)`.
/// * more sweeps: order 2, the damping being centred at every step.
#[derive(Debug, Default)]
pub struct CnnStabilised {
    inner: Inner,
    gamma: GammaRule,
    blend: Blend,
    prepared: Prepared,
    set_up: Option<SetUp>,
    force: Vec<f64>,
    change: Vec<f64>,
}

/// What a system and a step need.
#[derive(Debug)]
enum SetUp {
    /// Nothing beside M: the step is central difference's.
    Plain(CentralDifference),
    Stabilised(Box<Stabiliser>),
}

impl CnnStabilised {
    /// With this inner iteration, bound and blend.
    #[must_use]
    pub fn new(inner: Inner, gamma: GammaRule, blend: Blend) -> Self {
        Self {
            inner,
            gamma,
            blend,
            ..Self::default()
        }
    }

    /// What was added to M for the system and step at hand; `None` before set-up and where nothing
    /// was.
    #[must_use]
    pub fn stabiliser(&self) -> Option<&Stabiliser> {
        match &self.set_up {
            Some(SetUp::Stabilised(stabiliser)) => Some(stabiliser),
            _ => None,
        }
    }
}

const INNER: &str = "inner";
const GAMMA: &str = "gamma";
const S: &str = "s";

impl Method for CnnStabilised {
    const ID: &'static str = "cnn-stabilised";
    const SUMMARY: &'static str = "cellular network, order 2 with mass damping, stable at any step; one sweep a step, more with `inner`";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: INNER,
            help: "{ kind = \"block\" | \"jacobi\" | \"chebyshev\" | \"gauss-seidel\", sweeps = p }; default { kind = \"block\" }; two or more sweeps are of order 2 with any damping; in long steps \"gauss-seidel\" depends on the numbering of the nodes",
            shown_default: None,
        },
        OptionHelp {
            key: GAMMA,
            help: "how the bound of what is added to M is found: \"power\" (default) or \"gershgorin\"",
            shown_default: None,
        },
        OptionHelp {
            key: S,
            help: "share of dt^2/4 K (and of lagging damping) added to M: \"auto\" (default), or 1 for all of it at every step",
            shown_default: None,
        },
    ];

    const GUARD: GuardOption = GuardOption::Any;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let refused = |key: &str, found: &OptionValue, expected| {
            Err(OptionError::Value {
                integrator: Self::ID.into(),
                key: key.into(),
                found: found.clone(),
                expected,
            })
        };
        let inner = match options.get(INNER) {
            None => Inner::Block,
            Some(found) => match inner_of(found) {
                Some(inner) => inner,
                None => return refused(INNER, found, INNER_EXPECTED),
            },
        };
        let gamma = match options.get(GAMMA) {
            None => GammaRule::Power,
            Some(OptionValue::Text(word)) if word == "power" => GammaRule::Power,
            Some(OptionValue::Text(word)) if word == "gershgorin" => GammaRule::Gershgorin,
            Some(found) => return refused(GAMMA, found, "\"power\" or \"gershgorin\""),
        };
        let blend = match options.get(S) {
            None => Blend::Auto,
            Some(OptionValue::Text(word)) if word == "auto" => Blend::Auto,
            Some(OptionValue::Number(1.0)) => Blend::Full,
            Some(found) => return refused(S, found, "\"auto\" or 1"),
        };
        Ok(Self::new(inner, gamma, blend))
    }
}

const INNER_EXPECTED: &str = "{ kind = \"block\" }, or kind = \"jacobi\", \"chebyshev\" or \"gauss-seidel\" with sweeps = a whole number from 1 on";

/// Most inner iterations: far more than any can use.
const MOST_SWEEPS: f64 = 10_000.0;

fn inner_of(value: &OptionValue) -> Option<Inner> {
    let OptionValue::Table(entries) = value else {
        return None;
    };
    if entries.keys().any(|key| key != "kind" && key != "sweeps") {
        return None;
    }
    let sweeps = match entries.get("sweeps") {
        Some(OptionValue::Number(p)) if (1.0..=MOST_SWEEPS).contains(p) && p.fract() == 0.0 => {
            Some(*p as u32)
        }
        Some(_) => return None,
        None => None,
    };
    let Some(OptionValue::Text(kind)) = entries.get("kind") else {
        return None;
    };
    match (kind.as_str(), sweeps) {
        ("block", None) => Some(Inner::Block),
        ("jacobi", Some(sweeps)) => Some(Inner::Jacobi { sweeps }),
        ("chebyshev", Some(sweeps)) => Some(Inner::Chebyshev { sweeps }),
        ("gauss-seidel", Some(sweeps)) => Some(Inner::GaussSeidel { sweeps }),
        _ => None,
    }
}

impl Integrator for CnnStabilised {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(2),
            needs: Needs::Matrices,
            energy: EnergyBehaviour::Bounded,
            changing_loads: ChangingLoads::order(2),
            other_damping: OtherDamping::order(match self.inner.damping_share() {
                DampingShare::AsStiffness => 1,
                DampingShare::Whole => 2,
            }),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let operators =
            system
                .as_linear()
                .map(LinearSystem::operators)
                .ok_or(SetupError::Lacks {
                    integrator: Self::ID,
                    needs: Needs::Matrices.describe(),
                })?;
        let mut checked = Prepared::default();
        checked.check(Self::ID, system, dt)?;
        self.prepared = Prepared::default();
        for buffer in [&mut self.force, &mut self.change] {
            buffer.resize(system.dofs(), 0.0);
        }
        let stabiliser = Stabiliser::new(operators, dt, self.gamma, self.blend, self.inner);
        self.set_up = Some(if stabiliser.majorant().adds_nothing() {
            let mut plain = CentralDifference::default();
            plain.prepare(system, dt)?;
            SetUp::Plain(plain)
        } else {
            SetUp::Stabilised(Box::new(stabiliser))
        });
        self.prepared = checked;
        Ok(StepReport::default())
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
        let mut work = self.prepare(system, dt)?;
        Prepared::check_state(Self::ID, system, state)?;
        let stabiliser = match &mut self.set_up {
            Some(SetUp::Stabilised(stabiliser)) => stabiliser,
            Some(SetUp::Plain(plain)) => return plain.step(system, state, dt),
            None => return Ok(work),
        };
        let running = state.is_staggered_by(dt);
        if !running {
            work += synchronise(system, state)?;
        }
        let weight = if running { dt } else { dt / 2.0 };
        // Only the damping that P does not hold lags in the first half step.
        let lagging = 1.0 - stabiliser.majorant().damping_share();
        work += residual(system, state, dt, lagging, &mut self.force)?;
        for ((force, mass), v) in self.force.iter_mut().zip(system.mass()).zip(&state.v) {
            *force = weight * *force + if running { 0.0 } else { mass * v };
        }
        stabiliser.solve(&self.force, &mut self.change);
        work.sweeps += self.inner.sweeps();
        // Kept so that the velocity at the displacement's time can be had: M^-1 of the force is not
        // the acceleration of this motion.
        state.a.resize(state.u.len(), 0.0);
        let moving = state.u.iter_mut().zip(&mut state.v).zip(&mut state.a);
        for (((u, v), a), change) in moving.zip(&self.change) {
            let before = *v;
            *v = if running { *v + change } else { *change };
            *a = (*v - before) / weight;
            *u += dt * *v;
        }
        state.end_step(dt, VelocityTime::MiddleOfStep, Acceleration::Kick);
        system.accept(state);
        Ok(work)
    }

    fn facts(&self) -> Vec<Fact> {
        let Some(stabiliser) = self.stabiliser() else {
            return Vec::new();
        };
        let majorant = stabiliser.majorant();
        let fact = |name, value| Fact { name, value };
        vec![
            fact("s", majorant.s()),
            fact("s_d", majorant.damping_share()),
            fact("gamma", majorant.gamma()),
            fact("certificate", stabiliser.certificate()),
        ]
    }
}

/// `out = F - K u - D v` before a step of `dt` (s); at the start with the share `lagging` of the
/// damping other than alpha M in place of D.
fn residual(
    system: &dyn System,
    state: &State,
    dt: f64,
    lagging: f64,
    out: &mut [f64],
) -> Result<StepReport, StepError> {
    if state.is_staggered_by(dt) {
        let trial = Trial {
            load: LoadTime::around(state.t(), dt, dt),
            dt: 0.0,
            u: &state.u,
            v: &state.v,
        };
        return net_force(system, &trial, out);
    }
    if let Some(linear) = system.as_linear() {
        let operators = linear.operators();
        operators.external_force(LoadTime::around(state.t(), 0.0, dt), out);
        let damping = operators.damping();
        let of_stiffness = lagging * damping.stiffness;
        if of_stiffness == 0.0 {
            operators.stiffness().subtract_product(&state.u, out);
        } else {
            operators
                .stiffness()
                .subtract_product_combined(&state.u, of_stiffness, &state.v, out);
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(lagging, &state.v, out);
        }
    }
    Ok(StepReport::ONE_FORCE)
}
