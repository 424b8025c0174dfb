//! Shared code of the tests of several crates: random bodies, matrices in dense form, and scenes. Only tests depend on
//! it.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

pub mod body;
pub mod dense;
pub mod scenes;
