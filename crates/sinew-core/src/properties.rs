//! Properties that methods declare.

use crate::load_over_step::LoadOverStep;
use crate::step_error::SetupError;
use crate::system::System;

/// Properties that a method declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Accuracy in dt, with mass-proportional damping and nothing saturated.
    pub accuracy: Accuracy,
    /// Parts of a system that the method needs.
    pub needs: Needs,
    /// Behaviour of the energy of an undamped system within the stable step.
    pub energy: EnergyBehaviour,
    /// Accuracy in dt under damping that is not proportional to the mass.
    pub other_damping: OtherDamping,
    /// Accuracy in dt while loads change.
    pub changing_loads: ChangingLoads,
    /// True if set-up may refuse steps at which the method is stable, because it cannot resolve them
    /// ([`SetupError::Unresolved`]).
    pub refuses_long_steps: bool,
}

impl Properties {
    /// Properties of a method that has this order in every respect.
    #[must_use]
    pub fn of_order(order: u8, needs: Needs, energy: EnergyBehaviour) -> Self {
        Self {
            accuracy: Accuracy::Order(order),
            needs,
            energy,
            other_damping: OtherDamping::order(order),
            changing_loads: ChangingLoads::order(order),
            refuses_long_steps: false,
        }
    }

    /// Sets the orders without and with mass-proportional damping.
    #[must_use]
    pub fn with_orders(self, undamped: u8, damped: u8) -> Self {
        Self {
            accuracy: Accuracy::OrderByDamping { undamped, damped },
            ..self
        }
    }

    /// Sets the order under damping that is not proportional to the mass.
    #[must_use]
    pub fn with_other_damping(self, order: u8) -> Self {
        Self {
            other_damping: OtherDamping::order(order),
            ..self
        }
    }

    /// Sets the orders for loads that change smoothly and for loads that jump or have kinks.
    #[must_use]
    pub fn with_loads(self, smooth: u8, broken: u8) -> Self {
        Self {
            changing_loads: ChangingLoads::Order { smooth, broken },
            ..self
        }
    }
}

/// Accuracy of a method in dt while loads change.
///
/// The whole impulse of every load acts, wherever its jumps and kinks are: those between two steps shift within the
/// step, or in leapfrog methods within two neighbouring steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangingLoads {
    /// Errors fall as powers of dt.
    Order {
        /// Order while loads change smoothly.
        smooth: u8,
        /// Order with loads that jump or have kinks, on steps or between them.
        broken: u8,
    },
    /// Exact to the method's own tolerance for loads that meet this condition; others are refused.
    Exact(LoadOverStep),
}

impl ChangingLoads {
    /// One order for all loads.
    #[must_use]
    pub fn order(order: u8) -> Self {
        Self::Order {
            smooth: order,
            broken: order,
        }
    }

    /// Description of the accuracy.
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

    /// True if the error does not depend on the step.
    #[must_use]
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Exact(_))
    }

    /// Condition that loads must meet within each step.
    #[must_use]
    pub fn needed(self) -> LoadOverStep {
        match self {
            Self::Order { .. } => LoadOverStep::Any,
            Self::Exact(needed) => needed,
        }
    }
}

/// Accuracy of a method in dt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// The error falls as this power of dt.
    Order(u8),
    /// The error falls as one power of dt without damping and as another with it.
    OrderByDamping {
        /// Order without damping.
        undamped: u8,
        /// Order with mass-proportional damping.
        damped: u8,
    },
    /// Exact to the method's own tolerance at any step while loads are constant.
    Exact,
}

impl Accuracy {
    /// The order without or with damping; `None` if the method is exact.
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

/// Accuracy of a method in dt under each kind of damping other than alpha M; `None`
/// where set-up refuses that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherDamping {
    /// Accuracy under beta K.
    pub stiffness: Option<Accuracy>,
    /// Accuracy under dashpots, a damping matrix proportional to neither M nor K.
    pub dashpots: Option<Accuracy>,
}

impl OtherDamping {
    /// One order under both kinds of damping.
    #[must_use]
    pub fn order(order: u8) -> Self {
        Self {
            stiffness: Some(Accuracy::Order(order)),
            dashpots: Some(Accuracy::Order(order)),
        }
    }

    /// Description of the accuracy.
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

/// Parts of a system that a method needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Forces only.
    Forces,
    /// The matrices M, D and K.
    Matrices,
    /// An elastic law with its energy and tangent, which linear systems have too.
    Tangents,
}

impl Needs {
    /// Description of the needs.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Forces => "forces",
            Self::Matrices => "the matrices M, D and K of a linear system",
            Self::Tangents => "matrices, or an elastic law with its energy and tangent",
        }
    }

    /// Checks that a system has the properties a method needs.
    ///
    /// # Errors
    /// [`SetupError::Lacks`] if it does not.
    pub fn check(self, integrator: &'static str, system: &dyn System) -> Result<(), SetupError> {
        let has = match self {
            Self::Forces => true,
            Self::Matrices => system.as_linear().is_some(),
            Self::Tangents => system.as_elastic().is_some(),
        };
        if has {
            Ok(())
        } else {
            Err(self.lacking(integrator))
        }
    }

    /// The error for a system that lacks a needed property.
    #[must_use]
    pub fn lacking(self, integrator: &'static str) -> SetupError {
        SetupError::Lacks {
            integrator,
            needs: self.describe(),
        }
    }
}

/// Behaviour of the energy of an undamped, unloaded linear system.
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
    /// Never rises, for any step, on every system that meets the method's needs: points that the system's law refuses
    /// are avoided. With damping or loads the energy rises by no more than their work.
    NeverRises,
}

/// The largest stable step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StableStep {
    /// Stable at any step.
    Any,
    /// Stable up to this step (s); 0 means never.
    UpTo(f64),
    /// The method gives no statement.
    Unknown,
}

impl StableStep {
    /// True if a step of `dt` (s) is stable; `None` if unknown.
    #[must_use]
    pub fn allows(self, dt: f64) -> Option<bool> {
        match self {
            Self::Any => Some(true),
            Self::UpTo(limit) => Some(dt <= limit),
            Self::Unknown => None,
        }
    }
}
