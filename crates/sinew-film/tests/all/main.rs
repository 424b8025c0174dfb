//! Pictures and films.

#![cfg(test)]

mod common;
mod field_colours;
mod films;
mod run_folders;
mod silhouettes;
