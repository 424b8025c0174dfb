//! References, measured runs and advice.

#![cfg(test)]
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod advice;
mod advice_on_large_deformation;
mod affordable_reference;
mod extrapolated_reference;
mod forecasts;
mod foreign_integrator;
mod guard;
mod overlaps;
mod peers_cube;
mod ready_scenes;
mod reference_peaks;
mod touched_reference;
