//! Bodies whose forces follow from a law, that the user of the suite provides.

use std::sync::Arc;

use sinew_core::{Batch, CountingAllocator, Inputs, State, StepError, StepReport, System};

use super::run::{bits, largest};
use super::{Make, Method};
use crate::program::Program;
use crate::{Machine, ReferenceMachine};

/// A body with an initial state, from which 40 steps of any method stay within its law.
pub struct Body {
    /// Its name, as failures show it.
    pub name: String,
    /// The system.
    pub system: Box<dyn System>,
    /// The state at the beginning.
    pub start: State,
    /// Its approximate largest angular frequency (rad/s).
    pub omega: f64,
    /// True if its law refuses inverted elements.
    pub refuses: bool,
}

impl std::fmt::Debug for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Body")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

/// Steps of a run.
const STEPS: usize = 40;
/// Number of steps of a run with bounded velocities, in which errors grow.
const BOUNDED: usize = 3;

struct Run<'a> {
    body: &'a Body,
    name: String,
    program: Arc<Program>,
    dt: f64,
    steps: usize,
}

/// The programs of all methods on all bodies.
fn runs<'a>(methods: &'a [Method], bodies: &'a [Body]) -> impl Iterator<Item = Run<'a>> {
    let of = move |method: &'a Method| {
        bodies.iter().filter_map(move |body| {
            let dt = method.omega_dt / body.omega;
            Some(Run {
                body,
                name: format!("{} on {}", method.name, body.name),
                program: Arc::new((method.program)(&*body.system, dt)?),
                dt,
                steps: if method.bounds { BOUNDED } else { STEPS },
            })
        })
    };
    methods.iter().flat_map(of)
}

impl Run<'_> {
    fn loaded(&self, mut machine: Box<dyn Machine>) -> Box<dyn Machine> {
        machine.load(Arc::clone(&self.program), &*self.body.system);
        machine
    }

    fn by(
        &self,
        machine: &mut dyn Machine,
        start: &State,
        batches: &[usize],
    ) -> Result<(State, StepReport), StepError> {
        let mut state = start.clone();
        let mut work = StepReport::default();
        for steps in batches {
            let system = &*self.body.system;
            let mut batch = Batch::new(system, Inputs::none(), self.dt, *steps);
            machine.run(&mut batch, &mut state)?;
            assert_eq!(batch.taken(), *steps, "{}: steps taken", self.name);
            work += batch.work();
        }
        Ok((state, work))
    }

    fn by_a_fresh_one(&self, make: &Make, batches: &[usize]) -> (State, StepReport) {
        let mut machine = self.loaded(make());
        let done = self.by(&mut *machine, &self.body.start, batches);
        assert!(done.is_ok(), "{}: {done:?}", self.name);
        done.unwrap_or_else(|_| (self.body.start.clone(), StepReport::default()))
    }
}

/// After 40 steps u, v, the clock and the work equal those of [`ReferenceMachine`], to a relative rounding error; if
/// velocities are bounded, after a few steps.
pub fn bodies_move_as_by_the_reference(
    methods: &[Method],
    bodies: &[Body],
    make: &Make,
    rounding: f64,
) {
    let mut count = 0;
    for run in runs(methods, bodies) {
        let (found, work) = run.by_a_fresh_one(make, &[run.steps]);
        let reference = || -> Box<dyn Machine> { Box::new(ReferenceMachine::default()) };
        let (expected, expected_work) = run.by_a_fresh_one(&reference, &[run.steps]);
        let start = &run.body.start;
        for (what, found, expected, start) in [
            ("u", &found.u, &expected.u, &start.u),
            ("v", &found.v, &expected.v, &start.v),
        ] {
            let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            // A difference that is not a number is one too.
            let off = off.fold(0.0, |most: f64, off| if off <= most { most } else { off });
            let size = largest(expected).max(largest(start));
            assert!(
                off <= rounding * size,
                "{}: {what} is off by {:.1e}",
                run.name,
                off / size
            );
        }
        assert_eq!(found.clock, expected.clock, "{}: clock", run.name);
        assert_eq!(found.velocity, expected.velocity, "{}: time of v", run.name);
        let sweeps = |work: StepReport| (work.sweeps, work.force_evaluations);
        assert_eq!(sweeps(work), sweeps(expected_work), "{}: work", run.name);
        count += 1;
    }
    assert!(count > 0, "no method takes any of the bodies");
}

/// Every division of a run into batches gives the same bits of u and v, the same clock and the same work.
pub fn batches_of_bodies_change_not_a_bit(methods: &[Method], bodies: &[Body], make: &Make) {
    for run in runs(methods, bodies) {
        let (whole, work) = run.by_a_fresh_one(make, &[13]);
        for way in [&[1; 13][..], &[5, 8]] {
            let (cut, cut_work) = run.by_a_fresh_one(make, way);
            assert_eq!(bits(&whole.u), bits(&cut.u), "{}: u", run.name);
            assert_eq!(bits(&whole.v), bits(&cut.v), "{}: v", run.name);
            assert_eq!(whole.clock, cut.clock, "{}: clock", run.name);
            assert_eq!(work, cut_work, "{}: work", run.name);
        }
    }
}

/// A batch allocates nothing once the program is loaded, as far as the calling thread allocates. The
/// test's global allocator has to be [`CountingAllocator`].
pub fn batches_of_bodies_allocate_nothing(methods: &[Method], bodies: &[Body], make: &Make) {
    let counted = CountingAllocator::count(|| drop(std::hint::black_box(vec![0_u8; 100])));
    assert!(
        counted > 0,
        "the global allocator is not the CountingAllocator"
    );
    for run in runs(methods, bodies) {
        let mut machine = run.loaded(make());
        let mut state = run.body.start.clone();
        state.a.resize(state.u.len(), 0.0);
        for steps in [1, 1, run.steps] {
            let system = &*run.body.system;
            let mut batch = Batch::new(system, Inputs::none(), run.dt, steps);
            let mut done = Ok(());
            let count = CountingAllocator::count(|| done = machine.run(&mut batch, &mut state));
            assert!(done.is_ok(), "{}: {done:?}", run.name);
            assert_eq!(batch.taken(), steps, "{}: steps taken", run.name);
            assert_eq!(count, 0, "{}: allocations in {steps} steps", run.name);
        }
    }
}

/// A step that the law refuses ends the batch with its error, and the machine then continues from another state as if
/// nothing had happened.
pub fn a_refused_body_leaves_the_machine_usable(methods: &[Method], bodies: &[Body], make: &Make) {
    for run in runs(methods, bodies).filter(|run| run.body.refuses) {
        let mut machine = run.loaded(make());
        let mut wild = run.body.start.clone();
        wild.u.iter_mut().for_each(|value| *value *= 1e3);
        let refused = run.by(&mut *machine, &wild, &[10]);
        let error = refused.map(|(state, _)| state.t());
        assert!(
            matches!(error, Err(StepError::Refused { .. })),
            "{}: {error:?} beyond the law's domain",
            run.name
        );
        let done = run.by(&mut *machine, &run.body.start, &[10]);
        assert!(done.is_ok(), "{}: {done:?} after a refused step", run.name);
        let (found, work) = done.unwrap_or_else(|_| (wild, StepReport::default()));
        let (expected, expected_work) = run.by_a_fresh_one(make, &[10]);
        assert_eq!(bits(&found.u), bits(&expected.u), "{}: u", run.name);
        assert_eq!(bits(&found.v), bits(&expected.v), "{}: v", run.name);
        assert_eq!(work, expected_work, "{}: work", run.name);
    }
}
