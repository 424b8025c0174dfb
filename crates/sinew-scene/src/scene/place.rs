//! The conditions of `where`: positions in the body at rest, and data of its mesh.

use std::ops::Bound;

use sinew_mesh::Condition as On;
use toml::de::DeValue;

use super::place_data::{self, DATA};
use crate::decode::value::{Misfit, integer, list};
use crate::decode::{
    Condition, Inner, Key, Kind, List, Needs, Number, Optional, Shape, Table, TableDescription,
    Values, Vector,
};
use crate::error::{Fault, SceneError};

const MEANING: &str = "A place in the body at rest, or a part of it by data of its mesh. Where there are several keys, all of them must hold. A triangle or a \
                       tetrahedron is chosen if all its nodes are. `sinew plan` prints how many were found; to find none is an error.";

/// The conditions for nodes and triangles.
pub(super) const PLACE: TableDescription = TableDescription {
    name: "place",
    meaning: MEANING,
    keys: &[
        &BELOW, &ABOVE, &BOX, &SPHERE, &CYLINDER, &PLANE, &FACE, &NODES, &DATA,
    ],
    needs: Needs::Some,
    examples: &[
        "{ below = { z = 0.001 } }",
        "{ above = { x = 0.05, z = 0.199 } }",
        "{ box = [[0.0, 0.0, 0.19], [0.1, 0.1, 0.2]] }",
        "{ sphere = { center = [0.1, 0.1, 0.2], radius = 0.02 } }",
        "{ cylinder = { axis_from = [0.1, 0.1, 0.0], axis_to = [0.1, 0.1, 0.2], radius = 0.02 } }",
        "{ plane = { point = [0.0, 0.0, 0.2], normal = [0, 0, 1], within = 1e-6 } }",
        "{ above = { z = 0.1 }, face = { normal = [0, 0, 1], angle = 20 } }",
        "{ nodes = [4, 40, 65] }",
        "{ data = { name = \"labels\", equals = 2 } }",
    ],
};

/// The conditions for tetrahedra.
pub(super) const PLACE_OF_TETRAHEDRA: TableDescription = TableDescription {
    name: "place-of-tetrahedra",
    keys: &[
        &BELOW,
        &ABOVE,
        &BOX,
        &SPHERE,
        &CYLINDER,
        &PLANE,
        &FACE_OF_TETRAHEDRA,
        &NODES,
        &DATA,
    ],
    examples: &[
        "{ below = { z = 0.1 } }",
        "{ above = { z = 0.1 } }",
        "{ box = [[0.0, 0.0, 0.1], [0.2, 0.2, 0.2]] }",
        "{ sphere = { center = [0.1, 0.1, 0.1], radius = 0.05 } }",
        "{ cylinder = { axis_from = [0.1, 0.1, 0.0], axis_to = [0.1, 0.1, 0.2], radius = 0.06 } }",
        "{ plane = { point = [0.0, 0.0, 0.1], normal = [1, 0, 1], within = 0.05 } }",
        "{ nodes = [4, 40, 65, 71] }",
        "{ data = { name = \"labels\", equals = [2, 3] } }",
    ],
    ..PLACE
};

const BELOW: Key<Inner, Optional> = Key::optional(
    "below",
    "Coordinates that are at most these.",
    Inner::one("a table such as { z = 0.01 }", &BOUNDS),
    NO_CONDITION,
);

const ABOVE: Key<Inner, Optional> = Key::optional(
    "above",
    "Coordinates that are at least these.",
    Inner::one("a table such as { z = 0.01 }", &BOUNDS),
    NO_CONDITION,
);

const BOX: Key<Corners, Optional> = Key::optional(
    "box",
    "Nodes in a box between two corners, its faces among it.",
    Corners,
    NO_CONDITION,
)
.unit("m");

const SPHERE: Key<Inner, Optional> = Key::optional(
    "sphere",
    "Nodes in a sphere.",
    Inner::one(
        "a table such as { center = [0, 0, 0], radius = 0.01 }",
        &SPHERES,
    ),
    NO_CONDITION,
);

const CYLINDER: Key<Inner, Optional> = Key::optional(
    "cylinder",
    "Nodes in a straight cylinder with flat ends.",
    Inner::one(
        "a table such as { axis_from = [0, 0, 0], axis_to = [0, 0, 0.1], radius = 0.01 }",
        &CYLINDERS,
    ),
    NO_CONDITION,
);

const PLANE: Key<Inner, Optional> = Key::optional(
    "plane",
    "Nodes close to a plane.",
    Inner::one(
        "a table such as { point = [0, 0, 0], normal = [0, 0, 1], within = 1e-6 }",
        &PLANES,
    ),
    NO_CONDITION,
);

const FACE: Key<Inner, Optional> = Key::optional(
    "face",
    "Triangles of the boundary that look in a direction, or their nodes.",
    Inner::one("a table such as { normal = [0, 0, 1], angle = 20 }", &FACES),
    NO_CONDITION,
);

const FACE_OF_TETRAHEDRA: Key<Inner, Optional> = FACE.only(&[Condition::never(
    "chooses triangles of the boundary, and a region is made of tetrahedra",
)]);

const NODES: Key<List<Tag>, Optional> = Key::optional(
    "nodes",
    "Nodes by their tags in the mesh file.",
    List {
        expected: "a list of tags of nodes of the mesh file",
        of: Tag,
        least: 1,
    },
    NO_CONDITION,
);

const NO_CONDITION: &str = "no such condition";

const BOUNDS: TableDescription = TableDescription {
    name: "bounds",
    meaning: "Bounds of coordinates of the body at rest, for one axis or several.",
    keys: &[&X, &Y, &Z],
    needs: Needs::Some,
    examples: &["{ z = 0.001 }", "{ x = 0.05, y = 0.1 }"],
};

const X: Key<Number, Optional> = coordinate("x", "Bound along x.");
const Y: Key<Number, Optional> = coordinate("y", "Bound along y.");
const Z: Key<Number, Optional> = coordinate("z", "Bound along z.");

const fn coordinate(name: &'static str, meaning: &'static str) -> Key<Number, Optional> {
    let values = Number::finite("a finite coordinate in m");
    Key::optional(name, meaning, values, "no bound along this axis").unit("m")
}

const SPHERES: TableDescription = TableDescription {
    name: "sphere",
    meaning: "A sphere.",
    keys: &[&CENTER, &RADIUS],
    needs: Needs::Any,
    examples: &["{ center = [0.1, 0.1, 0.2], radius = 0.02 }"],
};

const CENTER: Key<Vector> = Key::required(
    "center",
    "The centre.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m");

const RADIUS: Key<Number> = Key::required(
    "radius",
    "The radius.",
    Number::above_zero("a finite radius above 0 m"),
)
.unit("m");

const CYLINDERS: TableDescription = TableDescription {
    name: "cylinder",
    meaning: "A straight cylinder, which ends at both ends of its axis.",
    keys: &[&AXIS_FROM, &AXIS_TO, &RADIUS],
    needs: Needs::Any,
    examples: &["{ axis_from = [0.1, 0.1, 0.0], axis_to = [0.1, 0.1, 0.2], radius = 0.02 }"],
};

const AXIS_FROM: Key<Vector> = Key::required(
    "axis_from",
    "One end of the axis, in the middle of an end face.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m");

const AXIS_TO: Key<Vector> = Key::required(
    "axis_to",
    "The other end of the axis.",
    Vector::finite(ANOTHER_END),
)
.unit("m");

const ANOTHER_END: &str = "[x, y, z] in m, all finite, at another place than `axis_from`";

const PLANES: TableDescription = TableDescription {
    name: "plane",
    meaning: "A plane and the distance within which nodes belong to it.",
    keys: &[&POINT, &NORMAL, &WITHIN],
    needs: Needs::Any,
    examples: &["{ point = [0.0, 0.0, 0.2], normal = [0, 0, 1], within = 1e-6 }"],
};

const POINT: Key<Vector> = Key::required(
    "point",
    "A point of the plane.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m");

const NORMAL: Key<Vector> = Key::required(
    "normal",
    "The direction at right angles to the plane or the face, of any length.",
    Vector {
        expected: "[x, y, z], all finite and not all 0",
        fits: has_length,
        ..Vector::finite("a finite number")
    },
);

const WITHIN: Key<Number> = Key::required(
    "within",
    "The largest distance from the plane.",
    Number::zero_or_above("a finite distance, 0 m or above"),
)
.unit("m");

const FACES: TableDescription = TableDescription {
    name: "face",
    meaning: "A direction and the angle up to which triangles of the boundary may look away from it.",
    keys: &[&NORMAL, &ANGLE],
    needs: Needs::Any,
    examples: &["{ normal = [0, 0, 1], angle = 20 }"],
};

const ANGLE: Key<Number> = Key::required(
    "angle",
    "The largest angle between the direction and the outward normal of a triangle.",
    Number::between(
        "an angle from 0 to 180 degrees",
        Bound::Included(0.0),
        Bound::Included(180.0),
    ),
)
.unit("degrees");

/// The conditions of a place.
pub(super) fn conditions(place: &Table<'_>) -> Result<Vec<On>, SceneError> {
    place.check_conditions()?;
    let mut conditions = Vec::new();
    if let Some(bounds) = bounds(place, &BELOW, f64::INFINITY)? {
        conditions.push(On::below(bounds));
    }
    if let Some(bounds) = bounds(place, &ABOVE, f64::NEG_INFINITY)? {
        conditions.push(On::above(bounds));
    }
    if let Some([low, high]) = place.read(&BOX)? {
        conditions.push(On::Box { low, high });
    }
    if let Some(sphere) = place.table(&SPHERE)? {
        conditions.push(On::Sphere {
            center: sphere.read(&CENTER)?,
            radius: sphere.read(&RADIUS)?,
        });
    }
    if let Some(cylinder) = place.table(&CYLINDER)? {
        let axis = [cylinder.read(&AXIS_FROM)?, cylinder.read(&AXIS_TO)?];
        let [from, to] = axis;
        if !has_length(&[0, 1, 2].map(|i| to[i] - from[i])) {
            return Err(cylinder.value_misfit(AXIS_TO.name, ANOTHER_END));
        }
        conditions.push(On::Cylinder {
            axis,
            radius: cylinder.read(&RADIUS)?,
        });
    }
    if let Some(plane) = place.table(&PLANE)? {
        conditions.push(On::Plane {
            point: plane.read(&POINT)?,
            normal: plane.read(&NORMAL)?,
            within: plane.read(&WITHIN)?,
        });
    }
    if let Some(face) = place.table(&FACE)? {
        conditions.push(On::Facing {
            normal: face.read(&NORMAL)?,
            angle: face.read(&ANGLE)?,
        });
    }
    if let Some(tags) = place.read(&NODES)? {
        conditions.push(On::Tags(tags));
    }
    if let Some(data) = place.table(&DATA)? {
        conditions.push(place_data::condition(&data)?);
    }
    Ok(conditions)
}

/// The bounds of `below` or `above`; `none` along axes that are not named.
fn bounds(
    place: &Table<'_>,
    key: &Key<Inner, Optional>,
    none: f64,
) -> Result<Option<[f64; 3]>, SceneError> {
    let Some(table) = place.table(key)? else {
        return Ok(None);
    };
    let given = [table.read(&X)?, table.read(&Y)?, table.read(&Z)?];
    if given == [None; 3] {
        let fault = Fault::Value {
            key: key.name.to_owned(),
            found: "{}".to_owned(),
            expected: "a coordinate along x, y or z such as { z = 0.01 }".to_owned(),
        };
        return Err(place.place().value_fault(key.name, fault));
    }
    Ok(Some(given.map(|bound| bound.unwrap_or(none))))
}

/// True if a vector has a direction: its components are not so small or large that its length is 0 or infinite.
fn has_length(vector: &[f64; 3]) -> bool {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    length > 0.0 && length.is_finite()
}

/// Two corners of a box.
#[derive(Debug, Clone, Copy)]
struct Corners;

const CORNER: Vector = Vector::finite("[x, y, z] in m, all finite");

impl Kind for Corners {
    fn expected(&self) -> String {
        "two corners [[x, y, z], [x, y, z]] in m, the lower one first".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::List {
            of: Box::new(CORNER.shape()),
            least: 2,
            most: Some(2),
        }
    }
}

impl Values for Corners {
    type Read = [[f64; 3]; 2];

    fn read(&self, value: &DeValue<'_>) -> Result<[[f64; 3]; 2], Misfit> {
        let corners = list(value, |corner| CORNER.read(corner))?;
        let corners = <[[f64; 3]; 2]>::try_from(corners).map_err(|_| Misfit::Value)?;
        let [low, high] = corners;
        match (0..3).all(|axis| low[axis] <= high[axis]) {
            true => Ok(corners),
            false => Err(Misfit::Value),
        }
    }
}

/// The tag of a node.
#[derive(Debug, Clone, Copy)]
struct Tag;

impl Kind for Tag {
    fn expected(&self) -> String {
        "a whole number, 0 or above".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::Whole(0, None)
    }
}

impl Values for Tag {
    type Read = u64;

    fn read(&self, value: &DeValue<'_>) -> Result<u64, Misfit> {
        u64::try_from(integer(value)?).map_err(|_| Misfit::Value)
    }
}
