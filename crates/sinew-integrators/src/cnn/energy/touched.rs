//! Sweeps that lower a step's potential with contact.

use sinew_cnn::Deflation;
use sinew_core::vectors::{dot, norm};
use sinew_core::{AllShown, Contact, EvaluationError, Inertia, Meeting, State, Step, StepReport};

use super::descent::{Descent, Found, MOST_HALVINGS, ROUNDING};
use super::point::{Law, Point};
use super::quadratic::Quadratic;
use crate::cnn::coupled_contact::{Coupled, CoupledContact};

/// Multiple of each cell's diagonal block, without inertia, with which the potential is bounded at first.
const FIRST_BOUND: f64 = 2.0;

/// The highest bound that leaves rigid motions their inertia: if the potential rises along such a motion, as it may for
/// a large rotation, no higher bound helps.
const MOST_DEFLATED: f64 = 64.0;

/// Displacement over a step at which sweeps start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SetOut {
    /// Displacement by the velocity at the beginning of the step, or zero if the law refuses it.
    Carried,
    /// Zero displacement.
    Still,
}

/// A displacement over a step, improved by sweeps: each minimises a bound of the potential, exactly and with contact.
///
/// The bound about a displacement z is `Phi(z) + g'(y - z) + (y - z)'(m M + beta B)(y - z)/2`, with the exact inertia
/// and the cells' diagonal blocks B of the rest, with beta large enough for a bound. Its minimum is the result of
/// contact, in the metric `dt^2 (m M + beta B)`, for cells with the contact-free displacement
/// `z - (m M + beta B)^-1 g`. So each sweep ends with forces of contact that fit its displacement, friction included.
/// It is a proximal gradient method with a momentum that restarts if it leads uphill (Beck and Teboulle, SIAM J.
/// Imaging Sci. 2, 2009; O'Donoghue and Candes, Found. Comput. Math. 15, 2015).
///
/// Sweeps start at `z = dt v`, where `y - z` is of the order of `dt^2`: the first one continues free motion.
/// A bound of the inertia, such as twice the inertia, would keep only a share of the velocity in each step.
///
/// B has no effect on rigid motions of parts that may move as rigid bodies ([`Deflation`]): such a part turns by z as
/// far as it turns in dt. With one block for each cell the stiffness that couples a cell to its neighbours would slow
/// such motions down.
///
/// One sweep from z = 0 with whole blocks ends where `Phi(y) <= Phi(0) + lambda'y - y'(m M + beta B)y/2` with the
/// forces lambda, for every law: the potential rises at most by the work of contact. If other sweeps violate this, this
/// sweep is taken. Coupled contacts are found by an iteration, whose residual may be larger than that: then the body
/// keeps its displacement, unless contact pushes it.
pub(super) struct Touched {
    /// The state that contact receives: that at the start of the step, with other u, v and contact variables.
    shown: State,
    /// The displacement z (m) from which a sweep starts, and the law there.
    origin: Vec<f64>,
    base: Point,
    trial: Point,
    /// Displacement (m) before the last sweep.
    before: Vec<f64>,
    gradient: Vec<f64>,
    /// Displacement (m) from z to a trial.
    change: Vec<f64>,
    /// Displacement (m) in the last sweep.
    swept: Vec<f64>,
    damped: Vec<f64>,
    /// Inverse blocks of the metric (1/kg).
    inverse: Vec<f64>,
    /// Present if parts may move as rigid bodies.
    coupled: Option<CoupledContact>,
    /// True if the metric leaves rigid motions their inertia.
    is_deflated: bool,
    pushed: Vec<u32>,
    /// History variables of contact in the last accepted sweep, or before the step.
    kept: Vec<f64>,
    /// Error of the law at the last trial, if it refused it.
    refused: Option<EvaluationError>,
}

/// A step that is taken, from a point of a law on.
#[derive(Clone, Copy)]
pub(super) struct Taken<'a> {
    pub(super) law: &'a Law<'a>,
    pub(super) quadratic: &'a Quadratic<'a>,
    pub(super) start: &'a Point,
    pub(super) contact: &'a dyn Contact,
    pub(super) step: &'a Step<'a>,
    pub(super) state: &'a State,
}

impl Touched {
    pub(super) fn new(contact: &dyn Contact, descent: &Descent, dofs: usize) -> Self {
        let rigid = descent.rigid.as_ref();
        let zeros = || vec![0.0; dofs];
        Self {
            shown: State::at_rest(dofs),
            origin: zeros(),
            base: Point::new(dofs),
            trial: Point::new(dofs),
            before: zeros(),
            gradient: zeros(),
            change: zeros(),
            swept: zeros(),
            damped: zeros(),
            inverse: vec![0.0; 3 * dofs],
            coupled: rigid.map(|rigid| CoupledContact::new(contact, dofs, rigid.deflation.count())),
            is_deflated: false,
            pushed: Vec::new(),
            kept: Vec::new(),
            refused: None,
        }
    }

    /// Runs `sweeps` sweeps that lower the potential; `descent` receives the result.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law has a force but no diagonal blocks or no damping, or is undefined for the
    /// displacements that tools cause.
    pub(super) fn lower(
        &mut self,
        taken: Taken<'_>,
        descent: &mut Descent,
        (set_out, sweeps): (SetOut, u32),
        work: &mut StepReport,
    ) -> Result<Found, EvaluationError> {
        let Taken {
            law,
            quadratic,
            start,
            state,
            step,
            ..
        } = taken;
        descent.restart(start);
        descent.look(law, quadratic, start)?;
        work.sweeps += 1;
        self.shown.clone_from(state);
        self.kept.clone_from(&state.contact);
        self.before.fill(0.0);
        if set_out == SetOut::Carried {
            for (before, v) in self.before.iter_mut().zip(&state.v) {
                *before = step.dt * v;
            }
            if let (Some(rigid), false) = (&mut descent.rigid, law.is_quadratic) {
                rigid.turn(&start.u, quadratic.masses, &mut self.before);
            }
        }
        let (mut bound, mut momentum) = (FIRST_BOUND, 1.0_f64);
        let mut share = match set_out {
            // From where `before` is.
            SetOut::Carried => -1.0,
            SetOut::Still => 0.0,
        };
        self.is_deflated = set_out == SetOut::Carried && descent.rigid.is_some();
        for ((u, start), before) in self.trial.u.iter_mut().zip(&start.u).zip(&self.before) {
            *u = start + before;
        }
        self.weigh(taken, descent, bound);
        for sweep in 0..sweeps {
            self.set_out(taken, descent, share, work)?;
            if !norm(&self.gradient).is_finite() {
                return Ok(Found::NotFinite);
            }
            if !self.sweep(taken, descent, &mut bound, work)? {
                // Forces of a trial that is not taken are none.
                self.shown.contact.clone_from(&self.kept);
                if sweep > 0 {
                    return Ok(Found::Lower);
                }
                // Where tools are does not depend on the bound: no higher one leads back to where the law is defined.
                return match (set_out, self.refused.take()) {
                    (SetOut::Still, Some(refused)) => Err(refused),
                    _ => Ok(Found::Nothing),
                };
            }
            self.kept.clone_from(&self.shown.contact);
            let places = self.swept.iter_mut().zip(&self.trial.u).zip(&start.u);
            for ((swept, u), start) in places {
                *swept = u - start;
            }
            if sweep > 0 {
                self.before.copy_from_slice(&descent.moved);
            }
            descent.moved.copy_from_slice(&self.swept);
            std::mem::swap(&mut descent.reached, &mut self.trial);
            for (swept, before) in self.swept.iter_mut().zip(&self.before) {
                *swept -= before;
            }
            let uphill = self.taken_out(descent, &self.swept)
                - descent.blocks.product(&self.change, &self.swept);
            let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            (share, momentum) = match uphill > 0.0 {
                true => (0.0, 1.0),
                false => ((momentum - 1.0) / next, next),
            };
        }
        Ok(Found::Lower)
    }

    /// Keeps the displacement of the beginning of the step, with the contact forces of the step before, if contact
    /// pushes no cell away from there.
    pub(super) fn stay(
        &mut self,
        (contact, step, state): (&dyn Contact, &Step<'_>, &State),
        descent: &mut Descent,
        start: &Point,
    ) -> bool {
        self.shown.u.copy_from_slice(&start.u);
        self.shown.v.fill(0.0);
        self.push(contact, step, state, None);
        self.shown.contact.clone_from(&state.contact);
        let is_free = self.shown.u == start.u;
        if is_free {
            descent.restart(start);
        }
        is_free
    }

    /// Applies contact to the cells at their contact-free positions, in the metric of the last sweep.
    fn push(
        &mut self,
        contact: &dyn Contact,
        step: &Step<'_>,
        state: &State,
        deflation: Option<&Deflation>,
    ) {
        self.shown.contact.clone_from(&state.contact);
        self.pushed.clear();
        let meeting = Meeting {
            inputs: step.inputs,
            dt: step.dt,
            mass: step.system.mass(),
            inertia: Inertia::InverseBlocks(&self.inverse),
            kick: None,
            saturation: f64::INFINITY,
            is_staggered: false,
        };
        let (shown, pushed) = (&mut self.shown, &mut self.pushed);
        match (deflation, &mut self.coupled) {
            (Some(deflation), Some(coupled)) => {
                let coupling = Coupled {
                    contact,
                    meeting: &meeting,
                    deflation,
                    kept: &state.contact,
                };
                coupled.meet(coupling, shown, pushed);
            }
            _ => contact.meet(&meeting, &mut AllShown, shown, pushed),
        }
    }

    /// The state after the sweeps as contact left it, at the clock of the start.
    pub(super) fn shown(&self) -> &State {
        &self.shown
    }

    /// Moves the starting point of a sweep beyond the end of the last sweep by a share of the last displacement, and
    /// finds the slope there.
    fn set_out(
        &mut self,
        taken: Taken<'_>,
        descent: &Descent,
        share: f64,
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        let Taken {
            law,
            quadratic,
            start,
            ..
        } = taken;
        let places = self.origin.iter_mut().zip(&descent.moved).zip(&self.before);
        for ((origin, moved), before) in places {
            *origin = moved + share * (moved - before);
        }
        let mut is_known = share == 0.0;
        if !is_known {
            for ((u, start), origin) in self.base.u.iter_mut().zip(&start.u).zip(&self.origin) {
                *u = start + origin;
            }
            *work += StepReport::ONE_FORCE;
            if self.base.evaluate(law).is_err() || !self.base.is_finite() {
                // Too far for the law.
                self.origin.copy_from_slice(&descent.moved);
                is_known = true;
            }
        }
        if is_known {
            self.base.clone_from(&descent.reached);
        }
        if law.is_damped() {
            law.damping_product(&self.origin, &mut self.damped)?;
            work.sweeps += 1;
        }
        let damped = law.is_damped().then_some(&*self.damped);
        quadratic.write_slope((&self.origin, damped), &self.base.force, &mut self.gradient);
        Ok(())
    }

    /// Finds the minimum of a trial bound, which is raised until it is above the potential; returns false if no such
    /// bound is found.
    fn sweep(
        &mut self,
        taken: Taken<'_>,
        descent: &mut Descent,
        bound: &mut f64,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        for _ in 0..=MOST_HALVINGS {
            self.meet(taken, descent);
            *work += StepReport::ONE_FORCE;
            if self.is_below(taken, descent, *bound, work)? {
                return Ok(true);
            }
            work.backtracks += 1;
            *bound *= 2.0;
            self.weigh(taken, descent, *bound);
        }
        Ok(false)
    }

    /// Computes the metric of a bound.
    fn weigh(&mut self, taken: Taken<'_>, descent: &mut Descent, bound: f64) {
        let dt = taken.step.dt;
        descent.factorise(taken.quadratic, bound);
        let scale = 1.0 / (dt * dt);
        descent.blocks.write_inverse(scale, &mut self.inverse);
        self.is_deflated &= bound <= MOST_DEFLATED;
        if let (Some(rigid), true) = (&mut descent.rigid, self.is_deflated) {
            let quadratic = taken.quadratic;
            let inertia = |dof: usize| quadratic.mass_weight * quadratic.masses[dof];
            let about = (!taken.law.is_quadratic).then_some(&*self.trial.u);
            let (added, inverse) = ((bound, &*descent.own), (scale, &*self.inverse));
            rigid.deflation.weigh(about, added, inverse, inertia);
        }
    }

    /// Amount (J) by which the metric is less than its blocks, for the displacement from z to the trial and another
    /// one.
    fn taken_out(&self, descent: &Descent, other: &[f64]) -> f64 {
        match &descent.rigid {
            Some(rigid) if self.is_deflated => rigid.deflation.taken_out(&self.change, other),
            _ => 0.0,
        }
    }

    /// Moves the cells down the slope and lets contact push them.
    fn meet(&mut self, taken: Taken<'_>, descent: &Descent) {
        let dt = taken.step.dt;
        self.change.copy_from_slice(&self.gradient);
        descent.blocks.solve(&mut self.change);
        let deflation = match &descent.rigid {
            Some(rigid) if self.is_deflated => Some(&rigid.deflation),
            _ => None,
        };
        if let Some(deflation) = deflation {
            deflation.correct(&self.gradient, &mut self.change);
        }
        let State { u, v, .. } = &mut self.shown;
        let values = u.iter_mut().zip(v).zip(&taken.start.u);
        let values = values.zip(self.origin.iter().zip(&self.change));
        for (((u, v), start), (origin, slope)) in values {
            let moved = origin - slope;
            *u = start + moved;
            *v = moved / dt;
        }
        self.push(taken.contact, taken.step, taken.state, deflation);
        self.trial.u.copy_from_slice(&self.shown.u);
        let values = self.change.iter_mut().zip(&self.trial.u);
        let values = values.zip(taken.start.u.iter().zip(&self.origin));
        for ((change, u), (start, origin)) in values {
            *change = (u - start) - origin;
        }
    }

    /// True if the potential at the trial is not above the bound there.
    fn is_below(
        &mut self,
        taken: Taken<'_>,
        descent: &Descent,
        bound: f64,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        let Taken { law, quadratic, .. } = taken;
        self.refused = self.trial.evaluate(law).err();
        if self.refused.is_some() || !self.trial.is_finite() {
            return Ok(false);
        }
        let change = &self.change;
        // The inertia is the same in both.
        let mut curved = 0.0;
        if law.is_damped() {
            law.damping_product(change, &mut self.damped)?;
            work.sweeps += 1;
            curved = quadratic.damping_weight * dot(change, &self.damped);
        }
        let beyond =
            self.base
                .energy_beyond_slope(&self.trial, (change, 1.0), (law, descent.stiff));
        let forces = norm(&self.base.force) + norm(&self.trial.force);
        let rounding = ROUNDING * norm(change) * forces;
        let limit = bound * descent.own_product(change) - self.taken_out(descent, change);
        Ok(0.5 * curved + beyond <= 0.5 * limit + rounding)
    }
}
