//! The live page, with requests like those of a browser.

#![cfg(test)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may end so")]

mod common;
mod connections;
mod cube;
mod cuts;
mod files;
mod loads;
mod new_tools;
mod past;
mod pauses;
mod pulls;
mod start;
