//! Bodies whose supports move, by every method and law, against closed forms.

use std::f64::consts::PI;

use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Integrator, LinearSystem, LoadTime, OptionValue, Options, Ramp, SetupError, StableStep, State,
    System,
};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, Fixed, Law, Model, Moving, On, Problem, Rayleigh};
use sinew_integrators::{entries, static_solution};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

use crate::common::tissue::{DENSITY, body, held, linear};
use crate::common::{build, largest, relative_error};

const YOUNGS_MODULUS: f64 = 5000.0;

fn hyperelastic(id: &'static str, poissons_ratio: f64) -> Law {
    let parameters = Parameters::new(YOUNGS_MODULUS, poissons_ratio);
    Law::hyperelastic(id, parameters)
}

/// A method with a step (s) for a body.
struct Method {
    name: String,
    integrator: Box<dyn Integrator>,
    dt: f64,
}

/// All methods and their variants that support a body, with a step of `long` (s), or a quarter of the stable step for
/// methods that must resolve the fastest motion. `small` is the body at small strain.
fn methods(model: &Model, small: &Model, long: f64) -> Vec<Method> {
    let critical = 2.0 / Spectrum::of(small.operators()).omega_max;
    let mut methods = Vec::new();
    for entry in entries() {
        let variants = (entry.variants)().into_iter();
        for options in std::iter::once(Options::new()).chain(variants) {
            let options = match entry.id {
                // Iterations until they have come to rest.
                "cnn-energy" => options.with_number("sweeps", 60.0),
                _ => options,
            };
            let name = format!("`{}` with {options:?}", entry.id);
            let mut integrator = build(entry.id, &options);
            let dt = match integrator.stable_step(model) {
                Ok(StableStep::UpTo(0.0)) => critical / 64.0,
                Ok(StableStep::UpTo(limit)) => long.min(limit / 4.0),
                // Its added mass slows what it does not resolve.
                Ok(_) if entry.id == "cnn-stabilised" => long.min(critical / 4.0),
                Ok(_) => long,
                Err(_) => continue,
            };
            match integrator.prepare(model, dt) {
                Ok(_) => methods.push(Method {
                    name,
                    integrator,
                    dt,
                }),
                Err(SetupError::Lacks { .. }) => {}
                Err(error) => panic!("{name}: {error}"),
            }
        }
    }
    methods
}

/// Steps of a body, each shown with its number, its time (s) and the forces (N) of supports at all nodes; none if a
/// method refuses the motion.
fn follow(
    method: &mut Method,
    model: &Model,
    (mut state, steps): (State, usize),
    mut see: impl FnMut(usize, f64, &[[f64; 3]]),
) {
    let dt = method.dt;
    let mut forces = vec![[0.0; 3]; model.mesh().points.len()];
    for step in 0..=steps {
        if step > 0 {
            match method.integrator.step(model, &mut state, dt) {
                Ok(_) => {}
                Err(sinew_core::StepError::Inaccurate { .. }) => return,
                Err(error) => panic!("{}: {error}", method.name),
            }
        }
        let t = state.t();
        reactions(model, &state, &mut forces);
        see(step, t, &forces);
    }
}

/// The forces (N) of supports in a state.
fn reactions(model: &Model, state: &State, forces: &mut [[f64; 3]]) {
    let (t, dt) = (state.t(), state.clock.last_step().unwrap_or(0.0));
    let when = LoadTime::around(t, dt.min(t), dt);
    model.reactions_in(when, state, forces).unwrap();
}

/// The nodes of a mesh at one end of an axis.
fn face(mesh: &TetMesh, axis: usize, at: f64) -> On {
    let is_there = |(_, point): &(u32, &[f64; 3])| (point[axis] - at).abs() < 1e-9;
    let nodes = (0..).zip(&mesh.points).filter(is_there);
    On::Nodes(nodes.map(|(node, _)| node).collect())
}

fn is_linear(model: &Model) -> bool {
    (model as &dyn System).as_linear().is_some()
}

/// Newton's first law, at steps beyond the fastest motion for methods that support them.
#[test]
fn a_body_and_its_clamp_at_one_speed_feel_no_force() {
    let size = [0.2, 0.05, 0.05];
    let velocity = [1.5, -0.4, 0.9];
    let mesh = structured::block([4, 1, 1], size, Split::Kuhn).unwrap();
    let soft = linear(YOUNGS_MODULUS, 0.3);
    let large = hyperelastic("neo-hookean", 0.3);
    for (law, stiffness) in [
        (soft.clone(), 0.0),
        (soft.clone(), 2e-3),
        (large.clone(), 0.0),
        (large, 2e-3),
    ] {
        let problem = |law| Problem {
            moves: vec![Moving::new(
                face(&mesh, 0, 0.0),
                [Course::at_velocity(velocity)],
            )],
            damping: Rayleigh::new(0.0, stiffness),
            ..body(law)
        };
        let [model, small] =
            [law.clone(), soft.clone()].map(|law| Model::build(&mesh, &problem(law)).unwrap());
        let v: Vec<f64> = velocity
            .iter()
            .copied()
            .cycle()
            .take(model.dofs())
            .collect();
        for mut method in methods(&model, &small, 0.01) {
            // What a support that is a step off pulls with.
            let scale = YOUNGS_MODULUS * size[1] * size[2] * 1.5 * method.dt / 0.05;
            let start = State::new(vec![0.0; model.dofs()], v.clone());
            let mut worst = 0.0_f64;
            follow(&mut method, &model, (start, 4), |_, _, forces| {
                worst = worst.max(largest(forces.as_flattened()));
            });
            let off = worst / scale;
            // An iteration that begins anew in the first step ends before its last digit.
            let bound = if method.name.contains("chebyshev") {
                1e-5
            } else {
                1e-9
            };
            assert!(off < bound, "{}, {law}, {stiffness}: {off:e}", method.name);
        }
    }
}

/// The stabilised network at these multiples of the step of central difference, on a block whose end moves as `course`
/// describes; initially the whole block has this velocity (m/s). Returns the largest force (N) on the support in
/// `steps` steps, from the third on.
fn beyond_the_stable_step(
    (times, options): (f64, &Options),
    (stiffness, modulus): (f64, f64),
    (course, velocity): (Course, [f64; 3]),
    steps: usize,
) -> f64 {
    let mesh = structured::block([4, 1, 1], [0.2, 0.05, 0.05], Split::Kuhn).unwrap();
    let problem = Problem {
        moves: vec![Moving::new(face(&mesh, 0, 0.0), [course])],
        damping: Rayleigh::new(0.0, stiffness),
        ..body(linear(modulus, 0.3))
    };
    let model = Model::build(&mesh, &problem).unwrap();
    let dt = times * 2.0 / Spectrum::of(model.operators()).omega_max;
    let mut integrator = build("cnn-stabilised", options);
    integrator.prepare(&model, dt).unwrap();
    let mut method = Method {
        name: format!("{times} times the stable step with {options:?}"),
        integrator,
        dt,
    };
    let v = velocity.iter().copied().cycle().take(model.dofs());
    let start = State::new(vec![0.0; model.dofs()], v.collect());
    let mut largest_force = 0.0_f64;
    follow(&mut method, &model, (start, steps), |step, _, forces| {
        if step > 2 {
            let sum = [0, 1, 2].map(|axis| forces.iter().map(|force| force[axis]).sum::<f64>());
            largest_force = largest_force.max(largest(&sum));
        }
    });
    largest_force
}

#[test]
fn beyond_the_stable_step_the_stabilised_network_carries_what_supports_carry() {
    let velocity = [1.5, -0.4, 0.9];
    let chebyshev = sinew_integrators::entry("cnn-stabilised")
        .map(|entry| (entry.variants)().remove(0))
        .unwrap();
    for options in [&Options::new(), &chebyshev] {
        for (times, stiffness) in [(2.0, 0.0), (9.0, 0.0), (4.0, 2e-3)] {
            let glide = (Course::at_velocity(velocity), velocity);
            let damped = (stiffness, YOUNGS_MODULUS);
            let force = beyond_the_stable_step((times, options), damped, glide, 6);
            assert!(force < 1e-6, "{times} {options:?}: {force:e} N");
        }
    }
    // Shaken slowly against its slowest motion, which is slowed down, a body resists by its mass.
    let (frequency, amplitude) = (0.1, 0.04);
    let omega = 2.0 * PI * frequency;
    let sine = Course::new(
        [0.0, 0.0, amplitude],
        Ramp::Sine {
            frequency,
            phase: 0.0,
        },
    );
    let shaken = (sine, [0.0, 0.0, omega * amplitude]);
    let force = beyond_the_stable_step((6.0, &Options::new()), (0.0, 2e6), shaken, 2000);
    let expected = DENSITY * 0.2 * 0.05 * 0.05 * omega * omega * amplitude;
    assert!(
        (force / expected - 1.0).abs() < 0.05,
        "{force} N of {expected} N"
    );
}

/// A bar with few modes that is slowly shaken at its end, or moves with it, along all axes: the support receives the
/// mass times the acceleration, with any number of modes and both kinds of vectors.
#[cfg(feature = "implicit")]
#[test]
fn few_modes_carry_what_supports_carry() {
    let mesh = structured::block([12, 3, 3], [0.2, 0.05, 0.05], Split::Mirrored).unwrap();
    let (frequency, amplitude) = (0.1, [0.02, -0.01, 0.04]);
    let omega = 2.0 * PI * frequency;
    let sine = Course::new(
        amplitude,
        Ramp::Sine {
            frequency,
            phase: 0.0,
        },
    );
    let glide = [1.5, -0.4, 0.9];
    let few = Options::new().with_number("modes", 3.0);
    let tolerant = Options::new().with_number("tolerance", 0.1);
    let ritz = few.clone().with_number("modes", 6.0);
    let ritz = ritz.with("vectors", OptionValue::Text("ritz".to_owned()));
    let mass = DENSITY * 0.2 * 0.05 * 0.05;
    let inertia = amplitude.map(|size| -mass * omega * omega * size);
    let shaken = (sine, amplitude.map(|size| omega * size), inertia);
    let cases = [(Course::at_velocity(glide), glide, [0.0; 3]), shaken];
    for (course, velocity, size) in cases {
        for stiffness in [0.0, 2e-3] {
            let problem = Problem {
                moves: vec![Moving::new(face(&mesh, 0, 0.0), [course.clone()])],
                damping: Rayleigh::new(0.0, stiffness),
                ..body(linear(2e5, 0.3))
            };
            let model = Model::build(&mesh, &problem).unwrap();
            for options in [&few, &tolerant, &ritz] {
                let name = format!("{options:?}");
                let mut method = Method {
                    integrator: build("modal", options),
                    dt: 0.02,
                    name: name.clone(),
                };
                method.integrator.prepare(&model, method.dt).unwrap();
                let v = velocity.iter().copied().cycle().take(model.dofs());
                let start = State::new(vec![0.0; model.dofs()], v.collect());
                let (mut worst, mut last) = (0.0_f64, 0);
                follow(&mut method, &model, (start, 400), |step, t, forces| {
                    last = step;
                    for (axis, size) in size.into_iter().enumerate() {
                        let found: f64 = forces.iter().map(|force| force[axis]).sum();
                        let off = (found - size * (omega * t).sin()).abs();
                        worst = worst.max(off / if size == 0.0 { 1e-5 } else { size.abs() });
                    }
                });
                assert_eq!(last, 400, "{name} refuses");
                assert!(worst < 0.06, "{name}, {stiffness}, {velocity:?}: {worst:e}");
            }
        }
    }
}

/// A bar that is stretched at one speed everywhere and fixed laterally along its whole length: there is no inertia, for
/// any mesh.
#[test]
fn a_bar_in_tension_pulls_by_its_law_whatever_the_cells() {
    let size = [0.2, 0.02, 0.02];
    let (strain, duration) = (0.02, 0.2);
    let area = size[1] * size[2];
    let soft = linear(YOUNGS_MODULUS, 0.0);
    for (cells, law) in [
        (10, soft.clone()),
        (20, soft.clone()),
        (10, hyperelastic("stvk", 0.0)),
    ] {
        let mesh = structured::block([cells, 1, 1], size, Split::Mirrored).unwrap();
        let along = [true, false, false];
        let speed = strain * size[0] / duration;
        let problem = |law| Problem {
            fixed: vec![
                held("tissue", [false, true, true]),
                Fixed::at(face(&mesh, 0, 0.0)).along(along),
            ],
            moves: vec![
                Moving::new(
                    face(&mesh, 0, size[0]),
                    [Course::at_velocity([speed, 0.0, 0.0])],
                )
                .along(along),
            ],
            ..body(law)
        };
        let [model, small] =
            [law.clone(), soft.clone()].map(|law| Model::build(&mesh, &problem(law)).unwrap());
        let of_node = |node: &u32| [mesh.points[*node as usize][0] / size[0] * speed, 0.0, 0.0];
        let v: Vec<f64> = model.nodes().iter().flat_map(of_node).collect();
        for mut method in methods(&model, &small, 0.02) {
            let start = State::new(vec![0.0; model.dofs()], v.clone());
            let steps = 10;
            let (mut pulls, mut reached) = ([0.0; 2], 0);
            follow(&mut method, &model, (start, steps), |step, _, forces| {
                (pulls, reached) = ([0.0; 2], step);
                for (force, point) in forces.iter().zip(&mesh.points) {
                    pulls[usize::from(point[0] > 0.1)] += force[0];
                }
            });
            if reached < steps {
                // Loads that change with time are not for all.
                assert!(method.name.contains("two-step"), "{} refuses", method.name);
                continue;
            }
            let strain = steps as f64 * method.dt * speed / size[0];
            let expected = match is_linear(&model) {
                true => strain,
                // S = E e, P = F S.
                false => (1.0 + strain) * (strain + strain * strain / 2.0),
            };
            for (end, pull) in [-1.0, 1.0].into_iter().zip(pulls) {
                let off = end * pull / (YOUNGS_MODULUS * area * expected) - 1.0;
                assert!(
                    off.abs() < 1e-8,
                    "{cells} cells, {law}, {}: {off:e}",
                    method.name
                );
            }
        }
    }
}

/// A block on a table that moves at a speed and accelerates: the table pushes with the whole mass times the
/// acceleration, its own nodes' share included, for any description of its path.
#[test]
fn a_shaken_block_is_pushed_by_its_mass_times_the_acceleration() {
    let edge = 0.1;
    let mesh = structured::cube(2, edge, Split::Mirrored).unwrap();
    let soft = linear(YOUNGS_MODULUS, 0.3);
    let (speed, amplitude, rise) = (1.0, 0.05, 1.0);
    let mass = DENSITY * edge.powi(3);
    let place = |t: f64| speed * t + amplitude * (PI * t / (2.0 * rise)).sin().powi(2);
    let acceleration = |t: f64| amplitude * PI * PI / (2.0 * rise * rise) * (PI * t / rise).cos();
    let still = Moving::new(face(&mesh, 2, 0.0), Vec::new());
    let problem = |law, courses: Vec<Course>| Problem {
        moves: vec![Moving {
            courses,
            ..still.clone()
        }],
        ..body(law)
    };
    let small = Model::build(&mesh, &problem(soft.clone(), Vec::new())).unwrap();
    let critical = 2.0 / Spectrum::of(small.operators()).omega_max;
    // Hangs behind from the start on, so that nothing swings.
    let along_x = |size: f64| -> Vec<f64> {
        let axes = [size, 0.0, 0.0];
        axes.into_iter().cycle().take(small.dofs()).collect()
    };
    let behind = along_x(-acceleration(0.0)).into_iter().zip(small.mass());
    let behind: Vec<f64> = behind.map(|(a, mass)| a * mass).collect();
    let u = static_solution(&small, &behind).unwrap();
    let steps = 24;
    // Rows of a table for each step; none: a formula.
    for (law, all_rows) in [
        (soft, &[0.0, 1.0, 3.7][..]),
        (hyperelastic("neo-hookean", 0.3), &[1.0]),
    ] {
        for &rows in all_rows {
            let courses = |dt: f64| match rows == 0.0 {
                true => vec![
                    Course::at_velocity([speed, 0.0, 0.0]),
                    Course::new([amplitude, 0.0, 0.0], Ramp::Sin2 { rise }),
                ],
                false => {
                    let count = ((steps + 2) as f64 * rows) as usize;
                    let times: Vec<f64> = (0..count).map(|row| row as f64 * dt / rows).collect();
                    let places: Vec<[f64; 3]> =
                        times.iter().map(|t| [place(*t), 0.0, 0.0]).collect();
                    Course::along(&times, &places)
                }
            };
            let resting = Model::build(&mesh, &problem(law.clone(), Vec::new())).unwrap();
            for mut method in methods(&resting, &small, critical / 20.0) {
                let model = Model::build(&mesh, &problem(law.clone(), courses(method.dt))).unwrap();
                let start = State::new(u.clone(), along_x(speed));
                let mut worst = 0.0_f64;
                follow(&mut method, &model, (start, steps), |step, t, forces| {
                    // A table gains no speed before its second row.
                    if step > 0 {
                        let push: f64 = forces.iter().map(|force| force[0]).sum();
                        let off = push / (mass * acceleration(t)) - 1.0;
                        worst = worst.max(off.abs());
                    }
                });
                assert!(
                    worst < 0.01,
                    "{}, {law}, {rows} rows a step: {worst:e}",
                    method.name
                );
            }
        }
    }
}

/// A small block on a table that accelerates along x, with stiff damping compared with its inertia, initially displaced
/// backwards to its lag; with the model at small strain, and the table's acceleration (m/s^2).
fn damped_block(law: fn(f64) -> Law) -> (Model, Model, State, impl Fn(f64) -> f64) {
    let mesh = structured::cube(2, 0.02, Split::Mirrored).unwrap();
    let (amplitude, rise, modulus) = (0.05, 0.4, 2e5);
    let acceleration =
        move |t: f64| amplitude * PI * PI / (2.0 * rise * rise) * (PI * t / rise).cos();
    let model = |law| {
        let problem = Problem {
            moves: vec![Moving::new(
                face(&mesh, 2, 0.0),
                [Course::new([amplitude, 0.0, 0.0], Ramp::Sin2 { rise })],
            )],
            damping: Rayleigh::new(0.0, 2e-3),
            ..body(law)
        };
        Model::build(&mesh, &problem).unwrap()
    };
    let small = model(linear(modulus, 0.3));
    let along = [acceleration(0.0), 0.0, 0.0].into_iter().cycle();
    let behind: Vec<f64> = along.zip(small.mass()).map(|(a, mass)| -a * mass).collect();
    let u = static_solution(&small, &behind).unwrap();
    let start = State::new(u, vec![0.0; small.dofs()]);
    (model(law(modulus)), small, start, acceleration)
}

/// Damping acts on no motion that all nodes share, so for any velocities that a method combines, the forces add up to
/// mass times acceleration.
#[test]
fn a_shaken_block_with_damping_is_pushed_by_its_mass_times_the_acceleration() {
    let laws: [fn(f64) -> Law; 2] = [|modulus| linear(modulus, 0.3), neo_hookean];
    for law in laws {
        let (model, small, start, acceleration) = damped_block(law);
        let mass: f64 = model.node_masses().iter().sum();
        for mut method in methods(&model, &small, 2e-3) {
            let steps = (0.03 / method.dt).round() as usize;
            let mut worst = 0.0_f64;
            follow(
                &mut method,
                &model,
                (start.clone(), steps),
                |_, t, forces| {
                    if t > 0.015 {
                        let push: f64 = forces.iter().map(|force| force[0]).sum();
                        worst = worst.max((push / (mass * acceleration(t)) - 1.0).abs());
                    }
                },
            );
            assert!(worst < 0.01, "{}, {}: {worst:e}", method.name, law(1.0));
        }
    }
}

fn neo_hookean(modulus: f64) -> Law {
    Law::hyperelastic("neo-hookean", Parameters::new(modulus, 0.3))
}

/// Newton's second law for the motion of a first-order method, to its last digits: a table pushes with the force that
/// changes the momentum of the free nodes in the step that takes the forces of a state, the next one or the last, and
/// with the force for its own nodes.
#[test]
fn a_damped_block_is_pushed_by_what_its_methods_own_step_gains_of_momentum() {
    let converged = Options::new().with_number("sweeps", 400.0);
    let converged = converged.with("kind", OptionValue::Text("ie".to_owned()));
    let methods = [
        ("forward-euler", Options::new(), true),
        ("symplectic-euler", Options::new(), true),
        ("cnn", Options::new(), true),
        ("cnn-symplectic", Options::new(), true),
        ("central-difference", Options::new(), true),
        ("implicit-euler", Options::new(), false),
        ("cnn-energy", converged, false),
    ];
    let laws: [fn(f64) -> Law; 2] = [|modulus| linear(modulus, 0.3), neo_hookean];
    for law in laws {
        let (model, small, start, acceleration) = damped_block(law);
        let of_free: f64 = model.mass().iter().sum::<f64>() / 3.0;
        let of_table = model.node_masses().iter().sum::<f64>() - of_free;
        for (id, options, is_next) in &methods {
            let mut integrator = build(id, options);
            let dt = match integrator.stable_step(&small) {
                Ok(StableStep::UpTo(limit)) => limit / 2.0,
                _ => 2e-3,
            };
            let mut state = start.clone();
            let mut forces = vec![[0.0; 3]; model.node_masses().len()];
            let (mut pushes, mut momenta) = (Vec::new(), Vec::new());
            for _ in 0..12 {
                integrator.step(&model, &mut state, dt).unwrap();
                reactions(&model, &state, &mut forces);
                let push: f64 = forces.iter().map(|force| force[0]).sum();
                pushes.push(push - of_table * acceleration(state.t()));
                let along = state.v.iter().zip(model.mass()).step_by(3);
                momenta.push(along.map(|(v, mass)| mass * v).sum::<f64>());
            }
            let gains = momenta.windows(2).map(|ends| (ends[1] - ends[0]) / dt);
            let first = usize::from(!is_next);
            let off = gains.zip(&pushes[first..]).map(|(gain, push)| gain - push);
            let off = off.fold(0.0_f64, |most, off| most.max(off.abs()));
            let off = off / (of_free * acceleration(0.0));
            assert!(off < 1e-6, "`{id}`, {}: {off:e}", law(1.0));
        }
    }
}

/// At small strain every law equals the linear one, also for a damped body whose support jumps in speed: the body
/// receives the whole change of speed, on steps and between them.
#[test]
fn jerks_of_a_support_reach_a_damped_body_by_every_law_as_by_the_linear_one() {
    let mesh = structured::cube(2, 0.1, Split::Mirrored).unwrap();
    let soft = linear(YOUNGS_MODULUS, 0.3);
    let problem = |law, positions: &[[f64; 3]]| Problem {
        moves: vec![Moving::new(
            face(&mesh, 2, 0.0),
            Course::along(&[0.0, 0.004, 0.0091, 0.0133], positions),
        )],
        damping: Rayleigh::new(0.0, 2e-3),
        ..body(law)
    };
    let way = [[0.0; 3], [0.0; 3], [1e-7, 0.0, 2e-7], [0.0, 1e-7, 2e-7]];
    let small = Model::build(&mesh, &problem(soft, &way)).unwrap();
    for id in ["neo-hookean", "stvk", "corotational"] {
        let large = Model::build(&mesh, &problem(hyperelastic(id, 0.3), &way)).unwrap();
        for mut method in methods(&large, &small, 2e-3) {
            let dt = method.dt;
            let steps = (0.02 / dt).round() as usize;
            let end = |integrator: &mut dyn Integrator, model: &Model| {
                let mut state = State::at_rest(model.dofs());
                for _ in 0..steps {
                    integrator.step(model, &mut state, dt).unwrap();
                }
                state
            };
            let found = end(&mut *method.integrator, &large);
            let mut same = methods(&small, &small, 2e-3);
            let same = same.iter_mut().find(|other| other.name == method.name);
            let expected = end(&mut *same.unwrap().integrator, &small);
            let off = [
                relative_error(&[found.u], &[expected.u]),
                relative_error(&[found.v], &[expected.v]),
            ];
            assert!(largest(&off) < 1e-4, "{}, {id}: {off:?}", method.name);
        }
    }
}
