//! Identities of objects that may change.

use std::sync::atomic::{AtomicU64, Ordering};

/// Identity of an object that may change, unique in the process: of a system's matrices and laws
/// (`System::revision`) or of its loads.
///
/// Values made from the object (factors, spectra, programs) stay valid while its revision stays
/// the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Revision(u64);

impl Revision {
    /// A revision no other system has.
    #[must_use]
    #[expect(clippy::new_without_default, reason = "each call gives another value")]
    pub fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}
