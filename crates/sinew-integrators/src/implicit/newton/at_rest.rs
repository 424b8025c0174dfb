//! Conjugate gradients at rest.

use sinew_core::vectors::noise;
use sinew_core::{Pattern, StepReport, TangentKind};

use super::by_products::{Gradients, Products, Solved};
use super::choice::{Bound, Choice};

/// Approximate share of a residual that a step leaves.
const SHARE: f64 = 1e-6;

/// True if conjugate gradients at rest are less work than a factor, tested by the solution for a random acceleration.
pub(super) fn are_less_work(
    gradients: &mut Gradients,
    products: &mut dyn Products,
    weights: &[f64],
    (choice, pattern): (&mut Choice, &Pattern),
    work: &mut StepReport,
) -> bool {
    let mut right = noise(weights.len(), 1);
    for (right, weight) in right.iter_mut().zip(weights) {
        *right /= weight;
    }
    let mut x = vec![0.0; right.len()];
    gradients.begin(&right, weights, &mut x);
    let (mut taken, mut most) = (0, Bound::AtRest.least());
    loop {
        let solved = gradients.go_on(
            (&mut *products, TangentKind::Exact),
            weights,
            (SHARE, most - taken),
            &mut x,
            (&mut taken, work),
        );
        match solved {
            Ok(Solved::Near(_)) => return true,
            Ok(Solved::Unfinished(_)) => {
                most = choice.bound(Bound::AtRest, pattern);
                if taken >= most {
                    return false;
                }
            }
            Ok(Solved::NotDefinite(_)) | Err(_) => return false,
        }
    }
}
