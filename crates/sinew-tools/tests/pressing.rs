//! Bodies that tools press on, against closed forms and the laws of motion.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test ends where something fails")]

#[path = "common/pressed.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod pressed;

use std::f64::consts::PI;

use pressed::{Block, E, staggered_energy, through, tool};
use sinew_core::{Contact, Inputs, OptionValue, Options, State};
use sinew_fem::Rayleigh;
use sinew_tools::{Convex, Grasp, Motion, Pose};

/// The rotation of a plate that faces down.
const DOWN: [f64; 3] = [PI, 0.0, 0.0];

#[test]
fn a_plate_on_a_bar_presses_with_e_a_d_over_l() {
    let (length, area, depth) = (0.1, 4e-4, 0.002);
    let bar = Block::of([0.02, 0.02, length], [2, 2, 8]).with_mass_damping(60.0);
    let down = [(0.0, [0.0, 0.0, length]), (0.1, [0.0, 0.0, length - depth])];
    let pressed = bar.with(vec![tool(Convex::Plane, through(&down, DOWN))]);
    let mut state = pressed.at_rest();
    let dt = 0.5 * pressed.stable_step();
    pressed.run(&mut state, "symplectic-euler", dt, (1.3 / dt) as usize);
    let expected = E * area * depth / length;
    let [x, y, z] = pressed.force(&state);
    assert!((z / expected - 1.0).abs() < 1e-10, "{z} {expected}");
    assert!(x.abs().max(y.abs()) < 1e-10 * expected);
    let report = pressed.tools.report(&state, 0);
    assert_eq!(report.contacts, 9);
    // About the tool's origin, which is above a corner of the bar.
    assert!((report.torque[0] / (0.01 * expected) - 1.0).abs() < 1e-9);
    assert!((report.torque[1] / (-0.01 * expected) - 1.0).abs() < 1e-9);
}

#[test]
fn the_settled_force_is_that_of_every_method_and_step() {
    let mut cube = Block::of([0.06; 3], [5; 3]).with_mass_damping(40.0);
    cube.nu = 0.45;
    let down = [(0.0, [0.03, 0.03, 0.0725]), (0.2, [0.03, 0.03, 0.067])];
    let ball = tool(Convex::sphere(0.012).unwrap(), through(&down, [0.0; 3]));
    let pressed = cube.with(vec![ball]);
    let settled = |method: &str, dt: f64, time: f64| {
        let mut state = pressed.at_rest();
        pressed.run(&mut state, method, dt, (time / dt) as usize);
        pressed.force(&state)[2]
    };
    let expected = settled("central-difference", 0.5e-3, 1.6);
    assert!(expected > 0.01);
    for (method, dt, time) in [
        ("central-difference", 1e-3, 1.6),
        ("symplectic-euler", 1e-3, 1.6),
        ("cnn-symplectic", 0.7e-3, 1.6),
        ("cnn-stabilised", 0.5e-3, 1.6),
        // What is added to the mass makes it slower.
        ("cnn-stabilised", 5e-3, 8.0),
    ] {
        let force = settled(method, dt, time);
        assert!(
            (force / expected - 1.0).abs() < 1e-6,
            "{method} {dt}: {force} {expected}"
        );
    }
}

#[test]
fn momentum_changes_by_the_impulse_of_the_tool() {
    let mut cube = Block::of([0.04; 3], [3; 3]);
    cube.is_held = false;
    let below = Pose::new([0.0, 0.0, -0.003], [0.0; 3]);
    let pressed = cube.with(vec![tool(Convex::Plane, Motion::Held(below))]);
    let mut state = pressed.at_rest();
    let falling = state.v.iter_mut().skip(2).step_by(3);
    falling.for_each(|v| *v = -0.5);
    let (before, mass) = pressed.mean_velocity(&state, 2);
    let (mut impulse, dt) = (0.0, 1e-3);
    for _ in 0..200 {
        pressed.run(&mut state, "symplectic-euler", dt, 1);
        impulse -= dt * pressed.force(&state)[2];
    }
    assert!(impulse > -1.5 * before * mass, "it bounces");
    let change = mass * (pressed.mean_velocity(&state, 2).0 - before);
    assert!((change / impulse - 1.0).abs() < 1e-12, "{change} {impulse}");
}

#[test]
fn energy_never_rises_by_more_than_the_work_of_a_plate() {
    let cube = Block::of([0.06; 3], [4; 3]);
    let (top, deep) = (0.0601, 0.05);
    let rows = [
        (0.0, [0.0, 0.0, top]),
        (0.05, [0.0, 0.0, deep]),
        (0.1, [0.0, 0.0, deep]),
        (0.15, [0.0, 0.0, top]),
    ];
    let pressed = cube.with(vec![tool(Convex::Plane, through(&rows, DOWN))]);
    for share in [0.05, 0.5, 0.95] {
        let dt = share * pressed.stable_step();
        let mut state = pressed.at_rest();
        let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
        for _ in 0..(0.3 / dt) as usize {
            let before = state.clone();
            pressed.run(&mut state, "central-difference", dt, 1);
            let energy = staggered_energy(&pressed.model, &before, &state, dt);
            let left = energy - pressed.tools.work(&state);
            rise = rise.max(last.map_or(0.0, |last| left - last));
            last = Some(left);
            largest = largest.max(energy);
        }
        assert!(largest > 1e-4, "the plate presses: {largest}");
        assert!(rise <= 1e-12 * largest, "{share}: {rise} of {largest}");
    }
}

#[test]
fn machines_threads_and_batches_lead_to_the_same_motion() {
    let mut cube = Block::of([0.06; 3], [8; 3]);
    cube.damping = Rayleigh {
        mass: 5.0,
        stiffness: 2e-4,
    };
    let down = [(0.0, [0.03, 0.03, 0.0725]), (0.1, [0.028, 0.031, 0.066])];
    let mut ball = tool(Convex::sphere(0.012).unwrap(), through(&down, [0.0; 3]));
    ball.friction = 0.3;
    let pressed = cube.with(vec![ball]);
    let dt = 0.8e-3;
    for id in ["central-difference", "symplectic-euler", "cnn-stabilised"] {
        let method = |machine: &str, threads: f64| {
            let options = Options::new().with("machine", OptionValue::Text(machine.into()));
            match machine {
                "reference" => (id, options),
                _ => (id, options.with("threads", OptionValue::Number(threads))),
            }
        };
        let mut expected = pressed.at_rest();
        pressed.run_with(&mut expected, method("reference", 1.0), dt, 120);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let size = largest(&mut expected.u.iter().map(|u| u.abs()));
        assert!(size > 1e-3 && pressed.tools.report(&expected, 0).contacts > 3);
        let mut one = pressed.at_rest();
        pressed.run_with(&mut one, method("general", 1.0), dt, 120);
        let pairs = one.u.iter().zip(&expected.u);
        let off = largest(&mut pairs.map(|(a, b)| (a - b).abs()));
        assert!(off < 1e-11 * size, "{id}: {off}");
        let single = Options::new().with("precision", OptionValue::Text("f32".into()));
        let mut rounded = pressed.at_rest();
        pressed.run_with(&mut rounded, (id, single.clone()), dt, 120);
        let pairs = rounded.u.iter().zip(&expected.u);
        let off = largest(&mut pairs.map(|(a, b)| (a - b).abs()));
        assert!(off < 1e-4 * size, "{id}: {off}");
        let mut again = pressed.at_rest();
        for steps in [1, 19, 100] {
            pressed.run_with(&mut again, (id, single.clone()), dt, steps);
        }
        assert!(rounded == again, "{id} in f32");
        for machine in ["general", "reference"] {
            let (mut whole, mut cut) = (pressed.at_rest(), pressed.at_rest());
            pressed.run_with(&mut whole, method(machine, 3.0), dt, 60);
            for steps in [1, 7, 52] {
                pressed.run_with(&mut cut, method(machine, 1.0), dt, steps);
            }
            assert!(whole == cut, "{id} {machine}");
        }
    }
}

#[test]
fn a_block_on_an_incline_sticks_and_slides_as_coulomb_says() {
    let friction: f64 = 0.3;
    for (angle, slides) in [(15.0_f64, false), (19.0, true), (25.0, true)] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let mut cube = Block::of([0.02; 3], [2; 3]);
        cube.damping.stiffness = 2e-3;
        cube.is_held = false;
        cube.gravity = Some([9.81 * sin, 0.0, -9.81 * cos]);
        let mut plane = tool(Convex::Plane, Motion::Held(Pose::identity()));
        plane.friction = friction;
        let pressed = cube.with(vec![plane]);
        let mut state = pressed.at_rest();
        let dt = 2e-4;
        // It settles on its support first.
        pressed.run(&mut state, "symplectic-euler", dt, 3000);
        let ((before, _), t) = (pressed.mean_velocity(&state, 0), state.t());
        pressed.run(&mut state, "symplectic-euler", dt, 2000);
        let (after, _) = pressed.mean_velocity(&state, 0);
        if slides {
            let acceleration = (after - before) / (state.t() - t);
            let expected = 9.81 * (sin - friction * cos);
            assert!(
                (acceleration / expected - 1.0).abs() < 0.01,
                "{angle}: {acceleration} {expected}"
            );
        } else {
            assert!(after.abs() < 1e-5, "{angle}: {after}");
        }
    }
}

#[test]
fn what_is_seized_goes_with_the_tool_and_is_let_go() {
    let cube = Block::of([0.04; 3], [4; 3]).with_mass_damping(20.0);
    let rows = [
        (0.0, [0.02, 0.02, 0.05]),
        (0.1, [0.02, 0.02, 0.047]),
        (0.3, [0.025, 0.02, 0.055]),
    ];
    let jaw = Convex::cuboid([0.012, 0.012, 0.02]).unwrap();
    let mut jaw = tool(jaw, through(&rows, [0.0; 3]));
    jaw.grasp = Some(Grasp {
        from: 0.1,
        to: 0.35,
    });
    let pressed = cube.with(vec![jaw]);
    let mut state = pressed.at_rest();
    let dt = 1e-3;
    pressed.run(&mut state, "symplectic-euler", dt, 110);
    let place = |state: &State| pressed.tools.pose(state, Inputs::none(), 0).position();
    let (pulled, begins) = (pressed.tools.report(&state, 0), place(&state));
    assert!(pulled.contacts >= 1);
    let forces: Vec<[f64; 3]> = pressed.tools.forces(&state).collect();
    let held: Vec<usize> = (0..forces.len())
        .filter(|place| forces[*place] != [0.0; 3])
        .collect();
    let at = |state: &State, place: usize| {
        let cell = pressed.tools.touched_cells()[place];
        let first = 3 * cell.cell as usize;
        [0, 1, 2].map(|axis| cell.rest[axis] + state.u[first + axis])
    };
    let places: Vec<[f64; 3]> = held.iter().map(|place| at(&state, *place)).collect();
    pressed.run(&mut state, "symplectic-euler", dt, 200);
    let (moved, ends) = (pressed.tools.report(&state, 0), place(&state));
    for (place, before) in held.iter().zip(&places) {
        let after = at(&state, *place);
        for axis in 0..3 {
            let expected = before[axis] + ends[axis] - begins[axis];
            assert!((after[axis] - expected).abs() < 1e-15);
        }
    }
    assert!(moved.force[2] < -1e-3, "it pulls: {:?}", moved.force);
    pressed.run(&mut state, "symplectic-euler", dt, 100);
    assert_eq!(pressed.tools.report(&state, 0).contacts, 0);
}

#[test]
fn a_motion_goes_on_from_bytes_with_the_same_bits() {
    let cube = Block::of([0.04; 3], [4; 3]).with_mass_damping(2.0);
    let rows = [(0.0, [0.02, 0.02, 0.055]), (0.1, [0.022, 0.02, 0.047])];
    let mut jaw = tool(Convex::sphere(0.01).unwrap(), through(&rows, [0.0; 3]));
    jaw.friction = 0.2;
    jaw.grasp = Some(Grasp {
        from: 0.07,
        to: 0.2,
    });
    let pressed = cube.with(vec![jaw]);
    let mut whole = pressed.at_rest();
    pressed.run(&mut whole, "cnn-stabilised", 3e-3, 60);
    let mut part = pressed.at_rest();
    pressed.run(&mut part, "cnn-stabilised", 3e-3, 30);
    let bytes = part.to_bytes(&pressed.model);
    let mut part = State::from_bytes(&bytes, &pressed.model).unwrap();
    pressed.run(&mut part, "cnn-stabilised", 3e-3, 30);
    assert!(whole == part);
    assert!(pressed.tools.report(&whole, 0).work != 0.0);
}

#[test]
fn methods_that_cannot_be_pushed_refuse_and_name_those_that_can() {
    let cube = Block::of([0.04; 3], [2; 3]);
    let held = Motion::Held(Pose::new([0.0, 0.0, 1.0], [0.0; 3]));
    let pressed = cube.with(vec![tool(Convex::sphere(0.01).unwrap(), held)]);
    for method in ["forward-euler", "rk4", "modified-leapfrog", "cnn"] {
        let mut integrator = sinew_integrators::build(method, &Options::new()).unwrap();
        let mut state = pressed.at_rest();
        let stepped = integrator.step_under(&pressed.model, Inputs::none(), &mut state, 1e-4);
        let message = stepped.unwrap_err().to_string();
        let names_others = message.contains(method) && message.contains("symplectic-euler");
        assert!(names_others, "{message}");
    }
}

#[test]
fn a_node_that_one_ball_pushes_into_another_is_outside_of_both() {
    let cube = Block::of([0.02; 3], [2; 3]).with_mass_damping(20.0);
    let ball = |name: &str, x: f64| {
        let start = Pose::new([x, 0.01, 0.023], [0.0; 3]);
        let velocity = [0.0, 0.0, -0.05];
        let motion = Motion::Steady { start, velocity };
        sinew_tools::Tool {
            name: name.to_owned(),
            ..tool(Convex::sphere(0.005).unwrap(), motion)
        }
    };
    let pressed = cube.with(vec![ball("left", 0.00567), ball("right", 0.01433)]);
    let mut state = pressed.at_rest();
    let mut both = 0;
    for _ in 0..100 {
        pressed.run(&mut state, "symplectic-euler", 1e-3, 1);
        for tool in 0..2 {
            let pose = pressed.tools.pose(&state, Inputs::none(), tool);
            let deepest = pressed.tools.deepest(&state.u, &pose, tool).unwrap();
            assert!(deepest.gap > -1e-15, "{} at {}", deepest.gap, state.t());
        }
        let touching = (0..2).filter(|tool| pressed.tools.report(&state, *tool).contacts > 0);
        both += usize::from(touching.count() == 2);
    }
    assert!(both > 10, "{both} steps in which both touch");
}
