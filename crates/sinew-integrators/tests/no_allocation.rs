//! After set-up, a step allocates nothing.

#![cfg(test)]
#![allow(
    unsafe_code,
    reason = "an allocator that counts is unsafe to implement"
)]

mod common;

use std::alloc::{GlobalAlloc, Layout, System as SystemAllocator};
use std::cell::Cell;
use std::hint::black_box;

use common::cube::{altered, cube, mass_damping, scene, springs};
use common::{build, inner, plain};
use sinew_core::{Fact, LinearSystem, Load, OptionValue, Options, Ramp, State, System};
use sinew_integrators::explicit::{GuardOption, Guarded};

/// Counts what each thread allocates, so that the test harness does not disturb the count.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends has no counter any more.
    let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
}

// SAFETY: everything is left to the system's allocator; counting touches no memory of its own.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise, passed on.
        unsafe { SystemAllocator.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { SystemAllocator.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { SystemAllocator.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { SystemAllocator.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(run: impl FnOnce()) -> u64 {
    let before = ALLOCATIONS.get();
    run();
    ALLOCATIONS.get() - before
}

fn allocations_of_steps(system: &dyn System, id: &str, options: &Options, dt: f64) -> u64 {
    let mut integrator = build(id, options);
    let mut state = State::at_rest(system.dofs());
    common::advance(&mut *integrator, system, &mut state, 2, dt);
    allocations(|| common::advance(&mut *integrator, system, &mut state, 20, dt))
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(black_box(vec![0_u8; 100]))), 1);
    assert_eq!(allocations(|| drop(black_box(Box::new(1)))), 1);
    assert_eq!(allocations(|| ()), 0);
}

#[test]
fn no_integrator_allocates_after_its_second_step() {
    let model = cube(4);
    for entry in sinew_integrators::entries() {
        let mut variants = vec![plain()];
        if entry.substeps {
            variants.push(plain().with_number("substeps", 3.0));
            variants.push(plain().with("substeps", OptionValue::Text("auto".into())));
        }
        if entry.guard != GuardOption::None {
            // So low that it is reached.
            let low = plain().with_number("saturation", 1e-6);
            let auto = plain().with("saturation", OptionValue::Text("auto".into()));
            for guarded in [low, auto] {
                if entry.substeps {
                    variants.push(guarded.clone().with_number("substeps", 3.0));
                }
                variants.push(guarded);
            }
        }
        if entry.id == "propagator" {
            for kind in ["two-step", "krylov"] {
                variants.push(plain().with("kind", OptionValue::Text(kind.into())));
            }
        }
        if entry.options.iter().any(|option| option.key == "inner") {
            // Stabilised at the step below, which it would leave as it is by itself.
            let full = plain().with_number("s", 1.0);
            variants.push(full.clone());
            for kind in ["jacobi", "chebyshev", "gauss-seidel"] {
                variants.push(full.clone().with("inner", inner(kind, Some(3.0))));
            }
        }
        for options in variants {
            let count = allocations_of_steps(&model, entry.id, &options, 1e-3);
            assert_eq!(count, 0, "`{}` with {options:?}", entry.id);
        }
    }
}

#[test]
fn neither_does_a_guard_that_cuts_and_clamps() {
    // Forward Euler without damping grows at any step until it is clamped.
    let (model, dt) = (scene(2, 0.2, springs(0.0), mass_damping(0.0)), 0.02);
    let model = &model;
    let auto = plain().with("saturation", OptionValue::Text("auto".into()));
    let mut integrator = build("forward-euler", &auto);
    let mut state = State::at_rest(model.dofs());
    common::advance(&mut *integrator, model, &mut state, 400, dt);
    let cut = |fact: &Fact| fact.name == Guarded::SUBSTEPS && fact.value > 1.0;
    assert!(integrator.facts().iter().any(cut));
    let mut saturated = 0;
    let count = allocations(|| {
        for _ in 0..20 {
            let work = integrator.step(model, &mut state, dt);
            saturated += work.map_or(0, |work| work.saturated);
        }
    });
    assert_eq!(count, 0);
    assert!(saturated > 0);
}

/// A load that changes takes sweeps of its own, and damping of another kind products of its own.
#[test]
fn neither_do_loads_that_change_nor_other_damping() {
    let model = cube(4);
    let loads = model.operators().loads().iter().map(|load| Load {
        ramp: Ramp::Sin2 { rise: 0.1 },
        ..load.clone()
    });
    let damping = sinew_core::Damping {
        mass: 3.0,
        stiffness: 1e-3,
        extra: None,
    };
    let system = altered(&model, damping, loads.collect());
    for id in sinew_integrators::ids() {
        let count = allocations_of_steps(&system, id, &plain(), 1e-3);
        assert_eq!(count, 0, "`{id}`");
    }
}

#[cfg(feature = "implicit")]
#[test]
fn neither_do_patches() {
    use common::sliver::{MASS_DAMPING, auto, model, with_sliver};
    let system = model(&with_sliver(1000.0), MASS_DAMPING);
    let count = allocations_of_steps(&system, "central-difference", &auto(), 0.004);
    assert_eq!(count, 0);
}
