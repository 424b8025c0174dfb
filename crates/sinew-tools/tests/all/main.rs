//! Tools: shapes, poses and contact.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod allocation;
mod bodies;
mod common;
mod energy_sweeps;
mod first_contact;
mod free_motion;
mod lips;
mod nearest;
mod poses;
mod pressing;
mod steered;
mod strokes;
mod thin;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
