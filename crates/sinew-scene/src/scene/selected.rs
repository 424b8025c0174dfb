//! `group` and `where`: the part of the body that a table concerns.

use sinew_mesh::Selection;
use toml::de::DeValue;

use super::group_name::GroupName;
use super::place::{PLACE, PLACE_OF_TETRAHEDRA, conditions};
use crate::decode::value::Misfit;
use crate::decode::{
    Condition, Key, Kind, Optional, Place, Shape, Table, TableDescription, Values,
};
use crate::error::SceneError;

/// A part of the body that a scene chooses by position. It becomes a group of the mesh when the scene is built.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// The name of the group.
    pub name: String,
    /// The kind of its members.
    pub members: Members,
    /// The choice.
    pub choice: Choice,
}

/// The kind of members of a selected part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Members {
    /// Nodes: for supports, motions, forces, initial states and probes.
    Nodes,
    /// Triangles of the boundary: for tractions and pressures.
    Triangles,
    /// Tetrahedra: for regions.
    Tetrahedra,
}

/// The choice of a part.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// Conditions on its nodes.
    Where(Selection),
    /// The tetrahedra that no other region has.
    Rest,
}

/// The selected parts of a scene, and the table of each.
#[derive(Debug, Default)]
pub(super) struct Selections {
    pub(super) parts: Vec<Selected>,
    pub(super) places: Vec<Place>,
}

const EXPECTED_GROUP: GroupName = GroupName {
    expected: "the name of a group, { name = \"liver\", dim = 2 } where several have it, or where = { .. } in its place",
};

/// Condition that `group` and `where` are not both given.
pub(super) const NOT_WHERE: Condition =
    Condition::without("where", "cannot be used with `where`; give one of the two");

/// The group of a table that is about a part of the body.
pub(super) const GROUP: Key<GroupName> = Key::required(
    "group",
    "Name of a group of the mesh. A cube or a block has `tissue`, `sides`, `top` and `bottom`.",
    EXPECTED_GROUP,
)
.only(&[NOT_WHERE]);

/// The group of a table that may also be about the whole body.
pub(super) const OPTIONAL_GROUP: Key<GroupName, Optional> = Key::optional(
    "group",
    "Name of a group of the mesh. A cube or a block has `tissue`, `sides`, `top` and `bottom`.",
    EXPECTED_GROUP,
    "the whole body",
);

/// A place that represents a group of nodes or of triangles.
pub(super) const WHERE: Key<Where, Optional> = Key::optional(
    "where",
    "The part of the body by where it lies or by data of the mesh, in place of a group.",
    Where {
        expected: "conditions such as { below = { z = 0.01 } }",
        place: &PLACE,
        takes_rest: false,
    },
    "see `group`",
);

/// A place that represents a group of tetrahedra.
pub(super) const WHERE_OF_TETRAHEDRA: Key<Where, Optional> = Key::optional(
    "where",
    "The part of the body by where it lies or by data of the mesh, in place of a group; `\"rest\"` is all that no other region has.",
    Where {
        expected: "conditions such as { below = { z = 0.01 } }, or \"rest\"",
        place: &PLACE_OF_TETRAHEDRA,
        takes_rest: true,
    },
    "see `group`",
);

/// A place, or the rest of the body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Where {
    expected: &'static str,
    place: &'static TableDescription,
    takes_rest: bool,
}

const REST: &str = "rest";

/// The two forms of `where`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    Conditions,
    Rest,
}

impl Kind for Where {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        let place = Shape::Table(self.place);
        match self.takes_rest {
            true => Shape::Either(vec![place, Shape::Words(vec![REST])]),
            false => place,
        }
    }
}

impl Values for Where {
    type Read = Form;

    fn read(&self, value: &DeValue<'_>) -> Result<Form, Misfit> {
        match value {
            DeValue::String(word) if self.takes_rest && word.as_ref() == REST => Ok(Form::Rest),
            DeValue::String(_) if self.takes_rest => Err(Misfit::Value),
            DeValue::Table(entries) if entries.is_empty() => Err(Misfit::Value),
            DeValue::Table(_) => Ok(Form::Conditions),
            _ => Err(Misfit::Type),
        }
    }
}

impl Selections {
    /// The group that a table names or selects, which must be one of both.
    pub(super) fn one_of(
        &mut self,
        table: &Table<'_>,
        (group, place): (&Key<GroupName>, &Key<Where, Optional>),
        members: Members,
    ) -> Result<String, SceneError> {
        match self.place(table, place, members)? {
            Some(name) => Ok(name),
            None => GroupName::required(table, group),
        }
    }

    /// The group that a table names or selects, if it does either.
    pub(super) fn at_most_one_of(
        &mut self,
        table: &Table<'_>,
        (group, place): (&Key<GroupName, Optional>, &Key<Where, Optional>),
        members: Members,
    ) -> Result<Option<String>, SceneError> {
        match self.place(table, place, members)? {
            Some(name) => Ok(Some(name)),
            None => GroupName::optional(table, group),
        }
    }

    /// The group that a table selects by position, if it does.
    pub(super) fn place(
        &mut self,
        table: &Table<'_>,
        key: &Key<Where, Optional>,
        members: Members,
    ) -> Result<Option<String>, SceneError> {
        let choice = match table.read(key)? {
            None => return Ok(None),
            Some(Form::Rest) => Choice::Rest,
            Some(Form::Conditions) => {
                let place = table.table_of(key.name, key.values.place)?;
                let conditions = place.as_ref().map(conditions).transpose()?;
                Choice::Where(Selection::new(conditions.unwrap_or_default()))
            }
        };
        let name = match (&choice, members) {
            (Choice::Rest, _) => REST.to_owned(),
            (Choice::Where(selection), Members::Nodes) => format!("nodes {selection}"),
            (Choice::Where(selection), Members::Triangles) => format!("triangles {selection}"),
            (Choice::Where(selection), Members::Tetrahedra) => format!("tetrahedra {selection}"),
        };
        self.parts.push(Selected {
            name: name.clone(),
            members,
            choice,
        });
        self.places.push(table.place().clone());
        Ok(Some(name))
    }
}
