//! The room that a tool passes through in a step.

use crate::pose::Pose;
use crate::shape::Shape;
use crate::stroke::Stroke;

/// A box (m, lowest and highest corner) that contains a tool during a whole step, from the pose before to the pose after;
/// none for a tool with a plane.
///
/// A node that moves straight meets the tool only if the box about its own way meets this one.
#[must_use]
pub fn swept_box(shape: &Shape, before: &Pose, after: &Pose) -> Option<[[f64; 3]; 2]> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for part in shape.parts() {
        let [part_low, part_high] = Stroke::new(part, *before, *after).bounds()?;
        low = [0, 1, 2].map(|axis| low[axis].min(part_low[axis]));
        high = [0, 1, 2].map(|axis| high[axis].max(part_high[axis]));
    }
    Some([low, high])
}
