//! Sums of a system's matrices as one matrix.

use sinew_core::{BlockMatrix, LinearOperators};

/// D = alpha M + beta K + extra as one matrix, computed on each call.
pub(crate) fn damping_matrix(operators: &LinearOperators) -> BlockMatrix {
    let damping = operators.damping();
    let mut whole = stiffness_and_dashpots(operators, damping.stiffness, 1.0);
    let layers = whole.layers().count();
    for cell in 0..whole.pattern().cells() {
        let mut diagonal = vec![0.0; layers * layers];
        for layer in 0..layers {
            diagonal[layer * (layers + 1)] = damping.mass * operators.mass()[cell * layers + layer];
        }
        let added = whole.add_block(cell as u32, cell as u32, &diagonal);
        debug_assert_eq!(added, Ok(()));
    }
    whole
}

/// `of_stiffness K + of_dashpots extra` as one matrix, computed on each call.
pub(crate) fn stiffness_and_dashpots(
    operators: &LinearOperators,
    of_stiffness: f64,
    of_dashpots: f64,
) -> BlockMatrix {
    let mut sum = BlockMatrix::clone(operators.stiffness());
    sum.scale_rows(&vec![of_stiffness; operators.dofs()]);
    if let Some(dashpots) = &operators.damping().extra {
        let mut scaled = BlockMatrix::clone(dashpots);
        scaled.scale_rows(&vec![of_dashpots; operators.dofs()]);
        for cell in 0..sum.pattern().cells() {
            for (column, block) in scaled.row_blocks(cell) {
                let added = sum.add_block(cell as u32, column as u32, block);
                debug_assert_eq!(added, Ok(()));
            }
        }
    }
    sum
}
