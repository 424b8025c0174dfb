//! Allocator that counts, for tests of allocations.

#![allow(
    unsafe_code,
    reason = "an allocator that counts is unsafe to implement"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
    /// Bytes allocated less bytes freed by this thread, and the largest value of that.
    static HELD: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

/// Bytes that all threads have allocated. The count wraps around instead of failing if a block of another allocator is
/// freed here.
static LIVE: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, which counts what each thread allocates: the global allocator of a test that checks whether
/// steps or cuts allocate.
///
/// ```
/// use sinew_core::CountingAllocator;
///
/// #[global_allocator]
/// static ALLOCATOR: CountingAllocator = CountingAllocator;
///
/// let count = CountingAllocator::count(|| drop(vec![0_u8; 100]));
/// assert!(count >= 1);
/// ```
#[derive(Debug)]
pub struct CountingAllocator;

impl CountingAllocator {
    /// Number of allocations by this thread while `body` runs; also 0 if it is not the global allocator.
    pub fn count(body: impl FnOnce()) -> u64 {
        let before = ALLOCATIONS.get();
        body();
        ALLOCATIONS.get() - before
    }

    /// Result of `body`, and the peak of the bytes that this thread allocated during it, beyond those at its
    /// beginning; 0 if it is not the global allocator.
    pub fn peak<T>(body: impl FnOnce() -> T) -> (T, usize) {
        let before = HELD.get();
        PEAK.set(before);
        let result = body();
        (result, PEAK.get().saturating_sub(before).unsigned_abs())
    }

    /// Bytes that all threads have allocated; 0 if it is not the global allocator.
    #[must_use]
    pub fn live_bytes() -> usize {
        LIVE.load(Ordering::Relaxed)
    }
}

/// Records an allocation of this thread.
fn count(bytes: usize) {
    // A thread that ends has no counters any more.
    let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
    hold(bytes.cast_signed());
}

fn hold(bytes: isize) {
    let _ = HELD.try_with(|held| {
        held.set(held.get().wrapping_add(bytes));
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(held.get())));
    });
    LIVE.fetch_add(bytes.cast_unsigned(), Ordering::Relaxed);
}

// SAFETY: everything is left to the system's allocator; counting touches no memory of its own.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: the caller's promise, passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // The old block may be there until the new one is filled.
        count(size);
        hold(-layout.size().cast_signed());
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        hold(-layout.size().cast_signed());
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}
