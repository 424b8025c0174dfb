//! Machines and programs.

mod bodies;
mod precision;
mod programs;
mod programs_of_methods;
