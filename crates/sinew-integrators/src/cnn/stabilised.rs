//! `cnn-stabilised`: the network with a stabilising matrix in template B.

use std::ops::Bound;

use sinew_cnn::{
    Blend, CellInertia, DampingShare, GammaRule, Inner, LoadAt, Loads, Physics, Program, Register,
    Slowing, Stabiliser, Sweep,
};
use sinew_core::{
    Acceleration, DampedAt, EnergyBehaviour, Fact, Needs, OptionError, OptionValue, Options,
    Properties, SetupError, StepReport, System, VelocityTime,
};

use super::carried::Carried;
use super::solved::SolvedSteps;
use crate::explicit::{CentralDifference, GuardOption};
use crate::scheme::linear;
use crate::{
    ConservedEnergy, Explicit, Method, OptionDefault, OptionHelp, OptionKind, OptionLabel, Scheme,
    SetUp,
};

/// `P (v+ - v-) = dt (F(t) - K u - D v-)`, `u += dt v+`, the velocity half a step behind, started with
/// `P v_half = M v0 + dt/2 (F(0) - K u0 - D_lag v0)`, D_lag being the part of D that is not in P: the
/// network's sweep with `B = P^-1` in place of `M^-1`.
///
/// With `P > dt/2 D + dt^2/4 K`, `E = v'(P - dt/2 D - dt^2/4 K) v/2 + u' K u/2`, u the mean of two displacements, falls
/// by `dt v' D v` a step: stable at any step, with the exact equilibrium K u = F. (Multiply the step by the mean of
/// both velocities; the products with K telescope. The idea of adding stiffness to the mass is that of Chen and Ricles,
/// J. Eng. Mech. 134, 2008, and of mass scaling.) Parts that may move as rigid bodies do so with their own mass
/// ([`Stabiliser::sparing`]). Elastic motions are slowed down; set-up computes the factor for the slowest one
/// ([`Stabiliser::slowing`]). Below .99 of central difference's limit nothing has to be added to M. Beyond it, with
/// more sweeps of the inner iteration, the method becomes Newmark's method with beta = s/4.
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
    stabiliser: Option<Stabiliser>,
}

impl CnnStabilised {
    /// The method with this inner iteration, bound and blend.
    #[must_use]
    pub fn new(inner: Inner, gamma: GammaRule, blend: Blend) -> Self {
        Self {
            inner,
            gamma,
            blend,
            ..Self::default()
        }
    }

    /// The matrix that was added to M for the current system and step; `None` before set-up and if no matrix was
    /// needed.
    #[must_use]
    pub fn stabiliser(&self) -> Option<&Stabiliser> {
        self.stabiliser.as_ref()
    }
}

/// Name of the fact for the share of the damping that is centred in time.
const DAMPING_SHARE: &str = "s_d";
const INNER: &str = "inner";
const GAMMA: &str = "gamma";
const S: &str = "s";

/// Largest number of inner iterations: far more than any run can use.
const MOST_SWEEPS: u32 = 10_000;

const INNER_OPTION: OptionHelp = OptionHelp {
    key: INNER,
    help: "the iteration that solves with the stabilising matrix; two or more sweeps are of order 2 with any damping; in long steps \"gauss-seidel\" depends on the numbering of the nodes",
    expected: "{ kind = \"block\" }, or kind = \"jacobi\", \"chebyshev\" or \"gauss-seidel\" with sweeps = a whole number from 1 to 10000",
    kind: OptionKind::Table(&[
        (
            "kind",
            OptionKind::Words(&["block", "jacobi", "chebyshev", "gauss-seidel"]),
        ),
        ("sweeps", OptionKind::Count(MOST_SWEEPS)),
    ]),
    default: OptionDefault::Value("{ kind = \"block\" }"),
    example: "inner = { kind = \"chebyshev\", sweeps = 4 }",
    shown_default: None,
};

const GAMMA_OPTION: OptionHelp = OptionHelp {
    key: GAMMA,
    help: "how the bound of what is added to M is found: \"power\", by iteration, or \"gershgorin\", from the rows alone",
    expected: "\"power\" or \"gershgorin\"",
    kind: OptionKind::Words(&["power", "gershgorin"]),
    default: OptionDefault::Value("\"power\""),
    example: "gamma = \"gershgorin\"",
    shown_default: None,
};

const S_OPTION: OptionHelp = OptionHelp {
    key: S,
    help: "share of dt^2/4 K (and of lagging damping) added to M: \"auto\" for as much as stability needs, or 1 for all of it at every step",
    expected: "\"auto\" or 1",
    kind: OptionKind::Either(&[
        OptionKind::Words(&["auto"]),
        OptionKind::Number(Bound::Included(1.0), Bound::Included(1.0)),
    ]),
    default: OptionDefault::Value("\"auto\""),
    example: "s = 1",
    shown_default: None,
};

impl Method for CnnStabilised {
    const SUMMARY: &'static str = "cellular network, order 2 with mass damping, stable at any step; one sweep a step, more with `inner`; beyond central difference's step it slows elastic motions down, and `sinew plan` says by how much";
    const OPTIONS: &'static [OptionHelp] = &[INNER_OPTION, GAMMA_OPTION, S_OPTION];

    const GUARD: GuardOption = GuardOption::Any;

    // A kind of iteration and its count speak for themselves.
    const LABELS: &'static [(&'static str, OptionLabel)] =
        &[(INNER, OptionLabel::Phrase(&["kind", "sweeps"]))];

    fn variants() -> Vec<Options> {
        vec![chebyshev(4.0), chebyshev(8.0)]
    }

    fn options_for_error(_error: f64) -> Vec<Options> {
        let plain = std::iter::once(Options::new());
        plain.chain(Self::variants()).collect()
    }

    /// The energy that the method conserves. If nothing is added to M the method is central difference and has no
    /// facts.
    fn conserved_energy(facts: &[Fact]) -> ConservedEnergy {
        match facts.iter().find(|fact| fact.name == DAMPING_SHARE) {
            None => ConservedEnergy::CentralDifference,
            Some(centred) => ConservedEnergy::Stabilised {
                lagging: 1.0 - centred.value,
            },
        }
    }

    const PROGRAMS: bool = true;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let inner = INNER_OPTION.read(options, Self::ID, inner_of)?;
        let gamma = GAMMA_OPTION.read(options, Self::ID, |value| match value.word()? {
            "power" => Some(GammaRule::Power),
            "gershgorin" => Some(GammaRule::Gershgorin),
            _ => None,
        })?;
        let blend = S_OPTION.read(options, Self::ID, |value| match value {
            OptionValue::Text(_) => Some(Blend::Auto),
            _ => Some(Blend::Full),
        })?;
        let (inner, gamma) = (inner.unwrap_or_default(), gamma.unwrap_or_default());
        Ok(Self::new(inner, gamma, blend.unwrap_or_default()))
    }
}

/// Chebyshev's iteration with this many sweeps.
fn chebyshev(sweeps: f64) -> Options {
    let inner = [
        ("kind".to_owned(), OptionValue::Text("chebyshev".to_owned())),
        ("sweeps".to_owned(), OptionValue::Number(sweeps)),
    ];
    Options::new().with(INNER, OptionValue::Table(inner.into()))
}

fn inner_of(value: &OptionValue) -> Option<Inner> {
    let OptionValue::Table(entries) = value else {
        return None;
    };
    let sweeps = match entries.get("sweeps") {
        Some(given) => Some(given.count(MOST_SWEEPS)?),
        None => None,
    };
    match (entries.get("kind")?.word()?, sweeps) {
        ("block", None) => Some(Inner::Block),
        ("jacobi", Some(sweeps)) => Some(Inner::Jacobi { sweeps }),
        ("chebyshev", Some(sweeps)) => Some(Inner::Chebyshev { sweeps }),
        ("gauss-seidel", Some(sweeps)) => Some(Inner::GaussSeidel { sweeps }),
        _ => None,
    }
}

impl Scheme for CnnStabilised {
    const ID: &'static str = "cnn-stabilised";

    type ByHand = SolvedSteps;

    fn properties(&self) -> Properties {
        let plain = Properties::of_order(2, Needs::Matrices, EnergyBehaviour::Bounded);
        plain.with_other_damping(match self.inner.damping_share() {
            DampingShare::AsStiffness => 1,
            DampingShare::Whole => 2,
        })
    }

    fn lacking(&self) -> SetupError {
        SetupError::Lacks {
            integrator: Self::ID,
            needs: "the matrices of a linear system (with a tangent that moves nothing proves that its energy stays bounded, and with \
                    one of a few steps ago it diverges; `cnn-energy` takes elastic laws at any step)",
        }
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        _before: Option<SolvedSteps>,
    ) -> Result<SetUp<SolvedSteps>, SetupError> {
        let operators = linear(system, Self::ID)?.operators();
        let stabiliser = Stabiliser::new(operators, dt, self.gamma, self.blend, self.inner)
            .sparing(system.free_parts());
        self.stabiliser = None;
        let physics = Physics::of(system);
        if stabiliser.majorant().adds_nothing() {
            return Ok(CentralDifference.program(&physics, dt).into());
        }
        let is_carried = Carried::carries(operators);
        let made = match program(&stabiliser, &physics, dt).filter(|_| !is_carried) {
            Some(program) => program.into(),
            None => {
                let steps = SolvedSteps::new(&stabiliser, (system, operators), self.inner.sweeps());
                SetUp::by_hand(steps, StepReport::default())
            }
        };
        self.stabiliser = Some(stabiliser);
        Ok(made)
    }

    fn facts(&self) -> Vec<Fact> {
        let Some(stabiliser) = self.stabiliser() else {
            return Vec::new();
        };
        let majorant = stabiliser.majorant();
        let fact = |name, value| Fact { name, value };
        let slowing = stabiliser.slowing();
        let slowing = slowing.map(|slowing| fact("slowest_period", slowing.factor));
        let facts = [
            fact("s", majorant.s()),
            fact(DAMPING_SHARE, majorant.damping_share()),
            fact("gamma", majorant.gamma()),
            fact("certificate", stabiliser.certificate()),
        ];
        facts.into_iter().chain(slowing).collect()
    }

    fn remarks(&self) -> Vec<String> {
        let Some(stabiliser) = self.stabiliser() else {
            return Vec::new();
        };
        let remark = |slowing: Slowing| {
            let rigid = if stabiliser.spares() {
                "; parts that may move as rigid bodies fall, fly and turn as they should"
            } else {
                ""
            };
            format!(
                "what is added to the mass slows elastic motions down: the period of the slowest one, {:.3} s, is {:.2} times as long at this step (shorter steps or more sweeps of \
                 `inner` come nearer){rigid}",
                slowing.period, slowing.factor
            )
        };
        stabiliser.slowing().map(remark).into_iter().collect()
    }
}

/// The step as a program; `None` if no program can express the solution with P.
fn program(stabiliser: &Stabiliser, physics: &Physics, dt: f64) -> Option<Program> {
    let (u, v, a) = (Register::U, Register::V, Register::A);
    let mut program = Program::new(VelocityTime::MiddleOfStep);
    // Kept so that the velocity at the displacement's time can be had: M^-1 of the force is not the
    // acceleration of this motion.
    program.acceleration = Acceleration::Kick;

    // Only the damping that P does not hold lags in the first half step.
    let centred = stabiliser.majorant().damping_share();
    let lagging = 1.0 - centred;
    program.damped = DampedAt::centred(centred);
    let w = program.named("w0");
    let before =
        Sweep::local().then(w.becomes([(u, 1.0), (v, lagging * physics.stiffness_damping)]));
    let mut start = Sweep::of_stiffness(1.0, w, Loads::at(LoadAt::From));
    if physics.dashpots {
        start = start.with_dashpots(lagging, v);
    }
    let start = start.scaled(dt / 2.0).with_own(v, 0.0, 1.0);
    let solution = stabiliser.sweeps(&mut program, start)?;
    let weight = dt / 2.0;
    let kick = solution.added_to(a.becomes([(v, -1.0 / weight)]), 1.0 / weight);
    let first = solution.added_to(v.becomes([]), 1.0);
    program.start = vec![before];
    let moves = [kick.in_last_step(), first, u.plus(dt, v)];
    program.start.extend(solution.then(moves));

    let force = program.net_force(physics, u, v, LoadAt::Around).scaled(dt);
    let solution = stabiliser.sweeps(&mut program, force)?;
    program.inertia = solution.is_single().then_some(CellInertia::Blocks);
    let kick = solution.added_to(a.becomes([]), 1.0 / dt);
    let next = solution.added_to(v.becomes([(v, 1.0)]), 1.0);
    program.step = solution.then([kick.in_last_step(), next, u.plus(dt, v)]);
    Some(program)
}
