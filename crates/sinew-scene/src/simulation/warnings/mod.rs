//! Warnings before a run.

mod acts;
mod groups;
mod initial;
mod joints;
mod loads;
mod material;
mod motions;
mod parts;
mod probes;
mod size;
mod step;
mod tools;
mod warning;

pub use warning::{Warning, WarningKind};

use super::Simulation;
use super::model::BodyModel;
use crate::scene::{Body, Subject};

impl Simulation {
    /// Warnings about the scene's mesh, materials, initial state, motions, tools, steps, loads and probes, in this
    /// order. Costs no more than [`Simulation::stable_step`].
    #[must_use]
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if let (Subject::Body(body), Some(built)) = (self.scene().subject(), self.model().body()) {
            warnings.extend(of_mesh(body, built));
            if !self.settings().free_flight {
                warnings.extend(parts::free(built));
            }
            warnings.extend(material::locking(body));
            warnings.extend(material::weak_laws(body));
            warnings.extend(initial::held(body, built));
            warnings.extend(motions::warnings(body, built));
            warnings.extend(acts::warnings(body, built));
            warnings.extend(tools::warnings(self, built));
        }
        warnings.extend(step::unstable(self));
        warnings.extend(loads::warnings(self));
        warnings.extend(step::beside_duration(self));
        if let (Subject::Body(body), Some(built)) = (self.scene().subject(), self.model().body()) {
            warnings.extend(probes::warnings(body, built, self.probes()));
        }
        warnings
    }
}

fn of_mesh(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let notes = &built.model.report().notes;
    let remarks = built.mesh_warnings.iter().chain(notes);
    let remark = |remark: &String| Warning::new(WarningKind::MeshFile, remark.as_str(), "");
    let mut warnings: Vec<Warning> = remarks.map(remark).collect();
    warnings.extend(joints::warnings(built));
    warnings.extend(size::warnings(body, built));
    warnings.extend(groups::warnings(body, built));
    warnings
}
