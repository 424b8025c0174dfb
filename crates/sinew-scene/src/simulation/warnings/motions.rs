//! Warnings about effects of prescribed motions that a user may not expect.

use super::{Warning, WarningKind};
use crate::scene::Body;
use crate::simulation::model::BodyModel;

pub(super) fn warnings(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (index, facts) in built.model.report().moves.iter().enumerate() {
        let motion = body.motion_in_words(index);
        warnings.extend(facts.jump.map(|instant| {
            let what = format!(
                "{motion} jumps at t = {instant} s, at infinite speed: waves start from it that no mesh resolves"
            );
            let warning = Warning::new(WarningKind::MotionJumps, what, "a rise takes time");
            warning.with(&[("instant_s", instant)])
        }));
        warnings.extend(facts.loads.iter().map(|load| {
            let load = body.load_in_words(*load);
            let what = format!(
                "{load} falls on nodes of {motion}: there it changes the reaction and no motion"
            );
            Warning::new(WarningKind::LoadOnMoved, what, "")
        }));
    }
    warnings
}
