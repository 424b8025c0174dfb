//! `cnn-energy`: its energy never rises, and its steps are those of implicit methods if sweeps converge.

use crate::common::dense_methods::{Dense, STEPS};
use crate::common::energy_method::{energy_method, never_rises};
use crate::common::springs::{Chain, Pendulum, Spring};
use crate::common::{advance, build, largest, plain};
use proptest::collection::vec;
use proptest::prelude::*;
use sinew_core::{Equations, ForceModel, Layers, Revision, State, StepError, StepReport, System};
use sinew_testkit::body::{bodies_up_to, fastest_time};

/// Turns the result of the energy check into that of a property test.
fn promise(kept: Result<(), String>) -> Result<(), TestCaseError> {
    kept.map_err(TestCaseError::fail)
}

fn power(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10.0_f64.powf(power))
}

fn kinds() -> impl Strategy<Value = &'static str> {
    prop_oneof![Just("ie"), Just("trap")]
}

/// Springs of one kind or of several, of the stiffness k and lengths near one metre.
fn springs(k: f64) -> impl Strategy<Value = Vec<Spring>> {
    let length = 0.1..2.0;
    let one = (0.1..10.0, length, 0..4).prop_map(move |(share, l, kind): (f64, f64, i32)| {
        let k = k * share;
        match kind {
            0 => Spring::Linear { k },
            1 => Spring::Hardening { k, c: k / (l * l) },
            2 => Spring::Barrier { k, l },
            _ => Spring::DoubleWell { k, l },
        }
    });
    vec(one, 1..6)
}

/// A chain and a state of it, and the time scale of its motion (s).
#[derive(Debug, Clone)]
struct Drawn {
    springs: Vec<Spring>,
    masses: Vec<f64>,
    damping: [f64; 3],
    force: f64,
    start: State,
}

fn chains() -> impl Strategy<Value = Drawn> {
    (power(-6.0, 6.0), power(-3.0, 9.0)).prop_flat_map(|(mass, k)| {
        springs(k).prop_flat_map(move |springs| {
            let n = springs.len();
            let masses = vec(power(-1.0, 1.0), n);
            let damping = proptest::array::uniform3(prop_oneof![Just(0.0), power(-3.0, 2.0)]);
            let force = prop_oneof![Just(0.0), -2.0..2.0];
            // Within every barrier.
            let u = vec(-0.045..0.045, n);
            let v = (vec(-1.0..1.0, n), power(-3.0, 2.0));
            let parts = (Just(springs), masses, damping, force, u, v);
            parts.prop_map(move |(springs, masses, damping, force, u, (v, fast))| {
                let v = v.iter().map(|v| 0.1 * fast * v).collect();
                Drawn {
                    springs,
                    masses,
                    damping,
                    force,
                    start: State::new(u, v),
                }
                .scaled(mass, k)
            })
        })
    })
}

impl Drawn {
    /// The same chain with this mass (kg) and stiffness (N/m), if all values were drawn as shares.
    fn scaled(mut self, mass: f64, k: f64) -> Self {
        let rate = (k / mass).sqrt();
        self.masses.iter_mut().for_each(|share| *share *= mass);
        self.start.v.iter_mut().for_each(|v| *v *= rate);
        let [of_mass, of_stiffness, of_dashpots] = self.damping;
        self.damping = [
            of_mass * rate,
            of_stiffness / rate,
            of_dashpots * rate * mass,
        ];
        self.force *= k;
        self
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn energy_never_rises_under_a_constant_load(
        drawn in chains(),
        kind in kinds(),
        sweeps in 1_u32..9,
        dt in power(-6.0, 1.0),
    ) {
        let Drawn { springs, masses, damping, force, start } = drawn;
        let chain = Chain::model(springs, &masses, damping, force, |_| 1.0);
        promise(never_rises(&chain, (kind, sweeps), start, dt, 60))?;
    }

    #[test]
    fn energy_rises_by_the_work_of_a_changing_load_at_most(
        drawn in chains(),
        kind in kinds(),
        sweeps in 1_u32..9,
        share in power(-2.0, 2.0),
    ) {
        let Drawn { springs, masses, damping, force, start } = drawn;
        let chain = Chain::model(springs, &masses, damping, force, |t| (1e3 * t).sin() + t);
        promise(never_rises(&chain, (kind, sweeps), start, 1e-3 * share, 60))?;
    }

    #[test]
    fn energy_of_a_pendulum_never_rises(
        stiffness in power(0.0, 8.0),
        mass in power(-3.0, 3.0),
        v in proptest::array::uniform3(-5.0..5.0),
        kind in kinds(),
        sweeps in 1_u32..9,
        dt in power(-4.0, 1.0),
    ) {
        let pendulum = Pendulum::model(stiffness, 1.0, mass);
        let start = State::new(vec![0.0; 3], v.to_vec());
        promise(never_rises(&pendulum, (kind, sweeps), start, dt, 60))?;
    }

    #[test]
    fn converged_steps_are_those_of_dense_methods(body in bodies_up_to(2), power in -1.0..0.7) {
        let model = body.model();
        let dt = (10.0_f64.powf(power) * fastest_time(&model)).min(0.2);
        let dense = Dense::of(&model);
        let start = body.state(&model, 1e-3, 1e-3 / dt);
        let pairs = [("ie", dense.implicit_euler(&start, dt)), ("trap", dense.newmark(&start, dt))];
        for (kind, expected) in pairs {
            let mut integrator = energy_method(kind, 300);
            let (mut state, mut work) = (start.clone(), StepReport::default());
            let mut off = [0.0_f64; 2];
            for expected in &expected {
                work += integrator.step(&model, &mut state, dt).unwrap();
                let distance = |a: &[f64], b: &[f64]| {
                    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
                };
                off[0] = off[0].max(distance(&state.u, &expected.u));
                off[1] = off[1].max(distance(&state.v, &expected.v));
            }
            let sizes = [|state: &State| largest(&state.u), |state: &State| largest(&state.v)]
                .map(|of| expected.iter().map(of).fold(0.0, f64::max));
            prop_assert_eq!((work.limiter_hits, work.fallbacks), (0, 0));
            prop_assert!(expected.len() == STEPS as usize);
            prop_assert!(off[0] <= 1e-10 * sizes[0] && off[1] <= 1e-10 * sizes[1], "{kind}: {off:?} of {sizes:?}");
        }
    }
}

/// Two masses on hardening springs, and a start at which the cubic part dominates.
fn hardening() -> (ForceModel<Chain>, State) {
    let spring = Spring::Hardening { k: 200.0, c: 2e5 };
    let chain = Chain::model(vec![spring; 2], &[0.5; 2], [0.0; 3], 0.0, |_| 0.0);
    (chain, State::new(vec![0.02, -0.01], vec![1.0, -0.5]))
}

#[test]
fn energy_does_not_creep_up_in_a_long_run() {
    let (chain, start) = hardening();
    for dt in [1e-4, 0.01] {
        never_rises(&chain, ("trap", 4), start.clone(), dt, 20_000).unwrap();
    }
}

/// The limiter acts in steps far beyond those for which the trapezoidal rule is stable on a nonlinear law, and a
/// restart by a fresh integrator continues with the same bits.
#[test]
fn what_the_limiter_took_is_counted_and_restarts_go_on_with_the_same_bits() {
    let (chain, start) = hardening();
    let (mut integrator, mut state) = (energy_method("trap", 2), start);
    let mut work = StepReport::default();
    for _ in 0..50 {
        work += integrator.step(&chain, &mut state, 0.1).unwrap();
    }
    assert!(work.limiter_hits > 5 && work.fallbacks > 0, "{work:?}");
    let mut checkpoint = state.clone();
    advance(&mut *integrator, &chain, &mut state, 50, 0.1);
    advance(
        &mut *energy_method("trap", 2),
        &chain,
        &mut checkpoint,
        50,
        0.1,
    );
    assert_eq!(state, checkpoint);
    let said = integrator.remarks().join("; ");
    assert!(
        said.starts_with("certificate: the energy never rises"),
        "{said}"
    );
    assert!(said.contains("in 100 steps it rose by"), "{said}");
    let rise = integrator
        .facts()
        .iter()
        .find(|fact| fact.name == "energy_rise")
        .unwrap()
        .value;
    assert!((0.0..=1e-15).contains(&rise), "{rise:e}");
}

/// A step takes a force at its start, one at the displacement by its velocity, the cells' blocks, and for each sweep a
/// tangent product and a force. The first step, from rest, computes its acceleration.
#[test]
fn work_is_as_declared() {
    let model = crate::common::cube::cube(3);
    let mut state = State::at_rest(model.dofs());
    for (kind, extras) in [("ie", [0, 1]), ("trap", [2, 1])] {
        let mut integrator = energy_method(kind, 5);
        integrator.prepare(&model, 1e-3).unwrap();
        for extra in extras {
            let work = integrator.step(&model, &mut state, 1e-3).unwrap();
            assert_eq!(work.force_evaluations, 1 + 5 + extra, "{kind}");
            assert_eq!(work.sweeps, 2 + 2 * 5 + extra, "{kind}");
            assert_eq!(work.backtracks, 0, "{kind}");
        }
        state.acceleration = sinew_core::Acceleration::None;
    }
}

/// Points that a law refuses shorten a sweep; a state that it refuses ends the run.
#[test]
fn a_barrier_is_never_passed_and_a_start_beyond_it_is_refused() {
    let barrier = Spring::Barrier { k: 100.0, l: 0.1 };
    let chain = Chain::model(vec![barrier; 3], &[0.1; 3], [0.0; 3], -50.0, |_| 1.0);
    for kind in ["ie", "trap"] {
        let mut integrator = energy_method(kind, 4);
        let mut state = State::new(vec![0.0; 3], vec![0.0, 0.0, -20.0]);
        let mut backtracks = 0;
        for _ in 0..200 {
            backtracks += integrator.step(&chain, &mut state, 0.5).unwrap().backtracks;
        }
        assert!(backtracks > 0, "{kind}");
        let mut state = State::new(vec![0.0, -0.2, -0.2], vec![0.0; 3]);
        let refusal = integrator.step(&chain, &mut state, 0.5);
        assert!(
            matches!(&refusal, Err(StepError::Refused { source, .. }) if source.element == 1),
            "{refusal:?}"
        );
    }
}

/// A body at rest in its equilibrium under a load stays there to rounding, and one near it comes to rest there.
#[test]
fn damped_motion_ends_in_the_equilibrium_of_a_nonlinear_law() {
    let spring = Spring::Hardening { k: 100.0, c: 1e4 };
    // 100 s + 1e4 s^3 = 20 at s = .1.
    let chain = Chain::model(vec![spring; 2], &[1.0; 2], [5.0, 0.0, 0.0], 20.0, |_| 1.0);
    for (kind, dt) in [("trap", 0.01), ("ie", 0.05), ("trap", 1.0)] {
        let mut state = State::at_rest(2);
        advance(&mut *energy_method(kind, 8), &chain, &mut state, 4000, dt);
        for (u, expected) in state.u.iter().zip([0.1, 0.2]) {
            assert!((u - expected).abs() < 1e-12, "{kind}, {dt} s: {u}");
        }
    }
}

/// A chain with internal variables.
struct Remembering(ForceModel<Chain>);

impl System for Remembering {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }
    fn layers(&self) -> Layers {
        self.0.layers()
    }
    fn mass(&self) -> &[f64] {
        self.0.mass()
    }
    fn revision(&self) -> Revision {
        self.0.revision()
    }
    fn equations(&self) -> Equations<'_> {
        self.0.equations()
    }
    fn internal_variables(&self) -> usize {
        1
    }
}

#[test]
fn what_it_cannot_promise_is_refused_by_name() {
    let system = Remembering(hardening().0);
    let refusal = energy_method("trap", 4).prepare(&system, 0.01).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "`cnn-energy` needs an energy of the displacement alone behind the forces (stress that relaxes has none; \
         `generalized-alpha`, `newmark` and explicit methods do without), which this system does not offer"
    );
    let refusal = build("cnn-stabilised", &plain())
        .prepare(&system.0, 0.01)
        .unwrap_err();
    let message = refusal.to_string();
    assert!(
        message.starts_with("`cnn-stabilised` needs the matrices of a linear system"),
        "{message}"
    );
    assert!(
        message.contains("diverges") && message.contains("`cnn-energy`"),
        "{message}"
    );
    let mut state = State::new(vec![0.0; 2], vec![f64::NAN, 0.0]);
    let refusal = energy_method("trap", 4)
        .step(&system.0, &mut state, 0.01)
        .unwrap_err();
    assert!(matches!(refusal, StepError::Inaccurate { .. }), "{refusal}");
}
