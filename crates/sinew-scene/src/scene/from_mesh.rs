//! Values that the mesh's data may give for each tetrahedron.

use toml::de::DeValue;

use crate::decode::value::Misfit;
use crate::decode::{Key, Kind, Needs, Shape, Table, TableDescription, Text, Values};
use crate::error::SceneError;

/// A value for all tetrahedra of a region, or the name of data with one for each.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Given<T> {
    Everywhere(T),
    Data(String),
}

impl<T> Given<T> {
    /// The value, or `otherwise` with the name of the data.
    pub(super) fn or(self, otherwise: T) -> (T, Option<String>) {
        match self {
            Self::Everywhere(value) => (value, None),
            Self::Data(name) => (otherwise, Some(name)),
        }
    }
}

/// Values of a kind, or the table [`DATA`] instead.
#[derive(Debug, Clone, Copy)]
pub(super) struct OrData<V>(pub(super) V);

const DATA: TableDescription = TableDescription {
    name: "data",
    meaning: "Data of the mesh file that give each tetrahedron a value of its own: an `$ElementData` section of a gmsh file, or cell data of a .vtu or .vtk file, by their name. \
              Every tetrahedron of the region needs one. The tetrahedra of a finer mesh have that of the one they are a part of.",
    keys: &[&NAME],
    needs: Needs::Any,
    examples: &["{ data = \"density\" }"],
};

const NAME: Key<Text> = Key::required(
    "data",
    "The name of the data; of a section of a gmsh file it is the first string tag, in gmsh the name of the view. Data with several time steps are \
     refused.",
    Text::any("the name of data in the mesh file"),
);

impl<V: Kind> Kind for OrData<V> {
    fn expected(&self) -> String {
        format!("{}, or {{ data = \"name\" }}", self.0.expected())
    }

    fn shape(&self) -> Shape {
        Shape::Either(vec![self.0.shape(), Shape::Table(&DATA)])
    }
}

impl<V: Values> Values for OrData<V> {
    /// `None` for a table.
    type Read = Option<V::Read>;

    fn read(&self, value: &DeValue<'_>) -> Result<Option<V::Read>, Misfit> {
        match value {
            DeValue::Table(_) => Ok(None),
            _ => self.0.read(value).map(Some),
        }
    }
}

/// The names of the data in a list of tables.
pub(super) fn names(table: &Table<'_>, key: &'static str) -> Result<Vec<String>, SceneError> {
    let tables = table.tables_of(key, &DATA)?;
    tables.iter().map(|data| data.read(&NAME)).collect()
}

/// The value of a key, or the name of the data given instead.
pub(super) fn read<V: Values>(
    table: &Table<'_>,
    key: &Key<OrData<V>>,
) -> Result<Given<V::Read>, SceneError> {
    if let Some(value) = table.read(key)? {
        return Ok(Given::Everywhere(value));
    }
    match table.table_of(key.name, &DATA)? {
        Some(data) => data.read(&NAME).map(Given::Data),
        None => Err(table.missing(key.name, key.values.expected())),
    }
}
