//! The laws every integrator keeps, as a suite that any crate can run on its own method.
//!
//! ```ignore
//! sinew_core::conformance!(forward_euler, || Box::new(ForwardEuler::default()));
//! ```
//!
//! makes a test module `forward_euler` with one test per law. The problems are small networks
//! with solutions known in closed form. A method with saturation is given unsaturated.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::closed_form::DampedOscillator;
use crate::{
    Accuracy, BlockMatrix, Damping, Energy, EnergyBehaviour, EvaluationError, Integrator, Layers,
    LinearModel, LinearOperators, LinearSystem, Load, LoadTime, Pattern, Ramp, Revision,
    SetupError, StableStep, State, StepError, System, Trial,
};

/// A boxed integrator.
pub type Boxed = Box<dyn Integrator>;

/// Makes a module of tests, one per law, for one integrator.
#[macro_export]
macro_rules! conformance {
    ($name:ident, $make:expr) => {
        mod $name {
            #[allow(unused_imports)]
            use super::*;

            $crate::conformance!(@laws $make;
                rest_stays_at_rest
                observed_order_is_declared_order
                observed_order_under_other_damping_is_declared_order
                order_with_changing_loads_is_as_declared
                the_impulse_of_a_load_arrives_wherever_it_falls
                time_does_not_drift_over_a_million_steps
                loads_act_alike_at_any_time
                checkpoint_continues_bit_identically
                energy_behaves_as_declared
                stable_step_is_as_declared
                bad_systems_and_steps_are_refused
                each_step_is_accepted_once
                velocity_can_be_had_at_the_time_of_the_displacement
                static_solution_is_the_equilibrium
                another_system_is_noticed
            );
        }
    };
    (@laws $make:expr; $($law:ident)*) => {
        $(
            #[test]
            fn $law() {
                $crate::conformance::$law(&|| $make());
            }
        )*
    };
}

mod changing_loads;

pub use changing_loads::{
    loads_act_alike_at_any_time, order_with_changing_loads_is_as_declared,
    the_impulse_of_a_load_arrives_wherever_it_falls, time_does_not_drift_over_a_million_steps,
};

const MASS: f64 = 0.5;
const SPRING: f64 = 200.0;
const FORCE: f64 = 3.0;

/// wall - mass - mass - wall with equal springs: modes (1, 1) at sqrt(k/m) and (1, -1) at
/// sqrt(3k/m); a force on the first mass from t = 0.
fn chain(damping: f64, force: f64, masses: [f64; 2]) -> LinearModel {
    chain_under(Ramp::Step, damping, force, masses)
}

/// The same under a force that changes.
fn chain_under(ramp: Ramp, damping: f64, force: f64, masses: [f64; 2]) -> LinearModel {
    let damping = ChainDamping {
        mass: damping,
        ..ChainDamping::default()
    };
    damped_chain(ramp, damping, force, masses)
}

#[derive(Clone, Copy, Debug, Default)]
struct ChainDamping {
    /// alpha (1/s).
    mass: f64,
    /// beta (s).
    stiffness: f64,
    /// Between the wall and the first mass (N s/m), which mixes the modes.
    dashpot: f64,
}

fn damped_chain(ramp: Ramp, damping: ChainDamping, force: f64, masses: [f64; 2]) -> LinearModel {
    let build = move || {
        let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]])?);
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
        let element = [2.0 * SPRING, -SPRING, -SPRING, 2.0 * SPRING];
        stiffness.add_element(&[0, 1], &element)?;
        let mut dashpots = BlockMatrix::zeros(pattern, Layers::One);
        dashpots.add_block(0, 0, &[damping.dashpot])?;
        let damping = Damping {
            mass: damping.mass,
            stiffness: damping.stiffness,
            extra: (damping.dashpot > 0.0).then(|| Arc::new(dashpots)),
        };
        let load = Load {
            ramp,
            entries: vec![(0, force)],
        };
        LinearOperators::new(masses.to_vec(), stiffness, damping, vec![load])
    };
    match build() {
        Ok(operators) => LinearModel::new(operators),
        Err(error) => unreachable!("the chain is sound: {error}"),
    }
}

const OMEGA_MAX: f64 = 34.641_016_151_377_55; // sqrt(3 k/m)

fn exact(damping: f64, start: &State, t: f64) -> [f64; 2] {
    let mode = |sign: f64, omega: f64| {
        let project = |x: &[f64]| (x[0] + sign * x[1]) * FRAC_1_SQRT_2;
        DampedOscillator {
            omega,
            damping,
            load: FORCE / MASS * FRAC_1_SQRT_2,
            displacement: project(&start.u),
            velocity: project(&start.v),
        }
        .at(t)
        .0
    };
    let slow = mode(1.0, (SPRING / MASS).sqrt());
    let fast = mode(-1.0, OMEGA_MAX);
    [(slow + fast) * FRAC_1_SQRT_2, (slow - fast) * FRAC_1_SQRT_2]
}

/// The displacements at `t` by the Taylor series of the motion in steps far below 1/omega_max.
fn by_series(system: &LinearModel, start: &State, t: f64) -> [f64; 2] {
    let operators = system.operators();
    let parts = (t / 0.01).ceil().max(1.0);
    let (mut u, mut v) = ([start.u[0], start.u[1]], [start.v[0], start.v[1]]);
    for _ in 0..parts as usize {
        // The derivatives number k and k + 1, and h^k/k!.
        let (mut low, mut high, mut weight) = (u, v, 1.0);
        (u, v) = ([0.0; 2], [0.0; 2]);
        for k in 0..25 {
            let mut next = [0.0; 2];
            if k == 0 {
                operators.external_force(0.0, &mut next);
            }
            operators.subtract_internal_force(&low, &high, &mut next);
            for dof in 0..2 {
                u[dof] += weight * low[dof];
                v[dof] += weight * high[dof];
                next[dof] /= operators.mass()[dof];
            }
            (low, high) = (high, next);
            weight *= t / parts / f64::from(k + 1);
        }
    }
    u
}

fn moving() -> State {
    State::new(vec![0.02, -0.01], vec![0.3, 0.5])
}

fn advance(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    steps: usize,
    dt: f64,
) {
    for _ in 0..steps {
        if let Err(error) = integrator.step(system, state, dt) {
            unreachable!("`{}` refused a sound step: {error}", integrator.id());
        }
    }
}

/// A step within the stable one: a quarter of it, or of 2/omega_max where there is no limit or
/// the method is never stable.
fn gentle_step(integrator: &dyn Integrator, system: &dyn System) -> f64 {
    match integrator.stable_step(system) {
        Ok(StableStep::UpTo(limit)) if limit > 0.0 => limit / 4.0,
        _ => 0.5 / OMEGA_MAX,
    }
}

/// No load, no motion: nothing ever moves.
pub fn rest_stays_at_rest(make: &dyn Fn() -> Boxed) {
    let system = chain(1.0, 0.0, [MASS; 2]);
    let mut state = State::at_rest(2);
    advance(&mut *make(), &system, &mut state, 100, 0.01);
    assert_eq!(state.u, [0.0; 2]);
    assert_eq!(state.v, [0.0; 2]);
    assert_eq!(state.t(), 1.0);
}

/// Halving the step divides the error by 2^order, to a tenth of an order, with damping and
/// without; an exact method is exact, under a constant load, to 1e-9 at any step.
pub fn observed_order_is_declared_order(make: &dyn Fn() -> Boxed) {
    for damping in [2.0, 0.0] {
        let start = moving();
        let system = chain(damping, FORCE, [MASS; 2]);
        let duration = 0.5;
        let mut dt = gentle_step(&*make(), &system);
        if matches!(make().stable_step(&system), Ok(StableStep::UpTo(limit)) if limit <= 0.0) {
            continue; // never stable on this system: no order to observe
        }
        let accuracy = make().properties().accuracy;
        if accuracy == Accuracy::Exact {
            dt = 0.07;
        }
        let coarse = (duration / dt).ceil() as usize;
        let error = |refinement: usize| {
            let dt = duration / (coarse * refinement) as f64;
            let (mut integrator, mut state) = (make(), start.clone());
            let (mut sum, mut size) = (0.0, 0.0);
            for step in 1..=coarse {
                advance(&mut *integrator, &system, &mut state, refinement, dt);
                let t = step as f64 * duration / coarse as f64;
                for (u, expected) in state.u.iter().zip(exact(damping, &start, t)) {
                    sum += (u - expected).powi(2);
                    size += expected * expected;
                }
            }
            f64::sqrt(sum / size)
        };
        let Some(order) = accuracy.order(damping > 0.0) else {
            let error = error(1);
            assert!(
                error <= 1e-9,
                "c = {damping}: declared exact, error {error:.1e}"
            );
            continue;
        };
        let errors: Vec<f64> = [16, 32].into_iter().map(error).collect();
        let observed = (errors[0] / errors[1]).log2();
        assert!(
            (observed - f64::from(order)).abs() <= 0.1,
            "c = {damping}: declared order {order}, observed {observed:.3} (errors {errors:?})"
        );
    }
}

/// As [`observed_order_is_declared_order`], under beta K and under a dashpot. A kind of damping for
/// which no order is declared is refused at set-up.
pub fn observed_order_under_other_damping_is_declared_order(make: &dyn Fn() -> Boxed) {
    let declared = make().properties().other_damping;
    let stiffness = ChainDamping {
        stiffness: 0.01,
        ..ChainDamping::default()
    };
    let dashpot = ChainDamping {
        dashpot: 4.0,
        ..ChainDamping::default()
    };
    let (start, duration) = (moving(), 0.5);
    for (damping, accuracy) in [
        (stiffness, declared.stiffness),
        (dashpot, declared.dashpots),
    ] {
        let system = damped_chain(Ramp::Step, damping, FORCE, [MASS; 2]);
        let Some(accuracy) = accuracy else {
            let refusal = make().prepare(&system, 0.01);
            assert!(
                matches!(refusal, Err(SetupError::Lacks { .. })),
                "{damping:?}: declared to be refused, not {refusal:?}"
            );
            continue;
        };
        let order = accuracy.order(true);
        let dt = match order {
            Some(_) => gentle_step(&*make(), &system),
            None => 0.07,
        };
        let coarse = (duration / dt).ceil() as usize;
        let instants: Vec<[f64; 2]> = (1..=coarse)
            .map(|step| by_series(&system, &start, step as f64 * duration / coarse as f64))
            .collect();
        let error = |refinement: usize| {
            let dt = duration / (coarse * refinement) as f64;
            let (mut integrator, mut state) = (make(), start.clone());
            let (mut sum, mut size) = (0.0, 0.0);
            for expected in &instants {
                advance(&mut *integrator, &system, &mut state, refinement, dt);
                for (u, expected) in state.u.iter().zip(expected) {
                    sum += (u - expected).powi(2);
                    size += expected * expected;
                }
            }
            f64::sqrt(sum / size)
        };
        let Some(order) = order else {
            let error = error(1);
            assert!(
                error <= 1e-9,
                "{damping:?}: declared exact, error {error:.1e}"
            );
            continue;
        };
        let errors: Vec<f64> = [16, 32].into_iter().map(error).collect();
        let observed = (errors[0] / errors[1]).log2();
        assert!(
            (observed - f64::from(order)).abs() <= 0.1,
            "{damping:?}: declared order {order}, observed {observed:.3} (errors {errors:?})"
        );
    }
}

/// A clone of a state, continued with a fresh integrator, gives the same bits.
pub fn checkpoint_continues_bit_identically(make: &dyn Fn() -> Boxed) {
    let system = chain(2.0, FORCE, [MASS; 2]);
    let (mut integrator, mut state) = (make(), moving());
    let dt = gentle_step(&*integrator, &system);
    advance(&mut *integrator, &system, &mut state, 11, dt);
    let mut checkpoint = state.clone();
    advance(&mut *integrator, &system, &mut state, 13, dt);
    advance(&mut *make(), &system, &mut checkpoint, 13, dt);
    assert_eq!(state, checkpoint);
}

fn total_energy(system: &dyn System, state: &State) -> f64 {
    let mut velocity = vec![0.0; state.u.len()];
    if let Err(error) = state.velocity_at_t(system, &mut velocity) {
        unreachable!("a linear system refuses nothing: {error}");
    }
    system
        .energy(&state.u, &velocity)
        .map_or(f64::NAN, Energy::total)
}

/// The energy of an undamped, unloaded chain is conserved, bounded, falls or grows as declared.
pub fn energy_behaves_as_declared(make: &dyn Fn() -> Boxed) {
    let system = chain(0.0, 0.0, [MASS; 2]);
    let (mut integrator, mut state) = (make(), moving());
    let dt = gentle_step(&*integrator, &system);
    let start = total_energy(&system, &state);
    let energies: Vec<f64> = (0..2000)
        .map(|_| {
            advance(&mut *integrator, &system, &mut state, 1, dt);
            total_energy(&system, &state) / start
        })
        .collect();
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let (early, late) = (mean(&energies[..500]), mean(&energies[1500..]));
    let (low, high) = energies
        .iter()
        .fold((f64::MAX, f64::MIN), |(low, high), &e| {
            (low.min(e), high.max(e))
        });
    let summary = format!("energy over start {low:.3e}..{high:.3e}, early {early}, late {late}");
    match make().properties().energy {
        EnergyBehaviour::Conserved => {
            assert!(low > 1.0 - 1e-10 && high < 1.0 + 1e-10, "{summary}");
        }
        EnergyBehaviour::Bounded => {
            assert!(low > 0.5 && high < 2.0, "{summary}");
            assert!((late / early - 1.0).abs() < 0.01, "{summary}");
        }
        EnergyBehaviour::Falls => {
            assert!(late < 0.999 * early, "{summary}");
            assert!(high < 1.0 + 1e-3, "{summary}");
        }
        EnergyBehaviour::Grows => assert!(late > 1.5 * early, "{summary}"),
    }
}

/// Just below the declared stable step motion stays bounded, just above it grows; where the
/// method declares itself stable at any step, it stays bounded at a thousand times 2/omega_max, or
/// refuses a step it cannot resolve.
pub fn stable_step_is_as_declared(make: &dyn Fn() -> Boxed) {
    for damping in [0.0, 2.0] {
        let system = chain(damping, 0.0, [MASS; 2]);
        // The largest displacement within so many steps; beyond 1e3 m nothing more is learned.
        let growth = |dt: f64, steps: usize| {
            let (mut integrator, mut state) = (make(), moving());
            if let Err(SetupError::Unresolved { .. }) = integrator.prepare(&system, dt) {
                return 0.0; // refused, which is no growth
            }
            let mut size = 0.0;
            for _ in 0..steps / 1000 {
                advance(&mut *integrator, &system, &mut state, 1000, dt);
                let finite = state.u.iter().all(|u| u.is_finite());
                size = state.u.iter().fold(size, |size: f64, u| size.max(u.abs()));
                if !finite || size > 1e3 {
                    return f64::INFINITY;
                }
            }
            size
        };
        match make().stable_step(&system) {
            Ok(StableStep::UpTo(limit)) => {
                if limit > 0.0 {
                    let below = growth(0.99 * limit, 4000);
                    assert!(below < 1.0, "c = {damping}: {below} at .99 of {limit}");
                }
                let step = if limit > 0.0 {
                    1.02 * limit
                } else {
                    0.1 / OMEGA_MAX
                };
                let above = growth(step, 1_000_000);
                assert!(
                    above.is_infinite(),
                    "c = {damping}: only {above} at {step} above {limit}"
                );
            }
            Ok(StableStep::Any) => {
                for factor in [3.0, 1e3] {
                    let size = growth(factor * 2.0 / OMEGA_MAX, 4000);
                    assert!(size < 10.0, "c = {damping}: {size} at {factor} x critical");
                }
            }
            Ok(StableStep::Unknown) => {}
            Err(error) => unreachable!("a chain has a spectrum: {error}"),
        }
    }
}

/// Zero, negative or NaN masses and steps and states of the wrong size give an error that names
/// the integrator; nothing panics.
pub fn bad_systems_and_steps_are_refused(make: &dyn Fn() -> Boxed) {
    let sound = chain(1.0, FORCE, [MASS; 2]);
    for dt in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let refusal = make().step(&sound, &mut moving(), dt);
        assert!(
            matches!(refusal, Err(StepError::Setup(SetupError::Step { .. }))),
            "dt = {dt}: {refusal:?}"
        );
    }
    for mass in [0.0, -1.0, f64::NAN] {
        let system = chain(1.0, FORCE, [MASS, mass]);
        let refusal = make().prepare(&system, 0.01);
        assert!(
            matches!(refusal, Err(SetupError::Mass { .. })),
            "mass {mass}: {refusal:?}"
        );
        let message = refusal.map_or_else(|error| error.to_string(), |_| String::new());
        assert!(message.contains(make().id()), "{message}");
        assert!(message.contains("degree of freedom 1"), "{message}");
    }
    let refusal = make().step(&sound, &mut State::at_rest(3), 0.01);
    assert!(
        matches!(refusal, Err(StepError::Setup(SetupError::StateSize { .. }))),
        "{refusal:?}"
    );
}

/// A system that counts how often it is told of an accepted step.
struct Counting {
    inner: LinearModel,
    accepted: AtomicU64,
}

impl System for Counting {
    fn dofs(&self) -> usize {
        self.inner.dofs()
    }
    fn mass(&self) -> &[f64] {
        self.inner.mass()
    }
    fn revision(&self) -> Revision {
        self.inner.revision()
    }
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.inner.net_force(trial, out)
    }
    fn external_force(&self, when: LoadTime, out: &mut [f64]) {
        self.inner.external_force(when, out);
    }
    fn mass_damping(&self) -> f64 {
        self.inner.mass_damping()
    }
    fn accept(&self, _state: &mut State) {
        self.accepted.fetch_add(1, Ordering::Relaxed);
    }
    fn as_linear(&self) -> Option<&dyn LinearSystem> {
        self.inner.as_linear()
    }
}

/// The system is told once that a step was accepted.
pub fn each_step_is_accepted_once(make: &dyn Fn() -> Boxed) {
    let system = Counting {
        inner: chain(1.0, FORCE, [MASS; 2]),
        accepted: AtomicU64::new(0),
    };
    advance(&mut *make(), &system, &mut moving(), 7, 1e-3);
    assert_eq!(system.accepted.load(Ordering::Relaxed), 7);
}

/// The velocity at the time of the displacement is that of the exact motion, to the method's
/// accuracy, and a synchronised state can be taken over by any method.
pub fn velocity_can_be_had_at_the_time_of_the_displacement(make: &dyn Fn() -> Boxed) {
    let damping = 2.0;
    let system = chain(damping, FORCE, [MASS; 2]);
    let start = moving();
    let (mut integrator, mut state) = (make(), start.clone());
    let dt = 1e-5;
    advance(&mut *integrator, &system, &mut state, 1000, dt);
    let mut velocity = vec![0.0; 2];
    assert!(state.velocity_at_t(&system, &mut velocity).is_ok());
    let (before, after) = (
        exact(damping, &start, state.t() - 1e-6),
        exact(damping, &start, state.t() + 1e-6),
    );
    for dof in 0..2 {
        let expected = (after[dof] - before[dof]) / 2e-6;
        assert!(
            (velocity[dof] - expected).abs() < 1e-3,
            "{} instead of {expected}",
            velocity[dof]
        );
    }
}

/// Damped motion under a constant load ends in K u = F.
pub fn static_solution_is_the_equilibrium(make: &dyn Fn() -> Boxed) {
    let system = chain(20.0, FORCE, [MASS; 2]);
    let (mut integrator, mut state) = (make(), moving());
    let dt = gentle_step(&*integrator, &system);
    let steps = (4.0 / dt).ceil() as usize;
    advance(&mut *integrator, &system, &mut state, steps, dt);
    let equilibrium = [FORCE * 2.0 / (3.0 * SPRING), FORCE / (3.0 * SPRING)];
    for (u, expected) in state.u.iter().zip(equilibrium) {
        assert!(
            (u / expected - 1.0).abs() < 1e-8,
            "{u} instead of {expected}"
        );
    }
}

/// An integrator used on another system of the same size forgets all it kept of the first.
pub fn another_system_is_noticed(make: &dyn Fn() -> Boxed) {
    let (first, second) = (
        chain(1.0, FORCE, [MASS; 2]),
        chain(1.0, FORCE, [3.0 * MASS, MASS]),
    );
    let mut used = make();
    advance(&mut *used, &first, &mut moving(), 3, 1e-3);
    let (mut state, mut fresh_state) = (moving(), moving());
    advance(&mut *used, &second, &mut state, 5, 1e-3);
    advance(&mut *make(), &second, &mut fresh_state, 5, 1e-3);
    assert_eq!(state, fresh_state);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_the_closed_form_under_mass_damping() {
        let (system, start) = (chain(2.0, FORCE, [MASS; 2]), moving());
        for t in [0.003, 0.1, 0.47] {
            let expected = exact(2.0, &start, t);
            for (u, expected) in by_series(&system, &start, t).iter().zip(expected) {
                assert!((u - expected).abs() <= 1e-14, "{u} {expected} at {t}");
            }
        }
    }
}
