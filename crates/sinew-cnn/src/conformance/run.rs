//! A program on a system, and its comparison with the definition.

use std::sync::{Arc, LazyLock};

use sinew_core::{Acceleration, Batch, Inputs, LoadOverStep, State, StepReport, System};

use super::everything::everything;
use super::interpreter::Interpreter;
use super::known::Known;
use super::systems::{Case, Kind, Numbers, case, takes};
use super::{Make, Method};
use crate::program::Program;

/// Rounding error that a machine in f64 may add in 100 steps, relative to the largest value of the quantity.
const ROUNDING: f64 = 1e-13;

/// Relative distance between the starts of two motions that are compared to detect chaos.
const APART: f64 = 1e-9;

/// Largest growth of that distance in motions that are compared to rounding.
const FAR: f64 = 10.0;

/// Steps of a run.
pub(super) const STEPS: usize = 100;

/// A program on a case, with its name.
pub(super) struct Run {
    pub(super) name: String,
    /// True if velocities are clamped.
    pub(super) bounds: bool,
    pub(super) case: Case,
    pub(super) program: Arc<Program>,
    /// Reference results for this run and for others of its method.
    known: Arc<Known>,
}

impl Method {
    pub(super) fn needed(&self) -> LoadOverStep {
        self.properties.changing_loads.needed()
    }

    /// The method on a system of a kind, if it supports it.
    pub(super) fn on(&self, kind: Kind) -> Option<Run> {
        if !takes(self.needed(), kind.changing) {
            return None;
        }
        let case = case(kind, self.omega_dt, self.needed());
        let program = (self.program)(&case.system, case.dt)?;
        Some(Run {
            name: format!("{} on {kind:?}", self.name),
            bounds: self.bounds,
            program: Arc::new(program),
            case,
            known: Arc::clone(&self.known),
        })
    }
}

impl Run {
    /// Takes steps with a new machine.
    pub(super) fn by(&self, make: &Make, batches: &[usize]) -> (State, StepReport) {
        self.by_machines(make, batches, false)
    }

    /// Takes steps with one machine, or with a new one for each batch.
    pub(super) fn by_machines(
        &self,
        make: &Make,
        batches: &[usize],
        fresh: bool,
    ) -> (State, StepReport) {
        let made = || {
            let mut machine = make();
            machine.load(Arc::clone(&self.program), &self.case.system);
            machine
        };
        let mut machine = made();
        let mut state = self.case.start.clone();
        let mut work = StepReport::default();
        for steps in batches {
            if fresh {
                machine = made();
            }
            let mut batch = Batch::new(&self.case.system, Inputs::none(), self.case.dt, *steps);
            let done = machine.run(&mut batch, &mut state);
            assert!(done.is_ok(), "{}: {done:?}", self.name);
            assert_eq!(batch.taken(), *steps, "{}: steps taken", self.name);
            work += batch.work();
        }
        (state, work)
    }

    /// Takes steps by the definition.
    fn by_definition(&self, steps: usize) -> Arc<(State, StepReport)> {
        let run = || self.by_definition_from(&self.case.start, steps);
        self.known.end(&self.name, steps, run)
    }

    /// Growth of the distance between two motions over some steps, relative to their sizes.
    fn amplification(&self, steps: usize) -> f64 {
        let measure = || self.measured_amplification(steps);
        self.known.growth(&self.name, steps, measure)
    }

    fn measured_amplification(&self, steps: usize) -> f64 {
        let start = &self.case.start;
        let mut other = start.clone();
        let mut numbers = Numbers::new();
        for value in other.u.iter_mut().chain(&mut other.v) {
            *value *= 1.0 + APART * (2.0 * numbers.next() - 1.0);
        }
        let (one, _) = &*self.by_definition(steps);
        let (other, _) = self.by_definition_from(&other, steps);
        let apart = |a: &[f64], b: &[f64], start: &[f64]| {
            let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            differences.fold(0.0, f64::max) / largest(a).max(largest(start)) / APART
        };
        apart(&one.u, &other.u, &start.u).max(apart(&one.v, &other.v, &start.v))
    }

    /// Number of these steps, halved until the motion does not amplify an error much, and this amplification, at least
    /// 1: clamps make some motions chaotic.
    pub(super) fn predictable(&self, steps: usize) -> (usize, f64) {
        let mut steps = steps;
        let mut growth = self.amplification(steps);
        while steps > 1 && growth > FAR {
            steps /= 2;
            growth = self.amplification(steps);
        }
        (steps, growth.max(1.0))
    }

    fn by_definition_from(&self, start: &State, steps: usize) -> (State, StepReport) {
        let mut state = start.clone();
        let mut interpreter = Interpreter::new(&self.program, &self.case.system);
        let work = interpreter.run(&mut state, self.case.dt, steps);
        (state, work)
    }

    /// This program with a clamp on every cell's velocity that most of them reach.
    pub(super) fn clamped(self, steps: usize) -> Self {
        let (free, _) = &*self.by_definition(steps);
        let largest = largest(&free.v).max(largest(&self.case.start.v));
        let layers = self.case.system.layers().count();
        let cells = self.case.start.u.len() / layers;
        let limit = |cell: usize| largest * (0.1 + 0.05 * (cell % 4) as f64);
        let limits: Arc<[f64]> = (0..cells).map(limit).collect();
        let part = self.case.dt / f64::from(self.program.repeats);
        Self {
            name: format!("{}, clamped as of {steps} steps", self.name),
            bounds: true,
            program: Arc::new(self.program.guarded(limits, part)),
            case: self.case,
            known: self.known,
        }
    }

    pub(super) fn has_limits(&self) -> bool {
        self.program.limits.is_some()
    }

    /// Compares a machine with the definition, in a motion with this amplification of errors.
    pub(super) fn agrees(&self, make: &Make, steps: usize, growth: f64) {
        let (state, work) = self.by(make, &[steps]);
        let (expected, expected_work) = &*self.by_definition(steps);
        let name = &self.name;
        let allowed = ROUNDING * growth;
        let speed = largest(&expected.v).max(largest(&self.case.start.v));
        let way = largest(&expected.u).max(largest(&self.case.start.u));
        close([name, "u"], allowed, &state.u, &expected.u, way);
        close([name, "v"], allowed, &state.v, &expected.v, speed);
        if self.program.acceleration != Acceleration::None {
            // Made of differences of two velocities, over half a step where one was started.
            let half = self.case.dt / f64::from(self.program.repeats) / 2.0;
            let size = largest(&expected.a).max(2.0 * speed / half);
            close([name, "a"], allowed, &state.a, &expected.a, size);
        }
        assert_eq!(state.clock, expected.clock, "{name}: clock");
        assert_eq!(state.velocity, expected.velocity, "{name}: time of v");
        assert_eq!(
            state.acceleration, expected.acceleration,
            "{name}: kind of a"
        );
        assert_eq!(work, *expected_work, "{name}: work");
    }
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

fn close([name, what]: [&str; 2], allowed: f64, found: &[f64], expected: &[f64], size: f64) {
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    // A difference that is not a number is one too.
    let off = differences.fold(0.0, |most: f64, off| if off <= most { most } else { off });
    assert!(
        off <= allowed * size,
        "{name}: {what} is off by {:.1e} of {size:.3e}",
        off / size
    );
}

/// The runs of all methods on systems of all kinds.
pub(super) fn all_runs(methods: &[Method]) -> impl Iterator<Item = Run> {
    let kinds = Kind::all();
    methods
        .iter()
        .flat_map(move |method| kinds.clone().into_iter().filter_map(|kind| method.on(kind)))
}

/// The program with every instruction.
pub(super) fn everything_runs() -> impl Iterator<Item = Run> {
    static KNOWN: LazyLock<Arc<Known>> = LazyLock::new(Arc::default);
    Kind::all().into_iter().map(|kind| {
        let case = case(kind, 0.4, LoadOverStep::Smooth);
        Run {
            name: format!("every instruction on {kind:?}"),
            bounds: true,
            program: Arc::new(everything(&case.system, case.dt).complete()),
            case,
            known: Arc::clone(&KNOWN),
        }
    })
}
pub(super) fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
