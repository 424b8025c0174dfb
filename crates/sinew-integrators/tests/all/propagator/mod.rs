//! The propagator.

mod growth;
mod load_fit;
mod reference;
mod two_step;
