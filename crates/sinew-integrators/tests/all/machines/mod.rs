//! Machines and programs.

mod added;
mod bodies;
mod precision;
mod programs;
mod programs_of_methods;
