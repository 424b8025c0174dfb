//! A simulated device, for tests instead of real ones.

use std::fmt::{self, Debug};

use sinew_tools::vector::{Vector, add, dot, scaled, sub};

use crate::coupling::DeviceLimits;
use crate::device::Device;

/// Number of substeps of a tick in which its motion is computed.
const PARTS: usize = 10;

/// A handle with a mass, pulled by the spring and the damper of a model of the user's hand that follows a path, with an
/// encoder and with forces that are constant during a tick.
///
/// Time passes with [`Device::render`], by one tick: simulated time, in which nothing depends on a clock.
pub struct SoftwareDevice {
    limits: DeviceLimits,
    /// Mass (kg).
    mass: f64,
    /// Stiffness (N/m) of the model of the user's hand, whose damping is that of the limits.
    hand: f64,
    path: Box<dyn Fn(f64) -> [f64; 3] + Send>,
    ticks: u64,
    position: Vector,
    velocity: Vector,
    /// The work (J) of rendered forces on the handle, and its largest value.
    work: [f64; 2],
}

impl Debug for SoftwareDevice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("SoftwareDevice")
            .field("limits", &self.limits)
            .field("position", &self.position)
            .field("velocity", &self.velocity)
            .finish_non_exhaustive()
    }
}

impl SoftwareDevice {
    /// A handle of 100 g in a model of the user's hand, of 500 N/m and 5 N s/m, that follows a path (m) in time (s);
    /// ticks of 1 ms, a resolution of 25 um, at most 20 N.
    #[must_use]
    pub fn in_a_hand(path: impl Fn(f64) -> [f64; 3] + Send + 'static) -> Self {
        Self {
            limits: DeviceLimits {
                tick: 1e-3,
                damping: 5.0,
                resolution: 25e-6,
                largest_force: 20.0,
            },
            mass: 0.1,
            hand: 500.0,
            position: path(0.0),
            path: Box::new(path),
            ticks: 0,
            velocity: [0.0; 3],
            work: [0.0; 2],
        }
    }

    /// The time (s) that has passed.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.ticks as f64 * self.limits.tick
    }

    /// The position (m) of its handle, without rounding.
    #[must_use]
    pub fn true_position(&self) -> [f64; 3] {
        self.position
    }

    /// The velocity (m/s) of its handle.
    #[must_use]
    pub fn velocity(&self) -> [f64; 3] {
        self.velocity
    }

    /// The energy (J) that the handle has taken out of the source of the forces, exact, since it is the work of
    /// constant forces over displacements: negative if it has supplied energy.
    #[must_use]
    pub fn energy_taken_out(&self) -> f64 {
        self.work[0]
    }

    /// The largest value (J) of [`Self::energy_taken_out`] at any tick so far: at most 0 for a passive source.
    #[must_use]
    pub fn most_energy_taken_out(&self) -> f64 {
        self.work[1]
    }
}

impl Device for SoftwareDevice {
    fn limits(&self) -> DeviceLimits {
        self.limits
    }

    fn position(&mut self) -> [f64; 3] {
        let step = self.limits.resolution;
        self.position.map(|value| (value / step).round() * step)
    }

    /// Integrates the motion over a tick by the implicit midpoint rule, which neither adds nor takes energy.
    fn render(&mut self, force: [f64; 3]) {
        let dt = self.limits.tick / PARTS as f64;
        let (before, t) = (self.position, self.t());
        for part in 0..PARTS {
            let start = t + dt * part as f64;
            let ends = [(self.path)(start), (self.path)(start + dt)];
            let middle = scaled(add(ends[0], ends[1]), 0.5);
            let speed = scaled(sub(ends[1], ends[0]), 1.0 / dt);
            let spring = scaled(sub(middle, self.position), self.hand);
            let damper = scaled(speed, self.limits.damping);
            let pull = add(add(spring, damper), force);
            // With x in the middle = x + dt/2 v in the middle.
            let metric = self.mass + 0.5 * dt * self.limits.damping + 0.25 * dt * dt * self.hand;
            let mean = scaled(
                add(scaled(self.velocity, self.mass), scaled(pull, 0.5 * dt)),
                1.0 / metric,
            );
            self.position = add(self.position, scaled(mean, dt));
            self.velocity = sub(scaled(mean, 2.0), self.velocity);
        }
        self.ticks += 1;
        let [work, most] = &mut self.work;
        *work += dot(force, sub(self.position, before));
        *most = most.max(*work);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_swings_as_a_damped_oscillator() {
        // A step of the path by 10 mm: x'' + 50 x' + 5000 x = 0 about it.
        let mut device =
            SoftwareDevice::in_a_hand(|t| [if t > 0.0 { 0.01 } else { 0.0 }, 0.0, 0.0]);
        let (decay, omega) = (25.0_f64, (5000.0_f64 - 625.0).sqrt());
        // The step happens within the first part of the first tick.
        let impulse = 5.0 * 0.01 / 0.1;
        for _ in 0..200 {
            device.render([0.0; 3]);
            let t = device.t();
            let (a, b) = (-0.01, (impulse - 0.01 * decay) / omega);
            let swing = a * (omega * t).cos() + b * (omega * t).sin();
            let expected = 0.01 + (-decay * t).exp() * swing;
            let x = device.true_position()[0];
            assert!((x - expected).abs() < 4e-5, "{t}: {x} {expected}");
        }
    }

    #[test]
    fn energy_taken_out_is_force_times_way() {
        let mut device = SoftwareDevice::in_a_hand(|_| [0.0; 3]);
        for _ in 0..500 {
            device.render([0.0, 1.0, 0.0]);
        }
        // 1 N moves 500 N/m by 2 mm.
        assert!((device.true_position()[1] - 0.002).abs() < 1e-7);
        assert_eq!(device.position()[1], 0.002);
        assert!((device.energy_taken_out() - 0.002).abs() < 1e-7);
        assert!(device.most_energy_taken_out() >= device.energy_taken_out());
    }
}
