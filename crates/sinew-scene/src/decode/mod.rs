//! Values from TOML: the description of each table and key, and the reader based on it.

mod condition;
mod description;
mod key;
mod place;
mod presence;
mod table;
pub(crate) mod value;
mod values;

pub(crate) use condition::{Condition, Goes};
pub(crate) use description::{
    Described, KeyDescription, Needs, Parts, Shape, Stated, TableDescription,
};
pub(crate) use key::Key;
pub(crate) use place::Place;
pub(crate) use presence::{Optional, Or, Usual};
pub(crate) use table::Table;
pub(crate) use values::{
    Count, Flag, Inner, Kind, List, Number, Pairs, Text, Values, Vector, Words, Written,
};
