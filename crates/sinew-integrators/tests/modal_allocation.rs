//! After set-up, a step with modes from Lanczos bases allocates nothing, even where it has to find out
//! how much of a state lies outside them.

#![allow(
    unsafe_code,
    reason = "an allocator that counts is unsafe to implement"
)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![cfg(feature = "implicit")]

mod common;

use std::alloc::{GlobalAlloc, Layout, System as SystemAllocator};
use std::cell::Cell;

use common::cube::cube;
use common::{advance, build, largest, plain};
use sinew_core::{State, System};

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: everything is left to the system's allocator; counting touches no memory of its own.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // A thread that ends has no counter any more.
        let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
        // SAFETY: the caller's promise, passed on.
        unsafe { SystemAllocator.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { SystemAllocator.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_step_allocates_nothing() {
    let model = cube(6);
    assert!(model.dofs() > 400, "enough for a Lanczos basis");
    let before = ALLOCATIONS.get();
    let mut modal = build("modal", &plain().with_number("tolerance", 0.05));
    modal.prepare(&model, 0.01).unwrap();
    assert!(ALLOCATIONS.get() > before, "set-up does");
    let mut state = State::at_rest(model.dofs());
    advance(&mut *modal, &model, &mut state, 20, 0.01);
    state.u[7] += 0.01 * largest(&state.u);

    let before = ALLOCATIONS.get();
    let checked = modal.step(&model, &mut state, 0.01).unwrap();
    advance(&mut *modal, &model, &mut state, 20, 0.01);
    assert_eq!(ALLOCATIONS.get(), before);
    assert_eq!(checked.solves, 1, "how much is lost");
}
