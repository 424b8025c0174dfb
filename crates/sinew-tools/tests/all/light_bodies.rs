//! Tools that are light bodies: with friction too, they and the tissue never have more energy than the hand has put in.

use crate::common::pressed;

use pressed::{Block, Pressed, energy, staggered_energy, through, tool};
use sinew_core::Options;
use sinew_tools::{Convex, Tool, ToolBody};

fn body(mass: f64, damping: f64) -> ToolBody {
    ToolBody {
        mass,
        inertia: [0.4 * mass * 0.012 * 0.012; 3],
        coupling: 400.0,
        rotational_coupling: 0.05,
        damping,
    }
}

fn scene(body: ToolBody, friction: f64) -> Pressed {
    let mut cube = Block::of([0.06; 3], [5; 3]);
    cube.nu = 0.3;
    let rows = [
        (0.0, [0.025, 0.03, 0.0721]),
        (0.05, [0.027, 0.03, 0.067]),
        (0.3, [0.035, 0.03, 0.067]),
        (10.0, [0.035, 0.03, 0.067]),
    ];
    cube.with(vec![Tool {
        friction,
        body: Some(body),
        ..tool(Convex::sphere(0.012).unwrap(), through(&rows, [0.0; 3]))
    }])
}

/// The largest rise of the energy of tissue, tool and coupling in a run of a second, less the work of the hand, above where it was lowest before; and the largest energy (J).
fn rise_and_largest(pressed: &Pressed, id: &str, dt: f64) -> (f64, f64) {
    let is_energy = id == "cnn-energy";
    let options = match is_energy {
        true => Options::new().with_text("kind", "ie"),
        false => Options::new(),
    };
    let mut state = pressed.at_rest();
    let (mut largest, mut lowest, mut rise): (f64, f64, f64) = (0.0, f64::INFINITY, 0.0);
    for _ in 0..(1.0 / dt) as usize {
        let before = state.clone();
        pressed.run_with(&mut state, (id, options.clone()), dt, 1);
        let body = pressed.tools.report(&state, 0).body.unwrap();
        let tissue = if is_energy {
            energy(pressed, &state)
        } else {
            staggered_energy(&pressed.model, &before, &state, dt)
        };
        let left = tissue + body.energy - body.hand_work;
        lowest = lowest.min(left);
        rise = rise.max(left - lowest);
        largest = largest.max(tissue + body.energy);
    }
    (rise, largest)
}

#[test]
fn a_light_tool_that_rubs_makes_no_energy() {
    for (id, share) in [
        ("cnn-energy", 2.0),
        ("central-difference", 0.5),
        ("central-difference", 0.95),
    ] {
        for mass in [0.05, 1e-3, 1e-7] {
            for (damping, friction) in [(0.0, 0.4), (0.8, 0.4), (0.0, 0.0)] {
                let pressed = scene(body(mass, damping), friction);
                let dt = share * pressed.stable_step();
                let (rise, largest) = rise_and_largest(&pressed, id, dt);
                assert!(largest > 1e-4, "the ball presses: {largest}");
                // Normals turn with a ball that rolls, by what it rolls in a step: a contact slips round it by d, along a plane that leaves the ball by d^2/(2 r).
                let limit = match (id, friction) {
                    ("cnn-energy", 0.0) => 1e-12,
                    ("cnn-energy", _) => 1e-6,
                    _ => 3e-4,
                };
                assert!(
                    rise <= limit * largest,
                    "{id} {share} {mass} {damping} {friction}: {rise} of {largest}"
                );
            }
        }
    }
}
