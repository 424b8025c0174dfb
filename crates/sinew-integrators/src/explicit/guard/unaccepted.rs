//! A system that is told of no step yet.

use sinew_core::{
    Energy, EvaluationError, Layers, LinearSystem, LoadTime, Revision, Scales, State, System, Trial,
};

/// The same system, except that it is not told of accepted steps: the guard tells it once the
/// result is clamped.
pub(super) struct Unaccepted<'a>(pub(super) &'a dyn System);

impl System for Unaccepted<'_> {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }

    fn mass(&self) -> &[f64] {
        self.0.mass()
    }

    fn revision(&self) -> Revision {
        self.0.revision()
    }

    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.0.net_force(trial, out)
    }

    fn external_force(&self, when: LoadTime, out: &mut [f64]) {
        self.0.external_force(when, out);
    }

    fn mass_damping(&self) -> f64 {
        self.0.mass_damping()
    }

    fn accept(&self, _state: &mut State) {}

    fn energy(&self, u: &[f64], v: &[f64]) -> Option<Energy> {
        self.0.energy(u, v)
    }

    fn inverted_elements(&self, u: &[f64]) -> Option<usize> {
        self.0.inverted_elements(u)
    }

    fn extent(&self) -> Option<f64> {
        self.0.extent()
    }

    fn scales(&self) -> Option<Scales<'_>> {
        self.0.scales()
    }

    fn layers(&self) -> Layers {
        self.0.layers()
    }

    fn cell_name(&self, dof: usize) -> String {
        self.0.cell_name(dof)
    }

    fn as_linear(&self) -> Option<&dyn LinearSystem> {
        self.0.as_linear()
    }
}
