//! All modes of a small system together.

use sinew_core::LinearOperators;

use super::candidate::{CandidateMode, CandidateModes};
use crate::implicit::factor::symmetric_eigen;
use crate::implicit::factor_error::FactorError;
use crate::load_case::LoadCase;

/// Degrees of freedom up to which all modes are computed together: a selection would cost more than it saves.
pub(super) const SMALL: usize = 256;

/// Ratio of omega^2 to the largest omega^2 that counts as zero.
const RIGID: f64 = 1e-12;

/// The eigenvectors of `M^-1/2 K M^-1/2` on the free components.
pub(super) fn all_modes(
    operators: &LinearOperators,
    cases: &[LoadCase],
    held: &[bool],
) -> Result<CandidateModes, FactorError> {
    let free: Vec<usize> = (0..held.len()).filter(|dof| !held[*dof]).collect();
    let (n, m) = (held.len(), free.len());
    let mut place = vec![usize::MAX; n];
    for (at, dof) in free.iter().enumerate() {
        place[*dof] = at;
    }
    let root: Vec<f64> = operators.mass().iter().map(|mass| mass.sqrt()).collect();
    let stiffness = operators.stiffness();
    let layers = stiffness.layers().count();
    let mut matrix = vec![0.0; m * m];
    for (at, dof) in free.iter().enumerate() {
        for (other, block) in stiffness.row_blocks(dof / layers) {
            let row = &block[dof % layers * layers..][..layers];
            for (layer, entry) in row.iter().enumerate() {
                let column = other * layers + layer;
                if place[column] < m {
                    matrix[place[column] * m + at] = entry / (root[*dof] * root[column]);
                }
            }
        }
    }
    let (squares, vectors) = symmetric_eigen(&matrix, m)?;
    let largest = squares.last().copied().unwrap_or(0.0);
    let mut columns = vec![0.0; n * m];
    for (at, dof) in free.iter().enumerate() {
        columns[at * n + dof] = 1.0;
    }
    let modes = squares.iter().zip(vectors.chunks_exact(m.max(1)));
    let modes = modes.map(|(squared, vector)| CandidateMode {
        squared: if *squared <= RIGID * largest {
            0.0
        } else {
            *squared
        },
        forces: cases
            .iter()
            .map(|case| {
                let parts = free.iter().zip(vector);
                parts
                    .map(|(dof, y)| case.force[*dof] / root[*dof] * y)
                    .sum()
            })
            .collect(),
        vector: vector.to_vec(),
    });
    Ok(CandidateModes {
        modes: modes.collect(),
        columns,
    })
}
