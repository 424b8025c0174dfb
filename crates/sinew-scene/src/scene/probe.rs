//! `[[probe]]`: points whose motion is recorded.

use super::region::taken;
use super::selected::{self, Members, NOT_WHERE, Selections, Where};
use crate::decode::{Key, Needs, Optional, Place, Table, TableDescription, Text, Vector};
use crate::error::SceneError;

/// A node whose motion is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbePoint {
    /// Its name, which also begins the names of its columns.
    pub name: String,
    /// The node.
    pub at: ProbeAt,
}

/// The node of a probe.
#[derive(Debug, Clone, PartialEq)]
pub enum ProbeAt {
    /// The node nearest to a position in the undeformed body (m).
    Point([f64; 3]),
    /// The only node of a group.
    Group(String),
}

pub(super) const PROBE: TableDescription = TableDescription {
    name: "probe",
    meaning: "A node of the body whose motion is written down.",
    keys: &[&NAME, &POINT, &WHERE],
    needs: Needs::Any,
    examples: &[
        "[[probe]]\nname = \"top-centre\"\npoint = [0.1, 0.1, 0.2]\n",
        "[[probe]]\nname = \"node-42\"\nwhere = { nodes = [42] }\n",
    ],
};

const NAME: Key<Text> = Key::required(
    "name",
    "A name of its own, with which its columns in tables begin.",
    Text {
        expected: "a name made of letters, digits, `-`, `_` and `.`",
        pattern: Some("^[^ -,/:-@\\[-^`{-~]+$"),
        except: None,
        fits: is_plain,
    },
);

const POINT: Key<Vector> = Key::required(
    "point",
    "A place in the body at rest; the node nearest to it is followed.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m")
.only(&[NOT_WHERE]);

const WHERE: Key<Where, Optional> = selected::WHERE.otherwise("see `point`");

pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    selections: &mut Selections,
) -> Result<(Vec<ProbePoint>, Vec<Place>), SceneError> {
    let mut probes: Vec<ProbePoint> = Vec::new();
    for table in &tables {
        let probe = read(table, selections)?;
        let same = probes.iter().position(|other| other.name == probe.name);
        if let Some(first) = same {
            let owner = tables[first].place();
            return Err(taken(table.place(), NAME.name, &probe.name, owner));
        }
        probes.push(probe);
    }
    Ok((probes, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<ProbePoint, SceneError> {
    let name = table.read(&NAME)?;
    table.check_conditions()?;
    let at = match selections.place(table, &WHERE, Members::Nodes)? {
        Some(group) => ProbeAt::Group(group),
        None => ProbeAt::Point(table.read(&POINT)?),
    };
    Ok(ProbePoint { name, at })
}

/// Whether a name needs no quotes in a CSV file.
fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    name.chars().all(plain)
}
