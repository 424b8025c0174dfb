//! The best instruction set compared with the one that every processor has.

use sinew_core::ElementPrecision;
use sinew_core::{LinearSystem, State, System};
use sinew_fem::Model;
use sinew_machines::{FastMachine, Layout};
use sinew_sparse::simd::InstructionSet;
use sinew_verify::LabError;

use super::guard::{Guard, Limit};
use super::runner::Runner;
use crate::kernels::bodies::cube_body;
use crate::kernels::laps::central_difference;
use crate::median::median;

/// Smallest speed-up by the best set; if it is less, a kernel was compiled without the set.
const LEAST: f64 = 1.2;

pub(super) fn guards(quick: bool) -> Result<Vec<Guard>, LabError> {
    let body = cube_body(if quick { 6 } else { 10 })?;
    let mut guards = Vec::new();
    of::<f64>(&body.model, quick, &mut guards)?;
    of::<f32>(&body.model, quick, &mut guards)?;
    Ok(guards)
}

fn of<T: ElementPrecision>(
    model: &Model,
    quick: bool,
    guards: &mut Vec<Guard>,
) -> Result<(), LabError> {
    let best = InstructionSet::best();
    let Some((program, dt)) = central_difference(model)? else {
        return Ok(());
    };
    if best == InstructionSet::Portable {
        return Ok(());
    }
    let (steps, laps) = if quick { (4, 3) } else { (300, 31) };
    let layouts = [
        Some(Layout::<T>::general(model.operators())),
        Layout::repeated(model),
    ];
    for layout in layouts.into_iter().flatten() {
        let kind = if layout.templates().is_some() {
            "templates"
        } else {
            "general"
        };
        let start = State::at_rest(model.dofs());
        let mut runners = [InstructionSet::Portable, best].map(|set| {
            let machine = FastMachine::new(layout.clone()).with_instructions(set);
            Runner::new(Box::new(machine), (model, &program, dt), &start)
        });
        let mut ratios: Vec<f64> = Vec::with_capacity(laps);
        for _ in 0..laps {
            let [portable, best] = &mut runners;
            let (portable, best) = (portable.take(steps)?.cpu, best.take(steps)?.cpu);
            ratios.push(portable / best);
        }
        guards.push(Guard {
            name: format!(
                "{kind} {}, {} over portable instructions, times as fast",
                T::NAME,
                best.name()
            ),
            ratio: median(&mut ratios),
            limit: (!quick).then_some(Limit::AtLeast(LEAST)),
        });
    }
    Ok(())
}
