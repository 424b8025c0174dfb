//! Bodies and helpers that the tests share.

pub(crate) mod bodies;
