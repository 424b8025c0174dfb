//! Vectors of numbers that one instruction works on, for each instruction set.
//!
//! Kernels are written once over a trait of vectors and compiled once for each [`InstructionSet`]; one is chosen when
//! the program runs, so that a portable build uses the instructions of the machine. All code that accesses a kernel's
//! memory by address is here and in [`crate::sweep`].

mod aligned;
mod at;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lanes;
mod number;
mod portable;
mod real;
mod set;
mod shared;
mod vector;

pub use aligned::Aligned;
pub(crate) use at::At;
pub(crate) use lanes::Lanes;
pub use number::Number;
pub(crate) use portable::Array;
pub use real::Real;
pub use set::InstructionSet;
pub use shared::{Shared, SharedSlice};
pub use vector::{Vectors, WithNumber, WithReal};

#[cfg(target_arch = "x86_64")]
pub(crate) use {avx2::Avx2, avx512::Avx512};
