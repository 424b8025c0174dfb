//! The chores of the repository, as a developer meets them.

#![cfg(test)]

mod bad_input;
mod bench_output;
