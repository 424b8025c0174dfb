//! Rotations as matrices, by their rows, and as vectors (rad): the axis times the angle.

use crate::vector::{Vector, add, cross, dot, length, scaled};

pub(crate) type Matrix = [Vector; 3];

pub(crate) const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The matrix of a rotation vector, by Rodrigues' formula `I + sin(a)/a W + (1 - cos a)/a^2 W^2`.
///
/// 1 - cos a is computed as 2 sin^2(a/2), which is accurate for small angles.
pub(crate) fn matrix(vector: Vector) -> Matrix {
    if vector == [0.0; 3] {
        return IDENTITY;
    }
    let angle = length(vector);
    let first = sine_over_angle(angle);
    let second = sine_over_angle(angle / 2.0).powi(2) / 2.0;
    let [x, y, z] = vector;
    // W^2 = w w' - |w|^2 I, whose diagonal is -(y^2 + z^2) and so on.
    [
        [
            1.0 - second * (y * y + z * z),
            second * x * y - first * z,
            second * x * z + first * y,
        ],
        [
            second * x * y + first * z,
            1.0 - second * (x * x + z * z),
            second * y * z - first * x,
        ],
        [
            second * x * z - first * y,
            second * y * z + first * x,
            1.0 - second * (x * x + y * y),
        ],
    ]
}

/// The rotation vector of a matrix, with an angle of at most pi.
///
/// It is found from a quaternion, largest component first (Shepperd 1978): this is accurate at angles near 0 and near
/// pi.
pub(crate) fn vector(matrix: &Matrix) -> Vector {
    let m = matrix;
    let trace = m[0][0] + m[1][1] + m[2][2];
    let difference = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
    let axis = (0..3).fold(0, |best, axis| {
        if m[axis][axis] > m[best][best] {
            axis
        } else {
            best
        }
    });
    // Four times the quaternion times its largest component: only directions and ratios are needed.
    let (mut real, mut imaginary) = if trace >= m[axis][axis] {
        (1.0 + trace, difference)
    } else {
        let column = [0, 1, 2].map(|other| {
            if other == axis {
                1.0 + 2.0 * m[axis][axis] - trace
            } else {
                m[axis][other] + m[other][axis]
            }
        });
        (difference[axis], column)
    };
    if real < 0.0 {
        real = -real;
        imaginary = scaled(imaginary, -1.0);
    }
    let size = length(imaginary);
    if size == 0.0 {
        return [0.0; 3];
    }
    let angle = 2.0 * size.atan2(real);
    imaginary.map(|value| value / size * angle)
}

/// The spin (rad/s) of a body whose rotation vector changes at a rate (rad/s):
/// `I + (1 - cos a)/a^2 W + (a - sin a)/a^3 W^2` times the rate.
pub(crate) fn spin(vector: Vector, rate: Vector) -> Vector {
    let angle = length(vector);
    let second = sine_over_angle(angle / 2.0).powi(2) / 2.0;
    // The difference loses its digits where its share of the whole does not matter.
    let third = if angle < 1e-3 {
        1.0 / 6.0
    } else {
        (1.0 - sine_over_angle(angle)) / (angle * angle)
    };
    let across = cross(vector, rate);
    let back = scaled(cross(vector, across), third);
    add(rate, add(scaled(across, second), back))
}

pub(crate) fn times(matrix: &Matrix, vector: Vector) -> Vector {
    matrix.map(|row| dot(row, vector))
}

pub(crate) fn transposed(matrix: &Matrix) -> Matrix {
    [0, 1, 2].map(|row| [matrix[0][row], matrix[1][row], matrix[2][row]])
}

/// The product of two matrices: the second rotation comes first.
pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

fn sine_over_angle(angle: f64) -> f64 {
    if angle == 0.0 {
        1.0
    } else {
        angle.sin() / angle
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::vector::sub;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let quarter = matrix([0.0, 0.0, FRAC_PI_2]);
        assert!(length(sub(times(&quarter, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0])) < 1e-15);
        assert!(length(sub(times(&quarter, [0.0, 1.0, 0.0]), [-1.0, 0.0, 0.0])) < 1e-15);
    }

    #[test]
    fn tiny_angles_keep_their_digits() {
        for angle in [1e-300, 1e-20, 1e-9, 1e-4] {
            let tiny = [2.0 * angle / 3.0, -angle / 3.0, 2.0 * angle / 3.0];
            let back = vector(&matrix(tiny));
            assert!(length(sub(back, tiny)) <= 1e-15 * angle, "{angle}");
        }
        assert_eq!(vector(&matrix([0.0; 3])), [0.0; 3]);
    }

    #[test]
    fn half_turns_about_any_axis_come_back() {
        for axis in [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.48, -0.6, 0.64]] {
            for angle in [PI - 1e-3, PI - 1e-8, PI - 1e-14] {
                let turn = scaled(axis, angle);
                let back = vector(&matrix(turn));
                assert!(length(sub(back, turn)) < 1e-14, "{axis:?} {angle}");
            }
            let back = vector(&matrix(scaled(axis, PI)));
            assert!((length(back) - PI).abs() < 1e-15);
            assert!((dot(back, axis).abs() - PI).abs() < 1e-15);
        }
    }
}
