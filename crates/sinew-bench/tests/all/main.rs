//! The benches and the reproduction, as the commands call them.

#![cfg(test)]
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod hard_cases;
mod kernel_rows;
mod large_deformations;
mod one_list_of_integrators;
mod paper_rows;
mod reproduction;
mod synthetic_report;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
