//! Size and orientation of a mesh in space.

use super::TetMesh;
use crate::vector::{cross, dot};

impl TetMesh {
    /// Multiplies all coordinates by `factor`: 0.001 turns millimetres into metres.
    pub fn scale(&mut self, factor: f64) {
        for x in self.points.iter_mut().flatten() {
            *x *= factor;
        }
    }

    /// Rotates the mesh about an axis through the origin by an angle (degrees), counter-clockwise as seen from the
    /// axis's tip, with the formula of Rodrigues (1840). Multiples of 90 degrees about a coordinate axis are exact.
    /// Data of three components are vectors, such as directions, and are rotated with it.
    ///
    /// The length of `axis` does not matter; an axis of length 0, or one that is not finite, causes no rotation.
    ///
    /// ```
    /// use sinew_mesh::structured::{Split, block};
    /// let mut beam = block([3, 1, 1], [0.3, 0.1, 0.1], Split::Kuhn)?;
    /// beam.rotate([0.0, 0.0, 1.0], 90.0);
    /// assert_eq!(beam.bounding_box(), ([-0.1, 0.0, 0.0], [0.0, 0.3, 0.1]));
    /// # Ok::<(), sinew_mesh::structured::StructuredError>(())
    /// ```
    pub fn rotate(&mut self, axis: [f64; 3], degrees: f64) {
        // Divided by its largest entry first, so that squares neither overflow nor vanish.
        let largest = axis.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        let axis = axis.map(|x| x / largest);
        let length = dot(axis, axis).sqrt();
        if !length.is_finite() {
            return;
        }
        let axis = axis.map(|x| x / length);
        let (sin, cos) = sine_and_cosine(degrees);
        let vectors = self.data.iter_mut().filter(|data| data.components == 3);
        let vectors = vectors.flat_map(|data| data.values.as_chunks_mut().0);
        for point in self.points.iter_mut().chain(vectors) {
            let across = cross(axis, *point);
            let along = dot(axis, *point) * (1.0 - cos);
            for i in 0..3 {
                point[i] = point[i] * cos + across[i] * sin + axis[i] * along;
            }
        }
    }
}

/// Sine and cosine of an angle in degrees, exact for multiples of 90.
fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarters = (turn / 90.0).round();
    let (sin, cos) = (turn - 90.0 * quarters).to_radians().sin_cos();
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structured::{Split, cube};

    #[test]
    fn sines_and_cosines_are_those_of_radians_and_exact_where_they_can_be() {
        for degrees in -800..800 {
            let degrees = f64::from(degrees) * 0.93;
            let (sin, cos) = sine_and_cosine(degrees);
            let expected = degrees.to_radians().sin_cos();
            assert!((sin - expected.0).abs() < 1e-14, "{degrees}");
            assert!((cos - expected.1).abs() < 1e-14, "{degrees}");
        }
        for (degrees, exact) in [
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (-90.0, (-1.0, 0.0)),
            (720.0 + 270.0, (-1.0, 0.0)),
        ] {
            assert_eq!(sine_and_cosine(degrees), exact, "{degrees}");
        }
    }

    #[test]
    fn a_turn_about_the_diagonal_exchanges_the_axes() {
        let mut mesh = cube(2, 0.3, Split::Mirrored).expect("valid");
        let before = mesh.clone();
        mesh.rotate([7.0; 3], 120.0);
        for (turned, [x, y, z]) in mesh.points.iter().zip(&before.points) {
            for (turned, expected) in turned.iter().zip([z, x, y]) {
                assert!((turned - expected).abs() < 1e-15, "{turned} {expected}");
            }
        }
        mesh.rotate([-1e200; 3], 120.0);
        for (back, start) in mesh
            .points
            .iter()
            .flatten()
            .zip(before.points.iter().flatten())
        {
            assert!((back - start).abs() < 1e-15, "{back} {start}");
        }
    }

    #[test]
    fn volumes_stay_under_a_turn_and_go_with_the_cube_of_a_scale() {
        let mut mesh = cube(2, 0.3, Split::Mirrored).expect("valid");
        let before = mesh.signed_volumes();
        mesh.rotate([0.3, -2.0, 0.7], 33.0);
        mesh.scale(1e-3);
        for (volume, before) in mesh.signed_volumes().iter().zip(&before) {
            assert!((volume / (before * 1e-9) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn an_axis_without_direction_turns_nothing() {
        let mesh = cube(1, 0.3, Split::Kuhn).expect("valid");
        for axis in [[0.0; 3], [f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 1.0]] {
            let mut turned = mesh.clone();
            turned.rotate(axis, 45.0);
            assert_eq!(turned, mesh, "{axis:?}");
        }
    }
}
