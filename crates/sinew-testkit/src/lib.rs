//! What the tests of several crates share: bodies at random, matrices written out in full, and scenes. Only
//! tests depend on it.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

pub mod body;
pub mod dense;
pub mod scenes;
