//! `generalized-alpha`: its order, its damping of motion too fast for the step, and the methods that it equals in
//! special cases.

use crate::common::cube::{altered, cube, mass_damping, scene, springs};
use crate::common::{advance, build, largest, plain, relative_error};
use nalgebra::DMatrix;
use sinew_core::{
    Acceleration, LinearModel, LinearOperators, LinearSystem, Load, OptionValue, Options, Ramp,
    State, System,
};

fn rho(value: f64) -> Options {
    plain().with_number("rho_inf", value)
}

fn hht(value: f64) -> Options {
    plain().with_number("hht", value)
}

fn moving(dofs: usize) -> State {
    let wave = |size: f64, rate: f64| {
        let value = |dof| size * f64::sin(1.0 + rate * f64::from(dof));
        (0..dofs as u32).map(value).collect()
    };
    State::new(wave(1e-3, 7.1), wave(0.1, 3.7))
}

/// A network with dashpots and all damping under a load of this kind.
fn network(ramp: Ramp) -> LinearModel {
    let model = scene(3, 0.2, springs(0.1), mass_damping(5.0));
    let loads = model.operators().loads().iter().map(|load| Load {
        ramp: ramp.clone(),
        ..load.clone()
    });
    let loads = loads.collect();
    altered(&model, model.operators().damping().clone(), loads)
}

fn ramps() -> [Ramp; 4] {
    [
        Ramp::Step,
        Ramp::Sin2 { rise: 0.13 },
        Ramp::Pulse {
            from: 0.031,
            to: 0.15,
        },
        Ramp::Table {
            times: vec![0.02, 0.045, 0.2],
            values: vec![0.0, 3.0, -1.0],
        },
    ]
}

#[test]
fn order_2_whatever_it_damps() {
    let cases = [0.0, 0.3, 0.8, 1.0].map(rho).into_iter();
    for options in cases.chain([0.0, 0.1, 1.0 / 3.0].map(hht)) {
        for ramp in [Ramp::Step, Ramp::Sin2 { rise: 0.2 }] {
            let system = network(ramp);
            let start = moving(system.dofs());
            let states = |id: &str, options: &Options, dt: f64| {
                let (mut integrator, mut state) = (build(id, options), start.clone());
                let steps = (0.01 / dt).round() as usize;
                (0..10)
                    .map(|_| {
                        advance(&mut *integrator, &system, &mut state, steps, dt);
                        state
                            .u
                            .iter()
                            .map(|u| 100.0 * u)
                            .chain(state.v.clone())
                            .collect()
                    })
                    .collect::<Vec<Vec<f64>>>()
            };
            let reference = states("rk4", &plain(), 1e-4);
            let error = |dt| relative_error(&states("generalized-alpha", &options, dt), &reference);
            let order = (error(5e-4) / error(2.5e-4)).log2();
            assert!((order - 2.0).abs() <= 0.1, "{options:?}: {order}");
        }
    }
}

/// A step far too long for an oscillator, on `(u, v dt, a dt^2)`.
fn amplification(options: &Options) -> DMatrix<f64> {
    let (mass, spring): (f64, f64) = (0.1, 100.0);
    let system = LinearModel::new(LinearOperators::oscillator(mass, spring, 0.0).unwrap());
    let dt = 1e5 / f64::sqrt(spring / mass);
    let columns = (0..3).flat_map(|column| {
        let unit = |row| f64::from(u8::from(row == column));
        let mut state = State::new(vec![unit(0)], vec![unit(1) / dt]);
        state.a = vec![unit(2) / (dt * dt)];
        state.acceleration = Acceleration::Same;
        build("generalized-alpha", options)
            .step(&system, &mut state, dt)
            .unwrap();
        [state.u[0], state.v[0] * dt, state.a[0] * dt * dt]
    });
    DMatrix::from_iterator(3, 3, columns)
}

/// rho_inf itself, and (1 - alpha)/(1 + alpha) of the method of Hilber, Hughes and Taylor.
#[test]
fn what_is_left_of_infinitely_fast_motion_is_as_asked() {
    let cases = [0.0, 0.1, 0.5, 0.8, 0.95, 1.0].map(|share| (rho(share), share));
    let hughes = [0.0, 0.1, 0.3].map(|alpha| (hht(alpha), (1.0 - alpha) / (1.0 + alpha)));
    for (options, expected) in cases.into_iter().chain(hughes) {
        let eigenvalues = amplification(&options).complex_eigenvalues();
        let radius = eigenvalues
            .iter()
            .map(|value| value.norm())
            .fold(0.0, f64::max);
        // Three equal roots of rho = 0 scatter by the third root of what is small.
        assert!(
            (radius - expected).abs() <= 2e-3,
            "{options:?}: {radius} {expected}"
        );
    }
}

fn assert_same_as_newmark(options: &Options, rounding: f64) {
    for ramp in ramps() {
        let system = network(ramp.clone());
        for dt in [1e-3, 0.02, 1.0] {
            for start in [State::at_rest(system.dofs()), moving(system.dofs())] {
                let (mut one, mut other) = (start.clone(), start);
                let mut alpha = build("generalized-alpha", options);
                let mut newmark = build("newmark", &plain());
                let (mut difference, mut size) = (0.0_f64, 0.0_f64);
                for _ in 0..200 {
                    alpha.step(&system, &mut one, dt).unwrap();
                    newmark.step(&system, &mut other, dt).unwrap();
                    let off: Vec<f64> = one.u.iter().zip(&other.u).map(|(a, b)| a - b).collect();
                    difference = difference.max(largest(&off));
                    size = size.max(largest(&other.u));
                }
                assert!(
                    difference <= rounding * size,
                    "{options:?}, {ramp:?} at {dt}: {difference:e} of {size:e}"
                );
            }
        }
    }
}

/// With rho = 1, a_m = a_f = 1/2, beta = 1/4 and gamma = 1/2: the mean of `M a + D v + K u - F` at both ends of a step
/// vanishes. It vanishes at the start, where the acceleration is the consistent one, hence at every step, as in
/// Newmark's method: the two are one, under any damping and, as loads are averaged like forces, any load. (With loads
/// at the middle of the step the two would differ.)
#[test]
fn with_all_left_it_is_newmark_s_method_under_any_damping_and_load() {
    assert_same_as_newmark(&rho(1.0), 1e-9);
}

#[test]
fn hilber_hughes_and_taylor_s_method_with_alpha_0_is_newmark_s() {
    assert_same_as_newmark(&hht(0.0), 1e-12);
}

#[test]
fn each_is_a_method_of_its_own_otherwise() {
    let system = network(Ramp::Step);
    let end = |id: &str, options: &Options| {
        let mut state = moving(system.dofs());
        advance(&mut *build(id, options), &system, &mut state, 20, 0.02);
        state.u
    };
    let newmark = [end("newmark", &plain())];
    for options in [rho(0.0), rho(0.8), rho(0.9), hht(0.1), hht(0.3)] {
        let error = relative_error(&[end("generalized-alpha", &options)], &newmark);
        assert!(error > 1e-5, "{options:?}: {error:e}");
    }
    let default = end("generalized-alpha", &plain());
    assert_eq!(default, end("generalized-alpha", &rho(0.8)));
}

#[test]
fn a_step_is_one_solution() {
    let model = cube(3);
    let mut integrator = build("generalized-alpha", &plain());
    let mut state = State::at_rest(model.dofs());
    let first = integrator.step(&model, &mut state, 0.02).unwrap();
    let second = integrator.step(&model, &mut state, 0.02).unwrap();
    assert_eq!(
        (first.solves, first.factorizations, first.sweeps),
        (1, 1, 2)
    );
    assert_eq!(
        (second.solves, second.factorizations, second.sweeps),
        (1, 0, 1)
    );
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let refusal = |options: &Options| {
        let refusal = sinew_integrators::build("generalized-alpha", options).err();
        refusal.unwrap().to_string()
    };
    for value in [-0.1, 1.1, f64::NAN] {
        assert_eq!(
            refusal(&rho(value)),
            format!("`generalized-alpha`: rho_inf = {value}: expected a number from 0 to 1")
        );
    }
    for value in [-0.1, 0.34] {
        assert_eq!(
            refusal(&hht(value)),
            format!("`generalized-alpha`: hht = {value}: expected a number from 0 to 1/3")
        );
    }
    assert_eq!(
        refusal(&hht(0.1).with("rho_inf", OptionValue::Number(0.5))),
        "`generalized-alpha`: rho_inf = 0.5: expected nothing beside hht: one of the two says all"
    );
}
