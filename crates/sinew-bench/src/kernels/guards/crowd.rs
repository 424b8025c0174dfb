//! Threads on processors that other programs also use.

use sinew_verify::LabError;
use std::process::{Child, Command, Stdio};

use sinew_core::{LinearSystem, State, System};
use sinew_fem::Model;
use sinew_machines::{FastMachine, Layout};

use super::guard::{Guard, Limit};
use super::runner::Runner;
use crate::kernels::bodies::cube_body;
use crate::kernels::laps::central_difference;
use crate::median::median;

/// Largest wall time of several threads over that of one.
const MOST: f64 = 1.1;

/// Approximate wall time of a lap (s): many slices of a scheduler.
const LAP: f64 = 0.15;

/// Programs that only use CPU time, ended when dropped.
struct Crowd(Vec<Child>);

impl Crowd {
    fn gather(count: usize) -> Self {
        let busy = || {
            Command::new("sh")
                .args(["-c", "while :; do :; done"])
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
        };
        Self((0..count).filter_map(|_| busy().ok()).collect())
    }
}

impl Drop for Crowd {
    fn drop(&mut self) {
        for child in &mut self.0 {
            // It may have ended already.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

pub(super) fn guards(quick: bool) -> Result<Vec<Guard>, LabError> {
    let cores = sinew_machines::Threads::All.most();
    if cores < 2 {
        return Ok(Vec::new());
    }
    let body = cube_body(if quick { 6 } else { 20 })?;
    let model = &body.model;
    let mut guards = Vec::new();
    let mut measure = |crowd: usize, threads: usize| {
        let crowded = Crowd::gather(crowd);
        let beside = match crowded.0.len() {
            0 => String::new(),
            count => format!(" beside {count} busy programs"),
        };
        for templates in [false, true] {
            guards.extend(guard(model, templates, threads, (&beside, cores), quick)?);
        }
        Ok::<(), LabError>(())
    };
    measure(0, cores)?;
    measure(cores, cores)?;
    measure(0, 4 * cores)?;
    measure(cores, 4 * cores)?;
    Ok(guards)
}

fn guard(
    model: &Model,
    templates: bool,
    threads: usize,
    (beside, cores): (&str, usize),
    quick: bool,
) -> Result<Option<Guard>, LabError> {
    let Some((program, dt)) = central_difference(model)? else {
        return Ok(None);
    };
    let layout = match templates {
        true => Layout::<f64>::repeated(model),
        false => Some(Layout::general(model.operators())),
    };
    let Some(layout) = layout else {
        return Ok(None);
    };
    let start = State::at_rest(model.dofs());
    let mut runners = [1, threads].map(|threads| {
        let machine = FastMachine::new(layout.clone()).with_threads(threads);
        Runner::new(Box::new(machine), (model, &program, dt), &start)
    });
    let of_step = runners[0].take(20)?.cpu / 20.0;
    let (steps, laps) = match quick {
        true => (10, 3),
        false => ((LAP / of_step.max(1e-9)) as usize, 11),
    };
    let mut ratios: Vec<f64> = Vec::with_capacity(laps);
    for _ in 0..laps {
        let [one, several] = &mut runners;
        let (one, several) = (one.take(steps)?.wall, several.take(steps)?.wall);
        ratios.push(several / one);
    }
    let kind = if templates { "templates" } else { "general" };
    Ok(Some(Guard {
        name: format!(
            "{kind} f64, {threads} threads on {cores} cores{beside}: wall time over that of one thread"
        ),
        ratio: median(&mut ratios),
        limit: (!quick).then_some(Limit::AtMost(MOST)),
    }))
}
