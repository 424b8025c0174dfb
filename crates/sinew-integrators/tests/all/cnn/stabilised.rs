//! `cnn-stabilised`: its conserved energy, its rest state and the methods that it equals in special cases.

use std::sync::Arc;

use std::collections::BTreeMap;

use crate::common::cube::{altered, cube, mass_damping, run, scene, springs};
use crate::common::exponential::exponentials;
use crate::common::{advance, build, inner, largest, plain};
use nalgebra::{DMatrix, DVector};
use sinew_cnn::{Blend, DampingShare, GammaRule, Inner, Stabiliser};
use sinew_core::spectrum::critical_step;
use sinew_core::{
    BlockMatrix, Damping, Integrator, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    OptionValue, Options, Pattern, Ramp, StableStep, State, System,
};
use sinew_fem::{Law, Rayleigh};
use sinew_integrators::Frame;
use sinew_integrators::cnn::CnnStabilised;
use sinew_testkit::dense::{dense, dense_damping};

const INNERS: [Inner; 6] = [
    Inner::Block,
    Inner::Jacobi { sweeps: 3 },
    Inner::Chebyshev { sweeps: 1 },
    Inner::Chebyshev { sweeps: 2 },
    Inner::Chebyshev { sweeps: 5 },
    Inner::GaussSeidel { sweeps: 2 },
];

fn method(inner: Inner, blend: Blend) -> Frame<CnnStabilised> {
    Frame::new(CnnStabilised::new(inner, GammaRule::Power, blend))
}

fn matrix(rows: Vec<Vec<f64>>) -> DMatrix<f64> {
    let n = rows.len();
    DMatrix::from_row_iterator(n, n, rows.into_iter().flatten())
}

/// A displacement and a velocity without pattern, up to `u` and `v`.
fn moving(dofs: usize, u: f64, v: f64) -> State {
    let wave = |size: f64, rate: f64| {
        let value = |dof| size * f64::sin(1.0 + rate * f64::from(dof));
        (0..dofs as u32).map(value).collect()
    };
    State::new(wave(u, 7.1), wave(v, 3.7))
}

fn oscillator(damping: f64) -> LinearModel {
    LinearModel::new(LinearOperators::oscillator(0.1, 100.0, damping).unwrap())
}

/// The cube's network without loads under mass damping.
fn network(mass: f64) -> LinearModel {
    let damping = Damping {
        mass,
        ..Damping::default()
    };
    altered(&cube(3), damping, vec![])
}

/// The cube's network damped in proportion to its stiffness and its mass, under the cube's load.
fn stiffness_damped(stiffness: f64, mass: f64) -> LinearModel {
    let damping = Damping {
        mass,
        stiffness,
        extra: None,
    };
    let model = cube(3);
    let loads = model.operators().loads().to_vec();
    altered(&model, damping, loads)
}

/// A network with a dashpot beside every spring, under the cube's load.
fn dashpots(ratio: f64) -> LinearModel {
    let model = scene(3, 0.2, springs(ratio), mass_damping(0.0));
    LinearModel::new(model.operators().clone())
}

/// A network damped in every way, under the cube's load.
fn damped_in_every_way(loads: bool) -> LinearModel {
    let model = scene(3, 0.2, springs(0.3), mass_damping(5.0));
    let damping = Damping {
        stiffness: 2e-3,
        ..model.operators().damping().clone()
    };
    assert!(damping.extra.is_some());
    let loads = if loads {
        model.operators().loads().to_vec()
    } else {
        vec![]
    };
    altered(&model, damping, loads)
}

/// The energy form of a system, a step and P.
struct Form {
    /// P - dt/2 D - dt^2/4 K.
    moving: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
}

fn quadratic(matrix: &DMatrix<f64>, x: &DVector<f64>) -> f64 {
    x.dot(&(matrix * x))
}

impl Form {
    fn of(system: &LinearModel, dt: f64, inner: Inner, blend: Blend) -> Self {
        let operators = system.operators();
        let n = operators.dofs();
        let solver = Stabiliser::new(operators, dt, GammaRule::Power, blend, inner);
        let mut inverse = DMatrix::zeros(n, n);
        let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            unit.fill(0.0);
            unit[j] = 1.0;
            solver.solve(&unit, &mut column);
            inverse.set_column(j, &DVector::from_row_slice(&column));
        }
        let p = inverse.try_inverse().unwrap();
        let p = (&p + p.transpose()) * 0.5;
        let (stiffness, damping) = (
            matrix(dense(operators.stiffness())),
            matrix(dense_damping(operators)),
        );
        Self {
            moving: p - &damping * (dt / 2.0) - &stiffness * (dt * dt / 4.0),
            stiffness,
            damping,
        }
    }

    /// Energy (J) of a step that has just been taken from the displacement `before`.
    fn energy(&self, before: &[f64], after: &State) -> f64 {
        let mean = |(a, b): (&f64, &f64)| 0.5 * (a + b);
        let middle = before.iter().zip(&after.u).map(mean);
        let middle = DVector::from_iterator(before.len(), middle);
        let v = DVector::from_row_slice(&after.v);
        0.5 * (quadratic(&self.moving, &v) + quadratic(&self.stiffness, &middle))
    }
}

/// Follows `steps` steps and shows the displacement before each, the velocity before it (none for the first) and the
/// state after it.
fn follow(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    dt: f64,
    steps: usize,
    mut see: impl FnMut(usize, &[f64], &[f64], &State),
) {
    let (mut u, mut v) = (vec![0.0; state.u.len()], vec![0.0; state.u.len()]);
    for step in 0..steps {
        u.copy_from_slice(&state.u);
        v.copy_from_slice(&state.v);
        integrator.step(system, state, dt).unwrap();
        see(step, &u, &v, state);
    }
}

/// 10,000 steps without damping at 250 times the limit.
fn assert_conserves(system: &LinearModel, inner: Inner, blend: Blend) {
    let dt = 250.0 * critical_step(system.operators());
    let form = Form::of(system, dt, inner, blend);
    let mut state = moving(system.dofs(), 1e-3, 1e-3 / dt);
    let (mut first, mut early, mut late) = (None, 0.0_f64, 0.0_f64);
    let mut integrator = method(inner, blend);
    follow(
        system,
        &mut integrator,
        &mut state,
        dt,
        10_000,
        |step, before, _, after| {
            let energy = form.energy(before, after);
            let change = energy / *first.get_or_insert(energy) - 1.0;
            assert!(
                change.abs() <= 1e-9,
                "{inner:?} {blend:?}, step {step}: {change:e}"
            );
            let size = if step < 5000 { &mut early } else { &mut late };
            *size = size.max(largest(&after.u));
        },
    );
    assert!(integrator.scheme().stabiliser().is_some());
    assert!(late <= 1.5 * early, "{inner:?}: {early} {late}");
    assert!(early <= 0.1, "{inner:?}: {early}");
}

#[test]
fn an_undamped_oscillator_keeps_its_energy_form_at_250_times_the_limit() {
    for inner in INNERS {
        for blend in [Blend::Auto, Blend::Full] {
            assert_conserves(&oscillator(0.0), inner, blend);
        }
    }
}

#[test]
fn an_undamped_network_keeps_its_energy_form_at_250_times_the_limit() {
    for inner in INNERS {
        assert_conserves(&network(0.0), inner, Blend::Auto);
    }
    assert_conserves(&network(0.0), Inner::Block, Blend::Full);
}

/// `E+ - E- = -dt vbar' D vbar`, vbar being the mean of the two velocities.
#[test]
fn damping_takes_from_the_energy_form_what_it_should() {
    for system in [network(80.0), damped_in_every_way(false)] {
        for share in [1.5, 250.0] {
            let dt = share * critical_step(system.operators());
            for inner in INNERS {
                let form = Form::of(&system, dt, inner, Blend::Auto);
                let mut state = moving(system.dofs(), 1e-3, 1e-3 / dt);
                let (mut first, mut before_energy, mut lost) = (0.0, 0.0, 0.0);
                let see = |step, before: &[f64], v: &[f64], after: &State| {
                    let energy = form.energy(before, after);
                    if step == 0 {
                        first = energy;
                    } else {
                        let sum = v.iter().zip(&after.v).map(|(a, b)| 0.5 * (a + b));
                        let mean = DVector::from_iterator(v.len(), sum);
                        let loss = dt * quadratic(&form.damping, &mean);
                        let error = (before_energy - energy - loss) / first;
                        assert!(
                            error.abs() <= 1e-10,
                            "{inner:?} at {share}, step {step}: {error:e}"
                        );
                        lost += loss;
                    }
                    before_energy = energy;
                };
                let mut integrator = method(inner, Blend::Auto);
                follow(&system, &mut integrator, &mut state, dt, 500, see);
                assert!(
                    lost > 1e-3 * first && lost <= first * (1.0 + 1e-9),
                    "{inner:?}"
                );
            }
        }
    }
}

/// The rest state does not depend on P.
#[cfg(feature = "implicit")]
#[test]
fn every_inner_iteration_comes_to_rest_where_stiffness_carries_the_load() {
    for (model, dt) in [
        (scene(3, 0.2, springs(0.0), mass_damping(80.0)), 0.02),
        (scene(3, 0.2, springs(0.3), mass_damping(30.0)), 0.1),
    ] {
        let mut load = vec![0.0; model.dofs()];
        model
            .operators()
            .external_force(sinew_core::LoadTime::at(1.0), &mut load);
        let expected = sinew_integrators::static_solution(&model, &load).unwrap();
        for inner in INNERS {
            for blend in [Blend::Auto, Blend::Full] {
                let mut state = State::at_rest(model.dofs());
                advance(&mut method(inner, blend), &model, &mut state, 3000, dt);
                let off: Vec<f64> = state.u.iter().zip(&expected).map(|(a, b)| a - b).collect();
                let off = largest(&off) / largest(&expected);
                assert!(off <= 1e-8, "{inner:?}: {off:e}");
            }
        }
    }
}

#[test]
fn below_the_critical_step_it_is_central_difference_to_the_last_bit() {
    for system in [network(0.0), network(80.0)] {
        let limit = critical_step(system.operators());
        for (share, same) in [(0.3, true), (0.9899, true), (0.9901, false)] {
            for inner in INNERS {
                assert_same_as_central_difference(&system, inner, share * limit, same);
            }
        }
    }
}

/// Damping of any kind lowers the limit of both; with more than one sweep it is centred in time.
#[test]
fn below_the_limit_under_any_damping_one_sweep_is_central_difference_to_the_last_bit() {
    for system in [
        stiffness_damped(2e-3, 0.0),
        stiffness_damped(2e-2, 80.0),
        dashpots(0.1),
        dashpots(1.0),
        damped_in_every_way(true),
    ] {
        let plain = build("central-difference", &plain());
        let Ok(StableStep::UpTo(limit)) = plain.stable_step(&system) else {
            panic!("central difference has a limit");
        };
        for share in [0.1, 0.3, 0.98] {
            for inner in [Inner::Block, Inner::Chebyshev { sweeps: 1 }] {
                assert_same_as_central_difference(&system, inner, share * limit, true);
            }
            let more = Inner::Jacobi { sweeps: 2 };
            assert_same_as_central_difference(&system, more, share * limit, false);
        }
        assert_same_as_central_difference(&system, Inner::Block, 1.5 * limit, false);
    }
}

#[track_caller]
fn assert_same_as_central_difference(system: &LinearModel, inner: Inner, dt: f64, same: bool) {
    let start = moving(system.dofs(), 1e-3, 0.1);
    let (mut one, mut other) = (start.clone(), start);
    let mut stabilised = method(inner, Blend::Auto);
    let mut plain = build("central-difference", &plain());
    for _ in 0..50 {
        let work = stabilised.step(system, &mut one, dt).unwrap();
        let expected = plain.step(system, &mut other, dt).unwrap();
        assert!(!same || work == expected);
    }
    assert_eq!(one == other, same, "{inner:?} at {dt} s");
    assert_eq!(stabilised.scheme().stabiliser().is_none(), same);
}

/// The same for a body with an initial motion: the damping that is not in P acts in the first half step.
#[test]
fn just_beyond_the_limit_the_first_step_is_nearly_that_of_central_difference() {
    for system in [stiffness_damped(2e-3, 0.0), dashpots(0.3)] {
        let mut plain = build("central-difference", &plain());
        let Ok(StableStep::UpTo(limit)) = plain.stable_step(&system) else {
            panic!("central difference has a limit");
        };
        let mut dt = 0.99 * limit;
        let mut stabilised = method(Inner::Block, Blend::Auto);
        while stabilised.scheme().stabiliser().is_none() {
            dt *= 1.001;
            stabilised.prepare(&system, dt).unwrap();
        }
        let start = moving(system.dofs(), 0.0, 0.1);
        let (mut one, mut other) = (start.clone(), start);
        stabilised.step(&system, &mut one, dt).unwrap();
        plain.step(&system, &mut other, dt).unwrap();
        let difference = crate::common::relative_error(&[one.u], &[other.u]);
        assert!(difference <= 0.01, "{difference}");
    }
}

/// No inertia is added if stability does not need it: the error is that of central difference, and smaller if several
/// sweeps centre the damping.
#[test]
fn within_the_stable_step_of_central_difference_its_error_is_no_larger() {
    let soft = Law::linear(3500.0, 0.3);
    let stiffness = Rayleigh::new(0.0, 2e-3);
    for system in [
        scene(4, 0.1, soft, stiffness),
        scene(4, 0.1, springs(0.1), mass_damping(0.0)),
    ] {
        let (exact, _, _) = run(&system, &mut *build("rk4", &plain()), 64);
        for parts in [4, 8, 16, 32] {
            let error = |integrator: &mut dyn Integrator| {
                crate::common::relative_error(&run(&system, integrator, parts).0, &exact)
            };
            let expected = error(&mut *build("central-difference", &plain()));
            for inner in INNERS {
                let found = error(&mut method(inner, Blend::Auto));
                let allowed = match inner.damping_share() {
                    DampingShare::AsStiffness => 1.1,
                    DampingShare::Whole => 0.5,
                };
                assert!(
                    found <= allowed * expected,
                    "{inner:?}, {parts} steps per 20 ms: {found:.4} {expected:.4}"
                );
            }
        }
    }
}

/// The displacements after each of `steps` steps.
#[cfg(feature = "implicit")]
fn displacements(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    start: &State,
    dt: f64,
) -> Vec<Vec<f64>> {
    let mut state = start.clone();
    let step = |_| {
        integrator.step(system, &mut state, dt).unwrap();
        state.u.clone()
    };
    (0..60).map(step).collect()
}

/// Both agree to 1e-8 after enough sweeps.
#[cfg(feature = "implicit")]
fn assert_becomes_newmark(system: &LinearModel, start: &State, blend: Blend) {
    for (share, inner) in [
        (1.4, Inner::Jacobi { sweeps: 400 }),
        (1.4, Inner::GaussSeidel { sweeps: 60 }),
        (5.0, Inner::Chebyshev { sweeps: 200 }),
    ] {
        let dt = share * critical_step(system.operators());
        let mut network = method(inner, blend);
        network.prepare(system, dt).unwrap();
        let s = network.scheme().stabiliser().unwrap().majorant().s();
        assert_eq!(s < 1.0, blend == Blend::Auto);
        let mut newmark = build("newmark", &plain().with_number("beta", s / 4.0));
        let found = displacements(system, &mut network, start, dt);
        let expected = displacements(system, &mut *newmark, start, dt);
        let error = crate::common::relative_error(&found, &expected);
        assert!(error <= 1e-8, "{inner:?}: {error:e}");
        // It is the iteration that does it.
        let one = displacements(system, &mut method(Inner::Block, blend), start, dt);
        assert!(crate::common::relative_error(&one, &expected) > 1e-3);
    }
}

/// With beta = s/4 and gamma = 1/2 both obey `A (u+ - 2 u + u-) = dt^2 (F - K u) - dt D (u - u-)`,
/// `A = M + dt/2 D + s dt^2/4 K`. The network's first step is `A (u1 - u0) = dt M v0 + dt^2/2 (F - K u0)`; Newmark's
/// adds `(1 - s) dt^3/4 D a0` on the right: the same without damping, with s = 1, or with a0 = 0.
#[cfg(feature = "implicit")]
#[test]
fn many_sweeps_make_it_newmark_s_method() {
    let loads = cube(3).operators().loads().to_vec();
    let undamped = altered(&cube(3), Damping::default(), loads);
    let damped = damped_in_every_way(true);
    let n = undamped.dofs();
    for start in [State::at_rest(n), moving(n, 0.0, 0.1), moving(n, 1e-3, 0.1)] {
        assert_becomes_newmark(&undamped, &start, Blend::Auto);
        assert_becomes_newmark(&undamped, &start, Blend::Full);
        assert_becomes_newmark(&damped, &start, Blend::Full);
    }
}

/// F = K u0 + D v0.
#[cfg(feature = "implicit")]
#[test]
fn damped_motion_without_a_first_acceleration_is_newmark_s_at_any_s() {
    let unloaded = damped_in_every_way(false);
    let start = moving(unloaded.dofs(), 1e-3, 0.1);
    let mut force = vec![0.0; unloaded.dofs()];
    unloaded
        .operators()
        .subtract_internal_force(&start.u, &start.v, &mut force);
    let load = Load {
        ramp: Ramp::Step,
        entries: (0..).zip(force.iter().map(|force| -force)).collect(),
    };
    let damping = unloaded.operators().damping().clone();
    let system = altered(
        &scene(3, 0.2, springs(0.3), mass_damping(5.0)),
        damping,
        vec![load],
    );
    assert_becomes_newmark(&system, &start, Blend::Auto);
}

#[cfg(feature = "implicit")]
#[test]
fn otherwise_the_first_steps_differ_by_the_jerk_of_the_damping() {
    let system = damped_in_every_way(true);
    let operators = system.operators();
    let dt = 1.4 * critical_step(operators);
    let start = moving(system.dofs(), 1e-3, 0.1);
    let mut network = method(Inner::GaussSeidel { sweeps: 200 }, Blend::Auto);
    network.prepare(&system, dt).unwrap();
    let s = network.scheme().stabiliser().unwrap().majorant().s();
    let mut newmark = build("newmark", &plain().with_number("beta", s / 4.0));
    let [one, other] = [
        displacements(&system, &mut network, &start, dt).swap_remove(0),
        displacements(&system, &mut *newmark, &start, dt).swap_remove(0),
    ]
    .map(DVector::from_vec);
    let mass = DMatrix::from_diagonal(&DVector::from_row_slice(operators.mass()));
    let k = matrix(dense(operators.stiffness()));
    let d = matrix(dense_damping(operators));
    let mut net = vec![0.0; system.dofs()];
    operators.net_force(0.0, &start.u, &start.v, &mut net);
    let a0 = DVector::from_vec(net).component_div(&DVector::from_row_slice(operators.mass()));
    let a = mass + &d * (dt / 2.0) + k * (s * dt * dt / 4.0);
    let expected = a.lu().solve(&(d * a0)).unwrap() * ((1.0 - s) * dt.powi(3) / 4.0);
    let difference = other - one;
    assert!(difference.norm() > 1e-5);
    let error = (&difference - &expected).norm() / expected.norm();
    assert!(error <= 1e-8, "{error:e}");
}

/// The observed order between `parts` and twice as many steps for each of 20 steps of `dt`.
fn observed_order(
    system: &LinearModel,
    start: &State,
    make: impl Fn() -> Frame<CnnStabilised>,
    dt: f64,
    parts: usize,
) -> f64 {
    let exact = [exponentials(system, start, 20.0 * dt, 1).swap_remove(0).u];
    let error = |parts: usize| {
        let mut state = start.clone();
        advance(
            &mut make(),
            system,
            &mut state,
            20 * parts,
            dt / parts as f64,
        );
        crate::common::relative_error(&[state.u], &exact)
    };
    (error(parts) / error(2 * parts)).log2()
}

/// With s = 1 P differs from M at every step. One block per cell adds `dt/2 gamma blockdiag(D')` to
/// the inertia, D' being the damping other than alpha M; iterations that converge as dt falls do not.
#[test]
fn order_2_with_mass_damping_and_as_declared_with_other_damping() {
    for (system, mass_damping_only) in [
        (network(20.0), true),
        (stiffness_damped(2e-3, 0.0), false),
        (dashpots(0.3), false),
        (damped_in_every_way(true), false),
    ] {
        let dt = 0.2 * critical_step(system.operators());
        let start = moving(system.dofs(), 1e-3, 0.1);
        for inner in INNERS {
            for blend in [Blend::Auto, Blend::Full] {
                let make = || method(inner, blend);
                let declared = make().properties();
                let declared = if mass_damping_only {
                    declared.accuracy.order(true)
                } else {
                    let other = declared.other_damping;
                    assert_eq!(other.stiffness, other.dashpots);
                    other.stiffness.and_then(|accuracy| accuracy.order(true))
                };
                let order = observed_order(&system, &start, make, dt, 64);
                let off = order - f64::from(declared.unwrap());
                assert!(off.abs() <= 0.1, "{inner:?} {blend:?}: {order}");
            }
        }
    }
}

/// The cube's network with one cell on a very stiff spring that no step resolves: at each of these steps all other
/// cells move with P beyond the limit.
#[test]
fn beyond_the_limit_one_sweep_is_of_order_2_with_mass_damping_and_1_with_other() {
    let mut stiffness = cube(3).operators().stiffness().as_ref().clone();
    let spring = DMatrix::<f64>::identity(3, 3) * 1e10;
    stiffness.add_block(5, 5, spring.as_slice()).unwrap();
    let none = Damping::default;
    let dashpots = dashpots(0.3).operators().damping().clone();
    for (damping, expected) in [
        (none(), 2.0),
        (
            Damping {
                mass: 20.0,
                ..none()
            },
            2.0,
        ),
        (
            Damping {
                stiffness: 2e-3,
                ..none()
            },
            1.0,
        ),
        (dashpots, 1.0),
    ] {
        let soft = cube(3);
        let (mass, loads) = (soft.operators().mass().to_vec(), soft.operators().loads());
        let operators = LinearOperators::new(mass, stiffness.clone(), damping, loads.to_vec());
        let system = LinearModel::new(operators.unwrap());
        let dt = 0.2 * critical_step(soft.operators());
        assert!(dt / 32.0 > 10.0 * critical_step(system.operators()));
        let start = State::at_rest(system.dofs());
        for (inner, expected) in [
            (Inner::Block, expected),
            (Inner::Jacobi { sweeps: 4 }, 2.0),
            (Inner::GaussSeidel { sweeps: 2 }, 2.0),
        ] {
            let order = observed_order(&system, &start, || method(inner, Blend::Auto), dt, 16);
            assert!((order - expected).abs() <= 0.1, "{inner:?}: {order}");
        }
    }
}

#[test]
fn work_is_one_sweep_and_those_of_the_inner_iteration() {
    let system = network(80.0);
    let dt = 3.0 * critical_step(system.operators());
    for (kind, sweeps, expected) in [
        ("block", None, 1),
        ("jacobi", Some(3.0), 3),
        ("chebyshev", Some(1.0), 1),
        ("chebyshev", Some(8.0), 8),
        ("gauss-seidel", Some(1.0), 2),
        ("gauss-seidel", Some(3.0), 6),
    ] {
        let options = plain().with("inner", inner(kind, sweeps));
        let mut integrator = build("cnn-stabilised", &options);
        let mut state = State::at_rest(system.dofs());
        for _ in 0..3 {
            let work = integrator.step(&system, &mut state, dt).unwrap();
            assert_eq!(work.sweeps, expected, "{kind}");
        }
    }
}

#[test]
fn facts_say_what_was_added() {
    let system = damped_in_every_way(false);
    let dt = 250.0 * critical_step(system.operators());
    let facts = |gamma: &str| {
        let gamma = OptionValue::Text(gamma.into());
        let mut integrator = build("cnn-stabilised", &plain().with("gamma", gamma));
        assert!(integrator.facts().is_empty());
        integrator.prepare(&system, dt).unwrap();
        let facts = integrator.facts();
        let names: Vec<&str> = facts.iter().map(|fact| fact.name).collect();
        assert_eq!(
            names,
            ["s", "s_d", "gamma", "certificate", "slowest_period"]
        );
        facts.iter().map(|fact| fact.value).collect::<Vec<f64>>()
    };
    let (power, circles) = (facts("power"), facts("gershgorin"));
    // Damping can only raise the share; one block per cell takes as much of it.
    let undamped = 1.0 - (0.99_f64 / 250.0).powi(2);
    assert!(power[0] > undamped && power[0] < 1.0);
    assert_eq!(power[1], power[0]);
    assert!(power[2] > 1.0 && power[2] < circles[2]);
    assert!(power[3] < 1.0 && circles[3] < power[3]);
}

#[test]
fn options_that_make_no_sense_are_refused() {
    const INNER: &str = "{ kind = \"block\" }, or kind = \"jacobi\", \"chebyshev\" or \"gauss-seidel\" with sweeps = a whole number from 1 to 10000";
    let text = |word: &str| OptionValue::Text(word.into());
    let number = OptionValue::Number;
    let mut misspelt = BTreeMap::from([("kind".to_owned(), text("jacobi"))]);
    misspelt.insert("sweep".to_owned(), number(3.0));
    for (key, value, shown, expected) in [
        (
            "inner",
            inner("chebyshev", Some(0.0)),
            "{ kind = \"chebyshev\", sweeps = 0 }",
            INNER,
        ),
        (
            "inner",
            inner("jacobi", Some(2.5)),
            "{ kind = \"jacobi\", sweeps = 2.5 }",
            INNER,
        ),
        (
            "inner",
            inner("jacobi", Some(f64::NAN)),
            "{ kind = \"jacobi\", sweeps = NaN }",
            INNER,
        ),
        (
            "inner",
            inner("jacobi", Some(-1.0)),
            "{ kind = \"jacobi\", sweeps = -1 }",
            INNER,
        ),
        (
            "inner",
            inner("gauss-seidel", None),
            "{ kind = \"gauss-seidel\" }",
            INNER,
        ),
        (
            "inner",
            inner("block", Some(2.0)),
            "{ kind = \"block\", sweeps = 2 }",
            INNER,
        ),
        (
            "inner",
            inner("cg", Some(2.0)),
            "{ kind = \"cg\", sweeps = 2 }",
            INNER,
        ),
        (
            "inner",
            OptionValue::Table(misspelt),
            "{ kind = \"jacobi\", sweep = 3 }",
            INNER,
        ),
        ("inner", text("jacobi"), "\"jacobi\"", INNER),
        ("s", number(0.5), "0.5", "\"auto\" or 1"),
        ("s", number(f64::NAN), "NaN", "\"auto\" or 1"),
        ("s", text("full"), "\"full\"", "\"auto\" or 1"),
        (
            "gamma",
            text("tight"),
            "\"tight\"",
            "\"power\" or \"gershgorin\"",
        ),
        ("gamma", number(2.0), "2", "\"power\" or \"gershgorin\""),
    ] {
        let options = Options::new().with(key, value);
        let refusal = sinew_integrators::build("cnn-stabilised", &options).err();
        assert_eq!(
            refusal.unwrap().to_string(),
            format!("`cnn-stabilised`: {key} = {shown}: expected {expected}")
        );
    }
}

/// Beyond the critical step M^-1 of the force is not the acceleration of the motion: extrapolating
/// with it would give velocities thousands of times too large.
#[test]
fn the_velocity_at_the_time_of_the_displacement_is_of_the_size_of_its_neighbours() {
    let system = network(1.0);
    let linear = &system;
    for factor in [2.5, 25.0, 250.0] {
        let dt = factor * critical_step(linear.operators());
        let mut integrator = method(Inner::Block, Blend::Auto);
        let mut state = moving(system.dofs(), 1e-3, 1e-2);
        for _ in 0..20 {
            let before = largest(&state.v);
            integrator.step(&system, &mut state, dt).unwrap();
            let mut at_t = vec![0.0; system.dofs()];
            state
                .velocity_at_t(&system, sinew_core::Inputs::none(), &mut at_t)
                .unwrap();
            let around = before.max(largest(&state.v));
            assert!(
                largest(&at_t) <= 3.0 * around,
                "{:.1e} among {around:.1e} at {factor} x critical",
                largest(&at_t)
            );
        }
    }
}

/// A chain of masses between walls, numbered from one end or in a shuffled order, loaded at one mass; returns
/// the displacement of each mass along the chain.
fn chain_numbered_by(order: [u32; 9], inner: Inner) -> Vec<f64> {
    let pairs: Vec<[u32; 2]> = order.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let pattern = Arc::new(Pattern::from_elements(9, &pairs).unwrap());
    let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
    for pair in &pairs {
        let spring = [100.0, -100.0, -100.0, 100.0];
        stiffness.add_element(pair, &spring).unwrap();
    }
    for end in [order[0], order[8]] {
        stiffness.add_block(end, end, &[100.0]).unwrap();
    }
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(order[2], 1.0)],
    };
    let damping = Damping {
        mass: 2.0,
        ..Damping::default()
    };
    let operators = LinearOperators::new(vec![0.1; 9], stiffness, damping, vec![load]).unwrap();
    let system = LinearModel::new(operators);
    let mut state = State::at_rest(9);
    let mut integrator = method(inner, Blend::Auto);
    // Five times the critical step.
    for _ in 0..10 {
        integrator.step(&system, &mut state, 0.16).unwrap();
    }
    order.iter().map(|cell| state.u[*cell as usize]).collect()
}

#[test]
fn only_gauss_seidel_depends_on_the_numbering_of_the_nodes() {
    let difference = |inner| {
        let plain = chain_numbered_by([0, 1, 2, 3, 4, 5, 6, 7, 8], inner);
        let shuffled = chain_numbered_by([4, 0, 7, 2, 8, 1, 6, 3, 5], inner);
        let size = plain.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
        let differences = plain.iter().zip(&shuffled).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max) / size
    };
    for inner in [
        Inner::Block,
        Inner::Jacobi { sweeps: 3 },
        Inner::Chebyshev { sweeps: 3 },
    ] {
        assert!(difference(inner) < 1e-12, "{inner:?}");
    }
    let of_gauss_seidel = difference(Inner::GaussSeidel { sweeps: 2 });
    assert!(of_gauss_seidel > 0.01, "{of_gauss_seidel}");
}
