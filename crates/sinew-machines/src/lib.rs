//! Machines that run the programs of cellular networks as fast as the hardware allows.
//!
//! A program ([`sinew_cnn::Program`]) says what every cell does in a step; the reference machine of
//! `sinew-cnn` says what that means. The machines here do the same to rounding: [`FastMachine`] takes
//! the cells in an order of its own, as structures of arrays, makes each sweep in one pass and uses
//! the best instructions there are, in `f64` or `f32`, with the rows of any matrix or, where they repeat
//! on a lattice, with a few templates that are stored once. [`Chosen`] takes what fits a system.

mod chosen;
mod compiled;
mod crew;
mod fast;
mod forces;
mod layout;
mod touched;
mod unfit;

pub use chosen::{Chosen, Kind, PrecisionName, Settings, Threads};
pub use fast::FastMachine;
pub use layout::Layout;
pub use unfit::Unfit;
