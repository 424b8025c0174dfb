//! Common part of one-step implicit methods: an acceleration from a factor of M + d D + k K.

use sinew_core::{
    Acceleration, LoadTime, SetupError, State, Step, StepError, StepReport, Stepped, System,
};

use super::factor::{Combination, Factor};
use super::factor_error::FactorError;
use crate::scheme::{Scheme, SetUp, StepByHand, linear};

/// One force and one solution.
pub(super) const ONE_SOLVE: StepReport = StepReport {
    solves: 1,
    ..StepReport::ONE_FORCE
};

/// A method whose steps solve one linear system each.
pub trait OneSolve: Scheme + Clone {
    /// d and k of the matrix `M + d D + k K` in steps of `dt` (s).
    fn coefficients(&self, dt: f64) -> [f64; 2];

    /// Takes one step.
    ///
    /// # Errors
    /// [`StepError`] when the system refuses a trial state.
    fn step(
        &self,
        effective: &mut EffectiveMass,
        step: &Step<'_>,
        state: &mut State,
    ) -> Result<Stepped, StepError>;
}

/// Steps with one solution each.
pub struct ImplicitSteps<M> {
    method: M,
    effective: EffectiveMass,
}

impl<M: OneSolve> ImplicitSteps<M> {
    /// Factorises for a system and steps of `dt` (s); the analysis of the last factor is reused
    /// on the same pattern.
    pub(super) fn set_up(
        method: &M,
        system: &dyn System,
        dt: f64,
        before: Option<Self>,
    ) -> Result<SetUp<Self>, SetupError> {
        let operators = linear(system, M::ID)?.operators();
        let failed = |error: FactorError| error.at_set_up(M::ID);
        let known = before.map(|steps| steps.effective.factor);
        let mut factor = match known.filter(|factor| factor.fits(operators)) {
            Some(factor) => factor,
            None => Factor::analyse(operators).map_err(failed)?,
        };
        let [d, k] = method.coefficients(dt);
        factor
            .factorise(operators, Combination::of_step(operators, d, k))
            .map_err(failed)?;
        let zeros = || vec![0.0; system.dofs()];
        let effective = EffectiveMass {
            factor,
            u: zeros(),
            v: zeros(),
            a: zeros(),
        };
        let work = StepReport {
            factorizations: 1,
            ..StepReport::default()
        };
        let method = method.clone();
        Ok(SetUp::by_hand(Self { method, effective }, work))
    }
}

impl<M: OneSolve> StepByHand for ImplicitSteps<M> {
    fn without_program(&self) -> &'static str {
        "each step solves linear equations in all cells at once, which no fixed number of sweeps over neighbours does"
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        self.method.step(&mut self.effective, step, state)
    }
}

/// The effective mass `M + d D + k K` as a factor, with the vectors of `(M + d D + k K) a = F(t) - K u* - D v*`.
pub struct EffectiveMass {
    factor: Factor,
    /// Predicted displacement u*.
    pub(super) u: Vec<f64>,
    /// Predicted velocity v*.
    pub(super) v: Vec<f64>,
    /// The acceleration, once solved.
    pub(super) a: Vec<f64>,
}

impl EffectiveMass {
    /// The right-hand side, in `a`: the net force at the prediction.
    pub(super) fn evaluate(
        &mut self,
        step: &Step<'_>,
        load: LoadTime<'_>,
    ) -> Result<(), StepError> {
        step.net_force(load, step.dt, [&self.u, &self.v, &[]], &mut self.a)
    }

    /// Replaces the right-hand side in `a` by the acceleration.
    pub(super) fn solve(&mut self) {
        self.factor.solve(&mut self.a);
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
        if let (Some(last), Some(linear)) = (state.clock.last_step(), step.system.as_linear()) {
            let [_, before] = ends(t - last, last);
            self.a.fill(0.0);
            let operators = linear.operators();
            if operators.add_load_change([before, load], [t - last, t + dt], &mut self.a) {
                for ((a, force), mass) in state.a.iter_mut().zip(&self.a).zip(step.system.mass()) {
                    *a += force / mass;
                }
            }
        }
        Ok(StepReport::default())
    }
}
