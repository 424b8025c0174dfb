//! Contents of the folder of a run.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod balance_of_energy;
mod common;
mod comparisons;
mod cuts;
mod overlaps;
mod reference_page;
mod replays;
mod resumed_runs;
mod tables_and_fields;
mod tools;
