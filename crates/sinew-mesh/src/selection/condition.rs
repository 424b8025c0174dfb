//! One condition on the position of a node.

use std::fmt;

use super::data_values::{DataValues, WithData};

/// A condition on the position of a node at rest. Lengths are in the mesh's unit (metres in a scene).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Condition {
    /// A position in a box along the axes; an infinite bound has no effect.
    Box {
        /// Least coordinates.
        low: [f64; 3],
        /// Greatest coordinates.
        high: [f64; 3],
    },
    /// A position in a sphere.
    Sphere {
        /// Its centre.
        center: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// A position in a straight cylinder with flat ends.
    Cylinder {
        /// The ends of its axis, which differ.
        axis: [[f64; 3]; 2],
        /// Its radius.
        radius: f64,
    },
    /// A position near a plane.
    Plane {
        /// A point of the plane.
        point: [f64; 3],
        /// Its normal, of any length above 0.
        normal: [f64; 3],
        /// The greatest distance from it, on either side.
        within: f64,
    },
    /// A corner of a boundary triangle that faces in a direction. With this condition, only such triangles are
    /// selected, not all whose nodes are.
    Facing {
        /// The direction, of any length above 0.
        normal: [f64; 3],
        /// The greatest angle (degrees) between it and the triangle's outward normal.
        angle: f64,
    },
    /// One of these nodes, by their tags in the mesh file.
    Tags(Vec<u64>),
    /// A value of the mesh's data. Nodes are selected by data at nodes, otherwise by tetrahedra with such a value;
    /// tetrahedra and triangles of the boundary are selected by data of tetrahedra, otherwise if all their nodes have
    /// such values.
    Data {
        /// Name of the data.
        name: String,
        /// The values.
        values: DataValues,
    },
}

impl Condition {
    /// Coordinates of at most these; an infinite bound has no effect.
    #[must_use]
    pub fn below(high: [f64; 3]) -> Self {
        let low = [f64::NEG_INFINITY; 3];
        Self::Box { low, high }
    }

    /// Coordinates of at least these; an infinite bound has no effect.
    #[must_use]
    pub fn above(low: [f64; 3]) -> Self {
        let high = [f64::INFINITY; 3];
        Self::Box { low, high }
    }

    /// A corner of a boundary triangle that faces in the direction of `normal`, within an angle (degrees).
    #[must_use]
    pub fn facing(normal: [f64; 3], angle: f64) -> Self {
        Self::Facing { normal, angle }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Box { low, high } => bounds(f, *low, *high),
            Self::Sphere { center, radius } => {
                write!(f, "within {radius} m of {}", Point(*center))
            }
            Self::Cylinder {
                axis: [from, to],
                radius,
            } => write!(
                f,
                "within {radius} m of the axis from {} to {}",
                Point(*from),
                Point(*to)
            ),
            Self::Plane {
                point,
                normal,
                within,
            } => write!(
                f,
                "within {within} m of the plane through {} across {}",
                Point(*point),
                Point(*normal)
            ),
            Self::Facing { normal, angle } => {
                write!(f, "facing {} within {angle} degrees", Point(*normal))
            }
            Self::Tags(tags) => {
                let tags: Vec<String> = tags.iter().map(u64::to_string).collect();
                write!(f, "tagged {}", tags.join(", "))
            }
            Self::Data { name, values } => WithData(name, values).fmt(f),
        }
    }
}

/// The finite bounds.
fn bounds(f: &mut fmt::Formatter<'_>, low: [f64; 3], high: [f64; 3]) -> fmt::Result {
    let mut parts = Vec::new();
    for (axis, (low, high)) in ["x", "y", "z"].into_iter().zip(low.into_iter().zip(high)) {
        match (low.is_finite(), high.is_finite()) {
            (true, true) => parts.push(format!("{low} <= {axis} <= {high} m")),
            (true, false) => parts.push(format!("{axis} >= {low} m")),
            (false, true) => parts.push(format!("{axis} <= {high} m")),
            (false, false) => {}
        }
    }
    match parts.len() {
        0 => f.write_str("anywhere"),
        _ => write!(f, "at {}", parts.join(" and ")),
    }
}

struct Point([f64; 3]);

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "({x}, {y}, {z})")
    }
}
