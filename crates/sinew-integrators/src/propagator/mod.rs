//! `propagator`: the exact motion over a step, as a polynomial in the network.

mod chebyshev;
mod mode;
mod series;

pub use chebyshev::Propagator;
