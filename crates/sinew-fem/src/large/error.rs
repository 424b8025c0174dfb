//! The refusal of a deformation.

use sinew_core::EvaluationError;

/// Formats a ratio of volumes: to three decimal places, if these are sufficient.
fn in_words(volume_ratio: f64) -> String {
    if (1e-3..1e4).contains(&volume_ratio.abs()) || volume_ratio == 0.0 {
        format!("{volume_ratio:.3}")
    } else {
        format!("{volume_ratio:.1e}")
    }
}

/// The error for a tetrahedron for which fibres with isochoric invariants are not defined.
#[cold]
pub(super) fn fibres_refused(tag: u64, volume_ratio: f64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!(
            "its volume is {} of that at rest, and fibres freed of volume change have no meaning from 0 down: shorter steps \
             avoid that unless the motion itself leads there, and fibres without `split` go on",
            in_words(volume_ratio)
        ),
    }
}

/// The error for a tetrahedron, or the mean of some, for which memory is not defined.
#[cold]
pub(super) fn memory_refused(tag: u64, volume_ratio: f64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!(
            "its volume is {} of that at rest, and stress that relaxes has no meaning from 0 down: shorter steps \
             avoid that unless the motion itself leads there",
            in_words(volume_ratio)
        ),
    }
}

/// The error for a tetrahedron whose fibres are beyond their limit.
#[cold]
pub(super) fn limit_of_fibres_reached(tag: u64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!(
            "its fibres are stretched until exp(k2 X^2) is beyond numbers to compute with: {AT_A_LIMIT}"
        ),
    }
}

/// Advice for deformations beyond the limit of a law.
const AT_A_LIMIT: &str = "shorter steps avoid that unless the motion itself leads there, and then smaller loads or a softer law do";

/// The error for a tetrahedron, or the mean of some, that is beyond the limit of a law.
#[cold]
pub(super) fn limit_reached(law: &str, limit: &str, tag: u64) -> EvaluationError {
    EvaluationError {
        element: tag,
        reason: format!("the law `{law}` {limit}: {AT_A_LIMIT}"),
    }
}

/// The error for a tetrahedron, or the mean of some, for which a law is not defined.
#[cold]
pub(super) fn refused(law: &str, tag: u64, volume_ratio: f64) -> EvaluationError {
    let reason = if volume_ratio.is_finite() {
        format!(
            "its volume is {} of that at rest, and the law `{law}` is not defined at 0 or below: shorter steps avoid that unless \
             the motion itself leads there, and a law for elements that invert, such as `stable-neo-hookean`, goes on",
            in_words(volume_ratio)
        )
    } else {
        "its displacement is not finite".to_owned()
    };
    EvaluationError {
        element: tag,
        reason,
    }
}
