//! `[[fixed]]`: supports.

use sinew_fem::{Fixed, On};
use toml::de::DeValue;

use super::selected::{Members, Selections};
use crate::decode::value::{Misfit, text};
use crate::decode::{Place, Table};
use crate::error::SceneError;

pub(super) fn read_all(
    document: &Table<'_>,
    selections: &mut Selections,
) -> Result<(Vec<Fixed>, Vec<Place>), SceneError> {
    let tables = document.tables("fixed", &["group", "where", "axes"])?;
    let fixed = tables.iter().map(|table| read(table, selections));
    let fixed = fixed.collect::<Result<_, _>>()?;
    Ok((fixed, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Fixed, SceneError> {
    Ok(Fixed {
        on: On::Group(selections.required(table, Members::Nodes)?),
        axes: axes_of(table)?,
    })
}

/// The axes that a table names; all where it names none.
pub(super) fn axes_of(table: &Table<'_>) -> Result<[bool; 3], SceneError> {
    let expected = "some of the letters x, y and z, each once";
    let named = table.optional("axes", expected, axes)?;
    Ok(named.unwrap_or([true; 3]))
}

fn axes(value: &DeValue<'_>) -> Result<[bool; 3], Misfit> {
    let mut held = [false; 3];
    for letter in text(value)?.chars() {
        let axis = ['x', 'y', 'z'].iter().position(|&axis| axis == letter);
        let axis = axis.ok_or(Misfit::Value)?;
        if std::mem::replace(&mut held[axis], true) {
            return Err(Misfit::Value);
        }
    }
    Ok(held)
}
