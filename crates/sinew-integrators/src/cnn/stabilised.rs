//! `cnn-stabilised`: the network with a stabilising matrix in template B.

use sinew_cnn::{Blend, GammaRule, Inner, Stabiliser};
use sinew_core::{
    Accuracy, EnergyBehaviour, Fact, Integrator, LinearSystem, Needs, OptionError, OptionValue,
    Options, Prepared, Properties, SetupError, StableStep, State, StepError, StepReport, System,
    Trial,
};

use crate::evaluate::{net_force, synchronise};
use crate::explicit::{CentralDifference, GuardOption};
use crate::{Method, OptionHelp};

/// `P (v+ - v-) = dt (F(t) - K u - D v-)`, `u += dt v+`, the velocity half a step behind, started with
/// `P v_half = M v0 + dt/2 (F(0) - K u0)`: the network's sweep with `B = P^-1` in place of `M^-1`.
///
/// With `P > dt/2 D + dt^2/4 K`, `E = v'(P - dt/2 D - dt^2/4 K) v/2 + u' K u/2`, u the mean of two
/// displacements, falls by `dt v' D v` a step: stable at any step, with the exact equilibrium
/// K u = F. (Multiply the step by the mean of both velocities; the products with K telescope. The
/// idea of adding stiffness to the mass is that of Chen and Ricles, J. Eng. Mech. 134, 2008, and of
/// mass scaling.) Below .99 of the critical step P is M and the method is central difference with
/// mass damping; as the inner iteration grows it becomes Newmark's method with beta = s/4.
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
    const SUMMARY: &'static str =
        "cellular network, order 2, stable at any step; one sweep a step, more with `inner`";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: INNER,
            help: "{ kind = \"block\" | \"jacobi\" | \"chebyshev\" | \"gauss-seidel\", sweeps = p }; default { kind = \"block\" }",
            shown_default: None,
        },
        OptionHelp {
            key: GAMMA,
            help: "how the bound of K is found: \"power\" (default) or \"gershgorin\"",
            shown_default: None,
        },
        OptionHelp {
            key: S,
            help: "share of dt^2/4 K added to M: \"auto\" (default), or 1 for all of it at every step",
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
        let damping = operators.damping();
        let mass_damping_only = damping.stiffness == 0.0 && damping.extra.is_none();
        self.set_up = Some(if stabiliser.majorant().s() == 0.0 && mass_damping_only {
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
        let running = (state.t - state.v_time - dt / 2.0).abs() <= 1e-6 * dt;
        if !running {
            work += synchronise(system, state)?;
        }
        let (velocity_in_force, weight) = if running {
            (true, dt)
        } else {
            (false, dt / 2.0)
        };
        work += residual(system, state, velocity_in_force, &mut self.force)?;
        for ((force, mass), v) in self.force.iter_mut().zip(system.mass()).zip(&state.v) {
            *force = weight * *force + if running { 0.0 } else { mass * v };
        }
        stabiliser.solve(&self.force, &mut self.change);
        work.sweeps += self.inner.sweeps();
        // Kept so that the velocity at the displacement's time can be had: M^-1 of the force is not
        // the acceleration of this motion.
        state.a.resize(state.u.len(), 0.0);
        state.a_time = state.t;
        let moving = state.u.iter_mut().zip(&mut state.v).zip(&mut state.a);
        for (((u, v), a), change) in moving.zip(&self.change) {
            let before = *v;
            *v = if running { *v + change } else { *change };
            *a = (*v - before) / weight;
            *u += dt * *v;
        }
        state.t += dt;
        state.v_time = state.t - dt / 2.0;
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
            fact("gamma_k", majorant.gamma_stiffness()),
            fact("gamma_d", majorant.gamma_damping()),
            fact("certificate", stabiliser.certificate()),
        ]
    }
}

/// `out = F(t) - K u - D v`, without D v at the start.
fn residual(
    system: &dyn System,
    state: &State,
    with_damping: bool,
    out: &mut [f64],
) -> Result<StepReport, StepError> {
    let trial = Trial {
        t: state.t,
        dt: 0.0,
        u: &state.u,
        v: &state.v,
    };
    if with_damping {
        return net_force(system, &trial, out);
    }
    if let Some(linear) = system.as_linear() {
        let operators = linear.operators();
        operators.external_force(state.t, out);
        operators.stiffness().subtract_product(&state.u, out);
    }
    Ok(StepReport::ONE_FORCE)
}
