//! Far beyond the critical step a stabilised network keeps its energy form.

use sinew_measure::{Case, MethodChoice};

use super::trajectory;
use crate::hard::hard_run::run_with_energies;
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::{block, chebyshev, gauss_seidel};
use crate::report::{short, three};
use crate::results::Mark;
use sinew_core::vectors::largest;
use sinew_verify::LabError;

/// Steps over the critical step.
const STEPS: [f64; 3] = [5.0, 25.0, 250.0];

/// The largest relative change of the energy form over `steps` steps, among several inner
/// iterations and steps; the displacement must stay within ten times the reference's.
pub(crate) fn check(asked: Asked, case: &Case, steps: usize) -> Result<Mark, LabError> {
    let critical = case
        .critical_step()
        .ok_or_else(|| LabError::new("nothing vibrates"))?;
    let mut worst = Worst::default();
    let mut bounded = true;
    let mut largest_u = 0.0_f64;
    for method in [block(), chebyshev(4), gauss_seidel(4)] {
        for factor in STEPS {
            let (change, u) = follow(case, &method, factor * critical, steps)?;
            worst.include(
                change,
                format!("{}, {factor} critical steps", method.label()),
            );
            largest_u = largest_u.max(u);
            bounded &= u <= 10.0;
        }
    }
    let note = format!(
        "{steps} steps each of block, chebyshev 4 and gauss-seidel 4 at {} critical steps; |u| at most {} times the reference's",
        STEPS.map(short).join(", "),
        three(largest_u)
    );
    Ok(asked
        .measured(worst.figure, three, worst.by)
        .and(bounded)
        .noting(note))
}

fn follow(
    case: &Case,
    method: &MethodChoice,
    dt: f64,
    steps: usize,
) -> Result<(f64, f64), LabError> {
    let (_, energies) = run_with_energies(case, method, dt, steps)?;
    let simulation = case.simulation();
    let (system, start) = (simulation.system(), simulation.initial_state());
    let path = trajectory(system, start, method, dt, steps)?;
    let u = path.iter().map(|u| largest(u)).fold(0.0, f64::max);
    Ok((energies.change, u / case.samples().max_u))
}
