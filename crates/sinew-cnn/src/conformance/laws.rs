//! Runs compared with the definition and with each other.

use std::sync::Arc;

use sinew_core::{Acceleration, Batch, CountingAllocator, Inputs, Layers};

use super::run::{Run, STEPS, all_runs, bits, everything_runs};
use super::systems::{Changing, Damped, Kind, LONG};
use super::{Make, Method};

/// After 100 steps u, v and a equal those of the same program executed literally on full matrices, to 1e-13 relative,
/// and so do the clock and the work: for every method and a program with every instruction, clamped and not, on systems
/// of every kind. If a clamp makes errors grow with the motion, the bound grows with them; if this growth is more than
/// 10 times, fewer steps are taken.
pub fn steps_are_those_of_the_definition(methods: &[Method], make: &Make) {
    for run in everything_runs().chain(all_runs(methods)) {
        let (steps, growth) = match run.bounds {
            true => run.predictable(STEPS),
            false => (STEPS, 1.0),
        };
        run.agrees(make, steps, growth);
        if !run.has_limits() {
            let clamped = run.clamped(STEPS);
            let (steps, growth) = clamped.predictable(STEPS);
            clamped.agrees(make, steps, growth);
        }
    }
}

/// The law of [`steps_are_those_of_the_definition`] for a few steps of systems with more degrees of
/// freedom than a machine takes at a time.
pub fn steps_of_many_cells_are_those_of_the_definition(methods: &[Method], make: &Make) {
    for layers in [Layers::One, Layers::Three] {
        let cells = match layers {
            Layers::One => LONG,
            Layers::Three => LONG.map(|count| count.div_ceil(3)),
        };
        let kind = Kind {
            layers,
            damped: Damped::ByAll,
            changing: Changing::Jumps,
            held: true,
            cells,
        };
        for method in methods {
            let by_mass = Kind {
                damped: Damped::ByMass,
                ..kind
            };
            let run = [kind, by_mass].into_iter().find_map(|kind| method.on(kind));
            if let Some(run) = run {
                run.agrees(make, 3, 1.0);
                if !run.has_limits() {
                    run.clamped(3).agrees(make, 3, 1.0);
                }
            }
        }
    }
}

/// Divisions of 100 steps into batches, each with a flag: true if each batch has a machine of its own.
fn ways() -> [(Vec<usize>, bool); 5] {
    [
        (vec![1; STEPS], false),
        (vec![7, 93], false),
        (vec![50, 50], false),
        (vec![99, 1], false),
        (vec![1, 42, 57], true),
    ]
}

/// Every division of a run into batches, by one machine or by a fresh one for each, gives the same
/// bits of u, v and a, the same clock and the same work.
pub fn batches_change_not_a_bit(methods: &[Method], make: &Make) {
    let kinds: Vec<Kind> = Kind::all()
        .into_iter()
        .filter(|kind| kind.layers == Layers::Three && kind.held)
        .collect();
    let of_methods = methods.iter().flat_map(|method| {
        let kinds = kinds.iter();
        kinds
            .filter_map(|kind| method.on(*kind))
            .collect::<Vec<_>>()
    });
    let check = |run: &Run| {
        let (whole, work) = run.by(make, &[STEPS]);
        for (way, fresh) in ways() {
            let (cut, cut_work) = run.by_machines(make, &way, fresh);
            let ways = match fresh {
                false => format!("{} batches", way.len()),
                true => format!("{} batches, each by a fresh machine", way.len()),
            };
            let name = &run.name;
            assert_eq!(bits(&whole.u), bits(&cut.u), "{name}: u in {ways}");
            assert_eq!(bits(&whole.v), bits(&cut.v), "{name}: v in {ways}");
            assert_eq!(whole.clock, cut.clock, "{name}: clock");
            assert_eq!(whole.velocity, cut.velocity, "{name}: time of v");
            assert_eq!(whole.acceleration, cut.acceleration, "{name}: kind of a");
            if whole.acceleration != Acceleration::None {
                assert_eq!(bits(&whole.a), bits(&cut.a), "{name}: a in {ways}");
            }
            assert_eq!(work, cut_work, "{name}: work");
        }
    };
    for run in everything_runs().chain(of_methods) {
        check(&run);
        if !run.has_limits() {
            check(&run.clamped(STEPS));
        }
    }
}

/// A batch allocates nothing once the program is loaded, as far as the calling thread allocates. The
/// test's global allocator has to be [`CountingAllocator`].
pub fn batches_allocate_nothing(methods: &[Method], make: &Make) {
    let counted = CountingAllocator::count(|| drop(std::hint::black_box(vec![0_u8; 100])));
    assert!(
        counted > 0,
        "the global allocator is not the CountingAllocator"
    );
    let check = |run: &Run| {
        let mut machine = make();
        machine.load(Arc::clone(&run.program), &run.case.system);
        let mut state = run.case.start.clone();
        // The acceleration that a method begins to keep is the state's, not the machine's.
        state.a.resize(state.u.len(), 0.0);
        for steps in [1, 1, 50] {
            let mut batch = Batch::new(&run.case.system, Inputs::none(), run.case.dt, steps);
            let mut done = Ok(());
            let count = CountingAllocator::count(|| done = machine.run(&mut batch, &mut state));
            assert!(done.is_ok(), "{}: {done:?}", run.name);
            assert_eq!(batch.taken(), steps, "{}: steps taken", run.name);
            assert_eq!(count, 0, "{}: allocations in {steps} steps", run.name);
        }
    };
    for run in everything_runs().chain(all_runs(methods)) {
        check(&run);
        if !run.has_limits() {
            check(&run.clamped(1));
        }
    }
}
