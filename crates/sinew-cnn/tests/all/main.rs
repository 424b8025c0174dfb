//! Templates, programs, majorants and the conformance suite of machines.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod majorant;
mod program;
mod saturation;
mod templates;
