//! Sums of a system's matrices as one matrix.

use sinew_core::{BlockMatrix, LinearOperators};

/// D = alpha M + beta K + extra as one matrix, computed on each call.
pub(crate) fn damping_matrix(operators: &LinearOperators) -> BlockMatrix {
    let damping = operators.damping();
    let mut whole = stiffness_and_dashpots(operators, damping.stiffness, 1.0);
    let layers = whole.layers().count();
    for (cell, mass) in operators.mass().chunks_exact(layers).enumerate() {
        // Every row of a pattern has its own cell.
        let blocks = whole.row_blocks_mut(cell);
        for (_, block) in blocks.filter(|(column, _)| *column == cell) {
            let diagonal = block.iter_mut().step_by(layers + 1);
            for (entry, mass) in diagonal.zip(mass) {
                *entry += damping.mass * mass;
            }
        }
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
        for cell in 0..sum.pattern().cells() {
            // Both have one pattern (`LinearOperators::new`).
            let blocks = sum.row_blocks_mut(cell).zip(dashpots.row_blocks(cell));
            for ((_, block), (_, added)) in blocks {
                for (entry, added) in block.iter_mut().zip(added) {
                    *entry += of_dashpots * added;
                }
            }
        }
    }
    sum
}
