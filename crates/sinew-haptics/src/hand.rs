//! The motion of a handle, estimated from its positions.

use sinew_tools::vector::{scaled, sub};

use crate::published::DeviceMotion;

/// Number of ticks over which a velocity is averaged: one step of the encoder in one tick of 1 ms would be 25 mm/s.
const WINDOW: usize = 8;

/// The last positions of a handle.
#[derive(Clone, Debug)]
pub(crate) struct Hand {
    tick: f64,
    positions: [[f64; 3]; WINDOW],
    rotation_vector: [f64; 3],
    seen: usize,
}

impl Hand {
    /// A handle that is read once per tick (s).
    pub(crate) fn new(tick: f64) -> Self {
        Self {
            tick,
            positions: [[0.0; 3]; WINDOW],
            rotation_vector: [0.0; 3],
            seen: 0,
        }
    }

    /// Records its position (m) and rotation vector (rad).
    pub(crate) fn see(&mut self, position: [f64; 3], rotation_vector: [f64; 3]) {
        if self.seen == 0 {
            self.positions = [position; WINDOW];
        }
        self.seen += 1;
        self.positions[self.seen % WINDOW] = position;
        self.rotation_vector = rotation_vector;
    }

    /// Its current motion.
    pub(crate) fn motion(&self) -> DeviceMotion {
        let now = self.positions[self.seen % WINDOW];
        let first = self.positions[(self.seen + 1) % WINDOW];
        let time = (WINDOW - 1) as f64 * self.tick;
        DeviceMotion {
            position: now,
            rotation_vector: self.rotation_vector,
            velocity: scaled(sub(now, first), 1.0 / time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_motion_has_its_velocity() {
        let mut hand = Hand::new(1e-3);
        hand.see([0.5, 0.0, 0.0], [0.0; 3]);
        assert_eq!(hand.motion(), DeviceMotion::at([0.5, 0.0, 0.0]));
        for tick in 1..30 {
            hand.see([0.5 + 1e-4 * f64::from(tick), 0.0, 0.0], [0.0, 0.1, 0.0]);
        }
        let motion = hand.motion();
        assert!((motion.velocity[0] - 0.1).abs() < 1e-12);
        assert_eq!(motion.rotation_vector, [0.0, 0.1, 0.0]);
    }
}
