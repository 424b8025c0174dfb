//! Projection of positions to pixels.

use crate::View;
use crate::vector::{V3, add, cross, dot, scaled, sub, unit};

/// Distance of the eye in perspective, in units of the body's radius.
const DISTANCE: f32 = 5.2;

/// The smallest distance at which anything is drawn in perspective.
const NEAREST: f32 = 0.3;

/// A view of the stage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    pub(crate) right: V3,
    pub(crate) up: V3,
    /// The direction towards the eye.
    pub(crate) back: V3,
    /// The point that is seen at the middle.
    pub(crate) target: V3,
    /// The column and the row of the middle.
    pub(crate) middle: [f32; 2],
    /// Pixels for a length of 1 at the middle.
    pub(crate) scale: f32,
    pub(crate) is_perspective: bool,
}

/// A projected position.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// Column, to the right.
    pub(crate) x: f32,
    /// Row, downwards.
    pub(crate) y: f32,
    /// Nearness: larger for nearer positions, linear over the picture.
    pub(crate) near: f32,
    /// Reciprocal of the distance, by which lengths shrink; 1 without perspective.
    pub(crate) shrink: f32,
}

impl Camera {
    /// A camera that looks at the origin.
    pub(crate) fn new(view: View) -> Self {
        let (azimuth, elevation) = (view.azimuth.to_radians(), view.elevation.to_radians());
        let [sin, cos] = [azimuth.sin() as f32, azimuth.cos() as f32];
        let [high, level] = [elevation.sin() as f32, elevation.cos() as f32];
        let right = [cos, sin, 0.0];
        let back = [sin * level, -cos * level, high];
        Self {
            right,
            up: unit(cross(back, right)),
            back,
            target: [0.0; 3],
            middle: [0.0; 2],
            scale: 1.0,
            is_perspective: view.is_perspective,
        }
    }

    /// The distance of a position in front of the eye; 1 without perspective.
    pub(crate) fn distance(&self, place: V3) -> f32 {
        match self.is_perspective {
            true => DISTANCE - dot(sub(place, self.target), self.back),
            false => 1.0,
        }
    }

    /// True for positions that are far enough in front of the eye.
    pub(crate) fn is_before(&self, place: V3) -> bool {
        self.distance(place) >= NEAREST
    }

    /// The end of the drawn part, as a share of the segment from a position in front of the eye to one that is not.
    pub(crate) fn end_of(&self, before: V3, behind: V3) -> f32 {
        let [from, to] = [before, behind].map(|place| self.distance(place));
        ((from - NEAREST) / (from - to)).clamp(0.0, 1.0)
    }

    /// The projection of a position.
    pub(crate) fn seen(&self, place: V3) -> Seen {
        let offset = sub(place, self.target);
        let shrink = match self.is_perspective {
            true => 1.0 / self.distance(place).max(NEAREST),
            false => 1.0,
        };
        let size = match self.is_perspective {
            true => self.scale * DISTANCE * shrink,
            false => self.scale,
        };
        Seen {
            x: self.middle[0] + size * dot(offset, self.right),
            y: self.middle[1] - size * dot(offset, self.up),
            near: match self.is_perspective {
                true => shrink,
                false => dot(offset, self.back),
            },
            shrink,
        }
    }

    /// The direction from a position to the eye.
    pub(crate) fn towards_eye(&self, place: V3) -> V3 {
        match self.is_perspective {
            true => unit(sub(self.eye(), place)),
            false => self.back,
        }
    }

    fn eye(&self) -> V3 {
        add(self.target, scaled(self.back, DISTANCE))
    }

    /// A point that is seen at a column and a row, and the direction away from the eye.
    pub(crate) fn ray(&self, x: f32, y: f32) -> (V3, V3) {
        let aside = scaled(self.right, (x - self.middle[0]) / self.scale);
        let above = scaled(self.up, (self.middle[1] - y) / self.scale);
        let point = add(self.target, add(aside, above));
        match self.is_perspective {
            true => (point, sub(point, self.eye())),
            false => (point, scaled(self.back, -1.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::length;

    #[test]
    fn views_turn_as_their_angles_say() {
        let camera = |text: &str| text.parse().map(Camera::new);
        let is =
            |found: V3, expected: V3| assert!(length(sub(found, expected)) < 1e-6, "{found:?}");
        let top = camera("top").expect("a view");
        is(top.right, [1.0, 0.0, 0.0]);
        is(top.up, [0.0, 1.0, 0.0]);
        let right = camera("right").expect("a view");
        is(right.back, [1.0, 0.0, 0.0]);
        is(right.up, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_ray_goes_through_what_is_seen_at_its_pixel() {
        for text in ["front", "30,20"] {
            let mut camera = text.parse().map(Camera::new).expect("a view");
            (camera.scale, camera.middle, camera.target) =
                (200.0, [320.0, 180.0], [0.1, 0.0, -0.2]);
            let place = [0.3, -0.4, 0.25];
            let seen = camera.seen(place);
            let (from, along) = camera.ray(seen.x, seen.y);
            let aside = cross(sub(place, from), unit(along));
            assert!(length(aside) < 1e-5, "{text}: {aside:?}");
        }
    }
}
