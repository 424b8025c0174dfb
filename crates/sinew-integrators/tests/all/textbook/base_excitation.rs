//! A mass on a spring whose base moves, by every method, against closed forms.

use std::f64::consts::PI;

use crate::common::build;
use crate::common::tissue::{DENSITY, body, linear};
use sinew_core::closed_form::DampedOscillator;
use sinew_core::{
    Accuracy, Between, ChangingLoads, Inputs, LinearSystem, LoadOverStep, OptionValue, Options,
    Properties, Ramp, StableStep, State, StepError, System,
};
use sinew_fem::{Course, Fixed, Law, Model, Moving, On, Problem, Rayleigh, SpringRule};
use sinew_integrators::entries;
use sinew_mesh::TetMesh;

const EDGE: f64 = 0.1;
const DURATION: f64 = 0.4;

/// Total displacement of the base (m).
const WAY: f64 = 0.003;

/// One tetrahedron whose base moves along z and whose tip is free along z: one degree of freedom.
fn tower(law: Law, damping: Rayleigh, courses: Vec<Course>) -> Model {
    let points = vec![
        [0.0; 3],
        [EDGE, 0.0, 0.0],
        [0.0, EDGE, 0.0],
        [0.0, 0.0, EDGE],
    ];
    let mesh = TetMesh::new(points, vec![[0, 1, 2, 3]]).unwrap();
    let problem = Problem {
        fixed: vec![Fixed::at(On::Nodes(vec![0, 1, 2, 3])).along([true, true, false])],
        moves: vec![Moving::new(On::Nodes(vec![0, 1, 2]), courses).along([false, false, true])],
        damping,
        ..body(law)
    };
    Model::build(&mesh, &problem).unwrap()
}

/// A path of the base over time, relative to [`WAY`].
#[derive(Clone, Debug)]
enum Way {
    Rise(f64),
    /// Times and values of straight lines.
    Lines(Vec<f64>, Vec<f64>),
    /// Motion at 1/s from t = 0 on.
    Speed,
}

impl Way {
    fn courses(&self) -> Vec<Course> {
        let by = |ramp| Course::new([0.0, 0.0, WAY], ramp);
        match self {
            Self::Rise(rise) => vec![by(Ramp::Sin2 { rise: *rise })],
            Self::Lines(times, values) => {
                let positions: Vec<[f64; 3]> = values.iter().map(|z| [0.0, 0.0, z * WAY]).collect();
                Course::along(times, &positions)
            }
            Self::Speed => vec![Course::at_velocity([0.0, 0.0, WAY])],
        }
    }

    fn ramp(&self) -> Ramp {
        match self {
            Self::Rise(rise) => Ramp::Sin2 { rise: *rise },
            Self::Lines(times, values) => Ramp::Table {
                times: times.clone(),
                values: values.clone(),
            },
            Self::Speed => Ramp::Linear,
        }
    }
}

/// m u'' + alpha m u' + kappa m (u' - b') + omega^2 m (u - b) = 0.
#[derive(Clone, Copy, Debug)]
struct Tower {
    omega: f64,
    alpha: f64,
    kappa: f64,
}

impl Tower {
    /// Its parameters, from the stiffness of the single element E h/6 and mass rho h^3/24, Poisson's ratio being 0.
    fn elastic(youngs_modulus: f64, damping: Rayleigh) -> Self {
        let mass = DENSITY * EDGE.powi(3) / 24.0;
        let omega_squared = youngs_modulus * EDGE / 6.0 / mass;
        Self {
            omega: omega_squared.sqrt(),
            alpha: damping.mass,
            kappa: damping.stiffness * omega_squared,
        }
    }

    /// (u, u') at time `t` (s), from the initial (u, u') under `load` omega^2.
    fn free(self, [u, v]: [f64; 2], load: f64, t: f64) -> [f64; 2] {
        let motion = DampedOscillator {
            omega: self.omega,
            damping: self.alpha + self.kappa,
            load: load * self.omega.powi(2),
            displacement: u,
            velocity: v,
        };
        motion.at(t).into()
    }

    /// (u, u') at `t` (s) of the motion along the path, from rest (textbooks on vibrations: support excitation, e.g.
    /// Clough and Penzien, Dynamics of Structures, section 3-6).
    fn at(self, way: &Way, t: f64) -> [f64; 2] {
        let Self {
            omega,
            alpha,
            kappa,
        } = self;
        let w2 = omega * omega;
        match way {
            Way::Rise(rise) if t > *rise => self.free(self.at(way, *rise), 1.0, t - rise),
            Way::Rise(rise) => {
                // b = (1 - cos(r t))/2: u'' + (alpha + kappa) u' + w2 u = w2/2 - w2/2 cos(r t) + kappa r/2 sin(r t).
                let r = PI / rise;
                let (p, s) = (w2 - r * r, (alpha + kappa) * r);
                let (of_cos, of_sin) = (-0.5 * w2, 0.5 * kappa * r);
                let a = (p * of_cos - s * of_sin) / (p * p + s * s);
                let b = (p * of_sin + s * of_cos) / (p * p + s * s);
                let (sin, cos) = (r * t).sin_cos();
                let [q, v] = self.free([-a, -b * r], 0.5, t);
                [a * cos + b * sin + q, r * (b * cos - a * sin) + v]
            }
            Way::Lines(times, values) => {
                let mut state = [0.0; 2];
                for (times, values) in times.windows(2).zip(values.windows(2)) {
                    if t <= times[0] {
                        return state;
                    }
                    let slope = (values[1] - values[0]) / (times[1] - times[0]);
                    let passed = t.min(times[1]) - times[0];
                    // On a base at constant speed, mass damping alone pulls back.
                    let lag = values[0] - alpha * slope / w2;
                    let [q, v] = self.free([state[0] - lag, state[1] - slope], 0.0, passed);
                    state = [lag + slope * passed + q, slope + v];
                }
                let end = times[times.len() - 1];
                if t > end {
                    return self.free(state, values[values.len() - 1], t - end);
                }
                state
            }
            Way::Speed => {
                let lines = Way::Lines(vec![0.0, 2.0 * DURATION], vec![0.0, 2.0 * DURATION]);
                self.at(&lines, t)
            }
        }
    }
}

/// Relative error of a method over the duration in `coarse` times `refinement` steps; `None` if it refuses the loads.
fn error(
    (id, options): (&str, &Options),
    model: &Model,
    expected: impl Fn(f64) -> f64,
    coarse: usize,
    refinement: usize,
) -> Option<f64> {
    let tip = model.dofs() - 1;
    let mut integrator = build(id, options);
    let mut state = State::at_rest(model.dofs());
    let dt = DURATION / (coarse * refinement) as f64;
    let (mut sum, mut size) = (0.0, 0.0);
    for step in 1..=coarse {
        for _ in 0..refinement {
            match integrator.step(model, &mut state, dt) {
                Ok(_) => {}
                Err(StepError::Inaccurate { .. }) => return None,
                Err(error) => panic!("{id}: {error}"),
            }
        }
        let expected = WAY * expected(DURATION * step as f64 / coarse as f64);
        sum += (state.u[tip] - expected).powi(2);
        size += expected.powi(2);
    }
    Some((sum / size).sqrt())
}

/// The order that a method declares for a path, with stiffness damping or without; `None` for exact methods.
fn declared(properties: &Properties, smooth: bool, damped: bool) -> Option<u8> {
    let order = |accuracy: Accuracy| accuracy.order(true);
    let loads = match properties.changing_loads {
        ChangingLoads::Exact(_) => return None,
        ChangingLoads::Order { smooth: order, .. } if smooth => order,
        ChangingLoads::Order { broken, .. } => broken,
    };
    let other = properties.other_damping.stiffness.filter(|_| damped);
    let orders = [order(properties.accuracy), other.and_then(order)];
    Some(orders.into_iter().flatten().fold(loads, u8::min))
}

fn ways() -> Vec<(Way, bool)> {
    let on = |n: f64| n * DURATION / 20.0;
    let lines = |late: f64| {
        let times = [2.0, 7.0, 8.0, 15.0].map(|n| on(n + late));
        Way::Lines(times.to_vec(), vec![0.0, 1.0, 1.0, -0.5])
    };
    vec![
        (Way::Rise(2.0 * DURATION), true),
        (Way::Rise(on(13.0)), false),
        (Way::Rise(on(13.37)), false),
        (lines(0.0), false),
        (lines(0.37), false),
        (Way::Speed, false),
    ]
}

#[test]
fn every_method_follows_a_moving_base_at_its_order() {
    let youngs_modulus = 5e3;
    let law = linear(youngs_modulus, 0.0);
    let dampings = [(0.0, 0.0), (3.0, 0.0), (0.0, 2e-3), (3.0, 2e-3)];
    let mut taken = 0;
    for (mass, stiffness) in dampings {
        let damping = Rayleigh::new(mass, stiffness);
        let tower_in_theory = Tower::elastic(youngs_modulus, damping);
        for (way, smooth) in ways() {
            let model = tower(law.clone(), damping, way.courses());
            let expected = |t: f64| tower_in_theory.at(&way, t)[0];
            for entry in entries() {
                let integrator = entry.build(&Options::new()).unwrap();
                let properties = integrator.properties();
                let dt = match integrator.stable_step(&model).unwrap() {
                    StableStep::UpTo(limit) if limit > 0.0 => limit / 4.0,
                    StableStep::UpTo(_) => continue,
                    _ => 0.5 / tower_in_theory.omega,
                };
                let coarse = 20 * (DURATION / 20.0 / dt).ceil() as usize;
                let what = format!("{}, {damping:?}, {way:?}", entry.id);
                let method = (entry.id, &Options::new());
                let error = |refinement| error(method, &model, expected, coarse, refinement);
                match declared(&properties, smooth, stiffness > 0.0) {
                    None => {
                        let needed = properties.changing_loads.needed();
                        let step = DURATION / coarse as f64;
                        let ramps = [way.ramp(), way.ramp().rate()];
                        let used = if stiffness > 0.0 {
                            &ramps[..]
                        } else {
                            &ramps[..1]
                        };
                        let broken = used
                            .iter()
                            .any(|ramp| needed.first_broken(ramp, 0.0, step, DURATION).is_some());
                        match error(1) {
                            Some(error) => {
                                assert!(!broken, "{what}: taken");
                                assert!(error <= 1e-9, "{what}: {error:e}");
                                taken += 1;
                            }
                            None => {
                                assert!(broken && needed != LoadOverStep::Any, "{what}: refused");
                            }
                        }
                    }
                    Some(order) => {
                        let errors = [8, 32].map(error);
                        let [Some(larger), Some(smaller)] = errors else {
                            panic!("{what}: refused");
                        };
                        let observed = (larger / smaller).log2() / 2.0;
                        assert!(
                            observed >= f64::from(order) - 0.1,
                            "{what}: observed {observed:.3} of {order}, {errors:?}"
                        );
                        assert!(smaller <= 0.05, "{what}: {smaller:e}");
                        taken += 1;
                    }
                }
            }
        }
    }
    assert!(taken > 150, "{taken}");
}

/// A path is a load, or two with stiffness damping, from which Ritz vectors are computed.
#[cfg(feature = "implicit")]
#[test]
fn ritz_vectors_follow_a_moving_base() {
    let law = linear(5e3, 0.0);
    let ritz = Options::new().with("vectors", OptionValue::Text("ritz".into()));
    for (mass, stiffness) in [(0.0, 0.0), (3.0, 2e-3)] {
        let damping = Rayleigh::new(mass, stiffness);
        let theory = Tower::elastic(5e3, damping);
        for (way, _) in ways() {
            let model = tower(law.clone(), damping, way.courses());
            let expected = |t: f64| theory.at(&way, t)[0];
            let error = error(("modal", &ritz), &model, expected, 40, 1).unwrap();
            assert!(error <= 1e-9, "{way:?}: {error:e}");
        }
    }
}

/// Springs with dashpots: the base pulls through both.
#[test]
fn dashpots_see_the_velocity_of_the_base() {
    let law = Law::Springs {
        youngs_modulus: 5e3,
        rule: SpringRule::Lloyd,
        calibrate: false,
        damping_ratio: 0.2,
    };
    let way = Way::Rise(0.26);
    let damping = Rayleigh::new(3.0, 1e-3);
    let model = tower(law, damping, way.courses());
    let operators = model.operators();
    let tip = model.dofs() - 1;
    let cell = tip / 3;
    let diagonal = |matrix: &sinew_core::BlockMatrix| matrix.block(cell, cell).unwrap()[8];
    let omega_squared = diagonal(operators.stiffness()) / operators.mass()[tip];
    let dashpots = diagonal(operators.damping().extra.as_ref().unwrap()) / operators.mass()[tip];
    assert!(dashpots > 1.0);
    let in_theory = Tower {
        omega: omega_squared.sqrt(),
        alpha: damping.mass,
        kappa: damping.stiffness * omega_squared + dashpots,
    };
    let expected = |t: f64| in_theory.at(&way, t)[0];
    let mut refusals = Vec::new();
    for entry in entries() {
        let mut integrator = entry.build(&Options::new()).unwrap();
        if integrator.properties().other_damping.dashpots.is_none() {
            assert!(integrator.prepare(&model, 1e-3).is_err(), "{}", entry.id);
            refusals.push(entry.id);
            continue;
        }
        let error = error((entry.id, &Options::new()), &model, expected, 400, 4).unwrap();
        assert!(error <= 5e-3, "{}: {error:e}", entry.id);
    }
    assert_eq!(refusals, ["propagator", "modal"]);
}

/// A base that an input moves during the run moves like one whose table was known beforehand.
#[test]
fn a_base_moved_by_an_input_is_one_moved_by_its_table() {
    let damping = Rayleigh::new(0.0, 2e-3);
    let (dt, steps) = (2e-3, 100);
    let times: Vec<f64> = (0..=steps).map(|n| f64::from(n) * dt).collect();
    let values: Vec<f64> = times.iter().map(|t| (30.0 * t).sin()).collect();
    let mut inputs = Inputs::new();
    let channel = inputs.add_channel(Between::Line);
    let law = linear(5e3, 0.0);
    let known = tower(
        law.clone(),
        damping,
        Way::Lines(times.clone(), values.clone()).courses(),
    );
    let live = Course::new([0.0, 0.0, WAY], Ramp::Input(channel));
    let live = tower(law, damping, vec![live]);
    for id in ["central-difference", "newmark", "cnn", "rk4"] {
        let mut inputs = inputs.clone();
        let fresh = || build(id, &Options::new());
        let (mut by_table, mut by_input) = (fresh(), fresh());
        let (mut expected, mut reached) =
            (State::at_rest(known.dofs()), State::at_rest(live.dofs()));
        let mut size = 0.0_f64;
        for (t, value) in times.iter().zip(&values).skip(1) {
            inputs.set(channel, *t, *value).unwrap();
            by_table.step(&known, &mut expected, dt).unwrap();
            by_input
                .step_under(&live, &inputs, &mut reached, dt)
                .unwrap();
            for (u, expected) in reached.u.iter().zip(&expected.u) {
                size = size.max(expected.abs());
                assert!(
                    (u - expected).abs() < 1e-13 * WAY,
                    "{id} at {t}: {u} {expected}"
                );
            }
            let when = sinew_core::LoadTime::at(*t).under(&inputs);
            let base = live.node_displacement(when, &reached.u, 0).unwrap();
            assert!((base[2] - WAY * value).abs() < 1e-16, "{base:?}");
        }
        assert!(size > 0.5 * WAY, "{id}: {size}");
    }
}
