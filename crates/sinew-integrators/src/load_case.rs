//! Loads grouped by their ramps.

use sinew_core::{LinearOperators, Load, Ramp};

/// Loads with one ramp, as their sum.
#[derive(Clone, Debug)]
pub(crate) struct LoadCase {
    /// The factor over time.
    pub(crate) ramp: Ramp,
    /// The force (N) on each degree of freedom.
    pub(crate) force: Vec<f64>,
}

impl LoadCase {
    /// The loads of a system, those with equal ramps added up.
    pub(crate) fn of(operators: &LinearOperators) -> Vec<Self> {
        Self::of_loads(operators, operators.loads().iter())
    }

    /// The load cases through which positions of supports act.
    #[cfg(feature = "implicit")]
    pub(crate) fn of_places(operators: &LinearOperators) -> Vec<Self> {
        let is_place = |load: &&Load| matches!(load.ramp, Ramp::Position(_));
        Self::of_loads(operators, operators.loads().iter().filter(is_place))
    }

    fn of_loads<'a>(
        operators: &LinearOperators,
        loads: impl Iterator<Item = &'a Load>,
    ) -> Vec<Self> {
        let mut cases: Vec<Self> = Vec::new();
        for load in loads {
            let at = cases
                .iter()
                .position(|case| &case.ramp == load.ramp.course());
            let at = at.unwrap_or_else(|| {
                cases.push(Self {
                    ramp: load.ramp.course().clone(),
                    force: vec![0.0; operators.dofs()],
                });
                cases.len() - 1
            });
            for &(dof, force) in &load.entries {
                cases[at].force[dof as usize] += force;
            }
        }
        cases.retain(|case| case.force.iter().any(|force| *force != 0.0));
        cases
    }

    /// Largest size of the ramp.
    pub(crate) fn peak(&self) -> f64 {
        match &self.ramp {
            Ramp::Table { values, .. } | Ramp::Hold { values, .. } => {
                values.iter().fold(0.0, |peak, x| x.abs().max(peak))
            }
            Ramp::Step | Ramp::Sin2 { .. } | Ramp::Sine { .. } | Ramp::Pulse { .. } => 1.0,
            Ramp::Rate(of) if matches!(**of, Ramp::Sine { .. }) => {
                of.angular_frequency().unwrap_or(1.0)
            }
            // Half of what it rises and falls by.
            Ramp::Rate(_) => 0.5 * self.ramp.variation(),
            Ramp::Linear
            | Ramp::Input(_)
            | Ramp::InputRate(_)
            | Ramp::Scaled(..)
            | Ramp::Position(_) => 1.0,
        }
    }
}
