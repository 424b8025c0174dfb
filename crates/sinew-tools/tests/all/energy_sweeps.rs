//! Cellular energy steps of bodies that tools press: the energy never rises by more than the work of tools and loads,
//! for any step and any number of sweeps.

use crate::common::pressed;

use std::f64::consts::PI;

use pressed::{Block, Pressed, energy, through, tool};
use proptest::prelude::*;
use sinew_core::{Batch, Contact, Inputs, OptionValue, Options, State, StepError, vectors};
use sinew_fem::Element;
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_tools::{Convex, Motion, Pose};

fn energy_sweeps(sweeps: f64) -> (&'static str, Options) {
    let options = Options::new().with("kind", OptionValue::Text("ie".into()));
    (
        "cnn-energy",
        options.with("sweeps", OptionValue::Number(sweeps)),
    )
}

/// The largest rise of energy in a step beyond the work of tools, and the largest energy (J).
fn largest_rise(
    pressed: &Pressed,
    state: &mut State,
    sweeps: f64,
    dt: f64,
    steps: usize,
) -> (f64, f64) {
    let (mut rise, mut largest): (f64, f64) = (0.0, 0.0);
    let mut left = energy(pressed, state) - pressed.tools.work(state);
    for _ in 0..steps {
        pressed.run_with(state, energy_sweeps(sweeps), dt, 1);
        let now = energy(pressed, state);
        let next = now - pressed.tools.work(state);
        rise = rise.max(next - left);
        (left, largest) = (next, largest.max(now));
    }
    (rise, largest)
}

/// No bound of the potential leads back from the prescribed position of a tool.
#[test]
fn a_plate_that_pushes_tissue_inside_out_within_a_step_is_refused_by_the_law() {
    let mut block = Block::of([0.06; 3], [3; 3]);
    block.law = Some("neo-hookean");
    let start = [0.03, 0.03, 0.061];
    let down = [(0.0, start), (0.002, [0.03, 0.03, 0.03])];
    let pressed = block.with(vec![tool(Convex::Plane, through(&down, [PI, 0.0, 0.0]))]);
    let mut state = pressed.at_rest();
    let (id, options) = energy_sweeps(8.0);
    let mut integrator = sinew_integrators::build(id, &options).unwrap();
    let mut batch = Batch::new(&pressed.model, Inputs::none(), 0.002, 1);
    let refused = batch.take(&mut *integrator, &mut state).unwrap_err();
    assert!(matches!(refused, StepError::Refused { .. }), "{refused}");
}

#[test]
fn nothing_passes_through_and_nothing_is_left_in_a_tool() {
    let cube = Block::of([0.04; 3], [4; 3]);
    let start = Pose::new([0.02, 0.02, 0.0521], [0.0; 3]);
    let motion = Motion::Steady {
        start,
        velocity: [0.0, 0.0, -0.2],
    };
    let pressed = cube.with(vec![tool(Convex::sphere(0.012).unwrap(), motion)]);
    let mut state = pressed.at_rest();
    for _ in 0..8 {
        pressed.run_with(&mut state, energy_sweeps(3.0), 5e-3, 1);
        let pose = pressed.tools.pose(&state, Inputs::none(), 0);
        let deepest = pressed.tools.deepest(&state.u, &pose, 0).unwrap();
        assert!(deepest.gap > -1e-15, "{deepest:?}");
    }
    assert!(pressed.tools.report(&state, 0).contacts > 4);
}

#[test]
fn work_is_the_force_of_a_step_times_the_way_of_the_tool_in_it() {
    let cube = Block::of([0.04; 3], [4; 3]);
    let down = [
        (0.0, [0.0, 0.0, 0.041]),
        (0.05, [0.0, 0.0, 0.037]),
        (0.1, [0.0, 0.0, 0.038]),
    ];
    let pressed = cube.with(vec![tool(Convex::Plane, through(&down, [PI, 0.0, 0.0]))]);
    let (mut state, mut expected) = (pressed.at_rest(), 0.0);
    let height = |state: &State| {
        let pose = pressed.tools.pose(state, Inputs::none(), 0);
        pose.position()[2]
    };
    for _ in 0..40 {
        let before = height(&state);
        pressed.run_with(&mut state, energy_sweeps(4.0), 3e-3, 1);
        expected -= pressed.force(&state)[2] * (height(&state) - before);
    }
    let found = pressed.tools.work(&state);
    assert!(expected > 1e-5);
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
}

/// A ball that is finer than the surface: contacts that act on each other are found by an iteration, whose residual may
/// add some millionths of the energy, which the certificate counts. This must not end the run.
#[test]
fn a_ball_rests_on_elements_that_do_not_lock_for_as_long_as_it_likes() {
    let down = [(0.0, [0.05, 0.05, 0.1205]), (0.3, [0.05, 0.05, 0.108])];
    for law in [None, Some(Hyperelastic::IDS[0])] {
        let mut cube = Block::of([0.1; 3], [6; 3]).with_mass_damping(10.0);
        (cube.nu, cube.law, cube.element) = (
            0.45,
            law,
            Element::FbarEdge {
                edge_share: Element::EDGE_SHARE,
                patch: None,
            },
        );
        let mut ball = tool(Convex::sphere(0.02).unwrap(), through(&down, [0.0; 3]));
        ball.friction = 0.3;
        let pressed = cube.with_triangles(vec![ball]);
        let mut state = pressed.at_rest();
        let (rise, largest) = largest_rise(&pressed, &mut state, 4.0, 0.02, 250);
        assert!(rise <= 1e-5 * largest, "{rise:e} of {largest:e}");
        assert!(pressed.force(&state)[2] > 0.1);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn the_energy_never_rises_by_more_than_the_work_of_tools(
        dt_share in -1.0..2.5_f64,
        sweeps in 1..6_u32,
        depth in 0.001..0.012_f64,
        friction in prop_oneof![Just(0.0), 0.1..1.0_f64],
        law in 0..3_usize,
        speed in -0.3..0.3_f64,
    ) {
        let mut cube = Block::of([0.04; 3], [3; 3]);
        cube.law = [None, Some(Hyperelastic::IDS[0]), Some(Hyperelastic::IDS[1])][law];
        cube.nu = 0.4;
        let down = [
            (0.0, [0.02, 0.02, 0.0523]),
            (0.05, [0.022, 0.02, 0.0523 - depth]),
            (0.1, [0.015, 0.02, 0.0523 - depth]),
            (0.15, [0.015, 0.02, 0.0523]),
        ];
        let mut ball = tool(Convex::sphere(0.012).unwrap(), through(&down, [0.0; 3]));
        ball.friction = friction;
        let pressed = cube.with(vec![ball]);
        let mut state = pressed.at_rest();
        state.v.iter_mut().skip(2).step_by(3).for_each(|v| *v = speed);
        let dt = 1e-3 * 10_f64.powf(dt_share);
        let steps = ((0.25 / dt) as usize).clamp(3, 120);
        let (rise, largest) = largest_rise(&pressed, &mut state, f64::from(sweeps), dt, steps);
        prop_assert!(rise <= 1e-10 * largest, "{rise:e} of {largest:e}");
        prop_assert!(vectors::largest(&state.u) < 0.1);
    }
}
