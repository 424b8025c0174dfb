//! The steps of `cnn-stabilised` if no program can express the solution with P.

use sinew_cnn::{CellBlocks, Deflation, Inverse, Stabiliser};
use sinew_core::vectors::add_scaled;
use sinew_core::{
    Acceleration, AllShown, Contact, DampedAt, Inertia, LinearOperators, LoadTime, Meeting, State,
    Step, StepError, StepReport, Stepped, System, VelocityTime,
};
use std::sync::Arc;

use super::carried::Carried;
use super::coupled_contact::{Coupled, CoupledContact};
use crate::StepByHand;

/// Residual of the contact iteration above which a remark is reported.
const SETTLED: f64 = 1e-6;

/// The step of [`super::CnnStabilised`] with sums over all cells of a part, with moving supports, or with an iteration
/// in the order of the cells.
pub struct SolvedSteps {
    inverse: Inverse,
    /// Share of the damping that P does not contain.
    lagging: f64,
    sweeps: u64,
    reason: &'static str,
    force: Vec<f64>,
    change: Vec<f64>,
    before: Vec<f64>,
    touched: Option<Touched>,
    carried: Carried,
}

/// Data for contact.
struct Touched {
    blocks: Arc<CellBlocks>,
    /// Present if parts that may move as rigid bodies have contact.
    coupled: Option<CoupledParts>,
    pushed: Vec<u32>,
}

/// Rigid motions of parts, coupled with contact.
struct CoupledParts {
    deflation: Arc<Deflation>,
    contact: CoupledContact,
    kept: Vec<f64>,
}

impl SolvedSteps {
    pub(super) fn new(
        stabiliser: &Stabiliser,
        (system, operators): (&dyn System, &LinearOperators),
        sweeps: u64,
    ) -> Self {
        let majorant = stabiliser.majorant();
        let coupled = |(contact, deflation): (&dyn Contact, &Arc<Deflation>)| CoupledParts {
            deflation: Arc::clone(deflation),
            contact: CoupledContact::new(contact, majorant.dofs(), deflation.count()),
            kept: Vec::with_capacity(contact.kept()),
        };
        let touched = || Touched {
            blocks: Arc::clone(majorant.inverse()),
            coupled: system.contact().zip(stabiliser.deflation()).map(coupled),
            pushed: Vec::with_capacity(system.contact().map_or(0, |contact| contact.cells().len())),
        };
        let zeros = || vec![0.0; majorant.dofs()];
        let is_carried = Carried::carries(operators);
        Self {
            inverse: stabiliser.solver(),
            lagging: 1.0 - majorant.damping_share(),
            sweeps,
            reason: if stabiliser.spares() {
                "parts of the body may move as rigid ones, which the stabilising matrix must not slow down, and that takes sums over all of their cells"
            } else if is_carried {
                "supports move, and the stabilising matrix must not brake what they carry, which reaches over all cells"
            } else {
                "a Gauss-Seidel iteration takes the cells one after the other, and a sweep takes all at once"
            },
            force: zeros(),
            change: zeros(),
            before: zeros(),
            touched: stabiliser.is_of_blocks().then(touched),
            carried: Carried::of(operators),
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

impl Touched {
    /// Lets contact push the cells after a step.
    fn meet(&mut self, step: &Step<'_>, state: &mut State) {
        let Some(contact) = step.system.contact() else {
            return;
        };
        let meeting = Meeting {
            inputs: step.inputs,
            dt: step.dt,
            mass: step.system.mass(),
            inertia: Inertia::InverseBlocks(self.blocks.entries()),
            kick: None,
            saturation: f64::INFINITY,
            is_staggered: true,
        };
        let Some(parts) = &mut self.coupled else {
            self.pushed.clear();
            contact.meet(&meeting, &mut AllShown, state, &mut self.pushed);
            return;
        };
        parts.kept.clone_from(&state.contact);
        let coupling = Coupled {
            contact,
            meeting: &meeting,
            deflation: &parts.deflation,
            kept: &parts.kept,
        };
        parts.contact.meet(coupling, state, &mut self.pushed);
    }
}

impl StepByHand for SolvedSteps {
    fn without_program(&self) -> &'static str {
        self.reason
    }

    fn is_staggered(&self) -> bool {
        true
    }

    fn meets_contact(&self) -> bool {
        self.touched.is_some()
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
        let centred = 1.0 - self.lagging;
        let when = (state.t(), dt, !running);
        let is_carried = step
            .system
            .as_linear()
            .is_some_and(|linear| self.carried.look(linear.operators(), when, centred));
        if is_carried {
            add_scaled(-1.0, &self.carried.impulse, &mut self.force);
        }
        self.inverse.solve(&self.force, &mut self.change);
        if is_carried {
            add_scaled(1.0, &self.carried.change, &mut self.change);
        }
        self.before.copy_from_slice(&state.v);
        let moving = state.u.iter_mut().zip(&mut state.v);
        for ((u, v), change) in moving.zip(&self.change) {
            *v = if running { *v + change } else { *change };
            *u += dt * *v;
        }
        if let Some(touched) = &mut self.touched {
            touched.meet(step, state);
        }
        state.a.resize(state.u.len(), 0.0);
        let kicks = state.a.iter_mut().zip(&state.v).zip(&self.before);
        for ((a, v), before) in kicks {
            *a = (*v - before) / weight;
        }
        let mut work = StepReport::ONE_FORCE;
        work.sweeps += self.sweeps;
        Ok(Stepped {
            work,
            velocity: VelocityTime::MiddleOfStep,
            damped: DampedAt::centred(1.0 - self.lagging),
            acceleration: Acceleration::Kick,
        })
    }

    fn remarks(&self) -> Vec<String> {
        let touched = self.touched.as_ref();
        let coupled = touched.and_then(|touched| touched.coupled.as_ref());
        let left = coupled.map_or(0.0, |coupled| coupled.contact.largest_left);
        let remark = || {
            format!(
                "contact of a part that may move as a rigid one was found to {left:.1e} of its impulse in a step at worst; shorter steps settle it"
            )
        };
        (left > SETTLED).then(remark).into_iter().collect()
    }
}
