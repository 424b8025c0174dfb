//! Sources of light.

use super::camera::Camera;
use crate::vector::{V3, add, scaled, unit};

/// The direction of the lamp from the body: components upwards, to the left, and towards the eye.
const KEY: [f32; 3] = [1.0, 0.5, 0.35];

/// Light of the sky and of the floor, from all sides.
const SKY: V3 = [0.46, 0.48, 0.52];
const GROUND: V3 = [0.24, 0.21, 0.21];

/// A weak light from the other side, which keeps shaded sides readable.
const FILL: f32 = 0.16;

/// The lamps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Light {
    /// The direction of the lamp.
    pub(crate) key: V3,
    /// The direction of the weak lamp.
    fill: V3,
}

impl Light {
    /// Light that falls over the left shoulder of the viewer, from above.
    pub(crate) fn of(camera: &Camera) -> Self {
        let [above, aside, towards] = KEY;
        // Seen from above, what points up in the picture stands for what points away from the eye.
        let level = |v: V3| [v[0], v[1], 0.0];
        let before = unit(level(camera.back));
        let before = match before == [0.0; 3] || camera.back[2].abs() > 0.98 {
            true => scaled(level(camera.up), -1.0),
            false => before,
        };
        let left = scaled(camera.right, -aside);
        let key = add(add([0.0, 0.0, above], left), scaled(before, towards));
        let fill = add(
            add([0.0, 0.0, 0.3], scaled(camera.right, 0.8)),
            scaled(before, 0.6),
        );
        Self {
            key: unit(key),
            fill: unit(fill),
        }
    }

    /// The light that reaches a surface with this normal from all sides.
    pub(crate) fn around(&self, normal: V3) -> V3 {
        let share = 0.5 + 0.5 * normal[2];
        let fill = FILL * crate::vector::dot(normal, self.fill).max(0.0);
        [0, 1, 2].map(|axis| GROUND[axis] + share * (SKY[axis] - GROUND[axis]) + fill)
    }
}
