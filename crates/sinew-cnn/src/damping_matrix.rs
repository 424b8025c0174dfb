//! The damping of a system as one matrix.

use sinew_core::{BlockMatrix, LinearOperators};

/// D = alpha M + beta K + extra as one matrix, made anew.
pub(crate) fn damping_matrix(operators: &LinearOperators) -> BlockMatrix {
    let damping = operators.damping();
    let mut whole = BlockMatrix::clone(operators.stiffness());
    whole.scale_rows(&vec![damping.stiffness; operators.dofs()]);
    let layers = whole.layers().count();
    for cell in 0..whole.pattern().cells() {
        let mut diagonal = vec![0.0; layers * layers];
        for layer in 0..layers {
            diagonal[layer * (layers + 1)] = damping.mass * operators.mass()[cell * layers + layer];
        }
        let added = whole.add_block(cell as u32, cell as u32, &diagonal);
        debug_assert_eq!(added, Ok(()));
        if let Some(extra) = &damping.extra {
            for (column, block) in extra.row_blocks(cell) {
                let added = whole.add_block(cell as u32, column as u32, block);
                debug_assert_eq!(added, Ok(()));
            }
        }
    }
    whole
}
