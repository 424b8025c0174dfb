//! Fast machines: layouts, threads, precision.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod elements;
mod lattice;
mod single_precision;
mod threads;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
