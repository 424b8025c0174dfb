//! Laws of the saturation f(x) = (|x + Q| - |x - Q|)/2.

use proptest::num::f64::{ANY, INFINITE, NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
use proptest::prelude::*;
use sinew_cnn::Saturation;

fn at(q: f64) -> Saturation {
    Saturation::at(q).unwrap()
}

/// Any possible voltage.
fn voltages() -> impl Strategy<Value = f64> {
    prop_oneof![POSITIVE | NORMAL | SUBNORMAL, 0.1..10.0]
}

/// Any possible velocity, often of the size of the voltage.
fn velocities(q: f64) -> impl Strategy<Value = f64> {
    let all = POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO | INFINITE;
    prop_oneof![1 => all, 2 => (-2.5..2.5).prop_map(move |share| q * share)]
}

/// A voltage and a velocity.
fn pairs() -> impl Strategy<Value = (f64, f64)> {
    voltages().prop_flat_map(|q| (Just(q), velocities(q)))
}

/// A voltage and two velocities.
fn triples() -> impl Strategy<Value = (f64, f64, f64)> {
    voltages().prop_flat_map(|q| (Just(q), velocities(q), velocities(q)))
}

proptest! {
    #[test]
    fn what_was_saturated_once_is_saturated((q, x) in pairs()) {
        let f = at(q);
        prop_assert_eq!(f.output(f.output(x)), f.output(x));
    }

    #[test]
    fn it_is_odd((q, x) in pairs()) {
        let f = at(q);
        prop_assert_eq!(f.output(-x).to_bits(), (-f.output(x)).to_bits());
    }

    #[test]
    fn it_stretches_no_distance((q, x, y) in triples()) {
        prop_assume!(x.is_finite() || y.is_finite());
        let f = at(q);
        prop_assert!((f.output(x) - f.output(y)).abs() <= (x - y).abs());
    }

    #[test]
    fn inside_the_voltage_it_is_exact(q in voltages(), share in -1.0..=1.0) {
        let x = q * share;
        prop_assert_eq!(at(q).output(x).to_bits(), x.to_bits());
        prop_assert_eq!(at(q).saturates(x), x.abs() == q);
    }

    #[test]
    fn it_is_the_papers_formula(q in 1e-6..1e6, x in -1e7..1e7) {
        let paper = (f64::abs(x + q) - f64::abs(x - q)) / 2.0;
        let rounding = f64::EPSILON * (f64::abs(x) + q);
        prop_assert!((at(q).output(x) - paper).abs() <= rounding);
    }

    #[test]
    fn it_never_passes_the_voltage((q, x) in pairs()) {
        let f = at(q);
        prop_assert!(f.output(x).abs() <= q);
        prop_assert_eq!(f.saturates(x), f.output(x).abs() == q);
    }

    #[test]
    fn what_is_off_lets_everything_through(x in velocities(1.0)) {
        prop_assert_eq!(Saturation::OFF.output(x).to_bits(), x.to_bits());
    }

    #[test]
    fn voltages_that_make_no_sense_are_refused(q in ANY) {
        let refusal = Saturation::at(q).err().map(|error| error.to_string());
        let expected = format!("saturation voltage Q = {q} m/s: expected a number above 0");
        let refused = q.is_nan() || q <= 0.0;
        prop_assert_eq!(refusal, refused.then_some(expected));
    }
}

#[test]
fn what_is_not_a_number_stays_so() {
    assert!(at(4.0).output(f64::NAN).is_nan());
}
