//! The methods: against closed forms, published figures, other methods and their own promises.

#![cfg(test)]
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod changes;
mod cnn;
mod common;
mod cuts;
mod explicit;
mod guard;
#[cfg(feature = "implicit")]
mod implicit;
mod large;
mod machines;
#[cfg(feature = "implicit")]
mod modal;
mod no_allocation;
mod propagator;
mod switching;
mod textbook;
mod what_methods_say;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
