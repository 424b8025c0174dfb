//! Common part of one-step implicit methods: the acceleration at the end of a step.

use sinew_core::vectors::add_scaled;
use sinew_core::{
    Acceleration, ElasticLaw, Equations, EvaluationError, Fact, LinearSystem, LoadTime, SetupError,
    State, Step, StepError, StepReport, Stepped, System, Trial, Velocities,
};

use super::factor::{self, Combination, Factor};
use super::newton::{NewtonSettings, NewtonSteps, Unknown, ViscousPlace};
use crate::scheme::{Scheme, SetUp, StepByHand};

/// One force and one solution.
const ONE_SOLVE: StepReport = StepReport {
    solves: 1,
    ..StepReport::ONE_FORCE
};

/// A method whose steps seek one acceleration each: by one solution on linear systems, by Newton's method on others.
pub trait OneAcceleration: Scheme + Clone {
    /// d and k of the matrix `M + d D + k K` in steps of `dt` (s).
    fn coefficients(&self, dt: f64) -> [f64; 2];

    /// Tolerance and iteration limit of Newton's method.
    fn newton(&self) -> NewtonSettings;

    /// Takes one step.
    ///
    /// # Errors
    /// [`StepError`] when the system refuses a trial state or the step's equations are not solved.
    fn step(
        &self,
        effective: &mut EffectiveMass,
        step: &Step<'_>,
        state: &mut State,
    ) -> Result<Stepped, StepError>;
}

/// Steps with one acceleration each.
pub struct ImplicitSteps<M> {
    method: M,
    effective: EffectiveMass,
}

impl<M: OneAcceleration> ImplicitSteps<M> {
    /// Factorises for a linear system and steps of `dt` (s), or allocates for Newton's method; the analysis of the last
    /// factor is reused for the same pattern.
    pub(super) fn set_up(
        method: &M,
        system: &dyn System,
        dt: f64,
        before: Option<Self>,
    ) -> Result<SetUp<Self>, SetupError> {
        let known = before.and_then(|steps| steps.effective.solver.into_factor());
        let coefficients = method.coefficients(dt);
        let (solver, work) = match system.as_linear() {
            Some(linear) => {
                let work = StepReport {
                    factorizations: 1,
                    ..StepReport::default()
                };
                (Solver::once(M::ID, linear, coefficients, known)?, work)
            }
            None => {
                let of = (dt, coefficients);
                let (steps, work) = NewtonSteps::set_up(M::ID, system, of, method.newton(), known)?;
                (Solver::Newton(Box::new(steps)), work)
            }
        };
        let zeros = || vec![0.0; system.dofs()];
        let effective = EffectiveMass {
            integrator: M::ID,
            solver,
            u: zeros(),
            v: zeros(),
            a: zeros(),
        };
        let method = method.clone();
        Ok(SetUp::by_hand(Self { method, effective }, work))
    }
}

impl<M: OneAcceleration> StepByHand for ImplicitSteps<M> {
    fn without_program(&self) -> &'static str {
        "each step solves equations in all cells at once, which no fixed number of sweeps over neighbours does"
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        self.method.step(&mut self.effective, step, state)
    }

    fn facts(&self) -> Vec<Fact> {
        match &self.effective.solver {
            Solver::Once(_) => Vec::new(),
            Solver::Newton(newton) => newton.facts(),
        }
    }

    fn remarks(&self) -> Vec<String> {
        match &self.effective.solver {
            Solver::Once(factor) => factor.remark().into_iter().collect(),
            Solver::Newton(newton) => newton.remarks(),
        }
    }
}

/// Solver for the acceleration.
enum Solver {
    /// One factor of `M + d D + k K`, which is kept.
    Once(Box<factor::Solver>),
    /// Newton's method with a factor for each iteration.
    Newton(Box<NewtonSteps>),
}

impl Solver {
    fn once(
        integrator: &'static str,
        system: &dyn LinearSystem,
        [d, k]: [f64; 2],
        known: Option<Factor>,
    ) -> Result<Self, SetupError> {
        let operators = system.operators();
        let combination = Combination::of_step(operators.damping(), d, k);
        let factor = match known.filter(|factor| factor.fits(operators)) {
            Some(factor) => Ok(factor.into()),
            None => factor::Solver::analyse(operators),
        };
        let prepared = factor.and_then(|mut solver| {
            solver.prepare(operators, combination)?;
            Ok(Self::Once(Box::new(solver)))
        });
        prepared.map_err(|error| error.at_set_up(integrator))
    }

    fn into_factor(self) -> Option<Factor> {
        match self {
            Self::Once(solver) => solver.into_factor(),
            Self::Newton(steps) => steps.into_factor(),
        }
    }
}

/// The effective mass `M + d D + k K` as a factor or by Newton's method, with the vectors of
/// `(M + d D + k K) a = F(t) - K u* - D v*` or its nonlinear form.
pub struct EffectiveMass {
    /// Id of the method.
    integrator: &'static str,
    solver: Solver,
    /// Predicted displacement u*.
    pub(super) u: Vec<f64>,
    /// Predicted velocity v*.
    pub(super) v: Vec<f64>,
    /// The acceleration, once solved.
    pub(super) a: Vec<f64>,
}

/// The acceleration a that a step seeks: `M a + m M a_before = c net(u* + k a/c, v* + d a/c) + c_old net(u, v)`.
#[derive(Clone, Copy)]
pub(super) struct Sought {
    /// d and k of `M + d D + k K`.
    pub(super) coefficients: [f64; 2],
    /// c.
    pub(super) of_forces: f64,
    /// m.
    pub(super) of_last_inertia: f64,
    /// `c_old`.
    pub(super) of_old_forces: f64,
    /// Times of the loads at both ends of the step.
    pub(super) loads: [LoadTime<'static>; 2],
    /// Displacement at which stiffness damping of force laws acts.
    pub(super) viscosity: ViscousPlace<'static>,
}

impl Sought {
    /// The acceleration for which forces and inertia balance at the end of a step.
    pub(super) fn at_end(coefficients: [f64; 2], loads: [LoadTime<'static>; 2]) -> Self {
        Self {
            coefficients,
            of_forces: 1.0,
            of_last_inertia: 0.0,
            of_old_forces: 0.0,
            loads,
            viscosity: ViscousPlace::at_end(loads),
        }
    }
}

impl EffectiveMass {
    /// True if the system is linear.
    pub(super) fn is_linear(&self) -> bool {
        matches!(self.solver, Solver::Once(_))
    }

    /// Solves for the acceleration. On a linear system `shape` computes `(M + d D + k K) a` from the net force at the
    /// prediction, with the loads at the end, and may use up the predicted velocity.
    pub(super) fn solve(
        &mut self,
        step: &Step<'_>,
        state: &State,
        sought: Sought,
        shape: impl FnOnce(&mut [f64], &mut [f64]),
    ) -> Result<StepReport, StepError> {
        match &mut self.solver {
            Solver::Once(factor) => {
                let point = [&self.u[..], &self.v, &[]];
                step.net_force(sought.loads[1], step.dt, point, &mut self.a)?;
                shape(&mut self.a, &mut self.v);
                let solved = factor.solve(&mut self.a);
                solved.map_err(|error| StepError::Inaccurate {
                    integrator: self.integrator,
                    t: state.t(),
                    reason: error.to_string(),
                })?;
                Ok(ONE_SOLVE)
            }
            Solver::Newton(newton) => {
                let unknown = Unknown {
                    predicted: [&self.u, &self.v],
                    coefficients: sought.coefficients,
                    of_forces: sought.of_forces,
                    of_last_inertia: sought.of_last_inertia,
                    of_old_forces: sought.of_old_forces,
                    loads: sought.loads,
                    viscosity: sought.viscosity,
                };
                newton.solve(step, state, unknown, &mut self.a)
            }
        }
    }

    /// Gives the state the acceleration at the beginning of a step of `dt` (s): `M^-1` of the net
    /// force, or the one kept from the end of the last step plus the jump of the loads between the
    /// two. `ends` gives the loads at both ends of a step from a time (s), `dt` (s) long.
    pub(super) fn keep_acceleration(
        &mut self,
        step: &Step<'_>,
        state: &mut State,
        ends: impl Fn(f64, f64) -> [LoadTime<'static>; 2],
    ) -> Result<StepReport, StepError> {
        let (t, dt) = (state.t(), step.dt);
        let ends = |t, dt| ends(t, dt).map(|when| when.under(step.inputs));
        let [load, _] = ends(t, dt);
        if state.acceleration != Acceleration::Same {
            step.acceleration(load, state, &mut self.a)?;
            state.a.clone_from(&self.a);
            state.acceleration = Acceleration::Same;
            return Ok(StepReport::ONE_FORCE);
        }
        let mut work = StepReport::default();
        if let Some(last) = state.clock.last_step() {
            let [_, before] = ends(t - last, last);
            let jumped = match step.system.equations() {
                Equations::Linear(linear) => {
                    self.a.fill(0.0);
                    let (loads, within) = ([before, load], [t - last, t + dt]);
                    linear
                        .operators()
                        .add_load_change(loads, within, &mut self.a)
                }
                Equations::Forces(law) => {
                    law.external_force(load, &state.u, &mut self.a);
                    law.external_force(before, &state.u, &mut self.v);
                    add_scaled(-1.0, &self.v, &mut self.a);
                    let drag = self.add_change_of_drag(step, state, [before, load]);
                    work.sweeps += drag.map_err(|source| StepError::Refused { t, source })?;
                    true
                }
            };
            if jumped {
                for ((a, force), mass) in state.a.iter_mut().zip(&self.a).zip(step.system.mass()) {
                    *a += force / mass;
                }
            }
        }
        Ok(work)
    }

    /// Adds the change of stiffness damping due to the motion of supports to the change of the loads: matrices have it
    /// among their loads, force laws do not. Returns the number of sweeps used.
    fn add_change_of_drag(
        &mut self,
        step: &Step<'_>,
        state: &State,
        [before, after]: [LoadTime<'_>; 2],
    ) -> Result<u64, EvaluationError> {
        let law = step.system.as_elastic();
        let drags = |law: &&dyn ElasticLaw| law.supports_move() && law.damping().stiffness != 0.0;
        let Some(law) = law.filter(drags) else {
            return Ok(0);
        };
        for (when, sign) in [(before, 1.0), (after, -1.0)] {
            law.viscous_force(&Trial::of(state, when), Velocities::Supports, &mut self.v)?;
            add_scaled(sign, &self.v, &mut self.a);
        }
        Ok(2)
    }
}
