//! The energy of central difference over many steps.

use sinew_measure::{Case, Method};

use crate::hard::hard_run::run_with_energies;
use crate::hard::mark::{Asked, Mark};
use crate::report::{short, three};

/// Share of the critical step.
const SHARE: f64 = 0.95;

/// The largest relative change of the half-step energy.
pub(crate) fn check(asked: Asked, case: &Case, steps: usize) -> Result<Mark, String> {
    let critical = case.critical_step().ok_or("nothing vibrates")?;
    let method = Method::new("central-difference");
    let (_, energies) = run_with_energies(case, &method, SHARE * critical, steps)?;
    let by = format!(
        "{}, {} critical steps, {steps} steps",
        method.label(),
        short(SHARE)
    );
    Ok(asked.measured(energies.change, three, by))
}
