//! The memory that a factor may take.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::implicit::factor_error::FactorError;

const NOT_SET: u64 = u64::MAX;

/// Bytes that a user set for this process.
static SET: AtomicU64 = AtomicU64::new(NOT_SET);

thread_local! {
    /// Limit of [`Memory::within`] for this thread.
    static HERE: Cell<Option<Memory>> = const { Cell::new(None) };
}

/// The most memory that a factor may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory(Option<u64>);

impl Memory {
    /// A limit of `bytes` bytes.
    #[must_use]
    pub fn of(bytes: u64) -> Self {
        Self(Some(bytes))
    }

    /// Limit of [`Memory::within`], else the one set by [`Memory::set_left`]; unlimited if none was set.
    #[must_use]
    pub fn left() -> Self {
        if let Some(here) = HERE.get() {
            return here;
        }
        let set = SET.load(Ordering::Relaxed);
        Self((set != NOT_SET).then_some(set))
    }

    /// Sets the value of [`Memory::left`] in this process from now on; `None` removes the limit. For programs that know
    /// the memory that is available.
    pub fn set_left(memory: Option<Self>) {
        let bytes = memory.and_then(|memory| memory.0);
        SET.store(bytes.unwrap_or(NOT_SET), Ordering::Relaxed);
    }

    /// Runs `act` under a limit for factors that this thread makes in the meantime: for programs that run several
    /// scenes.
    pub fn within<T>(self, act: impl FnOnce() -> T) -> T {
        /// Restores the previous limit, even after a panic.
        struct Back(Option<Memory>);
        impl Drop for Back {
            fn drop(&mut self) {
                HERE.set(self.0);
            }
        }
        let _back = Back(HERE.replace(Some(self)));
        act()
    }

    /// No limit.
    #[must_use]
    pub fn unlimited() -> Self {
        Self(None)
    }

    /// True if a factor of `bytes` bytes may be made.
    #[must_use]
    pub fn holds(self, bytes: u64) -> bool {
        self.check(bytes).is_ok()
    }

    /// Refuses a factor of `bytes` bytes if they are too many.
    pub(super) fn check(self, bytes: u64) -> Result<(), FactorError> {
        match self.0 {
            Some(most) if bytes > most => Err(FactorError::Memory {
                needed: bytes.div_ceil(1_000_000),
                left: most / 1_000_000,
            }),
            _ => Ok(()),
        }
    }
}
