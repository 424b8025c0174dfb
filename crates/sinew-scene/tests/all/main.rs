//! Scenes: read, checked, planned and built.

#![cfg(test)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod all_scenes;
mod bad_scenes;
mod common;
mod data_of_meshes;
mod good_scenes;
mod labelled_meshes;
mod load_warnings;
mod meshes_of_files;
mod motions;
mod overlaps;
mod places;
mod plans;
mod probes;
#[cfg(feature = "implicit")]
mod proposals;
mod ramps;
#[cfg(feature = "implicit")]
mod ready_scenes;
mod simulations;
mod tissues;
mod tools;
mod warnings;
