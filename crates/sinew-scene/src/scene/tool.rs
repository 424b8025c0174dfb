//! `[[tool]]`: rigid tools that press on the body.

use std::ops::Bound;
use std::path::PathBuf;

pub use sinew_tools::{Grasp, ToolBody};

use super::group_name::GroupName;
use super::region::taken;
use super::tool_body::{self, BODIES};
use super::tool_shape::{self, PLACES, ROTATIONS, SHAPE, ToolPart};
use crate::decode::value::Misfit;
use crate::decode::{
    Condition, Flag, Inner, Key, Kind, Needs, Number, Optional, Or, Place, Shape, Table,
    TableDescription, Text, Values, Vector, Words,
};
use crate::error::{Fault, SceneError};

/// A rigid tool that presses on the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// Its name, with which its columns in tables begin.
    pub name: String,
    /// The shapes that form it.
    pub parts: Vec<ToolPart>,
    /// Its motion.
    pub path: ToolPath,
    /// Coefficient of Coulomb's friction.
    pub friction: f64,
    /// The group whose nodes it can touch; `None` for the surface of the body.
    pub touches: Option<String>,
    /// Treatment of a tool that begins inside the body.
    pub starts_inside: StartsInside,
    /// The time in which it grasps the tissue that it touches.
    pub grasp: Option<Grasp>,
    /// The rigid body that a coupling pulls along the path; `None` for a tool that follows its path exactly.
    pub body: Option<ToolBody>,
}

/// The motion of a tool.
#[derive(Debug, Clone, PartialEq)]
pub enum ToolPath {
    /// The tool stays at a pose.
    Hold(ToolStart),
    /// The tool moves from a pose at this velocity (m/s), without rotation.
    Velocity(ToolStart, [f64; 3]),
    /// Poses over time in a CSV file: its path as written, relative to the scene's folder.
    Table(PathBuf),
}

/// The pose of a tool at t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolStart {
    /// The position (m) of its own origin.
    pub position: [f64; 3],
    /// Its rotation vector (rad).
    pub rotation: [f64; 3],
}

/// Treatment of a tool that begins inside the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartsInside {
    /// The scene is refused.
    Refuse,
    /// The first step pushes the tissue out.
    Push,
}

impl Tool {
    /// True if its shape is a blade, which cuts and touches nothing.
    #[must_use]
    pub fn is_blade(&self) -> bool {
        self.parts.iter().any(ToolPart::is_blade)
    }

    /// True if its shapes are two blades, which touch nothing and cut what is between them by a command.
    #[must_use]
    pub fn is_scissors(&self) -> bool {
        self.parts.len() == 2 && self.parts.iter().all(ToolPart::is_blade)
    }
}

pub(super) const TOOL: TableDescription = TableDescription {
    name: "tool",
    meaning: "A rigid tool that presses on the body: no node that it can touch gets into it. It meets nodes of the surface that move by themselves; those that are held, and those of which `[[move]]` moves a component, it does not. \
              The forces that hold it back are in `tools.csv`.",
    keys: &[
        &NAME,
        &SHAPE_OF_TOOL,
        &SHAPES,
        &START,
        &ROTATION,
        &TABLE,
        &VELOCITY,
        &HOLD,
        &FRICTION,
        &TOUCHES,
        &STARTS_INSIDE,
        &GRASP,
        &BODY,
    ],
    needs: Needs::OneOf(&[TABLE.name, VELOCITY.name, HOLD.name]),
    examples: &[
        "[[tool]]\nname = \"probe\"\nshape = { sphere = { radius = 0.006 } }\nstart = [0.05, 0.05, 0.12]\nvelocity = [0.0, 0.0, -0.01]\n\
         friction = 0.2\n",
        "[[tool]]\nname = \"plate\"\nshape = { plane = {} }\nstart = [0.1, 0.1, 0.21]\nrotation = [3.141592653589793, 0.0, 0.0]\n\
         hold = true\ntouches = \"top\"\nstarts_inside = \"push\"\n",
        "[[tool]]\nname = \"grasper\"\nshapes = [{ capsule = { radius = 0.003, length = 0.02 }, at = [0.0, 0.01, 0.0] }, \
         { capsule = { radius = 0.003, length = 0.02 }, at = [0.0, -0.01, 0.0] }]\ntable = \"grasper.csv\"\ngrasp = { from = 0.4, to = 1.2 }\n",
        "[[tool]]\nname = \"handle\"\nshape = { sphere = { radius = 0.006 } }\nstart = [0.05, 0.05, 0.12]\nvelocity = [0.0, 0.0, -0.01]\n\
         body = { mass = 0.05, inertia = [2e-6, 2e-6, 2e-6], coupling = 400.0, rotational_coupling = 0.5, damping = 0.8 }\n",
    ],
};

const NAME: Key<Text> = Key::required(
    "name",
    "A unique name; its columns in tables begin with it.",
    Text {
        expected: "a name made of letters, digits, `-` and `_`",
        pattern: Some("^[^ -,./:-@\\[-^`{-~]+$"),
        except: None,
        fits: is_plain,
    },
);

pub(super) const SHAPE_OF_TOOL: Key<Inner> = Key::required(
    "shape",
    "The shape of the tool.",
    Inner::one("a table such as { sphere = { radius = 0.006 } }", &SHAPE),
)
.only(&[Condition::without(
    "shapes",
    "cannot be used with `shapes`; give one of the two",
)]);

pub(super) const SHAPES: Key<Inner, Optional> = Key::optional(
    "shapes",
    "The shapes of a tool that is made of several. Two blades are scissors: in a scene with `[cutting]` they cut what is between them by a command of a session.",
    Inner::several(
        "a list of tables such as [{ sphere = { radius = 0.006 } }]",
        &SHAPE,
    ),
    "see `shape`",
);

const START: Key<Vector> = Key::required(
    "start",
    "The place of the tool's own origin at t = 0.",
    PLACES,
)
.unit("m")
.only(&[NOT_TABLE]);

const ROTATION: Key<Vector, Or<[f64; 3]>> = Key::or(
    "rotation",
    "Rotation about the tool's own origin at t = 0: the axis times the angle.",
    ROTATIONS,
    [0.0; 3],
)
.unit("rad")
.only(&[NOT_TABLE]);

const NOT_TABLE: Condition = Condition::without(
    "table",
    "cannot be used with `table`: the table has the positions and rotations; remove it",
);

pub(super) const TABLE: Key<Text> = Key::required(
    "table",
    "CSV file with the columns `t_s`, `x_m`, `y_m`, `z_m` and, for a tool that turns, `rx_rad`, `ry_rad`, `rz_rad`: places of the tool's own \
     origin and rotation vectors over time, with straight lines between the rows; the first row holds before, the last one after. \
     Its path is relative to the scene's folder.",
    Text::any("the path of a CSV file, seen from the scene"),
);

const VELOCITY: Key<Vector> = Key::required(
    "velocity",
    "Velocity from t = 0 on; the tool does not turn.",
    Vector {
        expected: "[x, y, z] in m/s, of at most 1e6",
        of: Number::between(
            "a velocity of at most 1e6 m/s",
            Bound::Included(-FASTEST),
            Bound::Included(FASTEST),
        ),
        fits: |_| true,
    },
)
.unit("m/s");

/// Largest component of a velocity (m/s).
const FASTEST: f64 = 1e6;

const HOLD: Key<True> = Key::required("hold", "The tool stays where it is.", True);

pub(super) const FRICTION: Key<Number, Or<f64>> = Key::or(
    "friction",
    "Coefficient of Coulomb's friction between tool and tissue.",
    Number::between(
        "a coefficient from 0 to 1e6",
        Bound::Included(0.0),
        Bound::Included(1e6),
    ),
    0.0,
);

pub(super) const TOUCHES: Key<GroupName, Optional> = Key::optional(
    "touches",
    "What it can touch: the nodes of the body's surface, or those of a group of the mesh.",
    GroupName {
        expected: "\"surface\", the name of a group, or { name = \"liver\", dim = 2 } where several have it",
    },
    "\"surface\"",
);

/// The word for all nodes of the body's surface.
const SURFACE: &str = "surface";

pub(super) const STARTS_INSIDE: Key<Words<StartsInside>, Or<StartsInside>> = Key::or(
    "starts_inside",
    "What happens where nodes are inside the tool at t = 0: the scene is refused, or the first step pushes them out.",
    Words(&[
        ("refuse", StartsInside::Refuse),
        ("push", StartsInside::Push),
    ]),
    StartsInside::Refuse,
);

pub(super) const GRASP: Key<Inner, Optional> = Key::optional(
    "grasp",
    "The time for which the tool holds what it touches: a node that it pushes within this time goes with it until the end.",
    Inner::one("a table such as { from = 0.4, to = 1.2 }", &GRASPS),
    "it grasps nothing",
);

pub(super) const BODY: Key<Inner, Optional> = Key::optional(
    "body",
    "Makes the tool a rigid body that a spring and a damper draw to its path, as a hand does: it gives way where tissue pushes back. No gravity pulls on it.",
    Inner::one(
        "a table such as { mass = 0.05, inertia = [2e-6, 2e-6, 2e-6], coupling = 400.0, rotational_coupling = 0.5 }",
        &BODIES,
    ),
    "the tool is where its path says, whatever it takes",
);

const GRASPS: TableDescription = TableDescription {
    name: "grasp",
    meaning: "The time for which a tool holds what it touches.",
    keys: &[&FROM, &TO],
    needs: Needs::Any,
    examples: &["{ from = 0.4, to = 1.2 }"],
};

const FROM: Key<Number> = Key::required(
    "from",
    "The time at which the tool begins to grasp.",
    Number::zero_or_above("a finite time, 0 s or above"),
)
.unit("s");

const TO: Key<Number> = Key::required(
    "to",
    "The time, later than `from`, at which it lets go.",
    Number::above_zero("a finite time above 0 s"),
)
.unit("s");

/// The value `true`; if the key is absent, another value applies.
#[derive(Debug, Clone, Copy)]
struct True;

impl Kind for True {
    fn expected(&self) -> String {
        "true".to_owned()
    }

    fn shape(&self) -> Shape {
        Flag.shape()
    }
}

impl Values for True {
    type Read = ();

    fn read(&self, value: &toml::de::DeValue<'_>) -> Result<(), Misfit> {
        match Flag.read(value)? {
            true => Ok(()),
            false => Err(Misfit::Value),
        }
    }
}

/// The place of a tool's table, and of those with the sizes of its parts.
#[derive(Debug, Clone)]
pub(crate) struct ToolPlace {
    pub(crate) table: Place,
    pub(crate) sizes: Vec<Place>,
}

pub(super) fn read_all(tables: Vec<Table<'_>>) -> Result<(Vec<Tool>, Vec<ToolPlace>), SceneError> {
    let (mut tools, mut places): (Vec<Tool>, Vec<ToolPlace>) = Default::default();
    for table in tables {
        let (tool, sizes) = read(&table)?;
        if let Some(first) = tools.iter().position(|other| other.name == tool.name) {
            let first = &places[first].table;
            return Err(taken(table.place(), NAME.name, &tool.name, first));
        }
        tools.push(tool);
        places.push(ToolPlace {
            table: table.into_place(),
            sizes,
        });
    }
    Ok((tools, places))
}

fn read(table: &Table<'_>) -> Result<(Tool, Vec<Place>), SceneError> {
    let path = table.exactly_one()?;
    table.check_conditions()?;
    let path = match path {
        key if key == TABLE.name => ToolPath::Table(table.read(&TABLE)?.into()),
        key if key == VELOCITY.name => ToolPath::Velocity(start(table)?, table.read(&VELOCITY)?),
        _ => {
            table.read(&HOLD)?;
            ToolPath::Hold(start(table)?)
        }
    };
    let name = table.read(&NAME)?;
    let (parts, sizes) = parts(table)?.into_iter().unzip();
    let tool = Tool {
        name,
        parts,
        path,
        friction: table.read(&FRICTION)?,
        touches: GroupName::optional(table, &TOUCHES)?.filter(|name| name != SURFACE),
        starts_inside: table.read(&STARTS_INSIDE)?,
        grasp: table.table(&GRASP)?.as_ref().map(grasp).transpose()?,
        body: table
            .table(&BODY)?
            .as_ref()
            .map(tool_body::read)
            .transpose()?,
    };
    Ok((tool, sizes))
}

fn start(table: &Table<'_>) -> Result<ToolStart, SceneError> {
    Ok(ToolStart {
        position: table.read(&START)?,
        rotation: table.read(&ROTATION)?,
    })
}

fn parts(table: &Table<'_>) -> Result<Vec<(ToolPart, Place)>, SceneError> {
    if !table.has(SHAPES.name) {
        let shape = table.table(&SHAPE_OF_TOOL)?;
        return Ok(vec![tool_shape::read(&shape)?]);
    }
    let shapes = table.tables(&SHAPES)?;
    if shapes.is_empty() {
        let fault = Fault::Value {
            key: SHAPES.name.to_owned(),
            found: "[]".to_owned(),
            expected: SHAPES.values.expected(),
        };
        return Err(table.place().value_fault(SHAPES.name, fault));
    }
    shapes.iter().map(tool_shape::read).collect()
}

fn grasp(table: &Table<'_>) -> Result<Grasp, SceneError> {
    let (from, to) = (table.read(&FROM)?, table.read(&TO)?);
    if to <= from {
        let fault = Fault::Value {
            key: TO.name.to_owned(),
            found: format!("{to:?}"),
            expected: format!("a time after `from`, {from:?} s"),
        };
        return Err(table.place().value_fault(TO.name, fault));
    }
    Ok(Grasp { from, to })
}

/// True if a name is suitable as the start of CSV column names and as part of a key.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    name.chars().all(plain)
}
