//! Strokes allocate nothing until the spare nodes are used up.

#![cfg(test)]
#![allow(
    clippy::unwrap_used,
    unsafe_code,
    reason = "a test ends where something fails; the allocator that counts must be unsafe"
)]

mod common;

use std::alloc::{GlobalAlloc, Layout, System as Allocator};
use std::cell::Cell;

use common::{body, kuhn_cube};
use sinew_cutting::Sheet;

/// The system's allocator, with a count of what this thread asks for.
struct Counting;

thread_local! {
    static ASKED: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends has no count any more.
    let _ = ASKED.try_with(|asked| asked.set(asked.get() + 1));
}

// SAFETY: everything is passed on to the system's allocator as it comes.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promises are passed on.
        unsafe { Allocator.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { Allocator.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn strokes_allocate_nothing_until_a_tenth_more_nodes_are_used_up() {
    let mesh = kuhn_cube();
    let mut body = body(&mesh, 0.45);
    let mut positions = mesh.points.clone();
    positions.reserve(mesh.points.len() / 10);
    let blade = |n: u32| {
        let depth = 0.11 - 0.003 * f64::from(n);
        [[0.0507, -0.01, depth], [0.0512, 0.11, depth]]
    };
    let before = ASKED.with(Cell::get);
    for n in 0..26 {
        let sheet = Sheet::swept(blade(n), blade(n + 1)).unwrap();
        body.stroke(&sheet, &mut positions, 0.25).unwrap();
    }
    let asked = ASKED.with(Cell::get) - before;
    let copies = body.nodes() - mesh.points.len();
    assert!((55..=133).contains(&copies), "{copies}");
    assert_eq!(asked, 0);
    let counted = vec![0_u8; positions.len()];
    assert_eq!(
        ASKED.with(Cell::get) - before,
        1,
        "the count counts {}",
        counted.len()
    );
}
