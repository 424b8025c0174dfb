//! Meshes: files of gmsh, groups, checks, generators.

#![cfg(test)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod boundary;
mod check;
mod common;
mod files;
mod formats;
mod groups;
mod joints;
mod linearise;
mod meshes;
mod msh;
mod refine;
mod selection;
mod selection_by_data;
mod simulation_mesh;
mod structured;

#[global_allocator]
static ALLOCATOR: sinew_core::CountingAllocator = sinew_core::CountingAllocator;
