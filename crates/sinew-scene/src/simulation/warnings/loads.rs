//! Loads that are refused, not resolved, or change outside the run only.

use sinew_core::Ramp;

use super::{Warning, WarningKind};
use crate::scene::Subject;
use crate::simulation::Simulation;

pub(super) fn warnings(simulation: &Simulation) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(simulation.refused_load().map(|load| {
        let warning = Warning::new(WarningKind::RefusedLoad, load.to_string(), "");
        warning.with(&[("instant_s", load.instant), ("dt_s", load.dt)])
    }));
    warnings.extend(simulation.unresolved_load().map(|load| {
        let numbers = [
            ("from_s", load.from),
            ("length_s", load.length),
            ("dt_s", load.dt),
        ];
        Warning::new(WarningKind::UnresolvedLoad, load.to_string(), "").with(&numbers)
    }));
    warnings.extend(outside_run(simulation));
    warnings
}

/// Warnings about loads and motions that do not change during the run.
fn outside_run(simulation: &Simulation) -> Vec<Warning> {
    let (Subject::Body(body), Some(built)) =
        (simulation.scene().subject(), simulation.model().body())
    else {
        return Vec::new();
    };
    let duration = simulation.settings().duration;
    let loads = body.problem.loads.iter().enumerate();
    let loads = loads.map(|(index, load)| (body.load_in_words(index), Some(&load.ramp)));
    let moves = built.problem.moves.iter().enumerate();
    let moves = moves.map(|(index, moving)| {
        let first = moving.courses.first().map(|course| &course.ramp);
        (body.motion_in_words(index), first)
    });
    let outside = loads.chain(moves).filter_map(|(what, ramp)| {
        let (from, to) = span(ramp?)?;
        let where_to = if to <= 0.0 {
            format!("ends at t = {to} s, before the run begins")
        } else if from >= duration {
            format!("begins at t = {from} s, after the run of {duration} s")
        } else {
            return None;
        };
        let warning = Warning::new(
            WarningKind::OutsideRun,
            format!("{what} {where_to}"),
            "move its times, or change the duration",
        );
        let numbers = [("from_s", from), ("to_s", to), ("duration_s", duration)];
        Some(warning.with(&numbers))
    });
    outside.collect()
}

/// The first and the last instant (s) at which a pulse or a table changes; `None` for other ramps, and if nothing
/// changes.
fn span(ramp: &Ramp) -> Option<(f64, f64)> {
    match ramp {
        Ramp::Pulse { from, to } => Some((*from, *to)),
        Ramp::Table { times, values } | Ramp::Hold { times, values } => {
            let changes = values.windows(2).any(|pair| pair[0] != pair[1]);
            changes.then(|| Some((*times.first()?, *times.last()?)))?
        }
        _ => None,
    }
}
