//! Candidate modes.

use crate::load_case::LoadCase;

/// A mode that may be taken.
#[derive(Debug)]
pub(super) struct CandidateMode {
    /// omega^2 (1/s^2); 0 exactly for a rigid motion.
    pub(super) squared: f64,
    /// Its components along the columns of [`CandidateModes::columns`].
    pub(super) vector: Vec<f64>,
    /// Each load case's force on it, its mass being 1.
    pub(super) forces: Vec<f64>,
}

impl CandidateMode {
    fn is_rigid(&self) -> bool {
        self.squared == 0.0
    }

    /// The squared size of its static response to all load cases.
    fn excitation(&self, cases: &[LoadCase]) -> f64 {
        let forces = self.forces.iter().zip(cases);
        let response = forces.map(|(force, case)| (case.peak() * force / self.squared).powi(2));
        response.sum()
    }
}

/// Modes that may be taken.
#[derive(Debug)]
pub(super) struct CandidateModes {
    /// M^1/2 times a basis, orthonormal.
    pub(super) columns: Vec<f64>,
    /// Slowest first.
    pub(super) modes: Vec<CandidateMode>,
}

/// Rigid motions, then the most excited modes, or the slowest without loads.
pub(super) fn most_excited(
    mut modes: Vec<CandidateMode>,
    cases: &[LoadCase],
    count: usize,
) -> Vec<CandidateMode> {
    let rigid = modes.iter().filter(|mode| mode.is_rigid()).count();
    if !cases.is_empty() {
        let rank = |mode: &CandidateMode| match mode.is_rigid() {
            true => f64::INFINITY,
            false => mode.excitation(cases),
        };
        modes.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    }
    modes.truncate(count.max(rigid));
    modes
}
