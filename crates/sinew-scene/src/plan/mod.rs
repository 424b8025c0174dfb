//! The plan: a description of a simulation for the user.

mod body;
mod cutting;
mod matrices;
mod oscillator;
mod run;
mod section;
mod tools;

use std::fmt;

use serde::Serialize;
use sinew_core::StableStep;

pub use section::PlanSection;

use crate::output::hanging;
use crate::scene::Subject;
use crate::simulation::{Simulation, Warning};
use matrices::Matrices;

/// A description of a simulation: its parts, omissions with their reasons, and warnings. It prints
/// one paragraph for each section, in lines of at most 100 characters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// Title of the scene.
    pub title: String,
    /// Its sections in order.
    pub sections: Vec<PlanSection>,
    /// Warnings, the same as [`Simulation::warnings`].
    pub warnings: Vec<Warning>,
    /// 2/omega_max (s), the limit of undamped leapfrog.
    pub critical_step: f64,
    /// The largest stable step of the scene's integrator; unknown if the integrator cannot compute it.
    pub stable_step: StableStep,
    /// Memory of the matrices (bytes).
    pub matrix_bytes: usize,
}

impl Simulation {
    /// Describes the simulation. Costs more than [`Simulation::warnings`]: it solves an eigenproblem for
    /// each element and sets up an integrator.
    #[must_use]
    pub fn plan(&self) -> Plan {
        let about_subject = match (self.scene().subject(), self.model().body()) {
            (Subject::Body(body), Some(built)) => body::sections(body, built, self.probes()),
            (Subject::Oscillator(oscillator), _) => oscillator::sections(oscillator),
            // The model is made from the subject.
            (Subject::Body(_), None) => Vec::new(),
        };
        let linear = self.system().as_linear();
        let matrices = linear.map(|linear| Matrices::of(linear.operators()));
        let (critical_step, matrix_bytes) = match &matrices {
            Some(matrices) => (matrices.critical_step, matrices.bytes),
            None => (f64::INFINITY, 0),
        };
        let about_matrices = matrices.map(|matrices| matrices.section);
        let sections = about_subject
            .into_iter()
            .chain(about_matrices)
            .chain([run::section(self)]);
        Plan {
            title: self.scene().title().to_owned(),
            sections: sections
                .filter(|section| !section.lines.is_empty())
                .collect(),
            warnings: self.warnings(),
            critical_step,
            stable_step: self.stable_step().unwrap_or(StableStep::Unknown),
            matrix_bytes,
        }
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.title.is_empty() {
            writeln!(f, "{}", self.title)?;
        }
        let warnings = PlanSection::new(
            "warning",
            self.warnings.iter().map(ToString::to_string).collect(),
        );
        for PlanSection { heading, lines } in self.sections.iter().chain([&warnings]) {
            for (index, line) in lines.iter().enumerate() {
                let heading = if index == 0 { heading } else { "" };
                writeln!(f, "{}", hanging(&format!("{heading:<11} "), line, 2))?;
            }
        }
        Ok(())
    }
}
