//! Cellular energy steps with tools: tissue that no tool pushes moves the same as without tools.

use crate::common::pressed;

use std::f64::consts::PI;

use pressed::{Block, tool};
use sinew_core::{OptionValue, Options, Run, State, System, simulate};
use sinew_fem::Model;
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_mesh::structured::{Split, block};
use sinew_tools::{Convex, Motion, Pose, Tool};

fn energy_sweeps(sweeps: u32) -> (&'static str, Options) {
    let options = Options::new().with("kind", OptionValue::Text("ie".into()));
    (
        "cnn-energy",
        options.with("sweeps", OptionValue::Number(f64::from(sweeps))),
    )
}

fn far_ball() -> Tool {
    let pose = Pose::new([0.0, 0.0, 5.0], [0.0; 3]);
    tool(Convex::sphere(0.01).unwrap(), Motion::Held(pose))
}

/// A plane with the tissue above or below it.
fn plane(height: f64, tissue_is_above: bool) -> Tool {
    let turn = if tissue_is_above { 0.0 } else { PI };
    let pose = Pose::new([0.0, 0.0, height], [turn, 0.0, 0.0]);
    tool(Convex::Plane, Motion::Held(pose))
}

fn laws() -> [Option<&'static str>; 2] {
    [None, Some(Hyperelastic::IDS[0])]
}

#[test]
fn a_body_flies_on_beside_a_tool_that_is_far_away() {
    let velocity = [0.3, -0.1, 0.2];
    for law in laws() {
        let mut cube = Block::of([0.06; 3], [3; 3]);
        (cube.law, cube.is_held, cube.nu) = (law, false, 0.3);
        let pressed = cube.with(vec![far_ball()]);
        for (sweeps, dt) in [(1, 1e-4), (4, 1e-4), (1, 2e-3), (4, 2e-3)] {
            let mut state = pressed.at_rest();
            let components = state.v.iter_mut().zip(velocity.iter().cycle());
            components.for_each(|(v, along)| *v = *along);
            pressed.run_with(&mut state, energy_sweeps(sweeps), dt, 50);
            for (v, along) in state.v.iter().zip(velocity.iter().cycle()) {
                assert!((v - along).abs() < 1e-10, "{law:?}, {sweeps}, {dt}: {v}");
            }
        }
    }
}

/// The mean displacement (m) along x of a cube that stands on its bottom and swings sideways from rest, every 4 ms up to 60 ms.
fn sway(model: &Model, method: (&str, Options), dt: f64) -> Vec<f64> {
    let mut integrator = sinew_integrators::build(method.0, &method.1).unwrap();
    let mut state = State::at_rest(model.dofs());
    let run = Run {
        dt,
        steps: (4e-3 / dt).round() as usize,
        divergence_limit: f64::INFINITY,
    };
    let mut next = || {
        simulate(model, &mut *integrator, &mut state, &run, &mut ()).unwrap();
        let along = state.u.iter().step_by(3);
        along.sum::<f64>() / (state.u.len() / 3) as f64
    };
    (0..15).map(|_| next()).collect()
}

/// The largest difference of two motions, as a share of the second one's size.
fn off(found: &[f64], exact: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |a, b| b.abs().max(a));
    let mut differences = found.iter().zip(exact).map(|(a, b)| a - b);
    largest(&mut differences) / largest(&mut exact.iter().copied())
}

fn assert_order_1(motion: impl Fn(f64) -> Vec<f64>, exact: &[f64], label: &str) {
    let errors = [2e-3, 1e-3, 0.5e-3].map(|dt| off(&motion(dt), exact));
    assert!(errors[2] < 0.03, "{label}: {errors:?}");
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((1.5..2.6).contains(&ratio), "{label}: {errors:?}");
    }
}

#[test]
fn a_body_swings_beside_a_tool_that_is_far_away_in_order_1() {
    for law in laws() {
        let mut cube = Block::of([0.06; 3], [3; 3]);
        (cube.law, cube.nu, cube.gravity) = (law, 0.42, Some([3.0, 0.0, -6.0]));
        let pressed = cube.with(vec![far_ball()]);
        let mesh = block(cube.cells, cube.size, Split::Kuhn).unwrap();
        let alone = Model::build(&mesh, &cube.problem()).unwrap();
        let exact = sway(&alone, ("newmark", Options::new()), 0.5e-3);
        let motion = |dt: f64| sway(&pressed.model, energy_sweeps(4), dt);
        assert_order_1(motion, &exact, &format!("{law:?}"));
        // Beside those of the formula, the errors of four sweeps are small.
        let formula = sway(&alone, ("implicit-euler", Options::new()), 1e-3);
        let of_sweeps = off(&motion(1e-3), &formula);
        assert!(of_sweeps < 2e-3, "{law:?}: {of_sweeps:e}");
    }
}

#[test]
fn a_body_swings_beneath_a_plate_that_rests_on_it_in_order_1() {
    for law in laws() {
        let mut cube = Block::of([0.06; 3], [3; 3]);
        (cube.law, cube.nu, cube.gravity) = (law, 0.3, Some([2.0, 0.0, 3.0]));
        let pressed = cube.with(vec![plane(0.06, false)]);
        // Its own error is that of a step twenty times as short.
        let exact = sway(
            &pressed.model,
            ("symplectic-euler", Options::new()),
            0.05e-3,
        );
        let motion = |dt: f64| sway(&pressed.model, energy_sweeps(4), dt);
        assert_order_1(motion, &exact, &format!("{law:?}"));
    }
}

/// Galileo's relativity beyond the stable step: a block under a smooth plate that presses it responds equally if its
/// support rests or glides along the plate.
#[test]
fn a_pressed_block_on_a_support_that_glides_answers_as_one_that_stands() {
    let velocity = [0.3, -0.2, 0.0];
    let mut standing = Block::of([0.06; 3], [3; 3]);
    (standing.nu, standing.gravity) = (0.3, Some([1.0, 0.0, -2.0]));
    let gliding = Block {
        carried_at: velocity,
        ..standing
    };
    let [standing, gliding] =
        [standing, gliding].map(|block| block.with(vec![plane(0.058, false)]));
    for share in [1.5, 4.0, 9.0] {
        let dt = share * standing.stable_step();
        let mut states = [standing.at_rest(), gliding.at_rest()];
        let along = states[1].v.iter_mut().zip(velocity.iter().cycle());
        along.for_each(|(v, along)| *v = *along);
        for step in 1..=40 {
            let [stands, glides] = &mut states;
            standing.run(stands, "cnn-stabilised", dt, 1);
            gliding.run(glides, "cnn-stabilised", dt, 1);
            let [expected, found] = [(&standing, &*stands), (&gliding, &*glides)]
                .map(|(block, state)| block.force(state));
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{share}, step {step}: {found} {expected}"
                );
            }
        }
        let [stands, glides] = &states;
        let moves = stands.v.iter().zip(&glides.v).zip(velocity.iter().cycle());
        for ((stands, glides), velocity) in moves {
            assert!(
                (stands + velocity - glides).abs() < 1e-9,
                "{share}: {stands} {glides}"
            );
        }
        assert!(
            standing.force(stands)[2] > 1e-3,
            "{share}: the plate touches"
        );
    }
}
