//! Elements that the library does not have, as references for those that it has.

pub(crate) mod tet10;
