//! Settings of machines.

use std::num::NonZero;

use sinew_core::System;
use sinew_sparse::simd::InstructionSet;

use crate::Unfit;
use crate::known::Kind;

/// Precisions that a machine may compute in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PrecisionName {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits.
    F32,
}

impl PrecisionName {
    /// The name users type.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }
}

/// Kind, precision, instructions and threads of a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Its kind.
    pub kind: Kind,
    /// The precision that it computes in.
    pub precision: PrecisionName,
    /// Its instructions; `None` for the best there are.
    pub instructions: Option<InstructionSet>,
    /// The largest number of threads.
    pub threads: Threads,
}

impl Settings {
    /// Checks that what they ask for can be had on a system.
    ///
    /// # Errors
    /// [`Unfit`] where it cannot.
    pub fn check(&self, system: &dyn System) -> Result<(), Unfit> {
        let known = self.kind.known();
        (known.check)(self, system)?;
        if known.precisions.contains(&self.precision) {
            return Ok(());
        }
        Err(Unfit::Precision {
            machine: known.id,
            precision: self.precision.id(),
        })
    }
}

/// Numbers of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread alone.
    #[default]
    One,
    /// At most so many, and no more than the system gives processors to this process.
    UpTo(NonZero<u32>),
    /// All processors that the system gives to this process.
    All,
}

impl Threads {
    /// Their largest number on this machine.
    #[must_use]
    pub fn most(self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, NonZero::get);
        match self {
            Self::One => 1,
            Self::UpTo(most) => all().min(most.get() as usize),
            Self::All => all(),
        }
    }
}
