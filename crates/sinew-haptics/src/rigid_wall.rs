//! A rigid wall: the simplest simulation, and the hardest to render.

use std::convert::Infallible;

use sinew_tools::vector::{Vector, add, scaled, sub};

use crate::coupling::Coupling;
use crate::published::{DeviceMotion, Published, Simulated};

/// Stiffness (N/m) that the wall publishes: that of steel under a square millimetre, and above that of any coupling.
const STIFFNESS: f64 = 1e6;

/// A point mass on a coupling above the rigid and smooth ground z = 0.
///
/// The step is the average acceleration method (Newmark 1959) with an inelastic impact, stable at any length.
#[derive(Clone, Debug)]
pub struct RigidWall {
    coupling: Coupling,
    mass: f64,
    dt: f64,
    steps: u64,
    position: Vector,
    velocity: Vector,
    /// Position (m) of the device at the end of the last step.
    device: Vector,
}

impl RigidWall {
    /// A tool with a mass (kg) on a coupling, which begins at a position (m); steps of `dt` (s).
    #[must_use]
    pub fn new(coupling: Coupling, mass: f64, dt: f64, position: [f64; 3]) -> Self {
        Self {
            coupling,
            mass,
            dt,
            steps: 0,
            position,
            velocity: [0.0; 3],
            device: position,
        }
    }
}

impl Simulated for RigidWall {
    type Error = Infallible;

    fn dt(&self) -> f64 {
        self.dt
    }

    fn step(&mut self, device: &DeviceMotion) -> Result<Published, Infallible> {
        let Coupling { stiffness, damping } = self.coupling;
        let (dt, mass) = (self.dt, self.mass);
        let end = add(device.position, scaled(device.velocity, dt));
        let path = scaled(sub(end, self.device), 1.0 / dt);
        let offset = sub(self.position, self.device);
        // (v+ - v) P = -dt (k (d + dt/2 (v - w)) + b (v - w)), P = m + dt/2 b + dt^2/4 k.
        let metric = mass + 0.5 * dt * damping + 0.25 * dt * dt * stiffness;
        let slip = sub(self.velocity, path);
        let spring = scaled(add(offset, scaled(slip, 0.5 * dt)), stiffness);
        let pull = add(spring, scaled(slip, damping));
        let mut mean = sub(self.velocity, scaled(pull, 0.5 * dt / metric));
        let depth = -(self.position[2] + dt * mean[2]);
        let mut force = [0.0; 3];
        if depth > 0.0 {
            mean[2] += depth / dt;
            force[2] = 2.0 * metric * depth / (dt * dt);
        }
        self.position = add(self.position, scaled(mean, dt));
        self.velocity = sub(scaled(mean, 2.0), self.velocity);
        if depth > 0.0 {
            // It stays on the ground: an inelastic impact.
            self.velocity[2] = 0.0;
        }
        self.device = end;
        self.steps += 1;
        let mut published = Published {
            t: self.steps as f64 * dt,
            dt,
            steps: self.steps,
            velocity: self.velocity,
            force,
            ..Published::free_at(self.position)
        };
        if depth > 0.0 {
            published.stiffness[2][2] = STIFFNESS;
        }
        Ok(published)
    }
}
