//! The paper's first example, section 4.1: peaks, limit cycles and stable steps, to the digits printed. Errors of methods are rows of the
//! verification.

use crate::common::{assert_prints, build, diverged, plain, saturation, watch};
use sinew_core::closed_form::DampedOscillator;
use sinew_core::{LinearModel, LinearOperators, Options, Run, StableStep, State};

const MASS: f64 = 0.1; // kg
const SPRING: f64 = 100.0; // N/m
const DASHPOT: f64 = 1.0; // N s/m
const VELOCITY: f64 = -5.0; // m/s

/// The largest |u| of the exact motion [m].
const PEAK: f64 = 0.12612;

fn model() -> LinearModel {
    LinearModel::new(LinearOperators::oscillator(MASS, SPRING, DASHPOT).unwrap())
}

fn exact() -> DampedOscillator {
    DampedOscillator {
        omega: f64::sqrt(SPRING / MASS),
        damping: DASHPOT / MASS,
        load: 0.0,
        displacement: 0.0,
        velocity: VELOCITY,
    }
}

/// (t, u) after each step, t = 0 included; `None` when the motion is unbounded.
fn motion(id: &str, options: &Options, dt: f64, duration: f64) -> Option<Vec<(f64, f64)>> {
    let mut motion = Vec::new();
    let run = Run::covering(duration, dt).with_divergence_limit(1e6 * PEAK);
    let start = State::new(vec![0.0], vec![VELOCITY]);
    let mut integrator = build(id, options);
    let (_, report) = watch(&model(), &mut *integrator, start, &run, |state| {
        motion.push((motion.len() as f64 * dt, state.u[0]));
    });
    (!diverged(&report)).then_some(motion)
}

/// The largest |u| from `from` to `to` [m].
fn peak(id: &str, options: &Options, dt: f64, from: f64, to: f64) -> f64 {
    motion(id, options, dt, to)
        .unwrap()
        .into_iter()
        .filter(|(t, _)| (from - 1e-9..=to + 1e-9).contains(t))
        .fold(0.0, |peak, (_, u)| f64::max(peak, u.abs()))
}

#[test]
fn the_exact_motion_peaks_where_it_should() {
    let peak = (0..=1_000_000).map(|i| exact().at(1e-6 * f64::from(i)).0.abs());
    assert_prints(peak.fold(0.0, f64::max), "0.12612");
}

#[test]
fn forward_euler_is_unbounded_beyond_its_step_and_so_is_the_network_without_its_clamp() {
    for dt in [0.015, 0.02] {
        assert_eq!(motion("forward-euler", &plain(), dt, 20.0), None);
        let off = plain().with("saturation", sinew_core::OptionValue::Text("off".into()));
        assert_eq!(motion("cnn", &off, dt, 20.0), None);
    }
    assert!(motion("forward-euler", &plain(), 0.001, 20.0).is_some());
}

#[test]
fn first_peaks() {
    let first = |id, options: Options, dt| peak(id, &options, dt, 0.0, 1.0);
    assert_prints(first("forward-euler", plain(), 0.001), "0.12901");
    for (q, dt, printed) in [
        (4.0, 0.001, "0.12602"),
        (3.2, 0.001, "0.11918"),
        (2.0, 0.001, "0.09979"),
        (4.0, 0.02, "0.2556"),
        (3.2, 0.02, "0.2014"),
        (2.0, 0.02, "0.1282"),
    ] {
        assert_prints(first("cnn", saturation(q), dt), printed);
    }
}

#[test]
fn the_clamp_makes_a_limit_cycle_of_a_blow_up() {
    let late = |q, dt| peak("cnn", &saturation(q), dt, 18.0, 20.0);
    for (q, dt, printed) in [
        (4.0, 0.015, "0.210"),
        (3.2, 0.015, "0.168"),
        (2.0, 0.015, "0.105"),
        (4.0, 0.02, "0.255"),
        (3.2, 0.02, "0.204"),
        (2.0, 0.02, "0.128"),
    ] {
        assert_prints(late(q, dt), printed);
    }
    // For ever: ten times later the cycle is as large.
    let much_later = peak("cnn", &saturation(4.0), 0.02, 198.0, 200.0);
    assert!((much_later / late(4.0, 0.02) - 1.0).abs() < 0.01);
    // Below the stable step the motion dies out.
    assert!(late(4.0, 0.001) < 1e-12);
}

/// (4/pi) Q sqrt(dt/c): proportional to Q and near to what is found.
#[test]
fn the_limit_cycle_has_the_size_of_its_describing_function() {
    let c = DASHPOT / MASS;
    for dt in [0.011, 0.013, 0.015, 0.02] {
        let late = |q| peak("cnn", &saturation(q), dt, 98.0, 100.0);
        let predicted = |q: f64| 4.0 / std::f64::consts::PI * q * f64::sqrt(dt / c);
        let ratio = late(4.0) / predicted(4.0);
        assert!((ratio - 1.0).abs() < 0.13, "at {dt} s: {ratio}");
        for q in [3.2, 2.0] {
            let other = late(q) / predicted(q);
            assert!(
                (other / ratio - 1.0).abs() < 0.01,
                "at {dt} s: {other} {ratio}"
            );
        }
    }
}

#[test]
fn stable_steps() {
    for (id, printed) in [
        ("forward-euler", "0.0100"),
        ("cnn", "0.0100"),
        ("symplectic-euler", "0.0540"),
        ("cnn-symplectic", "0.0540"),
        ("central-difference", "0.0632"),
    ] {
        let integrator = build(id, &plain());
        let Ok(StableStep::UpTo(limit)) = integrator.stable_step(&model()) else {
            panic!("`{id}` has a stable step");
        };
        assert_prints(limit, printed);
        if id != "cnn" && id != "cnn-symplectic" {
            let long = 100.0;
            assert!(motion(id, &plain(), 0.95 * limit, long).is_some(), "{id}");
            assert!(motion(id, &plain(), 1.05 * limit, long).is_none(), "{id}");
        }
    }
}
