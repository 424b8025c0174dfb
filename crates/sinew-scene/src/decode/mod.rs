//! From TOML to values: which keys a table has, what each must hold, and where it stands.

mod place;
mod table;
pub(crate) mod value;

pub(crate) use place::Place;
pub(crate) use table::Table;
