//! Haptic devices.

use crate::coupling::DeviceLimits;

/// A device with a handle.
pub trait Device {
    /// Capabilities of the device.
    fn limits(&self) -> DeviceLimits;

    /// Position (m) of its handle, as it measures it.
    fn position(&mut self) -> [f64; 3];

    /// Rotation vector (rad) of its handle.
    fn rotation_vector(&mut self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Holds this force (N) on its handle until the next.
    fn render(&mut self, force: [f64; 3]);
}
