//! The plane z = 0, solid below.

use super::touch::{Nearest, Touch};

const NORMAL: [f64; 3] = [0.0, 0.0, 1.0];

pub(super) fn nearest([x, y, z]: [f64; 3]) -> Nearest {
    Nearest {
        distance: z,
        point: [x, y, 0.0],
        normal: NORMAL,
    }
}

/// Contact at which a point from above or on the plane enters.
pub(super) fn first_contact(from: [f64; 3], motion: [f64; 3]) -> Option<Touch> {
    if motion[2] >= 0.0 {
        return None;
    }
    let share = from[2] / -motion[2];
    Some(Touch {
        share,
        point: [
            from[0] + share * motion[0],
            from[1] + share * motion[1],
            0.0,
        ],
        normal: NORMAL,
    })
}
