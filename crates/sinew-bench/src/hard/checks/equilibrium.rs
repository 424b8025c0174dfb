//! The place of rest: a damped body comes to rest at `K u = F`, for any replacement of the mass.

use sinew_core::{Outcome, Run, simulate};
use sinew_measure::{Case, MethodChoice};

use super::{at, set_up};
use crate::hard::hard_run::{equilibrium, relative_distance};
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::{block, chebyshev, cut};
use crate::report::{short, three};
use crate::results::Mark;
use sinew_verify::LabError;

/// Number of steps between two checks of the distance, and largest number of such intervals.
const ROUND: usize = 1000;
const MOST_ROUNDS: usize = 200;

/// The largest relative distance from the solution of K u = F, among several methods, each with sufficient time.
pub(crate) fn check(asked: Asked, case: &Case) -> Result<Mark, LabError> {
    let rest =
        equilibrium(case).ok_or_else(|| LabError::new("the reference does not come to rest"))?;
    let dt = case.simulation().dt();
    let mut worst = Worst::default();
    let mut notes = Vec::new();
    let mut bounded = true;
    for method in [
        block(),
        chebyshev(8),
        MethodChoice::new("newmark"),
        cut("central-difference"),
    ] {
        let settled = settle(case, &method, dt, &rest, asked.limit)?;
        notes.push(format!(
            "{} after {} s",
            method.label(),
            short(settled.time)
        ));
        bounded &= settled.bounded;
        worst.include(settled.distance, at(&method.label(), dt));
    }
    let note = format!("largest of: {}", notes.join(", "));
    Ok(asked
        .measured(worst.figure, three, worst.by)
        .and(bounded)
        .noting(note))
}

struct Settled {
    distance: f64,
    time: f64,
    bounded: bool,
}

fn settle(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    rest: &[f64],
    limit: f64,
) -> Result<Settled, LabError> {
    let system = case.simulation().system();
    let mut integrator = set_up(method, system, dt)?;
    let mut state = case.simulation().initial_state().clone();
    let run = Run {
        steps: ROUND,
        divergence_limit: 10.0 * case.samples().max_u,
        ..case.run(dt)
    };
    let mut settled = Settled {
        distance: f64::INFINITY,
        time: 0.0,
        bounded: true,
    };
    for _ in 0..MOST_ROUNDS {
        let report = simulate(system, &mut *integrator, &mut state, &run, &mut ())?;
        settled.bounded = !matches!(report.outcome, Outcome::Diverged { .. });
        settled.distance = relative_distance(&state.u, rest);
        settled.time = state.t();
        if !settled.bounded || settled.distance <= 1e-2 * limit {
            break;
        }
    }
    Ok(settled)
}
