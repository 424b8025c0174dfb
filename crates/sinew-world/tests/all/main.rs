//! Worlds: advanced, cut, driven, logged, replayed.

#![cfg(test)]
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking"
)]

mod common;
mod cuts;
mod driving;
mod hands;
mod lips;
mod logs;
mod moving_cuts;
mod recorders;
mod replays;
mod report;
mod saved;
