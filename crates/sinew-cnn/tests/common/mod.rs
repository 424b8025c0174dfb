//! What the tests of the network share.

#![allow(dead_code, reason = "each test file uses some of these")]

pub(crate) mod body;
pub(crate) mod dense;
