//! Sweeps that lower a step's potential while something pushes cells from outside.

use sinew_core::vectors::{dot, norm, weighted_dot};
use sinew_core::{AllShown, Contact, EvaluationError, Inertia, Meeting, State, Step, StepReport};

use super::descent::{Descent, Found, MOST_HALVINGS, Quadratic, ROUNDING};
use super::point::{Law, Point};

/// Times each cell's own block by which the potential is bounded at first.
const FIRST_BOUND: f64 = 2.0;

/// A displacement over a step, improved by sweeps of which each minimises a bound of the potential, exactly and with contact.
///
/// The bound about a displacement z is `Phi(z) + g'(y - z) + beta/2 (y - z)'B (y - z)`, with the cells' own blocks B. Its minimum lies where
/// contact, in the metric `beta dt^2 B`, leaves the cells that were led to `z - B^-1 g/beta`. So each sweep ends with forces of contact that fit its
/// displacement, friction included. It is a proximal gradient method with a momentum that begins anew where it leads uphill (Beck and Teboulle,
/// SIAM J. Imaging Sci. 2, 2009; O'Donoghue and Candes, Found. Comput. Math. 15, 2015).
///
/// After the first sweep, from z = 0, `Phi(y) <= Phi(0) + lambda'y - beta/2 y'B y` with the forces lambda, for every law: the potential rises by the
/// work of contact at most. Where later sweeps do not keep to that, the first one stands. Contacts that act on each other are found by an iteration, and what it leaves may be
/// more than that: then the body stays where it is, unless something pushes it from there.
pub(super) struct Touched {
    /// The state that contact is shown: that at the start of the step, but for u, v and what contact keeps.
    shown: State,
    /// The displacement z (m) from which a sweep sets out, and the law there.
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
    pushed: Vec<u32>,
    first: FirstSweep,
    /// What contact kept in the last sweep that was taken, or before the step.
    kept: Vec<f64>,
    /// Why the law refused the last trial, if it did.
    refused: Option<EvaluationError>,
}

/// What the first sweep leads to.
struct FirstSweep {
    /// Displacement (m).
    moved: Vec<f64>,
    reached: Point,
    /// What contact keeps.
    contact: Vec<f64>,
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
    pub(super) fn new(dofs: usize) -> Self {
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
            pushed: Vec::new(),
            first: FirstSweep {
                moved: zeros(),
                reached: Point::new(dofs),
                contact: Vec::new(),
            },
            kept: Vec::new(),
            refused: None,
        }
    }

    /// Lowers the potential by so many sweeps from the start of the step on; their end is left in `descent`.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law has no own blocks or no damping where it has a force, or refuses where tools push the tissue.
    pub(super) fn lower(
        &mut self,
        taken: Taken<'_>,
        descent: &mut Descent,
        sweeps: u32,
        work: &mut StepReport,
    ) -> Result<Found, EvaluationError> {
        let Taken {
            law,
            quadratic,
            start,
            state,
            ..
        } = taken;
        descent.restart(start);
        descent.factorise(law, quadratic, start)?;
        work.sweeps += 1;
        self.shown.clone_from(state);
        self.kept.clone_from(&state.contact);
        self.before.fill(0.0);
        let (mut bound, mut share, mut momentum) = (FIRST_BOUND, 0.0, 1.0_f64);
        self.weigh(descent, bound, taken.step.dt);
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
                return self.refused.take().map_or(Ok(Found::Nothing), Err);
            }
            self.kept.clone_from(&self.shown.contact);
            let places = self.swept.iter_mut().zip(&self.trial.u).zip(&start.u);
            for ((swept, u), start) in places {
                *swept = u - start;
            }
            self.before.copy_from_slice(&descent.moved);
            descent.moved.copy_from_slice(&self.swept);
            std::mem::swap(&mut descent.reached, &mut self.trial);
            if sweep == 0 {
                self.first.moved.copy_from_slice(&descent.moved);
                self.first.reached.clone_from(&descent.reached);
                self.first.contact.clone_from(&self.shown.contact);
            }
            for (swept, before) in self.swept.iter_mut().zip(&self.before) {
                *swept -= before;
            }
            let uphill = -descent.blocks.product(&self.change, &self.swept);
            let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            (share, momentum) = match uphill > 0.0 {
                true => (0.0, 1.0),
                false => ((momentum - 1.0) / next, next),
            };
        }
        Ok(Found::Lower)
    }

    /// Goes back to what the first sweep led to.
    pub(super) fn back_to_first(&mut self, descent: &mut Descent) {
        descent.moved.copy_from_slice(&self.first.moved);
        descent.reached.clone_from(&self.first.reached);
        self.shown.contact.clone_from(&self.first.contact);
    }

    /// Stays where the step began, with the forces of the step before, if nothing pushes a cell away from there.
    pub(super) fn stay(
        &mut self,
        (contact, step, state): (&dyn Contact, &Step<'_>, &State),
        descent: &mut Descent,
        start: &Point,
    ) -> bool {
        self.shown.u.copy_from_slice(&start.u);
        self.shown.v.fill(0.0);
        self.push(contact, step, state);
        self.shown.contact.clone_from(&state.contact);
        let is_free = self.shown.u == start.u;
        if is_free {
            descent.restart(start);
        }
        is_free
    }

    /// Lets contact push the cells from where they are led to, in the metric of the last sweep.
    fn push(&mut self, contact: &dyn Contact, step: &Step<'_>, state: &State) {
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
        contact.meet(&meeting, &mut AllShown, &mut self.shown, &mut self.pushed);
    }

    /// The state after the sweeps as contact left it, at the clock of the start.
    pub(super) fn shown(&self) -> &State {
        &self.shown
    }

    /// Sets out by a share of the last displacement beyond where the last sweep ended, and finds the slope there.
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

    /// Goes to the minimum of a bound, which is raised until it is one; whether that comes to an end.
    fn sweep(
        &mut self,
        taken: Taken<'_>,
        descent: &mut Descent,
        bound: &mut f64,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        for _ in 0..=MOST_HALVINGS {
            self.meet(taken, descent, *bound);
            *work += StepReport::ONE_FORCE;
            if self.is_below(taken, descent, *bound, work)? {
                return Ok(true);
            }
            work.backtracks += 1;
            *bound *= 2.0;
            self.weigh(descent, *bound, taken.step.dt);
        }
        Ok(false)
    }

    /// Takes the blocks, so many times, for the metric of contact in steps of `dt` (s).
    fn weigh(&mut self, descent: &Descent, bound: f64, dt: f64) {
        let factor = 1.0 / (bound * dt * dt);
        descent.blocks.write_inverse(factor, &mut self.inverse);
    }

    /// Leads the cells down the slope and lets contact push them.
    fn meet(&mut self, taken: Taken<'_>, descent: &Descent, bound: f64) {
        let dt = taken.step.dt;
        self.change.copy_from_slice(&self.gradient);
        descent.blocks.solve(&mut self.change);
        let State { u, v, .. } = &mut self.shown;
        let values = u.iter_mut().zip(v).zip(&taken.start.u);
        let values = values.zip(self.origin.iter().zip(&self.change));
        for (((u, v), start), (origin, slope)) in values {
            let moved = origin - slope / bound;
            *u = start + moved;
            *v = moved / dt;
        }
        self.push(taken.contact, taken.step, taken.state);
        self.trial.u.copy_from_slice(&self.shown.u);
        let values = self.change.iter_mut().zip(&self.trial.u);
        let values = values.zip(taken.start.u.iter().zip(&self.origin));
        for ((change, u), (start, origin)) in values {
            *change = (u - start) - origin;
        }
    }

    /// Whether the potential at the trial is not above the bound there.
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
        let mut curved = quadratic.mass_weight * weighted_dot(quadratic.masses, change, change);
        if law.is_damped() {
            law.damping_product(change, &mut self.damped)?;
            work.sweeps += 1;
            curved += quadratic.damping_weight * dot(change, &self.damped);
        }
        let beyond =
            self.base
                .energy_beyond_slope(&self.trial, (change, 1.0), (law, descent.stiff));
        let forces = norm(&self.base.force) + norm(&self.trial.force);
        let rounding = ROUNDING * norm(change) * forces;
        let limit = bound * descent.blocks.product(change, change);
        Ok(0.5 * curved + beyond <= 0.5 * limit + rounding)
    }
}
