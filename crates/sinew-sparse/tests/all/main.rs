//! Orders of elimination, and the kernels of fast machines.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod ordering;
mod sweeps;
