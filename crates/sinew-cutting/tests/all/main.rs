//! Cuts through meshes: strokes, slits, planes, and their allocations.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod allocation;
mod common;
mod kept_nodes;
mod moving;
mod planes;
mod random_strokes;
mod slits;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
