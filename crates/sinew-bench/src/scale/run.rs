//! One run on one cube, measured.

use std::time::Instant;

use sinew_core::CountingAllocator;
use sinew_core::{Equations, FreePart, Layers, LinearOperators, LinearSystem, Revision, System};
use sinew_measure::{Effort, MeasureError, measure, on_one_thread, process_cpu_time};

use super::cube::Cube;
use super::methods::Variant;
use super::row::ScaleRow;
use crate::median::median;
use crate::timed::time_run;
use sinew_verify::LabError;

/// Largest number of laps, and the time (s) after which no further lap starts.
const LAPS: usize = 5;
const BUDGET: f64 = 2.0;

/// Measures a method on a cube.
pub(super) fn row(cube: &mut Cube, variant: &Variant) -> Result<ScaleRow, LabError> {
    // Products that are no program's share a pool of threads.
    on_one_thread(|| row_here(cube, variant))?
}

fn row_here(cube: &mut Cube, variant: &Variant) -> Result<ScaleRow, LabError> {
    let dt = variant.step(cube.critical_step, cube.case.span().interval());
    let method = variant.method();
    let compared = measure(&mut cube.case, &method, dt, Effort::UNTIMED)?;

    let system = cube.case.simulation().system();
    let fresh = Fresh::of(system)?;
    let system = fresh.as_ref().map_or(system, |fresh| fresh as &dyn System);
    let start = cube.case.simulation().initial_state();
    let run = cube.case.run(dt);
    let mut state = start.clone();
    let before = CountingAllocator::live_bytes();
    let mut integrator = method.build().map_err(MeasureError::from)?;
    let (cpu, wall) = (process_cpu_time(), Instant::now());
    integrator.prepare(system, dt).map_err(MeasureError::from)?;
    let setup_wall_s = wall.elapsed().as_secs_f64();
    let setup_cpu_s = (process_cpu_time() - cpu).as_secs_f64();

    let (mut cpu_times, mut wall_times, mut spent) = (Vec::new(), Vec::new(), 0.0);
    while wall_times.is_empty() || wall_times.len() < LAPS && spent < BUDGET {
        state.clone_from(start);
        let (cpu, wall) = (process_cpu_time(), Instant::now());
        time_run(system, &mut *integrator, &mut state, &run)?;
        cpu_times.push((process_cpu_time() - cpu).as_secs_f64());
        let wall = wall.elapsed().as_secs_f64();
        wall_times.push(wall);
        spent += wall;
    }
    let bytes = CountingAllocator::live_bytes().saturating_sub(before);
    let body = &cube.body;
    let simulated = body.simulated_s;
    Ok(ScaleRow {
        mesh: body.mesh.clone(),
        nodes: body.nodes,
        tets: body.tets,
        integrator: variant.name,
        dt,
        step_over_critical: dt / cube.critical_step,
        precision: variant.precision,
        threads: variant.threads.count(),
        kernel: compared.kernel,
        steps: compared.steps,
        sweeps_per_s: compared.sweeps_per_s,
        simulated_s: simulated,
        error: compared.error,
        error_is_below: compared.error_is_below,
        reference_error: body.reference_error,
        cpu_s_per_s: median(&mut cpu_times) / simulated,
        wall_s_per_s: median(&mut wall_times) / simulated,
        laps: wall_times.len(),
        setup_cpu_s,
        setup_wall_s,
        bytes_per_tet: (bytes > 0).then(|| bytes as f64 / body.tets as f64),
    })
}

/// A body with its own matrices, without any derived data: for the first set-up of a method.
struct Fresh<'a> {
    body: &'a dyn System,
    operators: LinearOperators,
}

impl<'a> Fresh<'a> {
    /// `None` for a body without matrices.
    fn of(body: &'a dyn System) -> Result<Option<Self>, LabError> {
        let Some(linear) = body.as_linear() else {
            return Ok(None);
        };
        let of = linear.operators();
        let operators = LinearOperators::new(
            of.mass().to_vec(),
            of.stiffness().as_ref().clone(),
            of.damping().clone(),
            of.loads().to_vec(),
        )?;
        Ok(Some(Self { body, operators }))
    }
}

impl System for Fresh<'_> {
    fn dofs(&self) -> usize {
        self.body.dofs()
    }

    fn layers(&self) -> Layers {
        self.body.layers()
    }

    fn mass(&self) -> &[f64] {
        self.operators.mass()
    }

    fn revision(&self) -> Revision {
        self.operators.revision()
    }

    fn equations(&self) -> Equations<'_> {
        Equations::Linear(self)
    }

    fn looks_at_steps(&self) -> bool {
        self.body.looks_at_steps()
    }

    fn cell_positions(&self) -> Option<Vec<[f64; 3]>> {
        self.body.cell_positions()
    }

    fn free_parts(&self) -> Vec<FreePart> {
        self.body.free_parts()
    }

    fn stiffness_contrast(&self) -> Option<f64> {
        self.body.stiffness_contrast()
    }

    fn extent(&self) -> Option<f64> {
        self.body.extent()
    }
}

impl LinearSystem for Fresh<'_> {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }
}
