//! The floor. Only shadows on it are visible.

use super::contact::Contact;
use super::shadow::Shadow;
use crate::vector::{V3, add, scaled};

/// The colour behind everything.
pub(crate) const BACKGROUND: [u8; 3] = [232, 236, 241];

/// The share of the light that a shadow takes, and the share that an object close above the floor takes.
const SHADED: f32 = 0.34;
const HIDDEN: f32 = 0.42;

/// The distance from the middle at which shadows begin to fade, and at which they have faded away.
const FADING: f32 = 1.2;
const FADED: f32 = 1.75;

/// Sine of the angle below which the floor is too slanted to be seen.
pub(super) const SLANTED: f32 = 0.05;

/// Cells along an edge of the map.
const EDGE: usize = 256;

/// The darkness of the floor about the middle.
pub(super) struct Floor {
    height: f32,
    /// The share of light that is missing, on a square of cells.
    missing: Vec<f32>,
}

impl Floor {
    /// The floor at a height with the shadows on it.
    pub(super) fn of(height: f32, shadow: &Shadow, contact: &Contact) -> Self {
        let step = 2.0 * FADED / (EDGE - 1) as f32;
        let at = |cell: usize| cell as f32 * step - FADED;
        let missing = (0..EDGE * EDGE).map(|cell| {
            let (x, y) = (at(cell % EDGE), at(cell / EDGE));
            let far = (x * x + y * y).sqrt();
            let fade = ((FADED - far) / (FADED - FADING)).clamp(0.0, 1.0);
            if fade == 0.0 {
                return 0.0;
            }
            let shaded = SHADED * (1.0 - shadow.lit([x, y, height], [0.0, 0.0, 1.0]));
            let hidden = HIDDEN * contact.at(x, y);
            fade * fade * (3.0 - 2.0 * fade) * (1.0 - (1.0 - shaded) * (1.0 - hidden))
        });
        Self {
            height,
            missing: missing.collect(),
        }
    }

    /// The share of light of each colour from the floor along a ray from a point; `None` for all of it.
    pub(super) fn left(&self, (from, along): (V3, V3)) -> Option<V3> {
        if along[2] >= 0.0 {
            return None;
        }
        let place = add(from, scaled(along, (self.height - from[2]) / along[2]));
        let cells = (EDGE - 1) as f32 / (2.0 * FADED);
        let [x, y] = [0, 1].map(|axis: usize| (place[axis] + FADED) * cells);
        let last = (EDGE - 1) as f32;
        if !(x >= 0.0 && y >= 0.0 && x < last && y < last) {
            return None;
        }
        let (column, row) = (x as i32 as usize, y as i32 as usize);
        let [right, down] = [x - column as f32, y - row as f32];
        let value = |place: usize| self.missing[place];
        let first = row * EDGE + column;
        let upper = value(first) + right * (value(first + 1) - value(first));
        let below = first + EDGE;
        let lower = value(below) + right * (value(below + 1) - value(below));
        let missing = upper + down * (lower - upper);
        // Shadows are a little bluer than the floor.
        (missing > 0.0).then_some([1.0 - missing, 1.0 - missing, 1.0 - 0.93 * missing])
    }
}
