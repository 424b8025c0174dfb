//! `[[probe]]`: recorded quantities of points and parts.

use super::group_name::GroupName;
use super::region::taken;
use super::selected::{self, Members, NOT_WHERE, Selections, Where};
use crate::decode::{
    Condition, Count, Key, Needs, Optional, Or, Place, Table, TableDescription, Text, Vector, Words,
};
use crate::error::SceneError;

/// A place at which a quantity is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbePoint {
    /// Its name, which also begins the names of its columns.
    pub name: String,
    /// The place.
    pub at: ProbeAt,
    /// Quantity that is recorded there.
    pub quantity: Quantity,
}

/// The place of a probe.
#[derive(Debug, Clone, PartialEq)]
pub enum ProbeAt {
    /// The node nearest to a position in the undeformed body (m); for stress the tetrahedron that contains it.
    Point([f64; 3]),
    /// The mean over a group: by area over triangles, by volume over tetrahedra, with equal weights over nodes.
    Mean(String),
}

/// Quantity that a probe records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Displacement (m).
    Displacement,
    /// Velocity (m/s).
    Velocity,
    /// Stress (Pa), and its von Mises stress.
    Stress,
}

pub(super) const PROBE: TableDescription = TableDescription {
    name: "probe",
    meaning: "A node or a part of the body of which the motion or the stress is written down: of a part, the mean over it, alike over the \
              nodes that `where` chooses.",
    keys: &[&NAME, &POINT, &TO, &COUNT, &WHERE, &GROUP, &QUANTITY],
    needs: Needs::Any,
    examples: &[
        "[[probe]]\nname = \"top-centre\"\npoint = [0.1, 0.1, 0.2]\n",
        "[[probe]]\nname = \"node-42\"\nwhere = { nodes = [42] }\n",
        "[[probe]]\nname = \"rim\"\nwhere = { above = { z = 0.199 } }\n",
        "[[probe]]\nname = \"axis\"\npoint = [0.1, 0.1, 0.0]\nto = [0.1, 0.1, 0.2]\ncount = 5\n",
        "[[probe]]\nname = \"top\"\ngroup = \"top\"\nquantity = \"velocity\"\n",
        "[[probe]]\nname = \"inside\"\npoint = [0.1, 0.1, 0.1]\nquantity = \"stress\"\n",
    ],
};

const NAME: Key<Text> = Key::required(
    "name",
    "A unique name; its columns in tables begin with it.",
    Text {
        expected: "a name made of letters, digits, `-`, `_` and `.`",
        pattern: Some("^[^ -,/:-@\\[-^`{-~]+$"),
        except: None,
        fits: is_plain,
    },
);

const POINT: Key<Vector> = Key::required(
    "point",
    "A place in the body at rest; the node nearest to it is followed, or for stress the tetrahedron that holds it.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m")
.only(&[NOT_WHERE, NOT_GROUP]);

const NOT_GROUP: Condition = Condition::without(
    "group",
    "does not go with `group`, over which the mean is taken",
);

const TO: Key<Vector, Optional> = Key::optional(
    "to",
    "End of a line of probes that begins at `point`; their names end in -1, -2 and so on.",
    Vector::finite("[x, y, z] in m, all finite"),
    "one probe at `point`",
)
.unit("m")
.only(&[
    Condition::with("point", "needs `point`, the beginning of the line"),
    Condition::with("count", "needs `count`, the number of probes on the line"),
]);

const COUNT: Key<Count, Optional> = Key::optional(
    "count",
    "Number of probes on the line from `point` to `to`, both ends included where there are several.",
    Count { least: 1, most: 1000 },
    "one probe at `point`",
)
.only(&[Condition::with("to", "needs `to`, the end of the line")]);

const GROUP: Key<GroupName, Optional> = Key::optional(
    "group",
    "Name of a group of the mesh over which the mean is taken: by area over triangles, by volume over tetrahedra, alike over nodes.",
    GroupName {
        expected: "the name of a group, or { name = \"liver\", dim = 2 } where several have it",
    },
    "see `point`",
)
.only(&[NOT_WHERE]);

const QUANTITY: Key<Words<Quantity>, Or<Quantity>> = Key::or(
    "quantity",
    "What is written down. The stress is that of the law, what relaxes of it included, with von Mises' of the same (mean) stress beside it.",
    Words(&[
        ("displacement", Quantity::Displacement),
        ("velocity", Quantity::Velocity),
        ("stress", Quantity::Stress),
    ]),
    Quantity::Displacement,
);

const WHERE: Key<Where, Optional> = selected::WHERE.otherwise("see `point`");

pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    selections: &mut Selections,
) -> Result<(Vec<ProbePoint>, Vec<Place>), SceneError> {
    let (mut probes, mut places): (Vec<ProbePoint>, Vec<Place>) = Default::default();
    for table in tables {
        for probe in read(&table, selections)? {
            let same = probes.iter().position(|other| other.name == probe.name);
            if let Some(first) = same {
                return Err(taken(table.place(), NAME.name, &probe.name, &places[first]));
            }
            probes.push(probe);
            places.push(table.place().clone());
        }
    }
    Ok((probes, places))
}

/// The probes of a table: one, or those on a line.
fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Vec<ProbePoint>, SceneError> {
    let (name, quantity) = (table.read(&NAME)?, table.read(&QUANTITY)?);
    table.check_conditions()?;
    let one = |at| {
        let name = name.clone();
        Ok(vec![ProbePoint { name, at, quantity }])
    };
    if let Some(group) = selections.place(table, &WHERE, Members::Nodes)? {
        return one(ProbeAt::Mean(group));
    }
    if let Some(group) = GroupName::optional(table, &GROUP)? {
        return one(ProbeAt::Mean(group));
    }
    let from = table.read(&POINT)?;
    let (Some(to), Some(count)) = (table.read(&TO)?, table.read(&COUNT)?) else {
        return one(ProbeAt::Point(from));
    };
    let probe = |number: usize| {
        let share = number as f64 / (count - 1).max(1) as f64;
        let point = |axis: usize| (1.0 - share) * from[axis] + share * to[axis];
        ProbePoint {
            name: format!("{name}-{}", number + 1),
            at: ProbeAt::Point([0, 1, 2].map(point)),
            quantity,
        }
    };
    Ok((0..count).map(probe).collect())
}

/// True if a name needs no quotes in a CSV file.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    name.chars().all(plain)
}
