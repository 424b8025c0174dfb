//! Warnings about elements that seem to be joined but are not.

use sinew_mesh::JointFinding;

use super::{Warning, WarningKind};
use crate::simulation::model::BodyModel;

pub(super) fn warnings(built: &BodyModel) -> Vec<Warning> {
    let joints = built.mesh.joints();
    let numbers = [
        ("parts", joints.parts as f64),
        ("parts_apart", joints.parts_apart as f64),
    ];
    let warning = |(finding, words): (JointFinding, String)| {
        let kind = match finding {
            JointFinding::Touching => WarningKind::TouchingParts,
            JointFinding::Hinges => WarningKind::Hinge,
            JointFinding::Tangled => WarningKind::TangledMesh,
            _ => WarningKind::MismatchedFaces,
        };
        Warning::new(kind, words, "").with(&numbers)
    };
    joints.findings().into_iter().map(warning).collect()
}
