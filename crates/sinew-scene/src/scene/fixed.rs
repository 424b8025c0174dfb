//! `[[fixed]]`: supports.

use sinew_fem::{Fixed, On};
use toml::de::DeValue;

use super::selected::{GROUP, Members, Selections, WHERE};
use crate::decode::value::{Misfit, text};
use crate::decode::{Key, Kind, Needs, Or, Place, Shape, Table, TableDescription, Values, Written};
use crate::error::SceneError;

pub(super) const FIXED: TableDescription = TableDescription {
    name: "fixed",
    meaning: "A part of the body that is fixed, in all directions or in some of them.",
    keys: &[&GROUP, &WHERE, &AXES],
    needs: Needs::Any,
    examples: &[
        "[[fixed]]\ngroup = \"bottom\"\naxes = \"z\"\n",
        "[[fixed]]\ngroup = { name = \"bottom\", dim = 2 }\n",
        "[[fixed]]\nwhere = { below = { z = 0.001 } }\n",
    ],
};

/// The directions of a support or a motion.
pub(super) const AXES: Key<Axes, Or<[bool; 3]>> = Key::or(
    "axes",
    "Directions that are fixed or moved; the body is free to move in the others.",
    Axes,
    [true; 3],
);

pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    selections: &mut Selections,
) -> Result<(Vec<Fixed>, Vec<Place>), SceneError> {
    let fixed = tables.iter().map(|table| read(table, selections));
    let fixed = fixed.collect::<Result<_, _>>()?;
    Ok((fixed, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Fixed, SceneError> {
    table.check_conditions()?;
    Ok(Fixed {
        on: On::Group(selections.one_of(table, (&GROUP, &WHERE), Members::Nodes)?),
        axes: table.read(&AXES)?,
    })
}

/// Letters of axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes;

const LETTERS: [char; 3] = ['x', 'y', 'z'];

impl Kind for Axes {
    fn expected(&self) -> String {
        "some of the letters x, y and z, each once".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::Text {
            pattern: Some("^(x|y|z|xy|xz|yx|yz|zx|zy|xyz|xzy|yxz|yzx|zxy|zyx)$"),
            except: None,
        }
    }
}

impl Values for Axes {
    type Read = [bool; 3];

    fn read(&self, value: &DeValue<'_>) -> Result<[bool; 3], Misfit> {
        let mut named = [false; 3];
        for letter in text(value)?.chars() {
            let axis = LETTERS.iter().position(|&axis| axis == letter);
            let axis = axis.ok_or(Misfit::Value)?;
            if std::mem::replace(&mut named[axis], true) {
                return Err(Misfit::Value);
            }
        }
        Ok(named)
    }
}

impl Written for Axes {
    fn written(&self, axes: &[bool; 3]) -> String {
        let named = LETTERS.iter().zip(axes).filter(|(_, is_named)| **is_named);
        format!(
            "\"{}\"",
            named.map(|(letter, _)| letter).collect::<String>()
        )
    }
}
