//! The chores of the repository, as a developer uses them.

#![cfg(test)]

mod bad_input;
mod bench_output;
