//! A motion that decays through the range of denormal numbers, with which processors compute slowly.

use sinew_cnn::{Machine, ReferenceMachine};
use sinew_core::{LinearSystem, State, System};
use sinew_fem::Model;
use sinew_machines::{FastMachine, Layout};
use sinew_verify::LabError;

use super::guard::{Guard, Limit};
use super::runner::Runner;
use crate::kernels::bodies::damped_cube;
use crate::kernels::laps::central_difference;
use crate::median::median;

/// Largest time of the slowest stretch over that of the beginning.
const MOST: f64 = 1.1;

/// Size of displacements (m) that is below every denormal number in the products of a step.
const GONE: f64 = 1e-320;

/// Batches of a stretch.
const STRETCH: usize = 15;

pub(super) fn guards(quick: bool) -> Result<Vec<Guard>, LabError> {
    // Strong enough that the motion is gone after some thousand steps.
    let model = &damped_cube(6, 60.0)?;
    let in_f64 = || Box::new(FastMachine::new(Layout::<f64>::general(model.operators())));
    let in_f32 = || Box::new(FastMachine::new(Layout::<f32>::general(model.operators())));
    let plain = || Box::new(ReferenceMachine::default());
    let mut guards = Vec::new();
    for (name, machines, limit) in [
        (
            "general f64",
            [in_f64() as Box<dyn Machine>, in_f64()],
            true,
        ),
        ("general f32", [in_f32(), in_f32()], true),
        ("plain loops", [plain(), plain()], false),
    ] {
        guards.extend(slowest(name, machines, model, limit && !quick, quick)?);
    }
    Ok(guards)
}

/// The time of a step in the slowest stretch of a decay, over that of its beginning, which is repeated alternately.
fn slowest(
    name: &str,
    [early, late]: [Box<dyn Machine>; 2],
    model: &Model,
    limit: bool,
    quick: bool,
) -> Result<Option<Guard>, LabError> {
    let Some((program, dt)) = central_difference(model)? else {
        return Ok(None);
    };
    let mut start = State::at_rest(model.dofs());
    for (index, u) in start.u.iter_mut().enumerate() {
        *u = 1e-3 * (12.9898 * index as f64).sin();
    }
    let steps = if quick { 200 } else { 60 };
    let mut early = Runner::new(early, (model, &program, dt), &start);
    let mut late = Runner::new(late, (model, &program, dt), &start);
    let mut stretch = Vec::new();
    let mut slowest: f64 = 0.0;
    let mut gone = 0;
    // Some stretches beyond the end, and never for ever.
    for _ in 0..2000 {
        early.state.clone_from(&start);
        let (before, after) = (early.take(steps)?.cpu, late.take(steps)?.cpu);
        stretch.push(after / before);
        if stretch.len() == STRETCH {
            slowest = slowest.max(median(&mut stretch));
            stretch.clear();
        }
        let moving = late.state.u.iter().any(|u| u.abs() > GONE);
        gone += usize::from(!moving);
        if gone > 2 * STRETCH {
            break;
        }
    }
    Ok(Some(Guard {
        name: format!(
            "{name}, a motion that decays beyond 1e-300 m: slowest stretch over its beginning"
        ),
        ratio: slowest,
        limit: limit.then_some(Limit::AtMost(MOST)),
    }))
}
