//! Force feedback: local stiffness and passivity.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod local_stiffness;
mod passivity;
