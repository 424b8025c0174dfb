//! Tools that are dynamic bodies, against closed forms and the laws of motion.

use crate::common::pressed;

use pressed::{Block, Pressed, through, tool};
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

/// A rule that conserves the energy of motions that it does not resolve would reverse such a body in every step,
/// forever.
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

/// A cube between two dynamic bodies and a ball on a prescribed path, with friction and grasping.
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
