//! `shape` of `[[tool]]`: what tools are made of.

use crate::decode::{Inner, Key, Needs, Number, Or, Table, TableDescription, Vector};
use crate::error::SceneError;

/// A part of a tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolPart {
    /// Its shape.
    pub shape: ToolShape,
    /// The place (m) of its middle in the tool's own frame; of a plane, of one of its points.
    pub at: [f64; 3],
    /// Its rotation vector (rad) in the tool's own frame.
    pub rotation: [f64; 3],
}

/// The shape of a part of a tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToolShape {
    /// A sphere.
    Sphere {
        /// Its radius (m).
        radius: f64,
    },
    /// A cylinder along z with a half sphere on either end.
    Capsule {
        /// Its radius (m).
        radius: f64,
        /// Length (m) of the cylinder.
        length: f64,
    },
    /// All that lies below a plane whose normal is +z.
    Plane,
    /// A box along the axes.
    Box {
        /// Lengths (m) of its edges.
        size: [f64; 3],
    },
}

pub(super) const SHAPE: TableDescription = TableDescription {
    name: "tool-shape",
    meaning: "A shape in the frame of a tool.",
    keys: &[&SPHERE, &CAPSULE, &PLANE, &BOX, &AT, &ROTATION],
    needs: Needs::OneOf(&[SPHERE.name, CAPSULE.name, PLANE.name, BOX.name]),
    examples: &[
        "{ sphere = { radius = 0.006 } }",
        "{ capsule = { radius = 0.003, length = 0.02 }, at = [0.0, 0.0, 0.013], rotation = [0.1, 0.0, 0.0] }",
        "{ plane = {} }",
        "{ box = { size = [0.02, 0.02, 0.005] } }",
    ],
};

const SPHERE: Key<Inner> = Key::required(
    "sphere",
    "A sphere about the place.",
    Inner::one("a table such as { radius = 0.006 }", &SPHERES),
);

const CAPSULE: Key<Inner> = Key::required(
    "capsule",
    "A rod along z with round ends, the place in its middle.",
    Inner::one(
        "a table such as { radius = 0.003, length = 0.02 }",
        &CAPSULES,
    ),
);

const PLANE: Key<Inner> = Key::required(
    "plane",
    "All that lies below a plane through the place, whose normal is +z: tissue stays above it.",
    Inner::one("an empty table {}", &PLANES),
);

const BOX: Key<Inner> = Key::required(
    "box",
    "A box along the axes, the place in its middle.",
    Inner::one("a table such as { size = [0.02, 0.02, 0.005] }", &BOXES),
);

const AT: Key<Vector, Or<[f64; 3]>> = Key::or(
    "at",
    "Its place in the tool's own frame.",
    Vector::finite("[x, y, z] in m, all finite"),
    [0.0; 3],
)
.unit("m");

const ROTATION: Key<Vector, Or<[f64; 3]>> = Key::or(
    "rotation",
    "Its rotation about that place in the tool's own frame: the axis times the angle.",
    Vector::finite("[rx, ry, rz] in rad, all finite"),
    [0.0; 3],
)
.unit("rad");

const SPHERES: TableDescription = TableDescription {
    name: "tool-sphere",
    meaning: "A sphere.",
    keys: &[&RADIUS],
    needs: Needs::Any,
    examples: &["{ radius = 0.006 }"],
};

const CAPSULES: TableDescription = TableDescription {
    name: "tool-capsule",
    meaning: "A rod with round ends.",
    keys: &[&RADIUS, &LENGTH],
    needs: Needs::Any,
    examples: &["{ radius = 0.003, length = 0.02 }"],
};

const PLANES: TableDescription = TableDescription {
    name: "tool-plane",
    meaning: "A plane, which has no keys.",
    keys: &[],
    needs: Needs::Any,
    examples: &["{}"],
};

const BOXES: TableDescription = TableDescription {
    name: "tool-box",
    meaning: "A box.",
    keys: &[&SIZE],
    needs: Needs::Any,
    examples: &["{ size = [0.02, 0.02, 0.005] }"],
};

const RADIUS: Key<Number> = Key::required(
    "radius",
    "The radius.",
    Number::above_zero("a finite radius above 0 m"),
)
.unit("m");

const LENGTH: Key<Number> = Key::required(
    "length",
    "The length between the middles of its ends.",
    Number::above_zero("a finite length above 0 m"),
)
.unit("m");

const SIZE: Key<Vector> = Key::required(
    "size",
    "The lengths of its edges along x, y and z.",
    Vector {
        expected: "[x, y, z] in m, all finite and above 0",
        of: Number::above_zero("a finite length above 0 m"),
        fits: |_| true,
    },
)
.unit("m");

pub(super) fn read(table: &Table<'_>) -> Result<ToolPart, SceneError> {
    let shape = match table.exactly_one()? {
        key if key == SPHERE.name => ToolShape::Sphere {
            radius: table.table(&SPHERE)?.read(&RADIUS)?,
        },
        key if key == CAPSULE.name => {
            let capsule = table.table(&CAPSULE)?;
            ToolShape::Capsule {
                radius: capsule.read(&RADIUS)?,
                length: capsule.read(&LENGTH)?,
            }
        }
        key if key == PLANE.name => {
            table.table(&PLANE)?;
            ToolShape::Plane
        }
        _ => ToolShape::Box {
            size: table.table(&BOX)?.read(&SIZE)?,
        },
    };
    Ok(ToolPart {
        shape,
        at: table.read(&AT)?,
        rotation: table.read(&ROTATION)?,
    })
}
