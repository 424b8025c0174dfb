//! Section about the matrices: their size and their highest frequency.

use sinew_core::LinearOperators;
use sinew_core::spectrum::Spectrum;

use super::section::PlanSection;
use crate::number::{bytes, count, short};

/// The figures of a plan about matrices.
pub(super) struct Matrices {
    /// The section.
    pub(super) section: PlanSection,
    /// 2/omega_max (s).
    pub(super) critical_step: f64,
    /// Memory (bytes).
    pub(super) bytes: usize,
}

impl Matrices {
    /// Counts the memory of matrices and solves for their highest frequency.
    pub(super) fn of(operators: &LinearOperators) -> Self {
        let (stiffness, extra) = (operators.stiffness(), &operators.damping().extra);
        let blocks = stiffness.pattern().blocks();
        let cells = stiffness.pattern().cells();
        let layers = operators.dofs() / cells.max(1);
        let number = size_of::<f64>();
        let values = blocks * layers * layers * number;
        let matrices = 1 + usize::from(extra.is_some());
        let pattern = blocks * size_of::<u32>() + (cells + 1) * size_of::<usize>();
        let memory = matrices * values + pattern + operators.dofs() * number;
        let critical_step = Spectrum::of(operators).critical_step();
        let names = if extra.is_some() { "K and D" } else { "K" };
        let lines = vec![
            "linear: assembled once, no loop over elements afterwards".to_owned(),
            format!(
                "{names} with {} of {layers} x {layers}, lumped M: {}",
                count(blocks, "block"),
                bytes(memory)
            ),
            format!("2/omega_max = {} s", short(critical_step)),
        ];
        Self {
            section: PlanSection::new("matrices", lines),
            critical_step,
            bytes: memory,
        }
    }
}
