//! What a simulation is made of, for people.

mod body;
mod number;
mod run;

use std::fmt;

use sinew_core::StableStep;
use sinew_core::spectrum::Spectrum;

use crate::scene::Subject;
use crate::simulation::{SceneModel, Simulation};
use number::short;

/// What was built from a scene, what was left out and why, and what to beware of. Printed, it
/// is one paragraph a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Title of the scene.
    pub title: String,
    /// Its parts in order.
    pub sections: Vec<PlanSection>,
    /// What a user should know before running it.
    pub warnings: Vec<String>,
    /// 2/omega_max (s), the limit of undamped leapfrog.
    pub critical_step: f64,
    /// The largest stable step of the scene's integrator; unknown where it cannot say.
    pub stable_step: StableStep,
    /// Memory of the matrices (bytes).
    pub matrix_bytes: usize,
}

/// One part of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanSection {
    /// What it is about.
    pub heading: &'static str,
    /// What there is to say.
    pub lines: Vec<String>,
}

impl Plan {
    pub(crate) fn of(simulation: &Simulation) -> Self {
        let scene = simulation.scene();
        let mut plan = Self {
            title: scene.title().to_owned(),
            sections: Vec::new(),
            warnings: Vec::new(),
            critical_step: f64::INFINITY,
            stable_step: StableStep::Unknown,
            matrix_bytes: 0,
        };
        match (scene.subject(), simulation.model()) {
            (Subject::Body(body), SceneModel::Body(built)) => {
                body::describe(body, built, simulation.probes(), &mut plan);
            }
            (Subject::Oscillator(oscillator), _) => {
                let line = format!(
                    "{} kg on {} N/m and {} N s/m: one cell, one layer",
                    oscillator.mass, oscillator.stiffness, oscillator.damping
                );
                plan.add("oscillator", vec![line]);
                if oscillator.force != 0.0 {
                    plan.add("force", vec![format!("{} N from t = 0", oscillator.force)]);
                }
                let start = format!(
                    "u = {} m, v = {} m/s",
                    oscillator.displacement, oscillator.velocity
                );
                plan.add("initial", vec![start]);
            }
            (Subject::Body(_), SceneModel::Oscillator(_)) => {}
        }
        plan.describe_matrices(simulation);
        run::describe(simulation, &mut plan);
        plan
    }

    fn add(&mut self, heading: &'static str, lines: Vec<String>) {
        if !lines.is_empty() {
            self.sections.push(PlanSection { heading, lines });
        }
    }

    fn describe_matrices(&mut self, simulation: &Simulation) {
        let Some(linear) = simulation.system().as_linear() else {
            return;
        };
        let operators = linear.operators();
        let (stiffness, extra) = (operators.stiffness(), &operators.damping().extra);
        let blocks = stiffness.pattern().blocks();
        let cells = stiffness.pattern().cells();
        let layers = operators.dofs() / cells.max(1);
        let number = size_of::<f64>();
        let values = blocks * layers * layers * number;
        let matrices = 1 + usize::from(extra.is_some());
        let pattern = blocks * size_of::<u32>() + (cells + 1) * size_of::<usize>();
        self.matrix_bytes = matrices * values + pattern + operators.dofs() * number;
        self.critical_step = Spectrum::of(operators).critical_step();
        let names = if extra.is_some() { "K and D" } else { "K" };
        let lines = vec![
            "linear: assembled once, no loop over elements afterwards".to_owned(),
            format!(
                "{names} with {} of {layers} x {layers}, lumped M: {}",
                number::count(blocks, "block"),
                number::bytes(self.matrix_bytes)
            ),
            format!("2/omega_max = {} s", short(self.critical_step)),
        ];
        self.add("matrices", lines);
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.title.is_empty() {
            writeln!(f, "{}", self.title)?;
        }
        let warnings = PlanSection {
            heading: "warning",
            lines: self.warnings.clone(),
        };
        for PlanSection { heading, lines } in self.sections.iter().chain([&warnings]) {
            for (index, line) in lines.iter().enumerate() {
                let heading = if index == 0 { heading } else { "" };
                writeln!(f, "{heading:<11} {line}")?;
            }
        }
        Ok(())
    }
}
