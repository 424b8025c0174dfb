//! `cnn-energy`: its energy never rises, and its steps are those of implicit methods where sweeps converge.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::springs::{Chain, Pendulum, Spring};
use common::{build, plain};
use proptest::collection::vec;
use proptest::prelude::*;
use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{
    Inputs, Integrator, LoadTime, OptionValue, Options, State, StepError, StepReport, System, Trial,
};

fn options(kind: &str, sweeps: u32) -> Options {
    let kind = OptionValue::Text(kind.into());
    let options = Options::new().with("kind", kind);
    options.with_number("sweeps", f64::from(sweeps))
}

fn energy_method(kind: &str, sweeps: u32) -> Box<dyn Integrator> {
    build("cnn-energy", &options(kind, sweeps))
}

/// Kinetic and elastic energy of a state (J), and the size of both.
fn energy(system: &dyn System, state: &State) -> f64 {
    let trial = Trial {
        load: LoadTime::at(state.t()),
        dt: 0.0,
        u: &state.u,
        v: &state.v,
        internal: &state.internal,
    };
    let mut force = vec![0.0; state.u.len()];
    let law = system.as_elastic().unwrap();
    let elastic = law.elastic_force(&trial, &mut force).unwrap().energy;
    elastic + 0.5 * weighted_dot(system.mass(), &state.v, &state.v)
}

/// Work of the loads in a step (J): their mean over the step, times the way.
fn work(system: &dyn System, kind: &str, before: &State, after: &State, dt: f64) -> f64 {
    let moved: Vec<f64> = after.u.iter().zip(&before.u).map(|(b, a)| b - a).collect();
    let of = |when: LoadTime<'_>| {
        let mut force = vec![0.0; moved.len()];
        system.external_force(when, &mut force);
        dot(&force, &moved)
    };
    match kind {
        "ie" => of(LoadTime::end_of(before.t(), dt)),
        _ => {
            let [start, end] = LoadTime::at_both_ends(before.t(), dt, 0.5);
            0.5 * (of(start) + of(end))
        }
    }
}

/// Takes steps and holds the energy to that at the start and the work of the loads since; the work that was counted.
fn never_rises(
    system: &dyn System,
    (kind, sweeps): (&str, u32),
    start: State,
    dt: f64,
    steps: usize,
) -> Result<StepReport, TestCaseError> {
    let mut integrator = energy_method(kind, sweeps);
    let mut state = start;
    let first = energy(system, &state);
    let (mut brought, mut size, mut before_step) = (0.0, first.abs(), first);
    let mut counted = StepReport::default();
    for step in 0..steps {
        let before = state.clone();
        counted += integrator.step(system, &mut state, dt).unwrap();
        let found = energy(system, &state);
        let work = work(system, kind, &before, &state, dt);
        brought += work;
        size = size.max(found.abs()).max(brought.abs()).max(work.abs());
        prop_assert!(found.is_finite(), "step {step}: {found}");
        let rise = found - before_step - work;
        prop_assert!(rise <= 1e-13 * size, "step {step}: by {rise:e} of {size:e}");
        let excess = found - first - brought;
        prop_assert!(excess <= 1e-12 * size, "step {step}: {excess:e} of {size:e}");
        before_step = found;
    }
    Ok(counted)
}

fn power(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10.0_f64.powf(power))
}

fn kinds() -> impl Strategy<Value = &'static str> {
    prop_oneof![Just("ie"), Just("trap")]
}

/// Springs of one kind or of several, of the stiffness k and lengths near a meter.
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
            let damping = vec(prop_oneof![Just(0.0), power(-3.0, 2.0)], 3);
            let force = prop_oneof![Just(0.0), -2.0..2.0];
            // Within every barrier.
            let u = vec(-0.045..0.045, n);
            let v = (vec(-1.0..1.0, n), power(-3.0, 2.0));
            (Just(springs), masses, damping, force, u, v).prop_map(
                move |(springs, masses, damping, force, u, (v, fast)): (_, Vec<f64>, Vec<f64>, f64, _, (Vec<f64>, f64))| {
                    let rate = (k / mass).sqrt();
                    let masses: Vec<f64> = masses.iter().map(|share| share * mass).collect();
                    let v = v.iter().map(|v| 0.1 * fast * rate * v).collect();
                    Drawn {
                        springs,
                        masses,
                        damping: [damping[0] * rate, damping[1] / rate, damping[2] * rate * mass],
                        force: force * k,
                        start: State::new(u, v),
                    }
                },
            )
        })
    })
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
        never_rises(&chain, (kind, sweeps), start, dt, 60)?;
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
        never_rises(&chain, (kind, sweeps), start, 1e-3 * share, 60)?;
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
        never_rises(&pendulum, (kind, sweeps), start, dt, 60)?;
    }
}
