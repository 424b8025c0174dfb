//! Bodies that tools press and grasp, on any machine and from any state. Closed forms and the laws of motion are in the
//! verification.

use crate::common::pressed;

use pressed::{Block, energy, through, tool};
use sinew_core::{Inputs, OptionValue, Options, State};
use sinew_fem::Rayleigh;
use sinew_tools::{Convex, Grasp, Motion, Pose};

#[test]
fn machines_threads_and_batches_lead_to_the_same_motion() {
    let mut cube = Block::of([0.06; 3], [8; 3]);
    cube.damping = Rayleigh::new(5.0, 2e-4);
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
    let bytes = part.to_bytes(&pressed.model).unwrap();
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

/// A ball at 1 m/s hits a free cube, which stiffens so much that its steps have more substeps during contact: this adds
/// no momentum and no energy.
#[test]
fn a_hit_gives_tool_and_tissue_the_same_impulse_where_steps_become_shorter() {
    for id in ["central-difference", "symplectic-euler"] {
        let mut cube = Block::of([0.1; 3], [4; 3]);
        (cube.is_held, cube.nu, cube.law) = (false, 0.3, Some("neo-hookean"));
        let way = [(0.0, [0.05, 0.05, 0.131]), (0.1, [0.05, 0.05, 0.031])];
        let ball = tool(Convex::sphere(0.03).unwrap(), through(&way, [0.0; 3]));
        let pressed = cube.with(vec![ball]);
        let dt = 1.7 * pressed.stable_step();
        let options = Options::new().with("substeps", OptionValue::Text("auto".into()));
        let (mut state, mut parts) = (pressed.at_rest(), Vec::new());
        while state.t() < 0.1 {
            pressed.run_with(&mut state, (id, options.clone()), dt, 1);
            let [_, _, impulse] = pressed.tools.report(&state, 0).impulse;
            let (velocity, mass) = pressed.mean_velocity(&state, 2);
            let off = mass * velocity + impulse;
            assert!(
                off.abs() < 1e-12 * mass * 2.0,
                "{id}: {off} N s of {impulse}"
            );
            parts.push(state.cut.unwrap().parts);
        }
        assert!(parts.iter().min() < parts.iter().max(), "{parts:?}");
        let mut work = vec![0.0; state.u.len()];
        state
            .synchronise(&pressed.model, Inputs::none(), &mut work)
            .unwrap();
        let given = pressed.tools.report(&state, 0).work;
        let ratio = energy(&pressed, &state) / given;
        assert!(ratio < 1.002, "{id}: {ratio} of the work");
    }
}
