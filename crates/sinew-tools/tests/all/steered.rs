//! Tools that are steered from outside while a simulation runs.

use crate::common::pressed;

use pressed::{Block, Pressed, through, tool};
use sinew_core::{Inputs, Options, State};
use sinew_tools::{Convex, Motion, Steering};

const DT: f64 = 1e-3;

/// Positions (m) of a ball above and in a cube of 40 mm, at the ends of 80 steps.
fn path() -> Vec<[f64; 3]> {
    let place = |step: u32| {
        let phase = f64::from(step) / 12.0;
        [
            0.02 + 0.004 * phase.sin(),
            0.02,
            0.047 + 0.005 * phase.cos(),
        ]
    };
    (0..=80).map(place).collect()
}

fn cube(motion: Motion) -> Pressed {
    let cube = Block::of([0.04; 3], [4; 3]).with_mass_damping(20.0);
    let mut ball = tool(Convex::sphere(0.01).unwrap(), motion);
    ball.friction = 0.2;
    cube.with(vec![ball])
}

/// The ball on its path, given by a table.
fn by_table() -> Motion {
    let places = (0..).zip(path());
    let rows: Vec<_> = places
        .map(|(step, place)| (f64::from(step) * DT, place))
        .collect();
    through(&rows, [0.0; 3])
}

/// The state after 80 steps; before each step `steer` is called for the pose at its end.
fn driven(
    pressed: &Pressed,
    inputs: &mut Inputs,
    mut steer: impl FnMut(usize, &State, &mut Inputs),
) -> State {
    let mut integrator = sinew_integrators::build("symplectic-euler", &Options::new()).unwrap();
    let mut state = pressed.at_rest();
    for step in 0..80 {
        steer(step, &state, inputs);
        integrator
            .step_under(&pressed.model, inputs, &mut state, DT)
            .unwrap();
    }
    state
}

#[test]
fn a_steered_tool_does_what_a_table_does() {
    let expected = driven(&cube(by_table()), &mut Inputs::new(), |_, _, _| {});
    let mut inputs = Inputs::new();
    let steering = Steering::new(&mut inputs);
    let own = by_table();
    let steered = cube(Motion::Steered(Box::new(own), steering));
    let places = path();
    steering.set(&mut inputs, 0.0, places[0], [0.0; 3]).unwrap();
    let found = driven(&steered, &mut inputs, |step, state, inputs| {
        let mut clock = state.clock;
        clock.advance(DT);
        let place = places[step + 1];
        steering.set(inputs, clock.time(), place, [0.0; 3]).unwrap();
        inputs.forget_before(state.t() - 2.0 * DT);
    });
    let apart = expected.u.iter().zip(&found.u).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f64::max) < 1e-12);
    assert!(found.u.iter().any(|u| *u < -1e-4), "it was pressed");
    let report = steered.tools.report(&found, 0);
    assert!((report.work - cube(by_table()).tools.report(&expected, 0).work).abs() < 1e-12);
    assert_eq!(
        steered.tools.pose(&found, &inputs, 0).position(),
        places[80]
    );
}

#[test]
fn a_tool_follows_its_own_path_with_the_same_bits_until_it_is_steered() {
    let expected = driven(&cube(by_table()), &mut Inputs::new(), |_, _, _| {});
    let mut inputs = Inputs::new();
    let steering = Steering::new(&mut inputs);
    let steered = cube(Motion::Steered(Box::new(by_table()), steering));
    let is_expected = |found: State| {
        (found.u, found.v, found.a) == (expected.u.clone(), expected.v.clone(), expected.a.clone())
    };
    assert!(is_expected(driven(&steered, &mut inputs, |_, _, _| {})));
    // Also without its channels.
    assert!(is_expected(driven(
        &steered,
        &mut Inputs::new(),
        |_, _, _| {}
    )));
    // One that is steered from the middle on is where it was before.
    let half = driven(&steered, &mut inputs, |step, state, inputs| {
        if step == 40 {
            let place = steered.tools.pose(state, inputs, 0).position();
            steering.set(inputs, state.t(), place, [0.0; 3]).unwrap();
        }
        if step >= 40 {
            steering
                .set(inputs, state.t() + DT, [0.1; 3], [0.0; 3])
                .unwrap();
        }
    });
    assert_eq!(steered.tools.report(&half, 0).contacts, 0);
    assert_eq!(
        steered.tools.tools()[0].motion.at(0.02, &inputs),
        by_table().at(0.02, &inputs)
    );
}
