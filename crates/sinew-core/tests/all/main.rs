//! Runs of the core.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod host_needs;
mod running;
