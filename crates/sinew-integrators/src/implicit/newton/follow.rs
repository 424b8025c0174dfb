//! A solution reached from a known one by gradual change of the equations.

use sinew_core::StepReport;
use sinew_core::vectors::add_scaled;

use super::equations::Equations;
use super::newton_error::NewtonError;
use super::solver::Newton;

/// The first increment, as a share of the whole change.
const FIRST: f64 = 0.25;

/// The smallest increment, as a share of the whole change.
const SMALLEST: f64 = 1.0 / 4096.0;

/// Largest number of iterations after which the next increment is four times as long; after more iterations it is twice
/// as long.
const EASY: u64 = 3;

/// Equations that change with a share, from 0 to 1, of a load or of the path of supports.
pub(super) trait ByShare: Equations {
    /// Sets the equations of a share.
    fn take_share(&mut self, share: f64);
}

/// Error of a change that could be followed to a share only.
pub(in crate::implicit) struct Unreached {
    /// The share that is reached.
    pub(in crate::implicit) share: f64,
    /// The error of the last attempt to go beyond it.
    pub(in crate::implicit) error: NewtonError,
}

/// Moves the point from a solution without the change, or a start near it, to the solution with the whole change. The
/// change grows by increments that are halved if Newton's method fails and lengthened if it succeeds. Allocates two
/// vectors.
pub(super) fn follow(
    newton: &mut Newton,
    equations: &mut impl ByShare,
    work: &mut StepReport,
) -> Result<(), Unreached> {
    let mut solution = newton.point.x.clone();
    let mut change: Vec<f64> = Vec::new();
    let (mut reached, mut part, mut last) = (0.0, FIRST, FIRST);
    while reached < 1.0 {
        let share = f64::min(reached + part, 1.0);
        equations.take_share(share);
        newton.linear.insist_on_factor();
        newton.point.x.copy_from_slice(&solution);
        let mut begun = equations.evaluate(&mut newton.point, work);
        if begun.is_err() && !change.is_empty() {
            // Where only a part of the body feels the change at first, that part may leave the law's domain.
            add_scaled((share - reached) / last, &change, &mut newton.point.x);
            begun = equations.evaluate(&mut newton.point, work);
        }
        let before = work.newton_iterations;
        let solved = begun
            .map_err(NewtonError::Refused)
            .and_then(|()| newton.solve(equations, work));
        match solved {
            Ok(()) => {
                change.clone_from(&newton.point.x);
                add_scaled(-1.0, &solution, &mut change);
                last = share - reached;
                reached = share;
                solution.copy_from_slice(&newton.point.x);
                part *= match work.newton_iterations - before <= EASY {
                    true => 4.0,
                    false => 2.0,
                };
            }
            Err(_) if part > SMALLEST => part *= 0.5,
            Err(error) => {
                return Err(Unreached {
                    share: reached,
                    error,
                });
            }
        }
    }
    Ok(())
}
