//! `[cutting]`: blades and removing tools.

use std::ops::Bound;
use std::path::PathBuf;

use super::tool::{
    BODY, FRICTION, GRASP, SHAPES, STARTS_INSIDE, StartsInside, TOUCHES, Tool, ToolPlace,
};
use crate::decode::{
    Condition, Inner, Key, Needs, Number, Optional, Or, Table, TableDescription, Text, Words,
};
use crate::error::{Fault, SceneError};

/// Cutting of the body: the table `[cutting]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Cutting {
    /// Share of its shortest edge within which a node is moved onto the cut.
    pub snap: f64,
    /// Work (J/m^2) of the blade per area of new surface.
    pub toughness: f64,
    /// The blade.
    pub blade: Blade,
    /// The tool (0-based) that removes the tetrahedra inside it.
    pub remove: Option<usize>,
    /// Treatment of parts that a cut disconnects from all supports.
    pub pieces: LoosePieces,
    /// Interaction of the two faces of a cut.
    pub lips: Lips,
}

/// The blade that cuts a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Blade {
    /// No blade: the body is cut by commands only.
    None,
    /// Both ends of a blade over time in a CSV file: its path as written, relative to the scene's folder.
    Table(PathBuf),
    /// A tool (0-based) with the shape of a blade.
    Tool(usize),
}

/// Treatment of unsupported components.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoosePieces {
    /// Unsupported components continue to move.
    Fall,
    /// Unsupported components rest at the position at which they were cut off, without contact; another cut may pass
    /// through them.
    Freeze,
    /// Unsupported components are removed with their mass.
    Remove,
}

/// Interaction of the two faces of a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lips {
    /// Contact: while they face each other, they do not pass through each other.
    Contact,
    /// No interaction.
    Free,
}

impl Cutting {
    /// True if a tool (0-based) cuts or removes, so that it touches nothing.
    #[must_use]
    pub fn is_by(&self, tool: usize) -> bool {
        self.blade == Blade::Tool(tool) || self.remove == Some(tool)
    }
}

pub(super) const CUTTING: TableDescription = TableDescription {
    name: "cutting",
    meaning: "Cuts along the faces of tetrahedra: no tetrahedron is born, so that mass stays, and so does the energy of tetrahedra that average no strain, \
              but for what moved nodes (`snap`) change. Of linear ones the stable step stays as well: it is bounded by single tetrahedra in scenes with this table. \
              Areas, nodes, mass and energy of all cuts are in `summary.json`. Without a blade the body is cut by commands of a session only.",
    keys: &[&SNAP, &TOUGHNESS, &TABLE, &TOOL, &REMOVE, &PIECES, &LIPS],
    needs: Needs::Any,
    examples: &[
        "[cutting]\nsnap = 0.25\ntable = \"strokes.csv\"\n",
        "[cutting]\ntool = \"scalpel\"\ntoughness = 150.0\npieces = \"remove\"\nlips = \"free\"\n\n[[tool]]\nname = \"scalpel\"\n\
         shape = { blade = { length = 0.02 } }\nrotation = [1.5707963267948966, 0.0, 0.0]  # along y\nstart = [0.05, 0.0, 0.12]\nvelocity = [0.0, 0.0, -0.05]\n",
        "[cutting]\nremove = { tool = \"burner\" }\n\n[[tool]]\nname = \"burner\"\nshape = { sphere = { radius = 0.01 } }\n\
         start = [0.05, 0.05, 0.1]\nhold = true\n",
    ],
};

const SNAP: Key<Number, Or<f64>> = Key::or(
    "snap",
    "Share of its shortest edge within which a node at the blade is moved onto the cut, at rest; 0 moves none. Cuts are smoother with 0.25, \
     and what that changes of the mass is reported.",
    Number::between(
        "a share from 0 to 0.5",
        Bound::Included(0.0),
        Bound::Included(0.5),
    ),
    0.0,
);

const TOUGHNESS: Key<Number, Or<f64>> = Key::or(
    "toughness",
    "Energy that new surface takes: the work of the blade, told in `summary.json`. The tissue gives none of it.",
    Number::zero_or_above("a finite energy, 0 J/m2 or above"),
    0.0,
)
.unit("J/m2");

pub(super) const TABLE: Key<Text, Optional> = Key::optional(
    "table",
    "CSV file with the columns `stroke`, `t_s`, `ax_m`, `ay_m`, `az_m`, `bx_m`, `by_m`, `bz_m`: places of both ends of the blade over time, \
     with straight lines between the rows of a stroke; with another number of a stroke the blade was lifted. What comes before \
     t = 0 cuts the body that the motion starts with. Its path is relative to the scene's folder.",
    Text::any("the path of a CSV file, seen from the scene"),
    "no blade by a table",
)
.only(&[Condition::without(
    "tool",
    "does not go with `tool`, which is a blade as well",
)]);

const TOOL: Key<Text, Optional> = Key::optional(
    "tool",
    "The name of a `[[tool]]` with `shape = { blade = { length = 0.02 } }`: it cuts wherever it goes, and where it rests the tissue that comes through it.",
    Text::any("the name of a tool with the shape of a blade"),
    "no tool cuts",
);

const REMOVE: Key<Inner, Optional> = Key::optional(
    "remove",
    "Takes away, with their mass, the tetrahedra whose middle is inside a tool: what burns or sucks.",
    Inner::one("a table such as { tool = \"burner\" }", &REMOVALS),
    "nothing is taken away",
);

const PIECES: Key<Words<LoosePieces>, Or<LoosePieces>> = Key::or(
    "pieces",
    "What becomes of pieces that no support, motion or grasp holds: they move on, rest where they came off, or are taken away with their mass.",
    Words(&[
        ("fall", LoosePieces::Fall),
        ("freeze", LoosePieces::Freeze),
        ("remove", LoosePieces::Remove),
    ]),
    LoosePieces::Fall,
);

const LIPS: Key<Words<Lips>, Or<Lips>> = Key::or(
    "lips",
    "What the lips of a cut do to each other: while they face each other, no node goes beyond the one that the cut parted it from, along the normal of the cut; or nothing. \
     With methods that tools cannot push, nothing.",
    Words(&[("contact", Lips::Contact), ("free", Lips::Free)]),
    Lips::Contact,
);

const REMOVALS: TableDescription = TableDescription {
    name: "remove",
    meaning: "What takes tetrahedra away.",
    keys: &[&REMOVER],
    needs: Needs::Any,
    examples: &["{ tool = \"burner\" }"],
};

const REMOVER: Key<Text> = Key::required(
    "tool",
    "The name of the `[[tool]]`, which touches nothing else.",
    Text::any("the name of a tool"),
);

pub(super) fn read(table: &Table<'_>, tools: &[Tool]) -> Result<Cutting, SceneError> {
    table.check_conditions()?;
    let blade = match (table.read(&TABLE)?, table.read(&TOOL)?) {
        (Some(path), _) => Blade::Table(path.into()),
        (None, Some(name)) => Blade::Tool(named(table, TOOL.name, &name, tools, true)?),
        (None, None) => Blade::None,
    };
    let remove = match table.table(&REMOVE)? {
        None => None,
        Some(remove) => {
            let name = remove.read(&REMOVER)?;
            Some(named(&remove, REMOVER.name, &name, tools, false)?)
        }
    };
    Ok(Cutting {
        snap: table.read(&SNAP)?,
        toughness: table.read(&TOUGHNESS)?,
        blade,
        remove,
        pieces: table.read(&PIECES)?,
        lips: table.read(&LIPS)?,
    })
}

/// The index of the tool with a name, which must be a blade, or must not be one.
fn named(
    table: &Table<'_>,
    key: &'static str,
    name: &str,
    tools: &[Tool],
    is_blade: bool,
) -> Result<usize, SceneError> {
    let fits = |tool: &&Tool| tool.is_blade() == is_blade && !tool.is_scissors();
    let place = tools.iter().position(|tool| tool.name == name);
    let found = place.filter(|place| fits(&&tools[*place]));
    found.ok_or_else(|| {
        let known = tools.iter().filter(fits);
        let known: Vec<String> = known.map(|tool| format!("\"{}\"", tool.name)).collect();
        let kind = match is_blade {
            true => "a [[tool]] with shape = { blade = { length = .. } }",
            false => "a [[tool]] that is no blade",
        };
        let known = match known.is_empty() {
            true => "there is none".to_owned(),
            false => known.join(", "),
        };
        let fault = Fault::Value {
            key: key.to_owned(),
            found: format!("\"{name}\""),
            expected: format!("the name of {kind}: {known}"),
        };
        table.place().value_fault(key, fault)
    })
}

/// Refuses blades of several parts, and keys that a tool that cuts or removes does not have.
pub(super) fn check_tools(
    tools: &[Tool],
    cutting: Option<&Cutting>,
    places: &[ToolPlace],
) -> Result<(), SceneError> {
    for (index, (tool, ToolPlace { table: place, .. })) in tools.iter().zip(places).enumerate() {
        let is_by = cutting.is_some_and(|cutting| cutting.is_by(index)) || tool.is_scissors();
        let misplaced = |key: &'static str, reason: &str| {
            let reason = reason.to_owned();
            Err(place.key_fault(key, Fault::Misplaced { key, reason }))
        };
        let several = tool.is_blade() && tool.parts.len() > 1;
        if several && !tool.is_scissors() {
            return misplaced(
                SHAPES.name,
                "has a blade, which goes alone, or with one other blade as scissors",
            );
        }
        if !is_by {
            continue;
        }
        let reason = "does not go with a tool that cuts, which touches nothing";
        for (key, is_given) in [
            (FRICTION.name, tool.friction > 0.0),
            (TOUCHES.name, tool.touches.is_some()),
            (STARTS_INSIDE.name, tool.starts_inside == StartsInside::Push),
            (GRASP.name, tool.grasp.is_some()),
            (BODY.name, tool.body.is_some()),
        ] {
            if is_given {
                return misplaced(key, reason);
            }
        }
    }
    Ok(())
}
