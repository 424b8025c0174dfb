//! `cnn-stabilised` with an inner iteration that goes from cell to cell.

use sinew_cnn::{GaussSeidel, Stabiliser};
use sinew_core::{
    Acceleration, LoadTime, State, Step, StepError, StepReport, Stepped, VelocityTime,
};

use crate::StepByHand;

/// The step of [`super::CnnStabilised`] with an iteration that no program expresses.
pub struct OrderedSteps {
    solver: GaussSeidel,
    /// Share of the damping that P does not hold.
    lagging: f64,
    sweeps: u64,
    force: Vec<f64>,
    change: Vec<f64>,
}

impl OrderedSteps {
    pub(super) fn new(solver: GaussSeidel, stabiliser: &Stabiliser, sweeps: u64) -> Self {
        let majorant = stabiliser.majorant();
        Self {
            solver,
            lagging: 1.0 - majorant.damping_share(),
            sweeps,
            force: vec![0.0; majorant.dofs()],
            change: vec![0.0; majorant.dofs()],
        }
    }

    /// `F - K u - D v` before a step; for the first step, D is replaced by the lagging share of the
    /// damping other than alpha M.
    fn residual(&mut self, step: &Step<'_>, state: &State, running: bool) -> Result<(), StepError> {
        let (t, dt) = (state.t(), step.dt);
        let Some(linear) = step.system.as_linear().filter(|_| !running) else {
            let load = LoadTime::around(t, dt, dt);
            let at = [&state.u[..], &state.v, &state.internal];
            return step.net_force(load, 0.0, at, &mut self.force);
        };
        let (operators, out) = (linear.operators(), &mut self.force);
        let load = LoadTime::around(t, 0.0, dt).under(step.inputs);
        operators.external_force(load, out);
        let damping = operators.damping();
        let of_stiffness = self.lagging * damping.stiffness;
        operators
            .stiffness()
            .subtract_product_combined(&state.u, of_stiffness, &state.v, out);
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(self.lagging, &state.v, out);
        }
        Ok(())
    }
}

impl StepByHand for OrderedSteps {
    fn without_program(&self) -> &'static str {
        "a Gauss-Seidel iteration takes the cells one after the other, and a sweep takes all at once"
    }

    fn is_staggered(&self) -> bool {
        true
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        let dt = step.dt;
        let running = state.is_staggered_by(dt);
        let weight = if running { dt } else { dt / 2.0 };
        self.residual(step, state, running)?;
        let moving = self.force.iter_mut().zip(step.system.mass()).zip(&state.v);
        for ((force, mass), v) in moving {
            *force = weight * *force + if running { 0.0 } else { mass * v };
        }
        self.solver.solve(&self.force, &mut self.change);
        state.a.resize(state.u.len(), 0.0);
        let moving = state.u.iter_mut().zip(&mut state.v).zip(&mut state.a);
        for (((u, v), a), change) in moving.zip(&self.change) {
            let before = *v;
            *v = if running { *v + change } else { *change };
            *a = (*v - before) / weight;
            *u += dt * *v;
        }
        let mut work = StepReport::ONE_FORCE;
        work.sweeps += self.sweeps;
        Ok(Stepped {
            work,
            velocity: VelocityTime::MiddleOfStep,
            acceleration: Acceleration::Kick,
        })
    }
}
