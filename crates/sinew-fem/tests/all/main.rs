//! Models of bodies: elements, laws, supports, loads, cuts.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod cut_allocation;
mod cuts;
mod cuts_in_place;
mod elements;
mod large;
mod memory;
mod model;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
