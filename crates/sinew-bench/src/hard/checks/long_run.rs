//! The energy of central difference over many steps.

use sinew_core::Options;
use sinew_measure::{Case, MethodChoice};

use crate::hard::hard_run::run_with_energies;
use crate::hard::mark::Asked;
use crate::report::{short, three};
use crate::results::Mark;
use sinew_verify::LabError;

/// Share of the critical step.
const SHARE: f64 = 0.95;

/// The largest relative change of the half-step energy, for steps computed in "f64" or "f32".
pub(crate) fn check(
    asked: Asked,
    case: &Case,
    steps: usize,
    precision: &str,
) -> Result<Mark, LabError> {
    let critical = case
        .critical_step()
        .ok_or_else(|| LabError::new("nothing vibrates"))?;
    let options = Options::new().with_text("precision", precision);
    let method = MethodChoice::new("central-difference").with_options(&options);
    let (_, energies) = run_with_energies(case, &method, SHARE * critical, steps)?;
    let by = format!(
        "{}, {} critical steps, {steps} steps",
        method.label(),
        short(SHARE)
    );
    Ok(asked.measured(energies.change, three, by))
}
