//! Bounds of frequencies and of K by its blocks that stay valid after any cut.

use nalgebra::{Matrix3, SMatrix};
use sinew_core::ElementBounds;

use super::Model;
use crate::material::Material;
use crate::tetra;

/// Margin for the rounding of eigenvalues.
const ROUNDING: f64 = 1e-12;

impl Model {
    /// Bounds from single tetrahedra, which stay valid after any cut along their faces. Checks each tetrahedron. `None`
    /// if a region is hyperelastic, so that its stiffness changes, or averages strain over tetrahedra that a cut
    /// separates.
    #[must_use]
    pub fn element_bounds(&self) -> Option<ElementBounds> {
        if self.large.is_some() || !self.body.smoothing.is_empty() {
            return None;
        }
        let mut bounds = ElementBounds {
            omega_max: 0.0,
            block_factor: 1.0,
        };
        for tet in 0..self.mesh.tets.len() {
            let vertices = tetra::vertices(&self.mesh.points, self.mesh.tets[tet]);
            bounds.omega_max = bounds.omega_max.max(self.tet_frequency(tet, &vertices));
            let material = &self.materials[self.region_of[tet] as usize];
            let scaled = by_blocks(&material.stiffness(&self.mesh, tet)?)?;
            if !is_bounded(&scaled, bounds.block_factor) {
                let factor = scaled.symmetric_eigenvalues().max();
                bounds.block_factor = bounds.block_factor.max(factor);
            }
        }
        bounds.omega_max *= 1.0 + ROUNDING;
        bounds.block_factor *= 1.0 + ROUNDING;
        Some(bounds)
    }

    /// The same model, whose frequencies and blocks are bounded by these numbers instead of being estimated.
    #[must_use]
    pub fn with_element_bounds(self, bounds: ElementBounds) -> Self {
        Self {
            operators: self.operators.with_element_bounds(bounds),
            ..self
        }
    }

    /// The largest frequency (1/s) at which a tetrahedron (0-based) with these vertices (m) would swing its own mass,
    /// at small strain. If density differs within a region, the least one counts. Infinite if the vertices lie in one
    /// plane.
    #[must_use]
    pub fn tet_frequency(&self, tet: usize, vertices: &[[f64; 3]; 4]) -> f64 {
        let region = self.region_of[tet] as usize;
        let density = self.report.regions[region].density[0];
        let frequency = self.materials[region].frequency(tet, vertices, density);
        frequency.unwrap_or(f64::INFINITY)
    }

    /// The data that determine [`Model::tet_frequency`], as a copy: they stay the same when the body is cut.
    pub(crate) fn tet_frequencies(&self) -> TetFrequencies {
        let regions = self.report.regions.iter();
        TetFrequencies {
            region_of: self.region_of.clone(),
            materials: self.materials.clone(),
            densities: regions.map(|region| region.density[0]).collect(),
        }
    }
}

/// The largest frequencies of tetrahedra.
pub(crate) struct TetFrequencies {
    region_of: Vec<u32>,
    materials: Vec<Material>,
    /// The least density (kg/m^3) of each region.
    densities: Vec<f64>,
}

impl TetFrequencies {
    /// The largest frequency (1/s) of a tetrahedron (0-based) with these vertices (m), same as
    /// [`Model::tet_frequency`].
    pub(crate) fn of(&self, tet: usize, vertices: &[[f64; 3]; 4]) -> f64 {
        let region = self.region_of[tet] as usize;
        let frequency = self.materials[region].frequency(tet, vertices, self.densities[region]);
        frequency.unwrap_or(f64::INFINITY)
    }
}

type ElementMatrix = SMatrix<f64, 12, 12>;

/// The matrix of a tetrahedron, scaled from both sides by the inverse roots of its blocks: its eigenvalues are those of `blockdiag(K)^-1 K`.
/// `None` if a block is singular.
fn by_blocks(matrix: &[f64; 144]) -> Option<ElementMatrix> {
    let mut scaled = ElementMatrix::from_row_slice(matrix);
    for vertex in 0..4 {
        let block: Matrix3<f64> = scaled.fixed_view::<3, 3>(3 * vertex, 3 * vertex).into();
        let inverse = block.cholesky()?.l().try_inverse()?;
        let rows = inverse * scaled.fixed_rows::<3>(3 * vertex);
        scaled.fixed_rows_mut::<3>(3 * vertex).copy_from(&rows);
        let columns = scaled.fixed_columns::<3>(3 * vertex) * inverse.transpose();
        scaled
            .fixed_columns_mut::<3>(3 * vertex)
            .copy_from(&columns);
    }
    Some(scaled)
}

/// True if no eigenvalue is larger than `bound`, except for rounding. This takes a small part of the time of
/// eigenvalues, and most tetrahedra of a mesh do not exceed the bound of those before.
fn is_bounded(matrix: &ElementMatrix, bound: f64) -> bool {
    let room = bound * (1.0 + ROUNDING / 2.0);
    let rest = ElementMatrix::from_diagonal_element(room) - matrix;
    rest.cholesky().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_bounded_by_its_largest_eigenvalue_and_by_none_below_it() {
        for skew in [0.0, 0.4, 0.9] {
            let vertices = [
                [0.0, 0.0, 0.0],
                [1.0, skew, 0.0],
                [skew, 1.0, 0.0],
                [0.3, 0.2, 1.0 - skew],
            ];
            let matrix = tetra::stiffness(&vertices, 9.0, 1.0).unwrap();
            let scaled = by_blocks(&matrix).unwrap();
            let largest = scaled.symmetric_eigenvalues().max();
            assert!(largest > 1.0 && largest <= 4.0, "{largest}");
            assert!(is_bounded(&scaled, largest), "{skew}");
            assert!(!is_bounded(&scaled, largest * (1.0 - 1e-11)), "{skew}");
        }
    }
}
