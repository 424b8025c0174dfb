//! `shape` of `[[tool]]`: the parts of tools.

use std::ops::Bound;

use sinew_tools::Pose;

use crate::decode::{Inner, Key, Needs, Number, Or, Place, Table, TableDescription, Vector};
use crate::error::SceneError;

/// A part of a tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolPart {
    /// Its shape.
    pub shape: ToolShape,
    /// The position (m) of its centre in the tool's own frame; for a plane, of one of its points.
    pub at: [f64; 3],
    /// Its rotation vector (rad) in the tool's own frame.
    pub rotation: [f64; 3],
}

impl ToolPart {
    pub(super) fn is_blade(&self) -> bool {
        matches!(self.shape, ToolShape::Blade { .. })
    }
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
    /// The half-space below a plane whose normal is +z.
    Plane,
    /// A box along the axes.
    Box {
        /// Lengths (m) of its edges.
        size: [f64; 3],
    },
    /// The edge of a blade along z, which cuts and touches nothing.
    Blade {
        /// Its length (m).
        length: f64,
    },
}

pub(super) const SHAPE: TableDescription = TableDescription {
    name: "tool-shape",
    meaning: "A shape in the frame of a tool.",
    keys: &[&SPHERE, &CAPSULE, &PLANE, &BOX, &BLADE, &AT, &ROTATION],
    needs: Needs::OneOf(&[SPHERE.name, CAPSULE.name, PLANE.name, BOX.name, BLADE.name]),
    examples: &[
        "{ sphere = { radius = 0.006 } }",
        "{ capsule = { radius = 0.003, length = 0.02 }, at = [0.0, 0.0, 0.013], rotation = [0.1, 0.0, 0.0] }",
        "{ plane = {} }",
        "{ box = { size = [0.02, 0.02, 0.005] } }",
        "{ blade = { length = 0.02 } }",
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

const BLADE: Key<Inner> = Key::required(
    "blade",
    "The edge of a blade along z, the place in its middle. It touches nothing, and cuts where `[cutting]` names its tool.",
    Inner::one("a table such as { length = 0.02 }", &BLADES),
);

const AT: Key<Vector, Or<[f64; 3]>> =
    Key::or("at", "Its place in the tool's own frame.", PLACES, [0.0; 3]).unit("m");

/// Largest length and coordinate (m): the rounding of larger ones would be as large as tissue.
pub(crate) const FARTHEST: f64 = 1e6;

/// Positions of tools and of their parts.
pub(super) const PLACES: Vector = Vector {
    expected: "[x, y, z] in m, of at most 1e6",
    of: Number::between(
        "a coordinate of at most 1e6 m",
        Bound::Included(-FARTHEST),
        Bound::Included(FARTHEST),
    ),
    fits: |_| true,
};

/// A length of a tool.
const fn length(expected: &'static str) -> Number {
    Number::between(expected, Bound::Excluded(0.0), Bound::Included(FARTHEST))
}

const ROTATION: Key<Vector, Or<[f64; 3]>> = Key::or(
    "rotation",
    "Its rotation about that place in the tool's own frame: the axis times the angle.",
    ROTATIONS,
    [0.0; 3],
)
.unit("rad");

/// Rotation vectors of tools and of their parts.
pub(super) const ROTATIONS: Vector = Vector {
    expected: "[rx, ry, rz] in rad, an angle of at most 1e6",
    of: Number::finite("[rx, ry, rz] in rad, an angle of at most 1e6"),
    fits: |vector| Pose::knows(*vector),
};

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

const BLADES: TableDescription = TableDescription {
    name: "tool-blade",
    meaning: "The edge of a blade.",
    keys: &[&EDGE],
    needs: Needs::Any,
    examples: &["{ length = 0.02 }"],
};

const EDGE: Key<Number> = Key::required(
    "length",
    "The length of the edge.",
    Number::above_zero("a finite length above 0 m"),
)
.unit("m");

const RADIUS: Key<Number> = Key::required(
    "radius",
    "The radius.",
    length("a radius above 0 m, up to 1e6 m"),
)
.unit("m");

const LENGTH: Key<Number> = Key::required(
    "length",
    "The length between the middles of its ends.",
    length("a length above 0 m, up to 1e6 m"),
)
.unit("m");

const SIZE: Key<Vector> = Key::required(
    "size",
    "The lengths of its edges along x, y and z.",
    Vector {
        expected: "[x, y, z] in m, all above 0 and at most 1e6",
        of: length("a length above 0 m, up to 1e6 m"),
        fits: |_| true,
    },
)
.unit("m");

/// A part, and the place of the table with its sizes.
pub(super) fn read(table: &Table<'_>) -> Result<(ToolPart, Place), SceneError> {
    let (shape, place) = match table.exactly_one()? {
        key if key == SPHERE.name => {
            let sphere = table.table(&SPHERE)?;
            let radius = sphere.read(&RADIUS)?;
            (ToolShape::Sphere { radius }, sphere.into_place())
        }
        key if key == CAPSULE.name => {
            let capsule = table.table(&CAPSULE)?;
            let shape = ToolShape::Capsule {
                radius: capsule.read(&RADIUS)?,
                length: capsule.read(&LENGTH)?,
            };
            (shape, capsule.into_place())
        }
        key if key == PLANE.name => (ToolShape::Plane, table.table(&PLANE)?.into_place()),
        key if key == BLADE.name => {
            let blade = table.table(&BLADE)?;
            let length = blade.read(&EDGE)?;
            (ToolShape::Blade { length }, blade.into_place())
        }
        _ => {
            let cuboid = table.table(&BOX)?;
            let size = cuboid.read(&SIZE)?;
            (ToolShape::Box { size }, cuboid.into_place())
        }
    };
    let part = ToolPart {
        shape,
        at: table.read(&AT)?,
        rotation: table.read(&ROTATION)?,
    };
    Ok((part, place))
}

impl ToolShape {
    /// The key of the smallest size; `None` for a plane.
    pub(crate) fn thinnest(&self) -> Option<&'static str> {
        match self {
            Self::Sphere { .. } | Self::Capsule { .. } => Some(RADIUS.name),
            Self::Box { .. } => Some(SIZE.name),
            Self::Plane | Self::Blade { .. } => None,
        }
    }
}
