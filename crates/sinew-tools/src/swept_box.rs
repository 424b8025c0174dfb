//! The region through which a tool passes in a step.

use crate::pose::Pose;
use crate::shape::Shape;
use crate::stroke::Stroke;
use crate::vector::Vector;

/// A box (m, lowest and highest corner) that contains a tool during a whole step, from the pose before to the pose after;
/// `None` for a tool with a plane.
///
/// A node that moves along a straight line meets the tool only if the box around its own path meets this one.
#[must_use]
pub fn swept_box(shape: &Shape, before: &Pose, after: &Pose) -> Option<[[f64; 3]; 2]> {
    let parts = shape.parts().iter();
    around(parts.map(|part| Stroke::new(part, *before, *after).bounds()))
}

/// The smallest box (m) around all boxes; `None` if one of them is `None`, or if there are no boxes.
pub(crate) fn around(mut boxes: impl Iterator<Item = Option<[Vector; 2]>>) -> Option<[Vector; 2]> {
    let first = boxes.next()??;
    boxes.try_fold(first, |[low, high], next| {
        let [other_low, other_high] = next?;
        Some([
            [0, 1, 2].map(|axis| low[axis].min(other_low[axis])),
            [0, 1, 2].map(|axis| high[axis].max(other_high[axis])),
        ])
    })
}
