//! The energy that a method adds to the work of the loads.

use sinew_measure::{Case, MethodChoice};

use super::at;
use crate::hard::hard_run::run_with_energies;
use crate::hard::mark::{Asked, Worst};
use crate::hard::methods::{block, chebyshev, cnn, energy, gauss_seidel};
use crate::report::three;
use crate::results::Mark;
use sinew_verify::LabError;

/// The largest excess of the energy over E0 and the work so far, as a share of them, among the methods that guarantee
/// no excess.
pub(crate) fn check(asked: Asked, case: &Case) -> Result<Mark, LabError> {
    let dt = case.simulation().dt();
    let critical = case
        .critical_step()
        .ok_or_else(|| LabError::new("nothing vibrates"))?;
    let promising = [
        (block(), dt),
        (chebyshev(4), dt),
        (chebyshev(8), dt),
        (gauss_seidel(4), dt),
        (energy(1), dt),
        (energy(4), dt),
        (MethodChoice::new("newmark"), dt),
        (MethodChoice::new("central-difference"), 0.9 * critical),
    ];
    let mut worst = Worst::default();
    let mut names = Vec::new();
    for (method, dt) in &promising {
        let excess = excess(case, method, *dt)?;
        names.push(at(&method.label(), *dt));
        worst.include(excess, at(&method.label(), *dt));
    }
    let paper = excess(case, &cnn(), dt)?;
    let note = format!(
        "largest of: {}; the paper's network at this step: {}",
        names.join("; "),
        without_bound_or(paper)
    );
    Ok(asked.measured(worst.figure, three, worst.by).noting(note))
}

/// Description of an excess.
fn without_bound_or(excess: f64) -> String {
    if excess.is_finite() {
        three(excess)
    } else {
        "beyond all bounds".into()
    }
}

fn excess(case: &Case, method: &MethodChoice, dt: f64) -> Result<f64, LabError> {
    let (_, energies) = run_with_energies(case, method, dt, case.run(dt).steps)?;
    Ok(energies.excess)
}
