//! Points of segments.

use crate::vector::{Vector, dot, sub};

/// The shares (0 to 1) of two segments, each given by its ends (m), at which they are nearest to each other (Ericson,
/// Real-Time Collision Detection, 2005, 5.1.9).
#[must_use]
pub fn nearest_of_segments([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> (f64, f64) {
    let (one, two, between) = (sub(b, a), sub(d, c), sub(a, c));
    let (long, wide, apart) = (dot(one, one), dot(two, two), dot(two, between));
    if long == 0.0 && wide == 0.0 {
        return (0.0, 0.0);
    }
    if long == 0.0 {
        return (0.0, (apart / wide).clamp(0.0, 1.0));
    }
    let back = dot(one, between);
    if wide == 0.0 {
        return ((-back / long).clamp(0.0, 1.0), 0.0);
    }
    let both = dot(one, two);
    let determinant = long * wide - both * both;
    let first = if determinant > 0.0 {
        ((both * apart - back * wide) / determinant).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let second = (both * first + apart) / wide;
    if second < 0.0 {
        ((-back / long).clamp(0.0, 1.0), 0.0)
    } else if second > 1.0 {
        (((both - back) / long).clamp(0.0, 1.0), 1.0)
    } else {
        (first, second)
    }
}
