//! Values from TOML: the keys of a table, what each must hold, and its place in the text.

mod place;
mod table;
pub(crate) mod value;

pub(crate) use place::Place;
pub(crate) use table::Table;
