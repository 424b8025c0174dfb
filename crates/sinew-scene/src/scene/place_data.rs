//! The condition `data` of `where`: values of the mesh's data.

use sinew_mesh::{Condition as On, DataValues};
use toml::de::DeValue;

use crate::decode::value::{Misfit, finite, list};
use crate::decode::{
    Inner, Key, Kind, Needs, Number, Optional, Shape, Table, TableDescription, Text, Values,
};
use crate::error::SceneError;

pub(super) const DATA: Key<Inner, Optional> = Key::optional(
    "data",
    "Nodes, triangles or tetrahedra by the values of data of the mesh file. Nodes are asked for data at nodes; where only tetrahedra have data \
     of the name, the nodes of those with such a value are chosen. Tetrahedra, and triangles of the boundary by the tetrahedron that they \
     bound, are asked for data of tetrahedra; where only nodes have such data, all nodes must have such a value.",
    Inner::one("a table such as { name = \"labels\", equals = 2 }", &CHOSEN),
    "no such condition",
);

const CHOSEN: TableDescription = TableDescription {
    name: "chosen-data",
    meaning: "Values of data of the mesh file, such as labels from an image. `sinew mesh info` lists the data and their ranges.",
    keys: &[&NAME, &EQUALS, &BETWEEN],
    needs: Needs::OneOf(&[EQUALS.name, BETWEEN.name]),
    examples: &[
        "{ name = \"labels\", equals = 2 }",
        "{ name = \"labels\", equals = [2, 3] }",
        "{ name = \"density\", between = [1000.0, 1100.0] }",
    ],
};

const NAME: Key<Text> = Key::required(
    "name",
    "The name of the data: an array of a .vtu or .vtk file, a view of gmsh, `medit:ref` for the references of a .mesh file.",
    Text::any("the name of data in the mesh file"),
);

const EQUALS: Key<Labels> =
    Key::required("equals", "The value, or one of several, exactly.", Labels);

const BETWEEN: Key<Range> = Key::required(
    "between",
    "The least and the greatest value, both among them.",
    Range,
);

/// The condition of a table `data`.
pub(super) fn condition(table: &Table<'_>) -> Result<On, SceneError> {
    let values = match table.exactly_one()? {
        key if key == EQUALS.name => DataValues::Equal(table.read(&EQUALS)?),
        _ => DataValues::Between(table.read(&BETWEEN)?),
    };
    let name = table.read(&NAME)?;
    Ok(On::Data { name, values })
}

/// A number or a list of numbers.
#[derive(Debug, Clone, Copy)]
struct Labels;

impl Kind for Labels {
    fn expected(&self) -> String {
        "a number such as 2, or a list such as [2, 3]".to_owned()
    }

    fn shape(&self) -> Shape {
        let number = Number::finite("a finite number").shape();
        let list = Shape::List {
            of: Box::new(number.clone()),
            least: 1,
            most: None,
        };
        Shape::Either(vec![number, list])
    }
}

impl Values for Labels {
    type Read = Vec<f64>;

    fn read(&self, value: &DeValue<'_>) -> Result<Vec<f64>, Misfit> {
        let numbers = match value {
            DeValue::Array(_) => list(value, finite)?,
            _ => vec![finite(value)?],
        };
        match numbers.is_empty() {
            true => Err(Misfit::Value),
            false => Ok(numbers),
        }
    }
}

/// Two numbers, the lower one first.
#[derive(Debug, Clone, Copy)]
struct Range;

impl Kind for Range {
    fn expected(&self) -> String {
        "two numbers such as [1.5, 3.0], the lower one first".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::List {
            of: Box::new(Number::finite("a finite number").shape()),
            least: 2,
            most: Some(2),
        }
    }
}

impl Values for Range {
    type Read = [f64; 2];

    fn read(&self, value: &DeValue<'_>) -> Result<[f64; 2], Misfit> {
        let numbers = list(value, finite)?;
        match <[f64; 2]>::try_from(numbers) {
            Ok([low, high]) if low <= high => Ok([low, high]),
            _ => Err(Misfit::Value),
        }
    }
}
