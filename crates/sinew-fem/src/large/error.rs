//! The refusal of a deformation.

use sinew_core::EvaluationError;

use crate::hyperelastic::HyperelasticLaw;

/// The error for a tetrahedron that fibres freed of volume change are not defined for.
#[cold]
pub(super) fn fibres_refused(tag: u64, volume_ratio: f64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!(
            "its volume is {volume_ratio:.3} of that at rest, and fibres freed of volume change have no meaning from 0 down: shorter steps \
             avoid that unless the motion itself leads there, and fibres without `split` go on"
        ),
    }
}

/// The error for a tetrahedron, or the mean of some, that memory is not defined for.
#[cold]
pub(super) fn memory_refused(tag: u64, volume_ratio: f64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!(
            "its volume is {volume_ratio:.3} of that at rest, and stress that relaxes has no meaning from 0 down: shorter steps \
             avoid that unless the motion itself leads there"
        ),
    }
}

/// The error for a tetrahedron, or the mean of some, that a law is not defined for.
#[cold]
pub(super) fn refused<L: HyperelasticLaw>(tag: u64, volume_ratio: f64) -> EvaluationError {
    let reason = if volume_ratio.is_finite() {
        format!(
            "its volume is {volume_ratio:.3} of that at rest, and the law `{}` has no meaning from 0 down: shorter steps avoid that unless \
             the motion itself leads there, and a law for elements that invert, such as `stable-neo-hookean`, goes on",
            L::ID
        )
    } else {
        "its displacement is not finite".to_owned()
    };
    EvaluationError {
        element: tag,
        reason,
    }
}
