//! Tools that are bodies of their own, against closed forms and the laws of motion.

use crate::common::pressed;

use std::f64::consts::PI;

use pressed::{Block, Pressed, staggered_energy, through, tool};
use sinew_core::{Inputs, OptionValue, Options, State};
use sinew_tools::{Convex, Grasp, Motion, Pose, Row, Table, Tool, ToolBody};

const BODY: ToolBody = ToolBody {
    mass: 0.05,
    inertia: [2e-6, 3e-6, 4e-6],
    coupling: 400.0,
    rotational_coupling: 0.5,
    damping: 0.8,
};

fn ball(motion: Motion, body: ToolBody) -> Tool {
    Tool {
        body: Some(body),
        ..tool(Convex::sphere(0.012).unwrap(), motion)
    }
}

fn turning(rows: &[(f64, [f64; 3])]) -> Motion {
    let rows = rows.iter().map(|(t, rotation_vector)| Row {
        t: *t,
        position: [0.0, 0.0, 1.0],
        rotation_vector: *rotation_vector,
    });
    Motion::Table(Table::new(rows.collect()).unwrap())
}

fn pose(pressed: &Pressed, state: &State, tool: usize) -> Pose {
    pressed.tools.pose(state, Inputs::none(), tool)
}

/// Deviation of a tool of 50 g on its coupling from `v/w e^(-z q t) sin(w t)`, after its path stopped at the speed v,
/// relative to the largest offset; along and about, by a method in steps of `dt` (s).
fn off_the_closed_form((id, options): (&str, &Options), dt: f64) -> [f64; 2] {
    let (stop, end, damping) = (0.05, 0.1, 0.1);
    let body = ToolBody { damping, ..BODY };
    let cube = Block::of([0.02; 3], [1; 3]);
    let [speed, spin] = [0.06, 0.4];
    let way = [(0.0, [0.0, 0.0, 1.0]), (stop, [speed * stop, 0.0, 1.0])];
    let along = cube.with(vec![ball(through(&way, [0.0; 3]), body)]);
    let turn = turning(&[(0.0, [0.0; 3]), (stop, [0.0, spin * stop, 0.0])]);
    let about = cube.with(vec![ball(turn, body)]);
    let worst = |pressed: &Pressed, rate: f64, (of, start): (&dyn Fn(&Pose) -> f64, f64)| {
        let mut state = pressed.at_rest();
        // The body of tissue is far away and at rest.
        let before = (stop / dt).round() as usize;
        pressed.run_with(&mut state, (id, options.clone()), dt, before);
        let swings = rate * (1.0 - damping * damping).sqrt();
        let mut worst: f64 = 0.0;
        for n in 1..=((end - stop) / dt).round() as usize {
            pressed.run_with(&mut state, (id, options.clone()), dt, 1);
            let t = dt * n as f64;
            let expected = start / swings * (-damping * rate * t).exp() * (swings * t).sin();
            let offset = of(&pose(pressed, &state, 0)) - start * stop;
            worst = worst.max((offset - expected).abs());
        }
        worst / (start / swings)
    };
    let x = |pose: &Pose| pose.position()[0];
    let turn = |pose: &Pose| pose.rotation_vector()[1];
    [
        worst(&along, (400.0_f64 / 0.05).sqrt(), (&x, speed)),
        worst(&about, (0.5_f64 / 3e-6).sqrt(), (&turn, spin)),
    ]
}

#[test]
fn a_tool_on_its_coupling_swings_as_its_spring_and_damper_say() {
    let euler = Options::new().with("kind", OptionValue::Text("ie".into()));
    for (id, options, order) in [
        ("cnn-stabilised", Options::new(), 2.0),
        ("cnn-energy", euler, 1.0),
    ] {
        let errors = [1e-4, 5e-5].map(|dt| off_the_closed_form((id, &options), dt));
        for (coarse, fine) in errors[0].into_iter().zip(errors[1]) {
            let found = (coarse / fine).log2();
            assert!((found - order).abs() < 0.1, "{id}: {errors:?}");
        }
        if order == 2.0 {
            assert!(errors[1][0] < 1e-5, "{errors:?}");
        }
    }
}

/// A rule that keeps the energy of what it does not resolve would turn such a body about in every step, for ever.
#[test]
fn a_tool_that_swings_faster_than_steps_tell_comes_to_rest_on_its_path() {
    let cube = Block::of([0.02; 3], [1; 3]);
    for (mass, damping) in [(0.05, 0.0), (1e-9, 0.8), (0.05, 1e6)] {
        let body = ToolBody {
            mass,
            damping,
            ..BODY
        };
        let dt = 0.5;
        let jump = [(0.0, [0.0, 0.0, 1.0]), (dt, [0.003, 0.0, 1.0])];
        let pressed = cube.with(vec![ball(through(&jump, [0.0; 3]), body)]);
        let mut state = pressed.at_rest();
        pressed.run(&mut state, "cnn-stabilised", dt, 1);
        let mut last = f64::INFINITY;
        for _ in 0..30 {
            pressed.run(&mut state, "cnn-stabilised", dt, 1);
            let energy = pressed.tools.report(&state, 0).body.unwrap().energy;
            assert!(energy <= last, "{mass} {damping}: {energy} after {last}");
            last = energy;
        }
        let off = pose(&pressed, &state, 0).position()[0] - 0.003;
        let slow = if damping > 1.0 { 0.003 } else { 1e-12 };
        assert!(off.abs() <= slow, "{mass} {damping}: {off}");
    }
}

#[test]
fn a_free_top_keeps_its_energy_and_turns_as_euler_says() {
    let cube = Block::of([0.02; 3], [1; 3]);
    let body = ToolBody {
        inertia: [2e-6, 2e-6, 3.5e-6],
        rotational_coupling: 0.0,
        ..BODY
    };
    let error = |dt: f64| {
        let turn = turning(&[(0.0, [0.0; 3]), (1.0, [3.0, 0.0, 40.0])]);
        let pressed = cube.with(vec![ball(turn, body)]);
        let mut state = pressed.at_rest();
        // The spin is that of the path, which is steady within a step.
        let steps = (0.1 / dt).round() as usize;
        pressed.run(&mut state, "cnn-stabilised", dt, 1);
        let start = pressed.tools.report(&state, 0);
        let own = |state: &State| {
            let body = pressed.tools.report(state, 0).body.unwrap();
            pose(&pressed, state, 0).turned_back(body.spin)
        };
        let first = own(&state);
        pressed.run(&mut state, "cnn-stabilised", dt, steps - 1);
        let end = pressed.tools.report(&state, 0);
        let (energy, before) = (end.body.unwrap().energy, start.body.unwrap().energy);
        assert!((energy / before - 1.0).abs() < 1e-12, "{energy} {before}");
        // The spin across the axis goes round it in the body's frame.
        let rate = (body.inertia[2] / body.inertia[0] - 1.0) * first[2];
        let (sin, cos) = (rate * dt * (steps - 1) as f64).sin_cos();
        let expected = [
            first[0] * cos - first[1] * sin,
            first[0] * sin + first[1] * cos,
            first[2],
        ];
        let end = own(&state);
        (0..3).fold(0.0, |worst: f64, axis| {
            worst.max((end[axis] - expected[axis]).abs())
        })
    };
    let errors = [error(2e-3), error(1e-3), error(5e-4)];
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "{errors:?}");
    }
}

#[test]
fn a_tool_that_flies_into_a_free_body_gives_it_what_it_loses() {
    let mut cube = Block::of([0.04; 3], [4; 3]);
    cube.is_held = false;
    cube.nu = 0.3;
    let body = ToolBody {
        coupling: 0.0,
        rotational_coupling: 0.0,
        ..BODY
    };
    let start = Pose::new([0.023, 0.018, 0.055], [0.0; 3]);
    let velocity = [0.02, 0.0, -0.6];
    let mut tool = ball(Motion::Steady { start, velocity }, body);
    tool.friction = 0.3;
    let pressed = cube.with(vec![tool]);
    let mut state = pressed.at_rest();
    let momentum = |state: &State, axis: usize| {
        let (mean, mass) = pressed.mean_velocity(state, axis);
        let body = pressed.tools.report(state, 0).body;
        mean * mass + 0.05 * body.map_or(velocity, |body| body.velocity)[axis]
    };
    let before = [0, 1, 2].map(|axis| momentum(&state, axis));
    let dt = 0.5 * pressed.stable_step();
    let mut touched = 0;
    for _ in 0..(0.1 / dt) as usize {
        pressed.run(&mut state, "central-difference", dt, 1);
        touched += pressed.tools.report(&state, 0).contacts;
        for axis in 0..3 {
            let off = momentum(&state, axis) - before[axis];
            assert!(off.abs() < 1e-13 * before[2].abs(), "{axis}: {off}");
        }
    }
    let after = pressed.tools.report(&state, 0);
    assert!(touched > 100 && after.body.unwrap().velocity[2] > -0.5);
    assert!(after.largest_residual < 1e-12, "{}", after.largest_residual);
    assert_eq!(after.body.unwrap().hand_work, 0.0);
}

#[test]
fn at_rest_the_coupling_bears_what_the_tissue_gives() {
    let mut cube = Block::of([0.06; 3], [5; 3]).with_mass_damping(40.0);
    cube.nu = 0.45;
    let down = [(0.0, [0.03, 0.03, 0.0725]), (0.2, [0.031, 0.029, 0.067])];
    let pressed = cube.with(vec![ball(through(&down, [0.0; 3]), BODY)]);
    let mut state = pressed.at_rest();
    pressed.run(&mut state, "central-difference", 1e-3, 2500);
    let report = pressed.tools.report(&state, 0);
    let there = pose(&pressed, &state, 0);
    for axis in 0..3 {
        let pulled = BODY.coupling * (there.position()[axis] - down[1].1[axis]);
        let force = report.force[axis];
        assert!((pulled - force).abs() < 1e-9, "{axis}: {pulled} {force}");
        let turned = BODY.rotational_coupling * there.rotation_vector()[axis];
        assert!((turned - report.torque[axis]).abs() < 1e-9, "{axis}");
    }
    assert!(report.force[2] > 0.01);
    // A tool that is led to the same pose feels the same.
    let [x, y, _] = there.position();
    let end = (0.2, there.position(), there.rotation_vector());
    let rows = [(0.0, [x, y, 0.0725], [0.0; 3]), end];
    let rows = rows.map(|(t, position, rotation_vector)| Row {
        t,
        position,
        rotation_vector,
    });
    let led = Motion::Table(Table::new(rows.to_vec()).unwrap());
    let led = cube.with(vec![tool(Convex::sphere(0.012).unwrap(), led)]);
    let mut other = led.at_rest();
    led.run(&mut other, "central-difference", 1e-3, 2500);
    let expected = led.force(&other)[2];
    assert!((report.force[2] / expected - 1.0).abs() < 1e-6);
}

#[test]
fn energy_never_rises_by_more_than_the_work_of_the_hand() {
    let cube = Block::of([0.06; 3], [4; 3]);
    let centre = |z: f64| [0.03, 0.03, z];
    let rows = [
        (0.0, centre(0.0601)),
        (0.05, centre(0.05)),
        (0.1, centre(0.05)),
        (0.15, centre(0.0601)),
    ];
    // It may not turn, so that normals do not.
    let stiff = ToolBody {
        inertia: [1e3; 3],
        damping: 0.0,
        ..BODY
    };
    for (share, coupling) in [(0.05, 400.0), (0.5, 400.0), (0.95, 400.0), (0.95, 1e6)] {
        let plate = Tool {
            body: Some(ToolBody { coupling, ..stiff }),
            ..tool(Convex::Plane, through(&rows, [PI, 0.0, 0.0]))
        };
        let pressed = cube.with(vec![plate]);
        let dt = share * pressed.stable_step();
        let mut state = pressed.at_rest();
        let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
        for _ in 0..(0.3 / dt) as usize {
            let before = state.clone();
            pressed.run(&mut state, "central-difference", dt, 1);
            let body = pressed.tools.report(&state, 0).body.unwrap();
            let energy = staggered_energy(&pressed.model, &before, &state, dt) + body.energy;
            let left = energy - body.hand_work;
            rise = rise.max(last.map_or(0.0, |last| left - last));
            last = Some(left);
            largest = largest.max(energy);
        }
        assert!(largest > 1e-4, "the plate presses: {largest}");
        assert!(
            rise <= 1e-12 * largest,
            "{share} {coupling}: {rise} of {largest}"
        );
    }
}

/// A cube between two bodies and a ball that is led, which rub and seize.
fn squeezed() -> Pressed {
    let mut cube = Block::of([0.06; 3], [6; 3]).with_mass_damping(10.0);
    cube.nu = 0.3;
    let side = |name: &str, x: f64, towards: f64| {
        let rows = [(0.0, [x, 0.031, 0.033]), (0.1, [towards, 0.03, 0.035])];
        Tool {
            name: name.to_owned(),
            friction: 0.4,
            ..ball(through(&rows, [0.1, 0.0, 0.0]), BODY)
        }
    };
    let right = Tool {
        grasp: Some(Grasp {
            from: 0.08,
            to: 0.3,
        }),
        ..side("right", 0.0721, 0.066)
    };
    let down = [(0.0, [0.03, 0.03, 0.0725]), (0.1, [0.032, 0.03, 0.068])];
    let led = Tool {
        name: "led".to_owned(),
        friction: 0.2,
        ..tool(Convex::sphere(0.012).unwrap(), through(&down, [0.0; 3]))
    };
    cube.with(vec![side("left", -0.0121, -0.007), led, right])
}

#[test]
fn several_bodies_and_a_led_tool_press_at_once_and_machines_threads_and_batches_agree() {
    let pressed = squeezed();
    let dt = 1e-3;
    for id in ["central-difference", "cnn-stabilised"] {
        let method = |machine: &str, threads: f64| {
            let options = Options::new().with("machine", OptionValue::Text(machine.into()));
            match machine {
                "reference" => (id, options),
                _ => (id, options.with("threads", OptionValue::Number(threads))),
            }
        };
        let mut expected = pressed.at_rest();
        pressed.run_with(&mut expected, method("reference", 1.0), dt, 150);
        for tool in 0..3 {
            let report = pressed.tools.report(&expected, tool);
            assert!(report.contacts > 1, "{id} {tool}: {report:?}");
            assert!(report.largest_residual < 1e-12, "{report:?}");
            let pose = pose(&pressed, &expected, tool);
            let shape = &pressed.tools.tools()[tool].shape;
            let cells = pressed.tools.touched_cells();
            for cell in cells {
                let first = 3 * cell.cell as usize;
                let at = [0, 1, 2].map(|axis| cell.rest[axis] + expected.u[first + axis]);
                let gap = shape.distance(&pose, at);
                assert!(gap > -1e-7, "{tool}: {gap}");
            }
        }
        for machine in ["general", "reference"] {
            let (mut whole, mut cut) = (pressed.at_rest(), pressed.at_rest());
            pressed.run_with(&mut whole, method(machine, 3.0), dt, 60);
            for steps in [1, 7, 52] {
                pressed.run_with(&mut cut, method(machine, 1.0), dt, steps);
            }
            assert!(whole == cut, "{id} {machine}");
        }
        let mut part = pressed.at_rest();
        pressed.run_with(&mut part, method("reference", 1.0), dt, 90);
        let bytes = part.to_bytes(&pressed.model).unwrap();
        let mut part = State::from_bytes(&bytes, &pressed.model).unwrap();
        pressed.run_with(&mut part, method("reference", 1.0), dt, 60);
        assert!(part == expected, "{id} from bytes");
    }
}

#[test]
fn what_a_body_seizes_hangs_on_its_coupling() {
    let cube = Block::of([0.04; 3], [4; 3]).with_mass_damping(20.0);
    let rows = [
        (0.0, [0.02, 0.02, 0.05]),
        (0.1, [0.02, 0.02, 0.046]),
        (0.3, [0.02, 0.02, 0.056]),
    ];
    let jaw = Tool {
        grasp: Some(Grasp { from: 0.1, to: 9.0 }),
        body: Some(BODY),
        ..tool(
            Convex::cuboid([0.012, 0.012, 0.02]).unwrap(),
            through(&rows, [0.0; 3]),
        )
    };
    let pressed = cube.with(vec![jaw]);
    let mut state = pressed.at_rest();
    pressed.run(&mut state, "symplectic-euler", 1e-3, 3000);
    let report = pressed.tools.report(&state, 0);
    assert!(report.force[2] < -1e-3, "it pulls: {report:?}");
    let pulled = BODY.coupling * (pose(&pressed, &state, 0).position()[2] - 0.056);
    assert!((pulled / report.force[2] - 1.0).abs() < 1e-9);
}
