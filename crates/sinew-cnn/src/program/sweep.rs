//! One sweep over all cells.

/// A value per cell and layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Register(pub(super) u8);

impl Register {
    /// Displacement (m) of the state.
    pub const U: Self = Self(0);
    /// Velocity (m/s) of the state.
    pub const V: Self = Self(1);
    /// Acceleration (m/s^2) of the state, if a program keeps one.
    pub const A: Self = Self(2);

    /// Its number.
    #[must_use]
    pub fn index(self) -> usize {
        self.0.into()
    }

    /// `self <- self + weight q`.
    #[must_use]
    pub fn plus_q(self, weight: f64) -> Update {
        self.becomes([(self, 1.0)]).and_q(weight)
    }

    /// `self <- self + weight other`.
    #[must_use]
    pub fn plus(self, weight: f64, other: Self) -> Update {
        self.becomes([(self, 1.0), (other, weight)])
    }

    /// `self <- q`.
    #[must_use]
    pub fn becomes_q(self) -> Update {
        self.becomes([]).and_q(1.0)
    }

    /// `self <- sum of weight register`.
    #[must_use]
    pub fn becomes<const N: usize>(self, terms: [(Self, f64); N]) -> Update {
        let term = |(register, weight)| Term {
            register,
            weight: Weight::Number(weight),
        };
        Update {
            target: self,
            terms: terms.into_iter().map(term).collect(),
            of_q: 0.0,
            clamp: None,
            last_only: false,
        }
    }
}

/// A sweep over all cells, followed by updates of each cell:
///
/// `rho = phi F - kappa K r_s - delta E r_d + sum_j (a_j + b_j m) r_j`, `q = rho`, `M^-1 rho` or
/// `P^-1 rho`, then the updates in order. K and the dashpots E are the only reads of neighbours, each
/// from one register.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Condition under which a step needs the sweep.
    pub when: When,
    /// `phi F`.
    pub loads: Loads,
    /// Forces of the neighbours.
    pub forces: Forces,
    /// `sum_j (a_j + b_j m) r_j`, m being a degree of freedom's mass.
    pub own: Vec<OwnTerm>,
    /// Definition of q.
    pub quotient: Quotient,
    /// The cell's own small linear map, in order.
    pub updates: Vec<Update>,
}

/// Steps in which a sweep is executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Every step.
    Always,
    /// Steps over which a load, by its number, is not constant.
    LoadChanges(u32),
    /// Steps at whose beginning a load jumps.
    LoadsJump,
}

/// The loads in a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loads {
    /// No loads.
    None,
    /// All loads, times a factor.
    All {
        /// phi.
        factor: f64,
        /// Time at which they are taken.
        at: LoadAt,
    },
    /// Half of the jump of all loads at the beginning of the step.
    HalfJump,
    /// One load, by its number, at factor 1.
    One(u32),
}

impl Loads {
    /// All loads, taken at this time.
    #[must_use]
    pub fn at(at: LoadAt) -> Self {
        Self::All { factor: 1.0, at }
    }
}

/// Time at which a sweep evaluates its loads; see [`sinew_core::LoadTime`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadAt {
    /// The beginning of the step, or the mean over it.
    StartOf,
    /// This share of the step, or the line of the same moments.
    Within(f64),
    /// The beginning, or the mean about it: running leapfrogs.
    Around,
    /// The beginning, or the mean from there on: a leapfrog's first step.
    From,
    /// The beginning, with the loads as they are throughout the step.
    Smooth,
}

/// Forces that the neighbours add to a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Forces {
    /// Products with the matrices; none if both are `None`.
    Products {
        /// `- kappa K r`.
        stiffness: Option<Product>,
        /// `- delta E r`, E being the dashpots.
        dashpots: Option<Product>,
    },
    /// `- f_int(u, v)` of a system that shows no matrices.
    Internal {
        /// Register of the displacement.
        u: Register,
        /// Register of the velocity.
        v: Register,
    },
}

/// A matrix times a register.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Product {
    /// kappa or delta: this times the product is subtracted.
    pub factor: f64,
    /// The register that neighbours read.
    pub source: Register,
}

/// `(plain + per_mass m) r`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnTerm {
    /// r.
    pub register: Register,
    /// a.
    pub plain: f64,
    /// b.
    pub per_mass: f64,
}

/// Definition of q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quotient {
    /// rho.
    Plain,
    /// M^-1 rho.
    Mass,
    /// P^-1 rho, P being one block for each cell.
    Blocks,
}

/// `target <- sum of weight register + of_q q`, then a clamp.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// The register that is written.
    pub target: Register,
    /// The terms that are added up.
    pub terms: Vec<Term>,
    /// Weight of q.
    pub of_q: f64,
    /// Bound of the result.
    pub clamp: Option<Clamp>,
    /// True if the update is executed only in the last step of a batch.
    pub last_only: bool,
}

impl Update {
    /// Adds `weight register`.
    #[must_use]
    pub fn and(mut self, weight: f64, register: Register) -> Self {
        self.terms.push(Term {
            register,
            weight: Weight::Number(weight),
        });
        self
    }

    /// Adds `weight q`.
    #[must_use]
    pub fn and_q(mut self, weight: f64) -> Self {
        self.of_q += weight;
        self
    }

    /// Sets the clamp.
    #[must_use]
    pub fn clamped(mut self, clamp: Option<Clamp>) -> Self {
        self.clamp = clamp;
        self
    }

    /// Restricts the update to the last step of a batch.
    #[must_use]
    pub fn in_last_step(mut self) -> Self {
        self.last_only = true;
        self
    }
}

/// A register and its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The register that is read.
    pub register: Register,
    /// Its weight.
    pub weight: Weight,
}

/// A weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    /// A number, the same in every step.
    Number(f64),
    /// A moment of a load over the step; see [`super::Moments`].
    OfLoad {
        /// Number of the load.
        load: u32,
        /// Number of the moment.
        moment: u32,
    },
}

/// A bound; values that reach it are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clamp {
    /// Bounds each component separately to this size: the network's saturation.
    Component(f64),
    /// Bounds each cell's vector, measured from a register or from 0, to this factor times the cell's limit.
    Vector {
        /// Register from which it is measured.
        from: Option<Register>,
        /// Factor of the limit.
        factor: f64,
    },
}

impl Sweep {
    /// A sweep that reads no neighbour: only the cell's own registers.
    #[must_use]
    pub fn local() -> Self {
        Self {
            when: When::Always,
            loads: Loads::None,
            forces: Forces::Products {
                stiffness: None,
                dashpots: None,
            },
            own: Vec::new(),
            quotient: Quotient::Plain,
            updates: Vec::new(),
        }
    }

    /// `q = M^-1 (phi F - kappa K source)`.
    #[must_use]
    pub fn of_stiffness(kappa: f64, source: Register, loads: Loads) -> Self {
        Self {
            loads,
            forces: Forces::Products {
                stiffness: Some(Product {
                    factor: kappa,
                    source,
                }),
                dashpots: None,
            },
            quotient: Quotient::Mass,
            ..Self::local()
        }
    }

    /// Adds `- delta E source`, E being the dashpots.
    #[must_use]
    pub fn with_dashpots(mut self, delta: f64, source: Register) -> Self {
        if let Forces::Products { dashpots, .. } = &mut self.forces {
            *dashpots = Some(Product {
                factor: delta,
                source,
            });
        }
        self
    }

    /// Adds an update.
    #[must_use]
    pub fn then(mut self, update: Update) -> Self {
        self.updates.push(update);
        self
    }

    /// Adds these updates.
    #[must_use]
    pub fn doing<const N: usize>(mut self, updates: [Update; N]) -> Self {
        self.updates.extend(updates);
        self
    }

    /// Adds `(plain + per_mass m) register` to rho.
    #[must_use]
    pub fn with_own(mut self, register: Register, plain: f64, per_mass: f64) -> Self {
        self.own.push(OwnTerm {
            register,
            plain,
            per_mass,
        });
        self
    }

    /// This sweep without any product.
    #[must_use]
    pub fn without_neighbours(mut self) -> Self {
        self.forces = Self::local().forces;
        self
    }

    /// This sweep times a factor, q not counted.
    #[must_use]
    pub fn scaled(mut self, by: f64) -> Self {
        if let Loads::All { factor, .. } = &mut self.loads {
            *factor *= by;
        }
        if let Forces::Products {
            stiffness,
            dashpots,
        } = &mut self.forces
        {
            for product in [stiffness, dashpots].into_iter().flatten() {
                product.factor *= by;
            }
        }
        for term in &mut self.own {
            term.plain *= by;
            term.per_mass *= by;
        }
        self
    }

    /// Sets the quotient.
    #[must_use]
    pub fn over(mut self, quotient: Quotient) -> Self {
        self.quotient = quotient;
        self
    }

    /// Restricts the sweep to steps that need it.
    #[must_use]
    pub fn when(mut self, when: When) -> Self {
        self.when = when;
        self
    }

    /// True if the sweep reads neighbours.
    #[must_use]
    pub(crate) fn reads_neighbours(&self) -> bool {
        !matches!(
            self.forces,
            Forces::Products {
                stiffness: None,
                dashpots: None
            }
        )
    }
}
