//! Steps whose energy never rises.

use sinew_core::vectors::{add_scaled, dot, dot_of_difference, scale, weighted_dot};
use sinew_core::{
    Acceleration, Contact, DampedAt, ElasticLaw, EvaluationError, Fact, LoadTime, Needs, State,
    Step, StepError, StepReport, Stepped, System, Velocities,
};

use super::certificate::Certificate;
use super::descent::{Descent, Found};
use super::kind::Kind;
use super::point::{Law, Point};
use super::quadratic::Quadratic;
use super::touched::{SetOut, Taken, Touched};
use crate::StepByHand;

/// Relative excess of the kinetic energy that counts as rounding when the limiter removes it.
const ROUNDING: f64 = 1e-12;

/// The steps of [`super::CnnEnergy`].
pub struct EnergySteps {
    id: &'static str,
    kind: Kind,
    sweeps: u32,
    descent: Descent,
    /// Present if the body has contact.
    touched: Option<Touched>,
    start: Point,
    /// Loads at the start and the end of the step, and their mean, for the work (N).
    load_before: Vec<f64>,
    load: Vec<f64>,
    mean_load: Vec<f64>,
    /// The linear part of the step's potential (N), and the damping force at one end of the step.
    pull: Vec<f64>,
    damped: Vec<f64>,
    /// Buffer for the displacement (m) at which stiffness damping is evaluated throughout a step.
    middle: Vec<f64>,
    /// The force (N) of that damping due to the motion of supports.
    drag: Vec<f64>,
    /// Velocity at the end of the step (m/s), and acceleration at its start (m/s^2).
    v: Vec<f64>,
    a: Vec<f64>,
    /// The time whose motion of supports that acceleration has in its stiffness damping: for an acceleration kept in
    /// the state, the time at the end of the last step.
    damped_at: LoadTime<'static>,
    certificate: Certificate,
}

/// Result of an attempt.
struct Attempt {
    /// Energy (J) that remains for the velocity; below 0 if the displacement alone takes more than is available.
    room: f64,
    found: Found,
}

impl Attempt {
    /// True if its displacement may be accepted; false if the remaining energy is NaN.
    fn has_room(&self) -> bool {
        self.room >= 0.0
    }
}

impl EnergySteps {
    /// Steps of a system, whose certificate continues the counts of `before`, as after a cut.
    pub(super) fn new(
        id: &'static str,
        system: &dyn System,
        (kind, sweeps): (Kind, u32),
        before: Option<Self>,
    ) -> Self {
        let zeros = || vec![0.0; system.dofs()];
        let descent = Descent::new(system);
        Self {
            id,
            kind,
            sweeps,
            touched: system
                .contact()
                .map(|contact| Touched::new(contact, &descent, system.dofs())),
            descent,
            start: Point::new(system.dofs()),
            load_before: zeros(),
            load: zeros(),
            mean_load: zeros(),
            pull: zeros(),
            damped: zeros(),
            middle: zeros(),
            drag: zeros(),
            v: zeros(),
            a: zeros(),
            damped_at: LoadTime::at(0.0),
            certificate: before.map_or_else(Certificate::default, |before| before.certificate),
        }
    }

    /// Returns the loads that the formula takes at both ends of a step, and the mean of both. Loads that follow the
    /// surface are taken on the surface at the beginning: they are constant in the step, as the guarantee requires.
    fn take_loads(&mut self, step: &Step<'_>, state: &State) -> LoadTime<'static> {
        let t = state.t();
        let under = |when: LoadTime<'_>, out: &mut [f64]| {
            let when = when.under(step.inputs);
            step.system.external_force(when, &state.u, out);
        };
        match self.kind {
            Kind::ImplicitEuler => {
                let end = LoadTime::end_of(t, step.dt);
                under(end, &mut self.load);
                self.mean_load.copy_from_slice(&self.load);
                end
            }
            Kind::Trapezoidal => {
                let [start, end] = ends(t, step.dt);
                under(start, &mut self.load_before);
                under(end, &mut self.load);
                let values = self.load_before.iter().zip(&self.load);
                for (mean, (before, after)) in self.mean_load.iter_mut().zip(values) {
                    *mean = 0.5 * (before + after);
                }
                end
            }
        }
    }

    /// Finds the acceleration at the beginning of a step: from the force, or from that of the end of the last step
    /// and the change of the loads since.
    fn find_acceleration(
        &mut self,
        step: &Step<'_>,
        law: &dyn ElasticLaw,
        state: &State,
    ) -> Result<StepReport, StepError> {
        let t = state.t();
        let masses = step.system.mass();
        if state.acceleration == Acceleration::Same
            && let Some(last) = state.clock.last_step()
        {
            let [_, before] = ends(t - last, last);
            self.damped_at = before;
            let before = before.under(step.inputs);
            step.system.external_force(before, &state.u, &mut self.pull);
            let change = self.load_before.iter().zip(&self.pull).zip(masses);
            let values = self.a.iter_mut().zip(&state.a).zip(change);
            for ((a, kept), ((after, before), mass)) in values {
                *a = kept + (after - before) / mass;
            }
            return Ok(StepReport::default());
        }
        let [load, _] = ends(t, step.dt);
        self.damped_at = load;
        let law = law_at(law, step, load, 0.0, state);
        self.start.u.copy_from_slice(&state.u);
        let evaluated = self.start.evaluate(&law);
        evaluated.map_err(|source| refused(load, source))?;
        let damped = law.damping_force(&state.u, &state.v, &mut self.damped);
        damped.map_err(|source| refused(load, source))?;
        let mut work = StepReport::ONE_FORCE;
        work.sweeps += u64::from(law.is_viscous());
        let rate = law.law.damping().mass;
        for (dof, a) in self.a.iter_mut().enumerate() {
            let force = self.load_before[dof] - self.start.force[dof] - self.damped[dof];
            *a = force / masses[dof] - rate * state.v[dof];
        }
        Ok(work)
    }

    /// Finds the point at which stiffness damping is evaluated in the step: half way, by the velocity at its start, so
    /// that a rotating body is not damped and the order is kept; or the start of the step, if the law is undefined half
    /// way. The damping force due to the motion of supports is a load of the step.
    fn hold_viscosity<'a>(
        &mut self,
        law: Law<'a>,
        (step, state): (&Step<'a>, &State),
        middle: &'a mut [f64],
        work: &mut StepReport,
    ) -> Result<Law<'a>, EvaluationError> {
        if !law.is_viscous() {
            return Ok(law);
        }
        let half = 0.5 * step.dt;
        let values = middle.iter_mut().zip(&state.u).zip(&state.v);
        for ((middle, u), v) in values {
            *middle = u + half * v;
        }
        let mut when = LoadTime::middle_of(state.t(), step.dt).under(step.inputs);
        work.sweeps += 1;
        if self
            .descent
            .take_viscosity(&law.damped_at(when, middle))
            .is_err()
        {
            // Too far for the law.
            middle.copy_from_slice(&state.u);
            when = LoadTime::start_of(state.t(), step.dt).under(step.inputs);
            work.sweeps += 1;
            self.descent.take_viscosity(&law.damped_at(when, middle))?;
        }
        let law = law.damped_at(when, middle);
        if law.law.supports_move() {
            work.sweeps += 1;
            law.law
                .viscous_force(&law.damped(), Velocities::Supports, &mut self.drag)?;
            add_scaled(-1.0, &self.drag, &mut self.mean_load);
        }
        Ok(law)
    }

    /// Lowers the potential of a formula from the start of the step on.
    fn attempt(
        &mut self,
        kind: Kind,
        law: &Law<'_>,
        (step, state): (&Step<'_>, &State),
        work: &mut StepReport,
    ) -> Result<Attempt, EvaluationError> {
        let (dt, masses) = (law.dt, step.system.mass());
        let rate = law.law.damping().mass;
        let [of_mass, of_damping] = kind.weights(dt);
        match kind {
            Kind::ImplicitEuler => {
                let values = self.pull.iter_mut().zip(masses).zip(&state.v);
                for (((pull, mass), v), load) in values.zip(&self.mean_load) {
                    *pull = mass * v / dt + load;
                }
            }
            Kind::Trapezoidal => {
                if law.is_damped() {
                    // That of the start of the step, which its acceleration has lost already: in the step it is held half way.
                    let at_start = Law {
                        load: self.damped_at.under(step.inputs),
                        ..*law
                    };
                    at_start.damping_force(&state.u, &state.v, &mut self.damped)?;
                    work.sweeps += u64::from(law.is_viscous());
                }
                for (dof, pull) in self.pull.iter_mut().enumerate() {
                    let (v, a) = (state.v[dof], self.a[dof]);
                    let inertia = masses[dof] * (4.0 * v / dt + a + rate * v);
                    let drag = 2.0 * self.drag[dof];
                    *pull = inertia + self.damped[dof] - drag + self.load[dof];
                }
            }
        }
        let quadratic = Quadratic {
            masses,
            mass_weight: of_mass + of_damping * rate,
            damping_weight: of_damping,
            pull: &self.pull,
        };
        let kinetic = 0.5 * weighted_dot(masses, &state.v, &state.v);
        let (Some(touched), Some(contact)) = (&mut self.touched, step.system.contact()) else {
            let found = self
                .descent
                .lower(law, &quadratic, &self.start, self.sweeps, work)?;
            return Ok(Attempt {
                room: kinetic - self.potential_change(law),
                found,
            });
        };
        let taken = Taken {
            law,
            quadratic: &quadratic,
            start: &self.start,
            contact,
            step,
            state,
        };
        let carried = (SetOut::Carried, self.sweeps);
        let found = touched.lower(taken, &mut self.descent, carried, work)?;
        let room = kinetic - self.potential_change(law) + self.work_of_contact(contact, state);
        if found == Found::NotFinite || found == Found::Lower && room >= 0.0 {
            return Ok(Attempt { room, found });
        }
        work.fallbacks += 1;
        let Some(touched) = &mut self.touched else {
            return Ok(Attempt { room, found });
        };
        let found = touched.lower(taken, &mut self.descent, (SetOut::Still, 1), work)?;
        let room = kinetic - self.potential_change(law) + self.work_of_contact(contact, state);
        Ok(Attempt { room, found })
    }

    /// Work of contact (J) in the step from a state on; 0 if nothing touches the body.
    fn work_of_contact(&self, contact: &dyn Contact, state: &State) -> f64 {
        let after = self.touched.as_ref().map(Touched::shown);
        after.map_or(0.0, |after| contact.work(after) - contact.work(state))
    }

    /// Change of the elastic energy without the work of the loads (J) since the start of the step.
    fn potential_change(&self, law: &Law<'_>) -> f64 {
        let moved = &self.descent.moved;
        let beyond = self.start.energy_beyond_slope(
            &self.descent.reached,
            (moved, 1.0),
            (law, self.descent.stiff),
        );
        dot_of_difference(&self.start.force, &self.mean_load, moved) + beyond
    }
}

/// The loads that the trapezoidal rule takes at both ends of a step.
fn ends(t: f64, dt: f64) -> [LoadTime<'static>; 2] {
    LoadTime::at_both_ends(t, dt, 0.5)
}

fn law_at<'a>(
    law: &'a dyn ElasticLaw,
    step: &Step<'a>,
    load: LoadTime<'_>,
    dt: f64,
    state: &'a State,
) -> Law<'a> {
    Law {
        law,
        is_quadratic: step.system.as_linear().is_some(),
        load: load.under(step.inputs),
        dt,
        v: &state.v,
        internal: &state.internal,
        held_at: (load.under(step.inputs), &state.u),
    }
}

fn refused(load: LoadTime<'_>, source: EvaluationError) -> StepError {
    StepError::Refused {
        t: load.t(),
        source,
    }
}

impl StepByHand for EnergySteps {
    fn without_program(&self) -> &'static str {
        "the length of each sweep's step follows from sums over all cells"
    }

    fn meets_contact(&self) -> bool {
        self.kind == Kind::ImplicitEuler
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        let mut middle = std::mem::take(&mut self.middle);
        middle.resize(state.u.len(), 0.0);
        let stepped = self.take_step(step, state, &mut middle);
        self.middle = middle;
        stepped
    }

    fn facts(&self) -> Vec<Fact> {
        self.certificate.facts()
    }

    fn remarks(&self) -> Vec<String> {
        vec![self.certificate.in_words()]
    }
}

impl EnergySteps {
    /// Takes a step, with a buffer for a displacement.
    fn take_step(
        &mut self,
        step: &Step<'_>,
        state: &mut State,
        middle: &mut [f64],
    ) -> Result<Stepped, StepError> {
        let law = step.system.as_elastic();
        let elastic = law.ok_or_else(|| Needs::Tangents.lacking(self.id))?;
        let (t, dt, masses) = (state.t(), step.dt, step.system.mass());
        let end = self.take_loads(step, state);
        let mut work = StepReport::default();
        if self.kind == Kind::Trapezoidal {
            work += self.find_acceleration(step, elastic, state)?;
        }
        let inaccurate = |id, reason: &str| StepError::Inaccurate {
            integrator: id,
            t,
            reason: reason.to_owned(),
        };
        let kinetic = 0.5 * weighted_dot(masses, &state.v, &state.v);
        if !kinetic.is_finite() {
            return Err(inaccurate(self.id, "the kinetic energy is not finite"));
        }

        let law = law_at(elastic, step, end, dt, state);
        let refused = |source| refused(end, source);
        self.start.u.copy_from_slice(&state.u);
        self.start.evaluate(&law).map_err(refused)?;
        work += StepReport::ONE_FORCE;
        if !self.start.is_finite() {
            return Err(inaccurate(self.id, "the elastic energy is not finite"));
        }
        let law = self
            .hold_viscosity(law, (step, state), middle, &mut work)
            .map_err(refused)?;
        let mut kind = self.kind;
        let mut attempt = self
            .attempt(kind, &law, (step, state), &mut work)
            .map_err(refused)?;
        let sound = attempt.has_room() && attempt.found == Found::Lower;
        if kind == Kind::Trapezoidal && !sound {
            work.fallbacks += 1;
            kind = Kind::ImplicitEuler;
            attempt = self
                .attempt(kind, &law, (step, state), &mut work)
                .map_err(refused)?;
        }
        if attempt.found == Found::NotFinite {
            return Err(inaccurate(self.id, "the forces are not finite"));
        }
        if let (false, Some(touched), Some(contact)) =
            (attempt.has_room(), &mut self.touched, step.system.contact())
        {
            if attempt.room.is_nan() {
                let reason = "contact leads to energies that are no numbers";
                return Err(inaccurate(self.id, reason));
            }
            let is_free = touched.stay((contact, step, state), &mut self.descent, &self.start);
            if !is_free {
                attempt = self
                    .attempt(kind, &law, (step, state), &mut work)
                    .map_err(refused)?;
            }
            // What tools push cannot stay: it is left without a velocity, and the certificate counts what it gained.
            attempt.room = if is_free { kinetic } else { 0.0 };
        }
        if !attempt.has_room() {
            // Rounding alone can do that: the potential is not higher than it was. To stay costs no energy.
            self.descent.restart(&self.start);
            attempt.room = kinetic;
        }

        for ((new, v), moved) in self.v.iter_mut().zip(&state.v).zip(&self.descent.moved) {
            *new = kind.velocity(*v, *moved, dt);
        }
        let mut after = 0.5 * weighted_dot(masses, &self.v, &self.v);
        if after > attempt.room {
            work.limiter_hits += u64::from(after - attempt.room > ROUNDING * kinetic.max(after));
            scale(&mut self.v, (attempt.room / after).sqrt());
            after = 0.5 * weighted_dot(masses, &self.v, &self.v);
        }
        let contact = step.system.contact();
        let of_contact = contact.map_or(0.0, |contact| self.work_of_contact(contact, state));
        let gained = (after - kinetic) - of_contact
            + (self.descent.reached.energy - self.start.energy)
            - dot(&self.mean_load, &self.descent.moved);
        let energy = kinetic + self.start.energy.abs();
        self.certificate.count(gained, energy, &work);

        if self.kind == Kind::Trapezoidal {
            let reached = &self.descent.reached;
            law.damping_force(&reached.u, &self.v, &mut self.damped)
                .map_err(refused)?;
            work.sweeps += u64::from(law.is_viscous());
            let rate = elastic.damping().mass;
            state.a.resize(self.v.len(), 0.0);
            for (dof, a) in state.a.iter_mut().enumerate() {
                let force = self.load[dof] - reached.force[dof] - self.damped[dof];
                *a = force / masses[dof] - rate * self.v[dof];
            }
        }
        state.u.copy_from_slice(&self.descent.reached.u);
        state.v.copy_from_slice(&self.v);
        if let Some(touched) = &self.touched {
            state.contact.clone_from(&touched.shown().contact);
        }
        let (acceleration, damped) = match self.kind {
            Kind::ImplicitEuler => (Acceleration::None, DampedAt::WAY_OF_STEP),
            Kind::Trapezoidal => (Acceleration::Same, DampedAt::default()),
        };
        Ok(Stepped {
            acceleration,
            damped,
            ..Stepped::at_same_time(work)
        })
    }
}
