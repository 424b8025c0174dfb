//! Haptic devices.

use crate::coupling::DeviceLimits;

/// A device with a handle.
pub trait Device {
    /// Capabilities of the device.
    fn limits(&self) -> DeviceLimits;

    /// Measured position (m) of its handle.
    fn position(&mut self) -> [f64; 3];

    /// Rotation vector (rad) of its handle.
    fn rotation_vector(&mut self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Applies this force (N) to its handle until the next call.
    fn render(&mut self, force: [f64; 3]);
}
