//! The contract of a time integrator.

use std::ops::AddAssign;

use crate::{EvaluationError, LoadOverStep, Revision, State, System};

/// A method that takes a state one step further.
///
/// Holds caches and work buffers, never physics: all that a method must remember from one step
/// to the next stands in the [`State`].
pub trait Integrator: Send {
    /// The name users type.
    fn id(&self) -> &'static str;

    /// What the method declares about itself; the conformance suite holds it to that.
    fn properties(&self) -> Properties;

    /// Sets up for a system and a step: buffers, factors, checks. [`Integrator::step`] does so
    /// itself where it must; calling it first keeps set-up out of the first step's time.
    ///
    /// # Errors
    /// [`SetupError`] when the system lacks what the method needs or the step makes no sense.
    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError>;

    /// The largest step at which the method is stable on this system.
    ///
    /// # Errors
    /// [`SetupError`] when the system lacks what the answer needs.
    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError>;

    /// Takes `state` from t to t + dt and tells the system that the step was accepted.
    ///
    /// # Errors
    /// [`StepError`] when set-up fails or the system refuses a trial state; `state` is then
    /// unspecified.
    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError>;

    /// What set-up found out for the system and step at hand, for reports; may cost as much as
    /// set-up did.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// What set-up found out that a user should read, a sentence each.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

/// A number that set-up found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fact {
    /// Its name, as results show it.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
}

/// What a method declares about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// How the error falls with dt, with mass-proportional damping and nothing saturated.
    pub accuracy: Accuracy,
    /// What it needs of a system.
    pub needs: Needs,
    /// What happens to the energy of an undamped system within the stable step.
    pub energy: EnergyBehaviour,
    /// How the error falls with dt under damping that is not proportional to the mass.
    pub other_damping: OtherDamping,
    /// How the error falls with dt while loads change.
    pub changing_loads: ChangingLoads,
}

/// How the error of a method falls with dt while loads change.
///
/// The impulse of every load arrives, wherever its jumps and kinks fall: one that does so between two
/// steps is moved within the step, or in leapfrog methods between two neighbouring steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangingLoads {
    /// As powers of dt.
    Order {
        /// While loads change smoothly.
        smooth: u8,
        /// With loads that jump or have kinks, on steps or between them.
        broken: u8,
    },
    /// Exact to the method's own tolerance where loads are such; others are refused.
    Exact(LoadOverStep),
}

impl ChangingLoads {
    /// The same order for all loads.
    #[must_use]
    pub fn order(order: u8) -> Self {
        Self::Order {
            smooth: order,
            broken: order,
        }
    }

    /// In words.
    #[must_use]
    pub fn describe(self) -> String {
        match self {
            Self::Order { smooth, broken } if smooth == broken => {
                format!("order {smooth} while loads change, jumps and kinks included")
            }
            Self::Order { smooth, broken } => format!(
                "order {smooth} while loads change smoothly, {broken} where they jump or have kinks"
            ),
            Self::Exact(LoadOverStep::Any) => "exact while loads change, wherever they jump".into(),
            Self::Exact(needed) => format!(
                "exact where loads are {}; others are refused",
                needed.describe()
            ),
        }
    }

    /// Whether the error does not depend on the step.
    #[must_use]
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Exact(_))
    }

    /// What the method needs loads to be over each step.
    #[must_use]
    pub fn needed(self) -> LoadOverStep {
        match self {
            Self::Order { .. } => LoadOverStep::Any,
            Self::Exact(needed) => needed,
        }
    }
}

/// How the error of a method falls with dt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// As this power of dt.
    Order(u8),
    /// As one power of dt without damping and as another with it.
    OrderByDamping {
        /// Without damping.
        undamped: u8,
        /// With mass-proportional damping.
        damped: u8,
    },
    /// Exact to the method's own tolerance at any step while loads are constant.
    Exact,
}

impl Accuracy {
    /// The order without or with damping; `None` where the method is exact.
    #[must_use]
    pub fn order(self, damping: bool) -> Option<u8> {
        match self {
            Self::Order(order) => Some(order),
            Self::OrderByDamping { undamped, damped } => {
                Some(if damping { damped } else { undamped })
            }
            Self::Exact => None,
        }
    }
}

/// How the error of a method falls with dt under each kind of damping other than alpha M; `None`
/// where set-up refuses that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherDamping {
    /// Under beta K.
    pub stiffness: Option<Accuracy>,
    /// Under dashpots, a damping matrix proportional to neither M nor K.
    pub dashpots: Option<Accuracy>,
}

impl OtherDamping {
    /// This power of dt under both kinds.
    #[must_use]
    pub fn order(order: u8) -> Self {
        Self {
            stiffness: Some(Accuracy::Order(order)),
            dashpots: Some(Accuracy::Order(order)),
        }
    }

    /// In words.
    #[must_use]
    pub fn describe(self) -> String {
        let words = |accuracy: Option<Accuracy>| match accuracy {
            None => "refused".to_owned(),
            Some(accuracy) => match accuracy.order(true) {
                Some(order) => format!("order {order}"),
                None => "exact".to_owned(),
            },
        };
        let (stiffness, dashpots) = (words(self.stiffness), words(self.dashpots));
        if stiffness == dashpots {
            format!("with stiffness damping or dashpots: {stiffness}")
        } else {
            format!("with stiffness damping: {stiffness}; with dashpots: {dashpots}")
        }
    }
}

/// What a method needs of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Forces only.
    Forces,
    /// The matrices M, D and K.
    Matrices,
}

impl Needs {
    /// In words.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Forces => "forces",
            Self::Matrices => "the matrices M, D and K of a linear system",
        }
    }

    /// The complaint about a system that does not offer it.
    #[must_use]
    pub fn lacking(self, integrator: &'static str) -> SetupError {
        SetupError::Lacks {
            integrator,
            needs: self.describe(),
        }
    }
}

/// What happens to the energy of an undamped, unloaded linear system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyBehaviour {
    /// Constant to rounding.
    Conserved,
    /// Oscillates about a constant.
    Bounded,
    /// Falls.
    Falls,
    /// Grows.
    Grows,
}

/// The largest stable step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StableStep {
    /// Stable at any step.
    Any,
    /// Stable up to this step (s); 0 means never.
    UpTo(f64),
    /// The method cannot say.
    Unknown,
}

impl StableStep {
    /// Whether a step of `dt` (s) is known to be stable.
    #[must_use]
    pub fn allows(self, dt: f64) -> Option<bool> {
        match self {
            Self::Any => Some(true),
            Self::UpTo(limit) => Some(dt <= limit),
            Self::Unknown => None,
        }
    }
}

/// The work of a step, or of many. Counts reproduce; seconds do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Evaluations of F - K u - D v over all cells, or work of that size.
    pub sweeps: u64,
    /// Evaluations of a system's net force.
    pub force_evaluations: u64,
    /// Solutions of a linear system with a factor.
    pub solves: u64,
    /// Numeric factorisations.
    pub factorizations: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Degrees of freedom whose velocity was saturated; of a step taken in parts, in the part in which
    /// most were.
    pub saturated: u64,
}

impl StepReport {
    /// One force evaluation, which is one sweep.
    pub const ONE_FORCE: Self = Self {
        sweeps: 1,
        force_evaluations: 1,
        solves: 0,
        factorizations: 0,
        newton_iterations: 0,
        saturated: 0,
    };

    /// Adds the work of a part of the same step.
    pub fn add_part(&mut self, part: Self) {
        let saturated = self.saturated.max(part.saturated);
        *self += part;
        self.saturated = saturated;
    }
}

impl AddAssign for StepReport {
    fn add_assign(&mut self, other: Self) {
        self.sweeps += other.sweeps;
        self.force_evaluations += other.force_evaluations;
        self.solves += other.solves;
        self.factorizations += other.factorizations;
        self.newton_iterations += other.newton_iterations;
        self.saturated += other.saturated;
    }
}

/// Why a method cannot run on a system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// The system lacks what the method needs.
    #[error("`{integrator}` needs {needs}, which this system does not offer")]
    Lacks {
        /// Integrator id.
        integrator: &'static str,
        /// What is missing.
        needs: &'static str,
    },
    /// A step that is no positive, finite time.
    #[error("`{integrator}`: dt = {dt} s: expected a finite step above 0")]
    Step {
        /// Integrator id.
        integrator: &'static str,
        /// The step (s).
        dt: f64,
    },
    /// A mass that is not positive.
    #[error("`{integrator}`: {cell} has a mass of {mass} kg: expected a finite mass above 0")]
    Mass {
        /// Integrator id.
        integrator: &'static str,
        /// The cell, in the system's words.
        cell: String,
        /// Its mass (kg).
        mass: f64,
    },
    /// A state of another size than the system.
    #[error("`{integrator}`: the state has {state} degrees of freedom, the system has {system}")]
    StateSize {
        /// Integrator id.
        integrator: &'static str,
        /// Length of the state's vectors.
        state: usize,
        /// Degrees of freedom of the system.
        system: usize,
    },
    /// The method cannot be accurate at this step.
    #[error("`{integrator}`: {reason}")]
    Unresolved {
        /// Integrator id.
        integrator: &'static str,
        /// Why, and what to do instead.
        reason: String,
    },
    /// The matrix of an implicit step could not be factorised.
    #[error("`{integrator}`: the matrix of the step could not be factorised: {reason}")]
    Factorization {
        /// Integrator id.
        integrator: &'static str,
        /// What the factorisation said.
        reason: String,
    },
}

/// Why a step failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// Set-up failed.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The method found that its step would be wrong.
    #[error("`{integrator}` at t = {t} s: {reason}")]
    Inaccurate {
        /// Integrator id.
        integrator: &'static str,
        /// Time of the state (s).
        t: f64,
        /// Why, and what to do instead.
        reason: String,
    },
    /// The system refused a trial state.
    #[error("at t = {t} s: {source}")]
    Refused {
        /// Time of the trial (s).
        t: f64,
        /// What the system said.
        source: EvaluationError,
    },
}

/// Remembers which system and step an integrator is set up for, and makes the checks that every
/// integrator owes its users.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prepared {
    done_for: Option<(Revision, f64)>,
}

impl Prepared {
    /// Whether set-up for this system and step is done.
    #[must_use]
    pub fn is_for(&self, system: &dyn System, dt: f64) -> bool {
        self.done_for == Some((system.revision(), dt))
    }

    /// Checks the step and the masses, then remembers the system.
    ///
    /// # Errors
    /// [`SetupError::Step`] or [`SetupError::Mass`].
    pub fn check(
        &mut self,
        integrator: &'static str,
        system: &dyn System,
        dt: f64,
    ) -> Result<(), SetupError> {
        self.done_for = None;
        if !(dt.is_finite() && dt > 0.0) {
            return Err(SetupError::Step { integrator, dt });
        }
        let masses = system.mass().iter().enumerate();
        for (dof, &mass) in masses {
            if !(mass.is_finite() && mass > 0.0) {
                return Err(SetupError::Mass {
                    integrator,
                    cell: system.cell_name(dof),
                    mass,
                });
            }
        }
        self.done_for = Some((system.revision(), dt));
        Ok(())
    }

    /// Checks that a state has the system's size.
    ///
    /// # Errors
    /// [`SetupError::StateSize`].
    pub fn check_state(
        integrator: &'static str,
        system: &dyn System,
        state: &State,
    ) -> Result<(), SetupError> {
        let dofs = system.dofs();
        match [state.u.len(), state.v.len()]
            .into_iter()
            .find(|&n| n != dofs)
        {
            None => Ok(()),
            Some(found) => Err(SetupError::StateSize {
                integrator,
                state: found,
                system: dofs,
            }),
        }
    }
}
