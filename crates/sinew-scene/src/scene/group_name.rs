//! Names of groups, with a dimension if several have one name.

use toml::de::DeValue;

use crate::decode::value::{Misfit, text};
use crate::decode::{
    Count, Key, Kind, Needs, Optional, Shape, Table, TableDescription, Text, Values,
};
use crate::error::SceneError;

/// The name of a group, alone or with a dimension.
#[derive(Debug, Clone, Copy)]
pub(super) struct GroupName {
    pub(super) expected: &'static str,
}

const ANY: Text = Text::any("the name of a group");

const NAME: Key<Text> = Key::required("name", "Name of the group.", ANY);

const DIM: Key<Count> = Key::required(
    "dim",
    "Dimension of its cells: 0 for nodes, 1 for lines, 2 for triangles, 3 for tetrahedra.",
    Count { least: 0, most: 3 },
);

const GROUP: TableDescription = TableDescription {
    name: "group",
    meaning: "A group of the mesh by its name and its dimension, where groups of several dimensions have one name.",
    keys: &[&NAME, &DIM],
    needs: Needs::Any,
    examples: &["{ name = \"bottom\", dim = 2 }"],
};

impl Kind for GroupName {
    fn expected(&self) -> String {
        self.expected.to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::Either(vec![ANY.shape(), Shape::Table(&GROUP)])
    }
}

/// The two forms of a group's name.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    Name(String),
    NameAndDimension,
}

impl Values for GroupName {
    type Read = Form;

    fn read(&self, value: &DeValue<'_>) -> Result<Form, Misfit> {
        match value {
            DeValue::Table(_) => Ok(Form::NameAndDimension),
            name => text(name).map(Form::Name),
        }
    }
}

impl GroupName {
    /// Reads the group that a table must name, in the form for [`sinew_mesh::TetMesh::group`]: with a dimension after a
    /// colon.
    pub(super) fn required(table: &Table<'_>, key: &Key<GroupName>) -> Result<String, SceneError> {
        named(table, key.name, table.read(key)?)
    }

    /// Reads the group that a table may name, in the same form.
    pub(super) fn optional(
        table: &Table<'_>,
        key: &Key<GroupName, Optional>,
    ) -> Result<Option<String>, SceneError> {
        let form = table.read(key)?;
        form.map(|form| named(table, key.name, form)).transpose()
    }
}

fn named(table: &Table<'_>, key: &'static str, form: Form) -> Result<String, SceneError> {
    let group = match form {
        Form::Name(name) => return Ok(name),
        Form::NameAndDimension => table.table_of(key, &GROUP)?,
    };
    let name = group.map(|group| {
        let (name, dim) = (group.read(&NAME)?, group.read(&DIM)?);
        Ok(format!("{name}:{dim}"))
    });
    Ok(name.transpose()?.unwrap_or_default())
}
