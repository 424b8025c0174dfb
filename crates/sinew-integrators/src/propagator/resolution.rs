//! Resolution of the steps of propagators.

use sinew_core::SetupError;

pub(super) const ID: &str = "propagator";
/// Highest degree; above it shorter steps need less memory and no more sweeps.
pub(super) const HIGHEST_DEGREE: usize = 500;
/// Error of a step with a user-given degree above which the step is refused: a polynomial of too low a degree has very
/// large errors.
pub(super) const LOOSE: f64 = 1e-2;

/// Resolution of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Resolution {
    /// Bound of the error of a step, as the kind measures it.
    pub(super) tolerance: f64,
    /// Degree, if given.
    pub(super) degree: Option<usize>,
}

impl Resolution {
    /// The degree to take: the given one, or the smallest whose error meets the tolerance. `left_out` gives an estimate
    /// of the error for each degree, from which the search begins.
    pub(super) fn degree_for(
        self,
        left_out: &[f64],
        dt: f64,
        error: impl Fn(usize) -> f64,
    ) -> Result<usize, SetupError> {
        let highest = HIGHEST_DEGREE.min(left_out.len() - 1);
        let meets = |degree: usize| error(degree) <= self.tolerance;
        let given = self.degree.map(|degree| degree.min(highest));
        if let Some(degree) = given
            && meets(degree)
        {
            return Ok(degree);
        }
        let estimated = left_out.iter().position(|left| *left <= self.tolerance);
        let enough =
            estimated.and_then(|from| (from.max(1)..=highest).find(|degree| meets(*degree)));
        let enough = enough.map(|enough| {
            let fewer = (1..enough).rev().take_while(|degree| meets(*degree));
            fewer.last().unwrap_or(enough)
        });
        let reason = match (given, enough) {
            (None, Some(degree)) => return Ok(degree),
            (Some(degree), Some(enough)) => format!(
                "degree {degree} leaves out {:.1e} of the motion over a step of {dt} s; take degree {enough} or leave it out",
                error(degree)
            ),
            (_, None) => format!(
                "a step of {dt} s needs a degree above {HIGHEST_DEGREE}; take a shorter step"
            ),
        };
        Err(SetupError::Unresolved {
            integrator: ID,
            reason,
        })
    }
}
