//! The floor, of which only what is dark on it is seen.

use super::contact::Contact;
use super::shadow::Shadow;
use crate::vector::{V3, add, scaled, times};

/// The colour behind everything.
pub(crate) const BACKGROUND: [u8; 3] = [232, 236, 241];

/// How much of the light a shadow takes, and how much the nearness of what stands there.
const SHADED: f32 = 0.34;
const HIDDEN: f32 = 0.42;

/// The distance from the middle at which shadows have faded away, and at which they begin to.
const FADED: [f32; 2] = [1.75, 1.2];

/// Sine of the angle below which the floor is too slanted to be seen.
pub(crate) const SLANTED: f32 = 0.05;

/// The colour of the floor along a ray from a point.
pub(super) fn floor(
    background: V3,
    (from, along): (V3, V3),
    height: f32,
    shadow: &Shadow,
    contact: &Contact,
) -> V3 {
    if along[2] > -SLANTED {
        return background;
    }
    let place = add(from, scaled(along, (height - from[2]) / along[2]));
    let far = (place[0] * place[0] + place[1] * place[1]).sqrt();
    let fade = ((FADED[0] - far) / (FADED[0] - FADED[1])).clamp(0.0, 1.0);
    if fade == 0.0 {
        return background;
    }
    let fade = fade * fade * (3.0 - 2.0 * fade);
    let shaded = SHADED * (1.0 - shadow.lit(place, [0.0, 0.0, 1.0]));
    let hidden = HIDDEN * contact.at(place[0], place[1]);
    let left = 1.0 - fade * (1.0 - (1.0 - shaded) * (1.0 - hidden));
    // Shadows are a little bluer than the floor.
    times(background, [left, left, left.powf(0.93)])
}
