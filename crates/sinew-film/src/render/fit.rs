//! Position of a camera that has everything in the picture.

use super::camera::Camera;
use crate::vector::{V3, add, scaled};
use crate::{Size, View};

/// Number of rounds in which a camera in perspective converges: near objects grow as the camera comes closer.
const ROUNDS: usize = 6;

/// Margins about the body for texts, as shares of the width or the height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    pub(crate) left: f32,
    pub(crate) right: f32,
    pub(crate) top: f32,
    pub(crate) bottom: f32,
}

impl Room {
    /// Equal margins, for pictures without texts.
    pub(crate) const EVEN: Self = Self {
        left: 0.06,
        right: 0.06,
        top: 0.08,
        bottom: 0.08,
    };
}

/// A camera that shows these points between the margins, as large as possible.
pub(crate) fn fitted(view: View, size: Size, room: Room, points: &[V3]) -> Camera {
    let mut camera = Camera::new(view);
    let [width, height] = [size.width() as f32, size.height() as f32];
    let [left, right] = [room.left * width, (1.0 - room.right) * width];
    let [top, bottom] = [room.top * height, (1.0 - room.bottom) * height];
    camera.middle = [0.5 * (left + right), 0.5 * (top + bottom)];
    camera.scale = 0.25 * (right - left).min(bottom - top);
    for _ in 0..ROUNDS {
        let mut low = [f32::MAX; 2];
        let mut high = [f32::MIN; 2];
        for point in points {
            let seen = camera.seen(*point);
            for (axis, at) in [seen.x, seen.y].into_iter().enumerate() {
                low[axis] = low[axis].min(at);
                high[axis] = high[axis].max(at);
            }
        }
        if low[0] > high[0] {
            break;
        }
        let aside = 0.5 * (low[0] + high[0]) - camera.middle[0];
        let above = camera.middle[1] - 0.5 * (low[1] + high[1]);
        let shift = add(
            scaled(camera.right, aside / camera.scale),
            scaled(camera.up, above / camera.scale),
        );
        camera.target = add(camera.target, shift);
        let least = 1e-3 * width;
        let wide = (right - left) / (high[0] - low[0]).max(least);
        let tall = (bottom - top) / (high[1] - low[1]).max(least);
        camera.scale *= wide.min(tall);
    }
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_touches_the_room_and_stays_within() {
        let room = Room {
            left: 0.1,
            right: 0.2,
            top: 0.1,
            bottom: 0.1,
        };
        let size = Size::new(1000, 500).expect("a size");
        let corners =
            [-1.0_f32, 1.0].map(|x| [-0.5_f32, 0.5].map(|y| [-0.2_f32, 0.2].map(|z| [x, y, z])));
        let points = corners.as_flattened().as_flattened();
        for text in ["front", "top", "40,30"] {
            let view = text.parse().expect("a view");
            let camera = fitted(view, size, room, points);
            let seen: Vec<[f32; 2]> = points
                .iter()
                .map(|point| camera.seen(*point))
                .map(|seen| [seen.x, seen.y])
                .collect();
            let along = |axis: usize| seen.iter().map(move |seen| seen[axis]);
            let [left, right] = [
                along(0).fold(f32::MAX, f32::min),
                along(0).fold(f32::MIN, f32::max),
            ];
            let [top, bottom] = [
                along(1).fold(f32::MAX, f32::min),
                along(1).fold(f32::MIN, f32::max),
            ];
            let is_within = left > 99.0 && right < 801.0 && top > 49.0 && bottom < 451.0;
            let touches = (right - left) > 695.0 || (bottom - top) > 395.0;
            assert!(
                is_within && touches,
                "{text}: {left} {right} {top} {bottom}"
            );
        }
    }
}
