//! `cnn-energy`: sweeps of cells that never raise the energy.

mod certificate;
mod descent;
mod kind;
mod point;
mod quadratic;
mod rigid;
mod steps;
mod touched;

use sinew_core::{
    ElasticLaw, EnergyBehaviour, Needs, OptionError, OptionValue, Options, Properties, SetupError,
    StepReport, System,
};

use self::steps::EnergySteps;
use crate::{Method, OptionDefault, OptionHelp, OptionKind, OptionLabel, Scheme, SetUp};

pub use self::kind::Kind;

/// A step as the minimum of a potential, approached by a few sweeps of the cells, and a limiter: the energy never rises by more than the work
/// of the loads, for any step, any number of sweeps and any elastic law.
///
/// With W the elastic energy, F the loads and y the displacement over the step, the potential is
/// `m/2 y'M y + d/2 y'D y - b'y + W(u + y)` and its minimum is
///
/// * [`Kind::ImplicitEuler`], with `m = 1/dt^2`, `d = 1/dt` and `b = M v/dt + F` (Ortiz and Stainier, Comput. Methods Appl. Mech. Eng.
///   171, 1999; for tissue Kane et al., Int. J. Numer. Meth. Eng. 49, 2000), or
/// * [`Kind::Trapezoidal`], with `m = 4/dt^2`, `d = 2/dt` and `b = M (4 v/dt + a) + D v + F`: Newmark's method with beta = 1/4 and gamma = 1/2.
///
/// From y = 0 on a given number of sweeps of nonlinear conjugate gradients lowers the potential. Each sweep solves with
/// every cell's diagonal block of the potential's second derivative, as a network does, and its step is halved until
/// the law accepts the point and the potential has decreased. The step's length along a direction takes one tangent
/// product.
///
/// # Why the energy does not rise
///
/// Let `E = v'M v/2 + W(u)` before the step and P be the mean load over it. A displacement y may be taken if
/// `W(u + y) - P'y <= E`; then the velocity is reduced, if necessary, until `E+ <= E + P'y`. Implicit Euler's potential
/// under the load P is E at y = 0, up to the constant `v'M v/2`, and never less than `W(u + y) - P'y`, as M and D have
/// no negative eigenvalues; the sweeps only lower it. So its y may be taken after any number of sweeps. If the y of the
/// trapezoidal rule may not be taken, the step is taken again by implicit Euler. If rounding prevents even that, or no
/// sweep finds a lower point, the body keeps its displacement and gets zero velocity. Energies are compared by their
/// difference along the step, so that the rounding of a large constant energy has no effect. Both energies include
/// supports at their positions at the end of the step: the work of moving supports is counted separately.
///
/// # Contact
///
/// With tools and [`Kind::ImplicitEuler`] each sweep finds the minimum of a bound of the potential by the cells'
/// diagonal blocks, in which contact is exact cell by cell, friction included, and `E+ <= E + P'y + W` holds with the
/// work W of the tools (the proof is with the sweeps, `touched.rs`). The trapezoidal rule would let nodes bounce off a
/// tool that they follow, and is refused.
///
/// All damping enters the potential: the mass-proportional part, dashpots, and stiffness damping at the point half way
/// through the step by the velocity at its start, instead of as a function of the displacement. It has no negative
/// eigenvalues. Its force due to moving supports is a load, whose work is part of P.
///
/// # Order
///
/// Parts that may move as rigid bodies are moved to the minimum of the potential over such motions first, with finite
/// rotations, so that rigid motion needs no sweeps ([`sinew_cnn::RigidMotions`]).
///
/// Apart from that, sweeps begin at zero displacement, an error of `dt v`. Each sweep leaves a share of this error that
/// falls as `dt^2`, or as `dt` with stiffness damping or dashpots, whose weight is `dt` times larger. So the order is
/// that of the formula from two sweeps on (from one for implicit Euler), with such damping from three (two).
#[derive(Clone, Copy, Debug)]
pub struct CnnEnergy {
    kind: Kind,
    sweeps: u32,
}

impl CnnEnergy {
    /// The method with this formula and `sweeps` sweeps, at least one.
    #[must_use]
    pub fn new(kind: Kind, sweeps: u32) -> Self {
        Self {
            kind,
            sweeps: sweeps.max(1),
        }
    }
}

impl Default for CnnEnergy {
    fn default() -> Self {
        Self::new(Kind::default(), 4)
    }
}

/// Largest number of sweeps: far more than any run can use.
const MOST_SWEEPS: u32 = 10_000;

const KIND: OptionHelp = OptionHelp {
    key: "kind",
    help: "formula of the step: \"trap\", the trapezoidal rule, of order 2, or \"ie\", implicit Euler, of order 1, which damps what it moves",
    expected: "\"trap\" or \"ie\"",
    kind: OptionKind::Words(&["trap", "ie"]),
    default: OptionDefault::Value("\"trap\""),
    example: "kind = \"ie\"",
    shown_default: None,
};

const SWEEPS: OptionHelp = OptionHelp {
    key: "sweeps",
    help: "sweeps of the cells a step, each of a force and a tangent product; more of them come nearer to the formula, and the energy never rises with any number",
    expected: "a whole number from 1 to 10000",
    kind: OptionKind::Count(MOST_SWEEPS),
    default: OptionDefault::Value("4"),
    example: "sweeps = 16",
    shown_default: None,
};

impl Method for CnnEnergy {
    const SUMMARY: &'static str =
        "cellular sweeps that lower a step's energy: stable at any step, for every elastic tissue";
    const OPTIONS: &'static [OptionHelp] = &[KIND, SWEEPS];

    const LABELS: &'static [(&'static str, OptionLabel)] = &[(KIND.key, OptionLabel::Value)];

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        let plain = Self::default();
        let kind = KIND.read(options, Self::ID, |value| match value.word()? {
            "trap" => Some(Kind::Trapezoidal),
            "ie" => Some(Kind::ImplicitEuler),
            _ => None,
        })?;
        let sweeps = SWEEPS.read(options, Self::ID, |value| value.count(MOST_SWEEPS))?;
        Ok(Self::new(
            kind.unwrap_or(plain.kind),
            sweeps.unwrap_or(plain.sweeps),
        ))
    }

    fn options_for_error(_error: f64) -> Vec<Options> {
        let more = Options::new().with(SWEEPS.key, OptionValue::Number(16.0));
        vec![Options::new(), more]
    }
}

impl Scheme for CnnEnergy {
    const ID: &'static str = "cnn-energy";

    type ByHand = EnergySteps;

    fn properties(&self) -> Properties {
        let of_formula = match self.kind {
            Kind::ImplicitEuler => 1,
            Kind::Trapezoidal => 2,
        };
        // After a displacement by the velocity, y is off by dt^2, and each sweep leaves dt^2 of it, with other damping
        // dt; v is off by that over dt.
        let sweeps = self.sweeps.min(8) as u8;
        let order = of_formula.min(2 * sweeps);
        Properties::of_order(order, Needs::Tangents, EnergyBehaviour::NeverRises)
            .with_other_damping(of_formula.min(sweeps))
    }

    fn set_up(
        &mut self,
        system: &dyn System,
        _dt: f64,
        before: Option<EnergySteps>,
    ) -> Result<SetUp<EnergySteps>, SetupError> {
        if system.as_linear().is_none() && system.internal_variables() > 0 {
            return Err(SetupError::Lacks {
                integrator: Self::ID,
                needs: "an energy of the displacement alone behind the forces (stress that relaxes has none; `generalized-alpha`, `newmark` \
                        and explicit methods do without)",
            });
        }
        let loads_follow = system.as_elastic().is_some_and(ElasticLaw::loads_follow);
        if loads_follow && self.kind == Kind::Trapezoidal {
            return Err(SetupError::Lacks {
                integrator: Self::ID,
                needs: "loads that do not depend on the displacement for kind = \"trap\", which would make energy of what they lag behind (kind = \"ie\" \
                        takes the surface at the beginning of each step; `generalized-alpha`, `newmark` and explicit methods follow it)",
            });
        }
        let steps = EnergySteps::new(Self::ID, system, (self.kind, self.sweeps), before);
        Ok(SetUp::by_hand(steps, StepReport::default()))
    }
}
