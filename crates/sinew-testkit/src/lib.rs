//! What the tests of several crates share: bodies at random, and matrices written out in full. Only
//! tests depend on it.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

pub mod body;
pub mod dense;
