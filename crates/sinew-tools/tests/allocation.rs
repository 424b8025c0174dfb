//! Contact allocates nothing in a step.

#![cfg(test)]
#![allow(
    clippy::unwrap_used,
    unsafe_code,
    reason = "a test ends where something fails; the allocator that counts must be unsafe"
)]

#[path = "common/pressed.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod pressed;

use std::alloc::{GlobalAlloc, Layout, System as Allocator};
use std::cell::Cell;

use pressed::{Block, through, tool};
use sinew_core::{Batch, Inputs, OptionValue, Options};
use sinew_tools::{Convex, Grasp};

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
fn steps_with_contacts_allocate_nothing() {
    let cube = Block::of([0.06; 3], [8; 3]).with_mass_damping(5.0);
    let down = [(0.0, [0.03, 0.03, 0.0801]), (0.1, [0.03, 0.03, 0.07])];
    let mut ball = tool(Convex::sphere(0.02).unwrap(), through(&down, [0.0; 3]));
    ball.friction = 0.3;
    ball.grasp = Some(Grasp {
        from: 0.05,
        to: 1.0,
    });
    let pressed = cube.with(vec![ball]);
    for machine in ["reference", "general"] {
        let options = Options::new().with("machine", OptionValue::Text(machine.into()));
        let mut integrator = sinew_integrators::build("central-difference", &options).unwrap();
        let mut state = pressed.at_rest();
        let mut take = |steps| {
            let mut batch = Batch::new(&pressed.model, Inputs::none(), 1e-3, steps);
            let before = ASKED.with(Cell::get);
            batch.take(&mut *integrator, &mut state).unwrap();
            ASKED.with(Cell::get) - before
        };
        take(20);
        take(1);
        let (few, many) = (take(1), take(98));
        assert_eq!(
            few, many,
            "{machine}: what a batch needs, and nothing for each step"
        );
        assert!(pressed.tools.report(&state, 0).contacts > 3);
    }
}
