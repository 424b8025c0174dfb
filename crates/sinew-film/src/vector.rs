//! Vectors of three numbers in single precision, in which pictures are computed.

/// A point, a direction or a linear colour.
pub(crate) type V3 = [f32; 3];

pub(crate) fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scaled(a: V3, by: f32) -> V3 {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// Products of components.
pub(crate) fn times(a: V3, b: V3) -> V3 {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

pub(crate) fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn length(a: V3) -> f32 {
    dot(a, a).sqrt()
}

/// The direction of a vector; zero stays zero.
pub(crate) fn unit(a: V3) -> V3 {
    let length = length(a);
    if length > 0.0 {
        scaled(a, 1.0 / length)
    } else {
        a
    }
}

/// The point at a share of the way from `a` to `b`.
pub(crate) fn between(a: V3, b: V3, share: f32) -> V3 {
    add(a, scaled(sub(b, a), share))
}

/// A vector turned by a rotation vector (rad), by Rodrigues' formula.
pub(crate) fn turned(v: V3, rotation: V3) -> V3 {
    let angle = length(rotation);
    if angle == 0.0 {
        return v;
    }
    let axis = scaled(rotation, 1.0 / angle);
    let (sin, cos) = angle.sin_cos();
    let along = scaled(axis, dot(axis, v) * (1.0 - cos));
    add(add(scaled(v, cos), scaled(cross(axis, v), sin)), along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let found = turned([1.0, 0.0, 2.0], [0.0, 0.0, std::f32::consts::FRAC_PI_2]);
        assert!(length(sub(found, [0.0, 1.0, 2.0])) < 1e-6, "{found:?}");
    }
}
