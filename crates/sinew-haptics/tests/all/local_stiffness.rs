//! The published stiffness of a simulation, compared with forces at rest.

use crate::common::tissue;

use std::f64::consts::PI;

use sinew_haptics::{DeviceMotion, Published, Simulated, ToolSimulation};

const LINEAR: &str = "model = \"linear\"";

/// Step (s).
const DT: f64 = 2e-3;

/// Number of iterations that is sufficient for the stiffness.
const ENOUGH: usize = 200;

/// A tool above the block that moves straight down to a depth (m) in half a second.
struct Press {
    simulation: ToolSimulation,
    /// The tool's position (m) at depth 0, and its rotation vector (rad).
    top: [f64; 3],
    rotation_vector: [f64; 3],
    depth: f64,
}

impl Press {
    fn plate(law: &str) -> Self {
        Self::new(
            "{ plane = {} }",
            [0.03, 0.03, tissue::EDGE],
            [PI, 0.0, 0.0],
            law,
        )
    }

    /// A ball of 40 mm, which touches several nodes.
    fn ball(law: &str) -> Self {
        let top = [0.03, 0.03, tissue::EDGE + 0.04];
        Self::new("{ sphere = { radius = 0.04 } }", top, [0.0; 3], law)
    }

    fn new(shape: &str, top: [f64; 3], rotation_vector: [f64; 3], law: &str) -> Self {
        let method = ("symplectic-euler", DT);
        Self {
            simulation: tissue::under(shape, rotation_vector, law, method),
            top,
            rotation_vector,
            depth: -1e-3,
        }
    }

    /// Result published at a depth (m) when all is at rest, after this many iterations for the stiffness.
    fn to(&mut self, depth: f64, iterations: usize) -> Published {
        let from = self.depth;
        self.depth = depth;
        self.simulation.set_iterations(0);
        let steps = 1000;
        for step in 1..steps {
            let share = (f64::from(step) * DT / 0.5).min(1.0);
            self.step(from + share * (depth - from));
        }
        self.simulation.set_iterations(iterations);
        self.step(depth)
    }

    fn step(&mut self, depth: f64) -> Published {
        let [x, y, z] = self.top;
        let device = DeviceMotion {
            rotation_vector: self.rotation_vector,
            ..DeviceMotion::at([x, y, z - depth])
        };
        self.simulation.step(&device).unwrap()
    }

    /// The stiffness (N/m) at a depth (m) from the difference of forces at rest next to it, and the published result.
    fn at(&mut self, depth: f64, by: f64) -> (f64, Published) {
        let places = [depth - by, depth, depth + by];
        let [below, here, above] = places.map(|depth| self.to(depth, ENOUGH));
        ((above.force[2] - below.force[2]) / (2.0 * by), here)
    }
}

#[test]
fn under_a_plate_it_is_that_of_the_block() {
    for (law, by, tolerance) in [
        (LINEAR, 1e-3, 1e-6),
        ("model = \"neo-hookean\"", 1e-4, 1e-4),
    ] {
        let (expected, published) = Press::plate(law).at(0.006, by);
        let found = published.stiffness[2][2];
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{found} {expected}"
        );
        assert!(expected > 100.0, "{expected}");
    }
}

#[test]
fn few_iterations_come_from_above() {
    let mut last = f64::INFINITY;
    let settled = Press::ball(LINEAR).to(0.006, ENOUGH).stiffness[2][2];
    for iterations in [0, 1, 3, 10, 30] {
        let published = Press::ball(LINEAR).to(0.006, iterations);
        let found = published.stiffness[2][2];
        assert!(found <= last * (1.0 + 1e-9), "{iterations}: {found} {last}");
        assert!(found >= settled * (1.0 - 1e-6), "{found} {settled}");
        last = found;
    }
    assert!(last < 1.001 * settled, "{last} {settled}");
}
