//! Laws on systems with internal variables.

use std::sync::{Mutex, PoisonError};

use super::boxed::Boxed;
use super::forces::lacks;
use super::problems::{Dampers, FORCE, MASS, SPRING, chain, gentle_step, moving, problems};
use super::running::{in_every_way, singly};
use crate::spectrum::Spectrum;
use crate::{
    ElasticLaw, Equations, EvaluationError, ForceLaw, Inputs, Layers, LinearModel, LinearSystem,
    LoadTime, Needs, Revision, State, System, Trial,
};

/// Stiffness of the spring in series with the dashpot (N/m).
const SERIES: f64 = 300.0;
/// Relaxation time of the two (s).
const RELAXATION: f64 = 0.05;

/// A mass on a spring and, parallel to it, a Maxwell element: a spring in series with a dashpot, whose
/// elongation z (m) is the internal variable, `z' = (u - z)/tau`. A force acts from t = 0 on.
struct Maxwell {
    mass: [f64; 1],
    revision: Revision,
}

impl Maxwell {
    fn new() -> Self {
        Self {
            mass: [MASS],
            revision: Revision::new(),
        }
    }

    /// The dashpot's elongation `dt` (s) after it was `z`, while the mass moves to `u` at the constant speed `v`: exact
    /// for such a path, and thus of order 2 in dt.
    fn elongation(z: f64, u: f64, v: f64, dt: f64) -> f64 {
        let behind = u - RELAXATION * v;
        behind + (z - behind + v * dt) * (-dt / RELAXATION).exp()
    }

    /// (u, v, z) after each of `count` times `interval` (s), by the Taylor series of the linear system of the three.
    fn motion(start: [f64; 3], interval: f64, count: usize) -> Vec<[f64; 3]> {
        let rate = |[u, v, z]: [f64; 3], force: f64| {
            let pull = SPRING * u + SERIES * (u - z);
            [v, (force - pull) / MASS, (u - z) / RELAXATION]
        };
        let mut y = start;
        let parts = (interval / 0.005).ceil();
        let h = interval / parts;
        let mut instants = Vec::with_capacity(count);
        for _ in 0..count {
            for _ in 0..parts as usize {
                let (mut derivative, mut weight, mut sum) = (y, 1.0, [0.0; 3]);
                for k in 0..25 {
                    for (sum, derivative) in sum.iter_mut().zip(derivative) {
                        *sum += weight * derivative;
                    }
                    derivative = rate(derivative, if k == 0 { FORCE } else { 0.0 });
                    weight *= h / f64::from(k + 1);
                }
                y = sum;
            }
            instants.push(y);
        }
        instants
    }
}

impl System for Maxwell {
    fn dofs(&self) -> usize {
        1
    }
    fn layers(&self) -> Layers {
        Layers::One
    }
    fn mass(&self) -> &[f64] {
        &self.mass
    }
    fn revision(&self) -> Revision {
        self.revision
    }
    fn equations(&self) -> Equations<'_> {
        Equations::Forces(self)
    }
    fn internal_variables(&self) -> usize {
        1
    }
    fn accept(&self, state: &mut State, _inputs: &Inputs, dt: f64) -> Result<(), EvaluationError> {
        state.internal[0] = Self::elongation(state.internal[0], state.u[0], state.v[0], dt);
        Ok(())
    }
}

impl ForceLaw for Maxwell {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let (u, v) = (trial.u[0], trial.v[0]);
        let z = Self::elongation(trial.internal[0], u, v, trial.dt);
        self.external_force(trial.load, trial.u, out);
        out[0] -= SPRING * u + SERIES * (u - z);
        Ok(())
    }
    fn external_force(&self, when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out[0] = FORCE * crate::Ramp::Step.factor(when);
    }
    fn spectrum(&self, _about: Option<&State>) -> Option<Spectrum> {
        Some(Spectrum {
            omega_max: ((SPRING + SERIES) / MASS).sqrt(),
            damping_max: 0.0,
            mass_damping: 0.0,
            stiffness_damping: 0.0,
            proportional: true,
        })
    }
}

/// The motion of a law with memory has the order that the law's own update allows: a Maxwell element whose
/// [`System::accept`] knows u and v at the end of a step is of order 2 at most, and methods of order 1 keep their
/// order. A method that sets [`Trial::dt`] to 0 within a step would be of order 1. Internal variables are part of a
/// checkpoint.
pub fn a_maxwell_element_relaxes_as_in_closed_form(make: &dyn Fn() -> Boxed) {
    let system = Maxwell::new();
    let properties = make().properties();
    if properties.needs != Needs::Forces {
        let answer = make().prepare(&system, 0.01);
        assert!(lacks(&*make(), &answer), "{answer:?}");
        return;
    }
    let mut start = State::new(vec![0.02], vec![0.3]);
    start.internal = vec![-0.01];
    let duration = 0.4;
    let coarse = (duration / gentle_step(&*make(), &system)).ceil() as usize;
    let instants = Maxwell::motion([0.02, 0.3, -0.01], duration / coarse as f64, coarse);
    let error = |refinement: usize| {
        let steps = coarse * refinement;
        let dt = duration / steps as f64;
        let inputs = Inputs::none();
        let (states, _) = singly(&mut *make(), &system, inputs, &start, dt, steps);
        let (mut sum, mut size) = (0.0, 0.0);
        let found = states.iter().step_by(refinement).skip(1);
        for (state, [u, _, z]) in found.zip(&instants) {
            sum += (state.u[0] - u).powi(2) + (state.internal[0] - z).powi(2);
            size += u * u + z * z;
        }
        f64::sqrt(sum / size)
    };
    let order = properties.accuracy.order(false).unwrap_or(2).min(2);
    let errors = [64, 128].map(error);
    let observed = (errors[0] / errors[1]).log2();
    assert!(
        (observed - f64::from(order)).abs() <= 0.1,
        "expected order {order}, observed {observed:.3} (errors {errors:?})"
    );
    let dt = duration / (8 * coarse) as f64;
    in_every_way(make, &system, Inputs::none(), &start, dt, 23);
}

/// A linear system that counts, in internal variables, how often it is notified of an accepted step, and adds up the
/// steps' lengths. As a force law it also checks each trial.
struct Counting {
    inner: LinearModel,
    shows_matrices: bool,
    revision: Revision,
    /// Time of the last accepted state (s) and the number of those before it.
    accepted: Mutex<(f64, f64)>,
}

impl Counting {
    fn new(inner: LinearModel, shows_matrices: bool) -> Self {
        Self {
            inner,
            shows_matrices,
            revision: Revision::new(),
            accepted: Mutex::new((0.0, 0.0)),
        }
    }

    fn accepted(&self) -> (f64, f64) {
        *self.accepted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl System for Counting {
    fn dofs(&self) -> usize {
        self.inner.dofs()
    }
    fn layers(&self) -> Layers {
        self.inner.layers()
    }
    fn mass(&self) -> &[f64] {
        self.inner.mass()
    }
    fn revision(&self) -> Revision {
        self.revision
    }
    fn equations(&self) -> Equations<'_> {
        if self.shows_matrices {
            Equations::Linear(&self.inner)
        } else {
            Equations::Forces(self)
        }
    }
    fn internal_variables(&self) -> usize {
        2
    }
    fn accept(&self, state: &mut State, _inputs: &Inputs, dt: f64) -> Result<(), EvaluationError> {
        state.internal[0] += 1.0;
        state.internal[1] += dt;
        let mut accepted = self.accepted.lock().unwrap_or_else(PoisonError::into_inner);
        *accepted = (state.t(), state.internal[0]);
        Ok(())
    }
}

impl ForceLaw for Counting {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let (t, count) = self.accepted();
        let at = trial.load.t();
        if trial.internal[0] != count || (at - t - trial.dt).abs() > 1e-14 || trial.dt < 0.0 {
            return Err(EvaluationError::of_body(format_args!(
                "a trial at {at} s, {} s after the accepted state, which is at {t} s; internal \
                 variables {:?} after {count} accepted steps",
                trial.dt, trial.internal
            )));
        }
        let operators = self.inner.operators();
        operators.net_force(trial.load, trial.u, trial.v, out);
        Ok(())
    }
    fn external_force(&self, when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        self.inner.operators().external_force(when, out);
    }
    fn mass_damping(&self) -> f64 {
        self.inner.operators().damping().mass
    }
    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        Some(self.inner.operators())
    }
    fn spectrum(&self, _about: Option<&State>) -> Option<Spectrum> {
        Some(Spectrum::of(self.inner.operators()))
    }
}

/// A system is notified once of each accepted step or substep, in single steps and in batches. Only its own
/// [`System::accept`] changes the internal variables. Each trial has those of the last accepted state and the time
/// since then.
pub fn each_step_is_accepted_once(make: &dyn Fn() -> Boxed) {
    let needs = make().properties().needs;
    for shows_matrices in [true, false] {
        if !shows_matrices && needs != Needs::Forces {
            continue;
        }
        let system = Counting::new(chain(1.0, FORCE, [MASS; 2]), shows_matrices);
        let mut start = moving();
        start.internal = vec![0.0; 2];
        let (dt, steps) = (1e-3, 21);
        // Each way begins again from the start, of which the system hears nothing.
        let make = || {
            *system
                .accepted
                .lock()
                .unwrap_or_else(PoisonError::into_inner) = (0.0, 0.0);
            make()
        };
        let (states, _) = singly(&mut *make(), &system, Inputs::none(), &start, dt, steps);
        let last = &states[steps];
        let part = last.clock.last_step().unwrap_or(f64::NAN);
        let parts = (dt / part).round();
        assert_eq!(last.internal[0], steps as f64 * parts, "accepted steps");
        assert!((last.internal[1] - steps as f64 * dt).abs() < 1e-14, "time");
        let mut batch_state = start.clone();
        let mut integrator = make();
        let mut batch = crate::Batch::new(&system, Inputs::none(), dt, steps);
        if let Err(error) = batch.take(&mut *integrator, &mut batch_state) {
            unreachable!("`{}` refused a sound batch: {error}", integrator.id());
        }
        assert_eq!(batch_state, *last, "in one batch");
    }
    // Of a body in space too.
    let [_, body] = problems(Dampers::ALL, FORCE);
    let damping = make().properties().other_damping;
    if damping.stiffness.is_some() && damping.dashpots.is_some() {
        let mut start = body.start.clone();
        start.internal = vec![0.0; 2];
        let system = Counting::new(body.system, true);
        let (states, _) = singly(&mut *make(), &system, Inputs::none(), &start, 1e-3, 5);
        assert!(states[5].internal[0] >= 5.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_update_of_a_dashpot_solves_its_equation() {
        // z' = (u - z)/tau with u = u0 + v t, in many small steps of the middle.
        let (z0, u0, v, dt) = (-0.01, 0.02, 0.3, 0.04);
        let (mut z, n) = (z0, 100_000);
        for step in 0..n {
            let h = dt / f64::from(n);
            let middle = u0 + v * h * (f64::from(step) + 0.5);
            let half = z + 0.5 * h * (middle - z) / RELAXATION;
            z += h * (middle - half) / RELAXATION;
        }
        let found = Maxwell::elongation(z0, u0 + v * dt, v, dt);
        assert!((found - z).abs() < 1e-10, "{found} {z}");
        assert_eq!(Maxwell::elongation(z0, u0, v, 0.0), z0);
    }

    #[test]
    fn the_series_ends_in_the_equilibrium() {
        let [u, v, z] = Maxwell::motion([0.02, 0.3, -0.01], 0.1, 60)[59];
        let expected = FORCE / SPRING;
        assert!((u - expected).abs() < 1e-9 && v.abs() < 1e-8 && (z - expected).abs() < 1e-9);
    }
}
