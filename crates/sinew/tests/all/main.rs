//! The library and the command.

#![cfg(test)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

#[cfg(feature = "cli")]
mod command;
#[cfg(feature = "cli")]
mod common;
mod library;
