//! Laws on a nonlinear system: two masses with a hardening spring between them.

use std::fmt::Display;
use std::sync::Arc;

use super::boxed::Boxed;
use super::forces::{agree, lacks};
use super::problems::{Dampers, MASS, SPRING, gentle_step};
use super::running::{Keeper, in_every_way, singly};
use crate::spectrum::Spectrum;
use crate::step_error::to_nine_digits;
use crate::{
    BlockMatrix, Damping, Deformed, ElasticLaw, EnergyBehaviour, EvaluationError, ForceLaw,
    ForceModel, Inputs, Layers, LinearModel, LinearOperators, LoadTime, Needs, Pattern, Run,
    SimulateError, StableStep, State, StepError, TangentKind, Trial, simulate,
};

/// Coefficient of the cube of the stretch (N/m^3).
const HARDENING: f64 = 1e5;

/// Tag of the spring in the middle.
const ELEMENT: u64 = 42;

/// Returns the value; there is no error, because the springs are valid.
fn sound<T, E: Display>(made: Result<T, E>) -> T {
    match made {
        Ok(value) => value,
        Err(error) => unreachable!("the springs are sound: {error}"),
    }
}

/// wall - mass - mass - wall, the outer springs linear, the inner one with the force
/// `k s + c s^3` at a stretch s; it refuses to be stretched beyond a limit.
#[derive(Clone)]
struct Hardening {
    damping: Damping,
    largest_stretch: f64,
    pattern: Arc<Pattern>,
    /// True if the law reports its energy and tangent.
    tells_tangent: bool,
}

impl Hardening {
    fn system(mass_damping: f64, largest_stretch: f64) -> ForceModel<Self> {
        let law = Self {
            damping: Damping {
                mass: mass_damping,
                ..Damping::default()
            },
            largest_stretch,
            pattern: sound(Pattern::from_elements(2, [[0, 1]]).map(Arc::new)),
            tells_tangent: true,
        };
        ForceModel::new(law, &[MASS; 2], Layers::One)
    }

    /// The same forces without energy and tangent.
    fn without_tangent() -> ForceModel<Self> {
        let law = Self {
            tells_tangent: false,
            ..Self::system(0.0, f64::INFINITY).law().clone()
        };
        ForceModel::new(law, &[MASS; 2], Layers::One)
    }

    fn stretch(u: &[f64]) -> f64 {
        u[1] - u[0]
    }

    /// Tangent stiffness of the inner spring (N/m).
    fn stiffness(stretch: f64) -> f64 {
        SPRING + 3.0 * HARDENING * stretch * stretch
    }
}

impl ForceLaw for Hardening {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.elastic_force(trial, out)?;
        for (out, v) in out.iter_mut().zip(trial.v) {
            *out = -*out - self.damping.mass * MASS * v;
        }
        Ok(())
    }

    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }

    fn mass_damping(&self) -> f64 {
        self.damping.mass
    }

    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        self.tells_tangent.then_some(self)
    }

    fn spectrum(&self, about: Option<&State>) -> Option<Spectrum> {
        let stretch = about.map_or(0.0, |state| Self::stretch(&state.u));
        let squared = (SPRING + 2.0 * Self::stiffness(stretch)) / MASS;
        Some(Spectrum {
            omega_max: squared.sqrt(),
            damping_max: 0.0,
            mass_damping: self.damping.mass,
            stiffness_damping: 0.0,
            proportional: true,
        })
    }
}

impl ElasticLaw for Hardening {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        let stretch = Self::stretch(trial.u);
        if stretch.abs() > self.largest_stretch {
            return Err(EvaluationError {
                element: ELEMENT,
                reason: format!(
                    "stretched by {stretch} m, more than {} m",
                    self.largest_stretch
                ),
            });
        }
        let inner = SPRING * stretch + HARDENING * stretch.powi(3);
        for ((out, u), inner) in out.iter_mut().zip(trial.u).zip([-inner, inner]) {
            *out = SPRING * u + inner;
        }
        let outer = trial.u.iter().map(|u| 0.5 * SPRING * u * u);
        Ok(Deformed {
            energy: outer.sum::<f64>()
                + 0.5 * SPRING * stretch.powi(2)
                + 0.25 * HARDENING * stretch.powi(4),
            ..Deformed::default()
        })
    }

    fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// The same matrix for all kinds: it has no negative eigenvalue.
    fn tangent(
        &self,
        trial: &Trial<'_>,
        _kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        let inner = Self::stiffness(Self::stretch(trial.u));
        let own = SPRING + inner;
        out.scale_rows(&[0.0; 2]);
        sound(out.add_element(&[0, 1], &[own, -inner, -inner, own]));
        Ok(())
    }

    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        _kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let inner = Self::stiffness(Self::stretch(trial.u)) * Self::stretch(w);
        for ((out, w), inner) in out.iter_mut().zip(w).zip([-inner, inner]) {
            *out = SPRING * w + inner;
        }
        Ok(())
    }

    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        out.fill(SPRING + Self::stiffness(Self::stretch(trial.u)));
        Ok(())
    }

    fn damping(&self) -> &Damping {
        &self.damping
    }
}

/// `q'' + a q + b q^3 = 0` with `a`, `b` above 0: `q = A cn(w t + phase | m)` with `w^2 = a + b A^2` and
/// `m = b A^2/(2 w^2)` (Abramowitz and Stegun, chapter 16, from cn'' = (2 m - 1) cn - 2 m cn^3).
struct Duffing {
    linear: f64,
    cubic: f64,
    amplitude: f64,
    phase: f64,
}

impl Duffing {
    /// (q (m), q' (m/s)) at `t` (s).
    fn at(&self, t: f64) -> (f64, f64) {
        let hardening = self.cubic * self.amplitude.powi(2);
        let w = (self.linear + hardening).sqrt();
        let m = hardening / (2.0 * w * w);
        let (sn, cn) = sn_cn(w * t + self.phase, m);
        let dn = (1.0 - m * sn * sn).sqrt();
        (self.amplitude * cn, -self.amplitude * w * sn * dn)
    }
}

/// The elliptic functions sn and cn of the parameter m, by the arithmetic-geometric mean
/// (Abramowitz and Stegun, 16.4).
fn sn_cn(u: f64, m: f64) -> (f64, f64) {
    let (mut a, mut b) = (1.0_f64, (1.0 - m).sqrt());
    let mut shares = Vec::new();
    for _ in 0..8 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        shares.push(c / a);
    }
    let mut phi = f64::from(1_u32 << shares.len()) * a * u;
    for share in shares.iter().rev() {
        phi = 0.5 * (phi + (share * phi.sin()).asin());
    }
    phi.sin_cos()
}

/// The motion in which both masses mirror each other.
const MIRRORED: Duffing = Duffing {
    linear: 3.0 * SPRING / MASS,
    cubic: 8.0 * HARDENING / MASS,
    amplitude: 0.02,
    phase: 0.9,
};

fn mirrored(q: f64, v: f64) -> State {
    State::new(vec![-q, q], vec![-v, v])
}

/// Halving the step divides the error by 2^order on a nonlinear system too, compared with its motion in closed form.
/// Single steps, batches, recorders that stop and checkpoints give the same bits there. A method that needs matrices
/// refuses the system, and one that needs a tangent refuses the same forces without tangent.
pub fn a_hardening_spring_swings_as_in_closed_form(make: &dyn Fn() -> Boxed) {
    let system = Hardening::system(0.0, f64::INFINITY);
    let properties = make().properties();
    if properties.needs == Needs::Matrices {
        let answer = make().prepare(&system, 0.01);
        assert!(lacks(&*make(), &answer), "{answer:?}");
        return;
    }
    let answer = make().prepare(&Hardening::without_tangent(), 0.01);
    match properties.needs {
        Needs::Tangents => assert!(lacks(&*make(), &answer), "{answer:?}"),
        _ => assert!(answer.is_ok(), "{answer:?}"),
    }
    let (q, v) = MIRRORED.at(0.0);
    let (start, duration) = (mirrored(q, v), 0.4);
    let coarse = (duration / gentle_step(&*make(), &system)).ceil() as usize;
    let error = |refinement: usize| {
        let dt = duration / (coarse * refinement) as f64;
        let steps = coarse * refinement;
        let (states, _) = singly(&mut *make(), &system, Inputs::none(), &start, dt, steps);
        let (mut sum, mut size) = (0.0, 0.0);
        for state in states.iter().step_by(refinement) {
            let (q, _) = MIRRORED.at(state.t());
            for (u, expected) in state.u.iter().zip([-q, q]) {
                sum += (u - expected).powi(2);
                size += expected * expected;
            }
        }
        f64::sqrt(sum / size)
    };
    let Some(order) = properties.accuracy.order(false) else {
        unreachable!("no method is exact that sees forces only");
    };
    let errors = [64, 128].map(error);
    let observed = (errors[0] / errors[1]).log2();
    assert!(
        (observed - f64::from(order)).abs() <= 0.1,
        "declared order {order}, observed {observed:.3} (errors {errors:?})"
    );
    let dt = duration / (16 * coarse) as f64;
    in_every_way(make, &system, Inputs::none(), &start, dt, 23);
}

/// A system that refuses a trial state ends the run with an error that names the time, the element and the reason, at
/// the same step however the steps were taken. The values recorded and watched until then equal those of a run without
/// a refusal, and the integrator can be used again. A method that solves equations may reach the last step through
/// other trials, avoiding one that is refused, and one whose energy never rises avoids refused states and runs to the
/// end.
pub fn a_refusal_ends_the_run_and_keeps_what_was(make: &dyn Fn() -> Boxed) {
    if make().properties().needs == Needs::Matrices {
        return;
    }
    let limit = 0.03;
    let free = Hardening::system(0.0, f64::INFINITY);
    let weak = Hardening::system(0.0, limit);
    let start = mirrored(0.0, 1.0);
    let dt = gentle_step(&*make(), &free) / 8.0;
    let steps = (0.1 / dt).ceil() as usize;
    let (expected, _) = singly(&mut *make(), &free, Inputs::none(), &start, dt, steps);
    let stretch = |state: &State| Hardening::stretch(&state.u).abs();
    let Some(beyond) = expected.iter().position(|state| stretch(state) > limit) else {
        unreachable!("the limit is within reach");
    };
    let run = Run {
        dt,
        steps,
        divergence_limit: f64::INFINITY,
    };

    if make().properties().energy == EnergyBehaviour::NeverRises {
        let states = in_every_way(make, &weak, Inputs::none(), &start, dt, steps);
        assert!(states.iter().all(|state| stretch(state) <= limit));
        return;
    }
    let mut first = None;
    for every in [1, 1000] {
        let (mut integrator, mut state) = (make(), start.clone());
        let mut keeper = Keeper::new(every, 2);
        let refused = simulate(&weak, &mut *integrator, &mut state, &run, &mut keeper);
        let error = match refused {
            Err(SimulateError::Step(error)) => error,
            other => unreachable!("a stretch beyond the limit was taken: {other:?}"),
        };
        let message = error.to_string();
        let StepError::Refused { t, ref source } = error else {
            unreachable!("refused by another door: {message}");
        };
        assert_eq!(source.element, ELEMENT);
        for part in [
            format!("t = {} s", to_nine_digits(t)),
            format!("element {ELEMENT}"),
            format!("more than {limit} m"),
        ] {
            assert!(message.contains(&part), "{message}");
        }

        // A method that evaluates ahead within a step is refused one step sooner than another.
        let rows = keeper.rows.len();
        assert!(
            rows == beyond || rows == beyond + 1,
            "{rows} rows of {beyond}"
        );
        let solved = match make().properties().needs {
            Needs::Tangents => 1e-9 * limit,
            _ => 0.0,
        };
        let allowed = [solved, solved / dt, solved / (dt * dt)];
        for (row, expected) in keeper.rows.iter().zip(&expected) {
            assert_eq!(row.0, expected.t());
            assert!(close(&row.1, &expected.u, solved));
        }
        let kept = if every == 1 { rows } else { 1 };
        assert_eq!(keeper.states.len(), kept);
        for (state, expected) in keeper.states.iter().zip(expected.iter().step_by(every)) {
            assert!(agree(state, expected, allowed), "{state:?} {expected:?}");
        }
        let last = &expected[rows - 1];
        assert!(last.t() <= t && t <= last.t() + dt * (1.0 + 1e-12));
        // A step may be taken in parts of which the first were taken.
        if state.t() == last.t() {
            let same = close(&state.u, &last.u, solved) && close(&state.v, &last.v, solved / dt);
            assert!(same, "a spoilt state: {state:?}");
        } else {
            assert!(last.t() < state.t() && state.t() <= t);
        }
        let first = first.get_or_insert_with(|| error.clone());
        assert_eq!(*first, error, "in batches of {every}");

        let small = mirrored(0.001, 0.0);
        let mut fresh_one = make();
        // Set-up is done already for the one that was refused.
        if let Err(error) = fresh_one.prepare(&weak, dt) {
            unreachable!("a sound system and step: {error}");
        }
        let again = singly(&mut *integrator, &weak, Inputs::none(), &small, dt, 9);
        let fresh = singly(&mut *fresh_one, &weak, Inputs::none(), &small, dt, 9);
        assert_eq!(again, fresh, "after a refusal");
    }
}

/// True if both lists have the same length and their values differ by at most `allowed`.
fn close(found: &[f64], expected: &[f64], allowed: f64) -> bool {
    let mut pairs = found.iter().zip(expected);
    found.len() == expected.len() && pairs.all(|(a, b)| (a - b).abs() <= allowed)
}

/// The linear system that the hardening one is for small motions about a state.
fn linearised(mass_damping: f64, state: &State) -> LinearModel {
    let system = Hardening::system(mass_damping, f64::INFINITY);
    let law = system.law();
    let mut stiffness = BlockMatrix::zeros(Arc::clone(&law.pattern), Layers::One);
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &state.u,
        v: &state.v,
        internal: &[],
    };
    sound(ElasticLaw::tangent(
        law,
        &trial,
        TangentKind::Exact,
        &mut stiffness,
    ));
    let damping = law.damping.clone();
    let operators = LinearOperators::new(vec![MASS; 2], stiffness, damping, Vec::new());
    LinearModel::new(sound(operators))
}

/// The stable step about a state of a nonlinear system is that of the system linearised there: a
/// stretched hardening spring needs shorter steps.
pub fn stable_step_follows_the_state(make: &dyn Fn() -> Boxed) {
    if make().properties().needs == Needs::Matrices {
        return;
    }
    for damping in [Dampers::MASS.mass, 10.0] {
        let system = Hardening::system(damping, f64::INFINITY);
        let limit = |about: Option<&State>| make().stable_step_about(&system, about);
        let (rest, stretched) = (mirrored(0.0, 0.0), mirrored(0.02, 0.0));
        assert_eq!(limit(None), limit(Some(&rest)));
        let close = |found: &Result<StableStep, _>, expected: &Result<StableStep, _>| match (
            found, expected,
        ) {
            (Ok(StableStep::UpTo(found)), Ok(StableStep::UpTo(expected))) => {
                (found / expected - 1.0).abs() <= 1e-9
            }
            (found, expected) => found == expected,
        };
        for state in [&rest, &stretched] {
            let (found, linear) = (limit(Some(state)), linearised(damping, state));
            let expected = make().stable_step(&linear);
            assert!(close(&found, &expected), "{found:?} for {expected:?}");
        }
        if let (Ok(StableStep::UpTo(rest)), Ok(StableStep::UpTo(stretched))) =
            (limit(None), limit(Some(&stretched)))
        {
            assert!(
                stretched < rest,
                "{stretched} s stretched, {rest} s at rest"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_solves_its_equation() {
        let (h, a) = (1e-4, MIRRORED.amplitude);
        for t in [0.0, 0.031, 0.2, 0.77] {
            let (q, v) = MIRRORED.at(t);
            let [before, after] = [-h, h].map(|h| MIRRORED.at(t + h));
            assert!(((after.0 - before.0) / (2.0 * h) - v).abs() < 1e-4);
            let acceleration = (after.1 - before.1) / (2.0 * h);
            let force = MIRRORED.linear * q + MIRRORED.cubic * q.powi(3);
            assert!(
                (acceleration + force).abs() < 1e-2,
                "{acceleration} {force}"
            );
            // v^2 + a q^2 + b q^4/2 stays.
            let energy =
                |q: f64, v: f64| v * v + MIRRORED.linear * q * q + 0.5 * MIRRORED.cubic * q.powi(4);
            assert!((energy(q, v) / energy(a, 0.0) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn elliptic_functions_have_their_tabled_values() {
        // Abramowitz and Stegun: K(1/2) = 1.85407 46773 01372; sn(K/2 | m) = 1/sqrt(1 + sqrt(1 - m)).
        let quarter = 1.854_074_677_301_372;
        let (sn, cn) = sn_cn(quarter, 0.5);
        assert!((sn - 1.0).abs() < 1e-14 && cn.abs() < 1e-14);
        let (sn, _) = sn_cn(quarter / 2.0, 0.5);
        assert!((sn - (1.0 + 0.5_f64.sqrt()).sqrt().recip()).abs() < 1e-14);
    }
}
