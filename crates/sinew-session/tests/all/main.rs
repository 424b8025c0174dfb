//! Sessions: driven, logged, replayed.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
mod driving;
mod logs;
mod replays;
