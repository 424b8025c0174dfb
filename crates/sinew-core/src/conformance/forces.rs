//! Laws on systems that show no matrices.

use super::boxed::Boxed;
use super::problems::{Dampers, FORCE, Problem, gentle_step, give, problems};
use super::running::singly;
use crate::spectrum::Spectrum;
use crate::{
    ElasticLaw, EvaluationError, ForceLaw, ForceModel, Inputs, Integrator, LinearModel,
    LinearSystem, LoadTime, Needs, SetupError, StableStep, State, Trial,
};

/// Rounding error of 30 steps, relative to the largest value of the same quantity in them.
const ROUNDING: f64 = 1e-13;

/// Rounding error of 30 solutions by factors, relative to the largest value of the same quantity in them.
const SOLVED: f64 = 1e-10;

/// The forces of a linear system that hides its matrices.
struct Hidden {
    inner: LinearModel,
    /// True if the law reports the spectrum of its fastest motions.
    knows_spectrum: bool,
    /// True if the law reports its energy and tangent.
    tells_tangent: bool,
}

/// A linear system that hides its matrices.
fn hidden(inner: &LinearModel, [knows_spectrum, tells_tangent]: [bool; 2]) -> ForceModel<Hidden> {
    let law = Hidden {
        inner: inner.clone(),
        knows_spectrum,
        tells_tangent,
    };
    ForceModel::like(inner, law)
}

impl ForceLaw for Hidden {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
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
        self.tells_tangent
            .then(|| -> &dyn ElasticLaw { self.inner.operators() })
    }
    fn spectrum(&self, _about: Option<&State>) -> Option<Spectrum> {
        let of_inner = || Spectrum::of(self.inner.operators());
        self.knows_spectrum.then(of_inner)
    }
}

/// True if set-up or the stable step was refused with [`SetupError::Lacks`] under this integrator's id.
pub(super) fn lacks<T>(integrator: &dyn Integrator, answer: &Result<T, SetupError>) -> bool {
    matches!(answer, Err(SetupError::Lacks { integrator: id, .. }) if *id == integrator.id())
}

/// Tests methods on a system that evaluates its forces and shows no matrices. A method that declares that it needs
/// forces only gives the same bits and the same work as with the matrices, under all kinds of damping. A method that
/// needs an elastic law with its tangent gives the motion with the matrices, up to rounding, if the system has such a
/// law. Any other method refuses the system by name, at set-up and when asked for a stable step. Without a spectrum the
/// stable step is unknown; with one it is that of the matrices.
pub fn forces_are_enough_where_declared(make: &dyn Fn() -> Boxed) {
    for damping in [
        Dampers::NONE,
        Dampers::MASS,
        Dampers::STIFFNESS,
        Dampers::DASHPOT,
        Dampers::ALL,
    ] {
        for problem in problems(damping, FORCE) {
            let dark = hidden(&problem.system, [false, false]);
            let elastic = hidden(&problem.system, [true, true]);
            let hidden = hidden(&problem.system, [true, false]);
            let needs = make().properties().needs;
            if needs == Needs::Tangents {
                tangents_are_enough(make, &problem, &elastic, damping);
            }
            match needs {
                Needs::Matrices | Needs::Tangents => {
                    for system in [&dark, &hidden] {
                        let (mut integrator, dt) = (make(), 0.01);
                        let answer = integrator.prepare(system, dt);
                        assert!(lacks(&*integrator, &answer), "set-up: {answer:?}");
                        let answer = make().stable_step(system);
                        assert!(lacks(&*integrator, &answer), "stable step: {answer:?}");
                    }
                }
                Needs::Forces => {
                    forces_are_enough(make, &problem, &hidden, damping);
                    let unknown = make().stable_step(&dark);
                    assert_eq!(unknown, Ok(StableStep::Unknown));
                    // A method that cuts steps by the stable one has nothing to cut them by.
                    let (mut integrator, dt) = (make(), gentle_step(&*make(), &problem.system));
                    let answer = integrator.prepare(&dark, dt);
                    assert!(answer.is_ok() || lacks(&*integrator, &answer), "{answer:?}");
                }
            }
        }
    }
}

fn forces_are_enough(
    make: &dyn Fn() -> Boxed,
    problem: &Problem,
    hidden: &ForceModel<Hidden>,
    damping: Dampers,
) {
    let (system, start) = (&problem.system, &problem.start);
    let what = format!("{}, {damping:?}", problem.name);
    assert_eq!(
        make().stable_step(hidden),
        make().stable_step(system),
        "{what}"
    );
    let dt = gentle_step(&*make(), system);
    let mut inputs = Inputs::new();
    give(&mut inputs, 3.0 * dt, &[(1, 0.4)]);
    give(&mut inputs, 8.5 * dt, &[(0, -0.3), (1, 0.1)]);
    let (mut of_matrices, mut of_law) = (make(), make());
    let (shown, of_shown) = singly(&mut *of_matrices, system, &inputs, start, dt, 30);
    let (found, of_hidden) = singly(&mut *of_law, hidden, &inputs, start, dt, 30);
    // A machine that is given the matrices may fuse what a law computes one after the other.
    let rounding = match of_matrices.kernel() == of_law.kernel() {
        true => 0.0,
        false => ROUNDING,
    };
    let sizes = sizes(&shown);
    for (step, (shown, found)) in shown.iter().zip(&found).enumerate() {
        let agree = agree(shown, found, sizes.map(|size| rounding * size));
        assert!(agree, "{what}: step {step}: {shown:?} {found:?}");
    }
    // Steps by a law's current stiffness have to check it, at a cost.
    let follows = found.iter().any(|state| state.cut.is_some());
    assert!(
        follows || of_shown == of_hidden,
        "{what}: {of_shown:?} {of_hidden:?}"
    );
}

/// The motion with the matrices equals that with the tangent of their law, up to the rounding of solutions.
fn tangents_are_enough(
    make: &dyn Fn() -> Boxed,
    problem: &Problem,
    elastic: &ForceModel<Hidden>,
    damping: Dampers,
) {
    let (system, start) = (&problem.system, &problem.start);
    let dt = gentle_step(&*make(), system);
    let mut inputs = Inputs::new();
    give(&mut inputs, 3.0 * dt, &[(1, 0.4)]);
    give(&mut inputs, 8.5 * dt, &[(0, -0.3), (1, 0.1)]);
    let (shown, _) = singly(&mut *make(), system, &inputs, start, dt, 30);
    let (found, work) = singly(&mut *make(), elastic, &inputs, start, dt, 30);
    let what = format!("{}, {damping:?}: {work:?}", problem.name);
    let sizes = sizes(&shown).map(|size| SOLVED * size);
    for (step, (shown, found)) in shown.iter().zip(&found).enumerate() {
        assert!(
            agree(shown, found, sizes),
            "{what}: step {step}: {shown:?} {found:?}"
        );
    }
}

/// The largest values of u, v and a in some states.
fn sizes(states: &[State]) -> [f64; 3] {
    let largest = |of: fn(&State) -> &[f64]| {
        let values = states.iter().flat_map(of);
        values.fold(0.0, |most: f64, value| value.abs().max(most))
    };
    [
        largest(|state| &state.u),
        largest(|state| &state.v),
        largest(|state| &state.a),
    ]
}

/// True if two states agree: u, v and a within the bounds `allowed`, everything else exactly.
pub(super) fn agree(one: &State, other: &State, allowed: [f64; 3]) -> bool {
    let pairs = [(&one.u, &other.u), (&one.v, &other.v), (&one.a, &other.a)];
    let close = pairs.iter().zip(allowed).all(|((one, other), allowed)| {
        let mut values = one.iter().zip(*other);
        one.len() == other.len() && values.all(|(a, b)| (a - b).abs() <= allowed)
    });
    let same_vectors = State {
        u: one.u.clone(),
        v: one.v.clone(),
        a: one.a.clone(),
        // Matrices have one stiffness, by which steps are cut once and for all.
        cut: one.cut,
        ..other.clone()
    };
    close && same_vectors == *one
}
