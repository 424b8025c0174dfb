//! Sums over the steps of a pane.

use super::lights::Settling;

/// Sums over the steps of a pane, which go back with its motion.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    /// Displacement (m) before the last step, after a cut at its beginning, and halfway through the step.
    pub(super) before: Vec<f64>,
    pub(super) middle: Vec<f64>,
    pub(super) force: Vec<f64>,
    /// The last commanded pose of each tool.
    pub(super) led: Vec<Option<[f64; 6]>>,
    /// The impulse (N s) that each tool had received before the last step.
    pub(super) received: Vec<[f64; 3]>,
    /// Impulse on each tool (N s) and time (s) since the last picture.
    pub(super) impulses: Vec<[f64; 3]>,
    pub(super) span: f64,
    /// Impulse (N s) of the user's pull since the last picture.
    pub(super) pulled: [f64; 3],
    pub(super) saturated: u64,
    pub(super) steps: u64,
    pub(super) has_stepped: bool,
    /// Current kinetic energy, and the work of loads since the beginning (J).
    pub(super) kinetic: f64,
    pub(super) load_work: f64,
    pub(super) energies: Energies,
    pub(super) settling: Settling,
}

/// Energies (J), all of the same instant, and the work since the beginning.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Energies {
    pub(super) kinetic: f64,
    pub(super) elastic: f64,
    pub(super) loads: f64,
    pub(super) tools: f64,
    /// Energy added by cuts.
    pub(super) cuts: f64,
    /// Energy at the beginning.
    pub(super) first: f64,
    /// The largest energy or work so far.
    pub(super) scale: f64,
}

impl Energies {
    /// Energy minus that at the beginning, the work since then, and the energy added by cuts.
    pub(super) fn balance(&self) -> f64 {
        self.kinetic + self.elastic - self.first - self.loads - self.tools - self.cuts
    }
}

impl Sums {
    /// Before the first step of a body with so many degrees of freedom.
    pub(super) fn new(dofs: usize, tools: usize) -> Self {
        Self {
            before: vec![0.0; dofs],
            middle: vec![0.0; dofs],
            force: vec![0.0; dofs],
            led: vec![None; tools],
            received: vec![[0.0; 3]; tools],
            impulses: vec![[0.0; 3]; tools],
            span: 0.0,
            pulled: [0.0; 3],
            saturated: 0,
            steps: 0,
            has_stepped: false,
            kinetic: 0.0,
            load_work: 0.0,
            energies: Energies::default(),
            settling: Settling::default(),
        }
    }

    /// Resizes stored vectors to the length of a displacement, which a cut changes.
    pub(super) fn fit(&mut self, u: &[f64]) {
        if self.before.len() != u.len() {
            self.before = u.to_vec();
            self.middle = u.to_vec();
            self.force.resize(u.len(), 0.0);
        }
    }
}
