//! Settings of machines.

use std::num::NonZero;
use std::sync::OnceLock;

use sinew_sparse::simd::InstructionSet;

/// A kind of machine by its id, one of [`crate::known_machines`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind(pub(crate) &'static str);

impl Kind {
    /// The fastest kind that supports the system.
    pub const AUTO: Self = Self("auto");
    /// Plain loops: the reference meaning of a program.
    pub const REFERENCE: Self = Self("reference");
    /// Kernels for any matrix.
    pub const GENERAL: Self = Self("general");
    /// Kernels for rows that repeat on a lattice.
    pub const REPEATED: Self = Self("repeated");

    /// The name that users type.
    #[must_use]
    pub const fn id(self) -> &'static str {
        self.0
    }
}

impl Default for Kind {
    fn default() -> Self {
        Self::AUTO
    }
}

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
    /// The name that users type.
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
    /// Its instructions; `None` for the best available.
    pub instructions: Option<InstructionSet>,
    /// The largest number of threads.
    pub threads: Threads,
}

/// Numbers of threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread alone.
    #[default]
    One,
    /// This number at most, and no more than the processors available to this process.
    UpTo(NonZero<u32>),
    /// All processors that the system gives to this process.
    All,
}

impl Threads {
    /// Their largest number on this machine.
    #[must_use]
    pub fn most(self) -> usize {
        // It is asked for once: the system reads several files for it.
        static ALL: OnceLock<usize> = OnceLock::new();
        let all =
            || *ALL.get_or_init(|| std::thread::available_parallelism().map_or(1, NonZero::get));
        match self {
            Self::One => 1,
            Self::UpTo(most) => all().min(most.get() as usize),
            Self::All => all(),
        }
    }
}
