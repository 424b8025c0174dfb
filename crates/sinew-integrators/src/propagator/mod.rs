//! `propagator`: the exact motion over a step, as a polynomial in the network.

mod chebyshev;
mod cut;
mod dense;
mod first_step;
mod krylov;
mod mode;
mod series;
mod two_step;
mod vectors;

use chebyshev::Chebyshev;
use krylov::Krylov;
use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Fact, Integrator, LinearSystem, Load, LoadOverStep,
    Needs, OptionError, OptionValue, Options, OtherDamping, Prepared, Properties, SetupError,
    StableStep, State, StepError, StepReport, System,
};

use two_step::TwoStep;

use crate::evaluate::{begin, synchronise};
use crate::{Method, OptionHelp};

const ID: &str = "propagator";
/// Above this degree shorter steps cost less memory and no more sweeps.
const HIGHEST_DEGREE: usize = 500;
/// Error of a step with a degree chosen by hand above which it is refused: a polynomial of too low
/// a degree is violently wrong.
const LOOSE: f64 = 1e-2;

/// The exact motion of a linear system over a step, by sweeps of the network only.
///
/// By Chebyshev polynomials for proportional damping and any ramp, or in a Krylov space for any
/// damping and loads that are constant or linear over a step; either way kinks and jumps of loads
/// must fall on steps. The degree is chosen from the step to meet a tolerance, and each step is
/// checked. [`PropagatorKind`] says what the tolerance bounds.
///
/// No undamped motion grows, whatever the tolerance, the step and the number of steps. Chebyshev's and
/// Krylov's forms err towards less energy instead: a loose tolerance takes energy out, up to about twice
/// the error of a step each time. The two-step form neither takes nor gives.
#[derive(Debug)]
pub struct Propagator {
    kind: PropagatorKind,
    resolution: Resolution,
    prepared: Prepared,
    engine: Option<Engine>,
}

/// Which polynomials, and what their tolerance bounds.
///
/// Rounding, up to `4e-15 (omega_max dt)^2`, comes on top.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PropagatorKind {
    /// Chebyshev's, on the interval of the eigenvalues: proportional damping, any ramp.
    ///
    /// The tolerance bounds the error of a step under constant loads, relative to the distance from
    /// equilibrium before it, both in the energy norm, whatever the state: the fact `step_error`. No step
    /// takes the state farther from equilibrium. A body that is not held keeps its velocity; its way
    /// and what its loads do to it fall short by the fact `relaxation`, which is below the tolerance.
    #[default]
    Chebyshev,
    /// Chebyshev's for the step from two displacements to the next, in half the sweeps: mass damping,
    /// loads that jump on steps and are constant between. The velocity is the mean over a step.
    ///
    /// Half the error of `sin(omega dt/2)` of any mode, omega its angular frequency, stays below the
    /// tolerance; the fact `sine_error` is that error. An undamped mode's phase is then off by up to about
    /// twice `sine_error/cos(omega dt/2)` a step and by at most 2 sqrt(2 `sine_error`), a displacement
    /// found from two exact ones by 8 `sine_error` of the distance from equilibrium. Amplitudes neither
    /// grow nor fall.
    TwoStep,
    /// Those that fit the state at hand best: any damping, loads constant or linear over a step.
    ///
    /// The tolerance bounds an estimate of the error of a step, relative to the step's change of
    /// `(omega_max u, v)` in the norm of the mass. Under constant loads, energy less the work of the loads
    /// does not rise over a step.
    Krylov,
}

impl PropagatorKind {
    /// What it needs loads to be over each step.
    fn needed_of_loads(self) -> LoadOverStep {
        match self {
            Self::Chebyshev => LoadOverStep::Smooth,
            Self::TwoStep => LoadOverStep::Constant,
            Self::Krylov => LoadOverStep::Linear,
        }
    }
}

/// How well a step is resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Resolution {
    /// Bound of the error of a step, as the kind measures it.
    tolerance: f64,
    /// Degree, where it is given.
    degree: Option<usize>,
}

impl Resolution {
    /// The degree to take: the given one, or the smallest whose error meets the tolerance. `left_out`
    /// holds an estimate of the error for each degree, from which the search begins.
    fn degree_for(
        self,
        left_out: &[f64],
        dt: f64,
        error: impl Fn(usize) -> f64,
    ) -> Result<usize, SetupError> {
        let highest = HIGHEST_DEGREE.min(left_out.len() - 1);
        let meets = |degree: usize| error(degree) <= self.tolerance;
        let given = self.degree.map(|degree| degree.min(highest));
        if let Some(degree) = given
            && meets(degree)
        {
            return Ok(degree);
        }
        let estimated = left_out.iter().position(|left| *left <= self.tolerance);
        let enough =
            estimated.and_then(|from| (from.max(1)..=highest).find(|degree| meets(*degree)));
        let enough = enough.map(|enough| {
            let fewer = (1..enough).rev().take_while(|degree| meets(*degree));
            fewer.last().unwrap_or(enough)
        });
        let reason = match (given, enough) {
            (None, Some(degree)) => return Ok(degree),
            (Some(degree), Some(enough)) => format!(
                "degree {degree} leaves out {:.1e} of the motion over a step of {dt} s; take degree {enough} or leave it out",
                error(degree)
            ),
            (_, None) => format!(
                "a step of {dt} s needs a degree above {HIGHEST_DEGREE}; take a shorter step"
            ),
        };
        Err(SetupError::Unresolved {
            integrator: ID,
            reason,
        })
    }
}

#[derive(Debug)]
enum Engine {
    TwoStep(Box<TwoStep>),
    Chebyshev(Box<Chebyshev>),
    Krylov(Box<Krylov>),
}

impl Propagator {
    /// With the smallest degrees that meet `tolerance`, which bounds what [`PropagatorKind`] says.
    #[must_use]
    pub fn with_tolerance(kind: PropagatorKind, tolerance: f64) -> Self {
        Self::new(
            kind,
            Resolution {
                tolerance,
                degree: None,
            },
        )
    }

    /// With this degree; refused where it leaves out more than `tolerance`.
    #[must_use]
    pub fn with_degree(kind: PropagatorKind, degree: usize, tolerance: f64) -> Self {
        Self::new(
            kind,
            Resolution {
                tolerance,
                degree: Some(degree),
            },
        )
    }

    fn new(kind: PropagatorKind, resolution: Resolution) -> Self {
        Self {
            kind,
            resolution,
            prepared: Prepared::default(),
            engine: None,
        }
    }
}

const TOLERANCE: &str = "tolerance";
const DEGREE: &str = "degree";
const KIND: &str = "kind";

impl Method for Propagator {
    const ID: &'static str = ID;
    const SUMMARY: &'static str = "the exact motion over a step as a polynomial: sweeps only";
    const OPTIONS: &'static [OptionHelp] = &[
        OptionHelp {
            key: KIND,
            help: "\"chebyshev\" (default; proportional damping, any ramp), \"two-step\" (half the sweeps; mass damping, loads constant over each step) or \"krylov\" (any damping)",
            shown_default: None,
        },
        OptionHelp {
            key: TOLERANCE,
            help: "largest error of a step in the energy norm, relative to the distance from equilibrium (\"chebyshev\"); two fifths of the largest error of any mode's sin(omega dt/2), so of the phase, not of the step (\"two-step\"); estimated error of a step relative to its change (\"krylov\"); default 1e-10",
            shown_default: None,
        },
        OptionHelp {
            key: DEGREE,
            help: "degree of the polynomial; default: the smallest that meets the tolerance",
            shown_default: None,
        },
    ];

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let kind = match options.get(KIND) {
            None => PropagatorKind::default(),
            Some(OptionValue::Text(word)) if word == "chebyshev" => PropagatorKind::Chebyshev,
            Some(OptionValue::Text(word)) if word == "two-step" => PropagatorKind::TwoStep,
            Some(OptionValue::Text(word)) if word == "krylov" => PropagatorKind::Krylov,
            Some(found) => {
                return Err(OptionError::Value {
                    integrator: ID.into(),
                    key: KIND.into(),
                    found: found.clone(),
                    expected: "\"chebyshev\", \"two-step\" or \"krylov\"",
                });
            }
        };
        let expected = "a number above 0 and below 1";
        let share = |x: f64| x > 0.0 && x < 1.0;
        let expected_degree = "a whole number from 1 to 500";
        let whole = |x: f64| (1.0..=HIGHEST_DEGREE as f64).contains(&x) && x.fract() == 0.0;
        let degree = options.number(ID, DEGREE, 0.0, expected_degree, whole)?;
        let given = (degree > 0.0).then_some(degree as usize);
        let default = if given.is_some() { LOOSE } else { 1e-10 };
        Ok(Self::new(
            kind,
            Resolution {
                tolerance: options.number(ID, TOLERANCE, default, expected, share)?,
                degree: given,
            },
        ))
    }
}

impl Integrator for Propagator {
    fn id(&self) -> &'static str {
        ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Exact,
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::Exact(self.kind.needed_of_loads()),
            // Conserved but for the part that is left out, by which it falls or, in two-step form,
            // oscillates.
            energy: EnergyBehaviour::Bounded,
            other_damping: OtherDamping {
                stiffness: (self.kind != PropagatorKind::TwoStep).then_some(Accuracy::Exact),
                dashpots: (self.kind == PropagatorKind::Krylov).then_some(Accuracy::Exact),
            },
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let operators = system
            .as_linear()
            .map(LinearSystem::operators)
            .ok_or_else(|| Needs::Matrices.lacking(ID))?;
        let mut checked = Prepared::default();
        checked.check(ID, system, dt)?;
        self.prepared = Prepared::default();
        let resolution = self.resolution;
        self.engine = Some(match self.kind {
            PropagatorKind::Chebyshev => {
                Engine::Chebyshev(Box::new(Chebyshev::set_up(operators, dt, resolution)?))
            }
            PropagatorKind::TwoStep => {
                Engine::TwoStep(Box::new(TwoStep::set_up(operators, dt, resolution)?))
            }
            PropagatorKind::Krylov => {
                Engine::Krylov(Box::new(Krylov::set_up(operators, dt, resolution)?))
            }
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
        if self.kind == PropagatorKind::TwoStep {
            return self.step_staggered(system, state, dt);
        }
        let mut work = begin(self, system, state, dt)?;
        if let Some(operators) = system.as_linear().map(LinearSystem::operators) {
            match &mut self.engine {
                Some(Engine::Chebyshev(engine)) => work += engine.step(operators, state, dt)?,
                Some(Engine::Krylov(engine)) => work += engine.step(operators, state, dt)?,
                Some(Engine::TwoStep(_)) | None => {}
            }
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }

    fn facts(&self) -> Vec<Fact> {
        match &self.engine {
            Some(Engine::Chebyshev(engine)) => engine.facts(),
            Some(Engine::TwoStep(engine)) => engine.facts(),
            Some(Engine::Krylov(engine)) => engine.facts(),
            None => Vec::new(),
        }
    }
}

impl Propagator {
    fn step_staggered(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = self.prepare(system, dt)?;
        Prepared::check_state(ID, system, state)?;
        if !state.is_staggered_by(dt) {
            work += synchronise(system, state)?;
        }
        let operators = system.as_linear().map(LinearSystem::operators);
        if let (Some(operators), Some(Engine::TwoStep(engine))) = (operators, &mut self.engine) {
            work += engine.step(operators, state, dt)?;
        }
        system.accept(state);
        Ok(work)
    }
}

/// Refuses loads that are not what a kind needs them to be over a step of `dt` (s) from `t` (s).
fn refuse_loads(
    loads: &[Load],
    needed: LoadOverStep,
    t: f64,
    dt: f64,
    remedy: &str,
) -> Result<(), StepError> {
    let broken = |load: &Load| needed.first_broken(&load.ramp, t, dt, t + dt);
    match loads.iter().find_map(broken) {
        None => Ok(()),
        Some(instant) => Err(StepError::Inaccurate {
            integrator: ID,
            t,
            reason: format!(
                "a load changes at t = {instant} s, and is not {} of {dt} s; {remedy}",
                needed.describe()
            ),
        }),
    }
}
