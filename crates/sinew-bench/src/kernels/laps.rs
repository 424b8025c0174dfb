//! Alternating laps: plain loops, then each machine.

use sinew_verify::LabError;
use std::sync::Arc;

use sinew_cnn::{Machine, Program, Quotient, ReferenceMachine, Sweep, When};
use sinew_core::CountingAllocator;
use sinew_core::ElementPrecision;
use sinew_core::{Batch, Inputs, Layers, LinearSystem, Options, State, System};
use sinew_fem::Rayleigh;
use sinew_machines::{FastMachine, Kind, Layout, PrecisionName};

use super::baseline::Baseline;
use super::bodies::Body;
use super::memory::bandwidth;
use super::row::KernelRow;
use super::variant::{Variant, variants};
use crate::median::median;
use crate::timed::{Spent, TimedRunError, time, time_batch};

/// Share of the stable step that steps take.
const SHARE: f64 = 0.9;

/// Approximate number of degrees of freedom that a lap moves.
const LAP: usize = 2_000_000;

/// Number of laps that one batch of several threads takes.
const LONG: usize = 5;

/// A machine with its own state.
struct Runner {
    variant: Variant,
    machine: Box<dyn Machine>,
    instructions: &'static str,
    templates: Option<usize>,
    /// Bytes of matrices.
    bytes: usize,
    state: State,
    /// Time of the baseline's lap, and of the following lap (s).
    laps: Vec<[f64; 2]>,
    /// Largest difference from the plain machine after the first lap, relative.
    difference: f64,
}

/// Measures all machines on a body.
pub(super) fn rows(body: &Body, quick: bool) -> Result<Vec<KernelRow>, LabError> {
    let model = &body.model;
    let Some((program, dt)) = central_difference(model)? else {
        return Ok(Vec::new());
    };
    let damping = Rayleigh::new(
        model.operators().damping().mass,
        model.operators().damping().stiffness,
    );
    let dofs = model.operators().dofs();
    let (steps, laps) = match quick {
        true => (4, 3),
        false => ((LAP / dofs).max(8), 15),
    };
    let mut runners: Vec<Runner> = variants()
        .into_iter()
        .filter_map(|variant| runner(variant, model, &program))
        .collect();
    let mut baseline = Baseline::new(model);
    let mut expected = State::at_rest(dofs);
    // Of the plain loops with and without checks (s).
    let mut plain: Vec<f64> = Vec::with_capacity(laps);
    for lap in 0..laps {
        let ((), with) = time(|| baseline.steps(steps, dt, damping));
        let ((), without) = time(|| baseline.steps_without_checks(steps, dt, damping));
        plain.push(with.cpu / without.cpu);
        for runner in &mut runners {
            let several = runner.variant.threads > 1;
            let ((), of_baseline) = time(|| baseline.steps(steps, dt, damping));
            // Threads begin with a batch, and runs have long ones.
            let batches = if several && lap > 0 { LONG } else { 1 };
            let of_machine = runner.take(model, dt, batches * steps)?;
            // Of this thread's CPU time, or on the wall where there are several.
            let [baseline, machine] = [of_baseline, of_machine].map(|spent| match several {
                true => spent.wall,
                false => spent.cpu,
            });
            runner.laps.push([baseline, machine / batches as f64]);
        }
        if lap == 0 {
            let mut reference = ReferenceMachine::default();
            reference.load(Arc::clone(&program), model);
            let mut batch = Batch::new(model, Inputs::none(), dt, steps);
            time_batch(&mut reference, &mut batch, steps, &mut expected)?;
            for runner in &mut runners {
                runner.laps.clear();
                runner.note_difference(&expected);
            }
        }
    }
    let layers = Layers::Three;
    let cells = dofs / layers.count();
    let vectors = program.traffic().vector_bytes(layers) * cells as f64;
    let operations = operations(&program, model);
    let gain_without_checks = median(&mut plain);
    let mut rows = Vec::new();
    for mut runner in runners {
        let allocations = runner.allocations(model, dt)?;
        let number = match runner.variant.precision {
            PrecisionName::F64 => 1.0,
            PrecisionName::F32 => 0.5,
        };
        let bytes_per_step = runner.bytes as f64 + number * vectors;
        let mut ratios: Vec<f64> = runner.laps.iter().map(|[b1, own]| b1 / own).collect();
        let ratio_to_b1 = median(&mut ratios);
        let mut times: Vec<f64> = runner
            .laps
            .iter()
            .map(|[_, own]| own / steps as f64)
            .collect();
        let step_s = median(&mut times);
        rows.push(KernelRow {
            mesh: body.name.clone(),
            nodes: body.nodes,
            tets: body.tets,
            kernel: match runner.variant.kind {
                Kind::REPEATED => "template lattice".into(),
                _ => "general".into(),
            },
            precision: match runner.variant.precision {
                PrecisionName::F64 => "f64",
                PrecisionName::F32 => "f32",
            },
            instructions: runner.instructions,
            threads: runner.variant.threads,
            ratio_to_b1,
            ratio_to_b1_without_checks: ratio_to_b1 / gain_without_checks,
            ratios: [ratios[0], ratios[ratios.len() - 1]],
            step_s,
            difference: runner.difference,
            bytes_per_step,
            operations_per_step: operations,
            gflops: 1e-9 * operations / step_s,
            intensity: operations / bytes_per_step,
            share_of_bandwidth: bytes_per_step / step_s / bandwidth(bytes_per_step as usize),
            templates: runner.templates,
            allocations_per_step: allocations,
        });
    }
    Ok(rows)
}

/// A step of central difference as a program, with its length (s).
pub(super) fn central_difference(
    model: &dyn System,
) -> Result<Option<(Arc<Program>, f64)>, LabError> {
    let omega = model.spectrum(None);
    let dt = SHARE * 2.0 / omega.map_or(1.0, |spectrum| spectrum.omega_max);
    let mut method = sinew_integrators::build("central-difference", &Options::new())?;
    method.prepare(model, dt)?;
    Ok(method.program().map(|program| (Arc::new(program), dt)))
}

/// Floating-point operations of a step: two for each entry of a matrix, independent of its storage, and those
/// of the cells' own maps.
fn operations(program: &Program, model: &dyn LinearSystem) -> f64 {
    let stiffness = model.operators().stiffness();
    let entries = stiffness.pattern().blocks() * stiffness.layers().block_len();
    let always = program
        .step
        .iter()
        .filter(|sweep| sweep.when == When::Always);
    let of_sweep = |sweep: &Sweep| {
        let updates = sweep.updates.iter().filter(|update| !update.last_only);
        let terms = updates.map(|update| update.terms.len() + usize::from(update.of_q != 0.0));
        2 * (sweep.own.len() + terms.sum::<usize>()) + usize::from(sweep.quotient == Quotient::Mass)
    };
    let own: usize = always.map(of_sweep).sum();
    let repeats = f64::from(program.repeats);
    repeats * (2 * program.traffic().products / program.repeats as usize * entries) as f64
        + repeats * (own * stiffness.dofs()) as f64
}

/// A machine of this kind; `None` if the body has no templates.
fn runner(variant: Variant, model: &sinew_fem::Model, program: &Arc<Program>) -> Option<Runner> {
    match variant.precision {
        PrecisionName::F64 => runner_in::<f64>(variant, model, program),
        PrecisionName::F32 => runner_in::<f32>(variant, model, program),
    }
}

fn runner_in<T: ElementPrecision>(
    variant: Variant,
    model: &sinew_fem::Model,
    program: &Arc<Program>,
) -> Option<Runner> {
    let layout = match variant.kind {
        Kind::REPEATED => Layout::<T>::repeated(model)?,
        _ => Layout::general(model.operators()),
    };
    let (templates, bytes) = (layout.templates(), layout.bytes());
    let mut machine = FastMachine::new(layout).with_threads(variant.threads);
    machine.load(Arc::clone(program), model);
    Some(Runner {
        variant,
        instructions: machine.instructions().name(),
        machine: Box::new(machine),
        templates,
        bytes,
        state: State::at_rest(model.dofs()),
        laps: Vec::new(),
        difference: 0.0,
    })
}

impl Runner {
    /// Takes steps and returns their time.
    fn take(&mut self, model: &dyn System, dt: f64, steps: usize) -> Result<Spent, TimedRunError> {
        let mut batch = Batch::new(model, Inputs::none(), dt, steps);
        time_batch(&mut *self.machine, &mut batch, steps, &mut self.state)
    }

    fn note_difference(&mut self, expected: &State) {
        let size = |values: &[f64]| values.iter().fold(0.0, |most: f64, x| x.abs().max(most));
        let pairs = self.state.u.iter().zip(&expected.u);
        let off: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        self.difference = size(&off) / size(&expected.u);
    }

    /// Allocations in a step of a batch of ten; `None` if the program's allocator does not count.
    fn allocations(&mut self, model: &dyn System, dt: f64) -> Result<Option<f64>, TimedRunError> {
        let counts = CountingAllocator::count(|| drop(std::hint::black_box(vec![0_u8; 100])));
        if counts == 0 {
            return Ok(None);
        }
        let mut done = Ok(());
        let count = CountingAllocator::count(|| done = self.take(model, dt, 10).map(drop));
        done.map(|()| Some(count as f64 / 10.0))
    }
}
