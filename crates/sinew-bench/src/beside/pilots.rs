//! Short runs that find which methods and steps are worth laps.

use sinew_measure::search::{CasePilots, Goal, Search, candidates};
use sinew_measure::{Case, Effort, MeasureError, MethodChoice, Row, measure};

/// An error and our run that reaches it at the lowest cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Largest error (fraction); none for the run that is the other program's own method and step.
    pub error: Option<f64>,
    /// The method.
    pub method: MethodChoice,
    /// The run, as its pilot measured it.
    pub row: Row,
}

/// Target errors (fractions).
const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-6];

/// The same method and step as the other program's first, then the cheapest run for each error, if any. Cost is CPU
/// time of set-up and steps for the case's duration.
///
/// # Errors
/// [`MeasureError`] when the other program's own method cannot run here.
pub fn pilots(
    case: &mut Case,
    integrators: &[String],
    same: (&str, f64),
) -> Result<Vec<Target>, MeasureError> {
    let method = MethodChoice::on(case, same.0);
    let same = measure(case, &method, same.1, Effort::QUICK)?;
    // What cannot run here is no candidate; the bench lists why.
    let (mut candidates, _) = candidates(case.simulation(), &ERRORS);
    candidates.retain(|candidate| integrators.contains(&candidate.method.integrator));
    let span = case.span();
    let mut search = Search::new(CasePilots::new(case), span, span.duration);
    candidates
        .into_iter()
        .for_each(|candidate| search.add(candidate));
    let mut targets = vec![Target {
        error: None,
        method,
        row: same,
    }];
    for error in ERRORS {
        let goal = Goal::error(error);
        search.seek(goal);
        search.try_single_precision(goal);
        if let Some(pilot) = search.cheapest(goal) {
            targets.push(Target {
                error: Some(error),
                method: pilot.method.clone(),
                row: pilot.row.clone(),
            });
        }
    }
    Ok(targets)
}
