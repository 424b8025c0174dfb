//! Tissue properties that a cut needs.

/// Properties of the tetrahedra of a body.
pub trait TetProperties: Send + Sync {
    /// Mass density (kg/m^3) of a tetrahedron (0-based).
    fn density(&self, tet: usize) -> f64;

    /// The largest frequency (1/s) at which a tetrahedron (0-based) with these vertices (m) would swing its own mass:
    /// snapping keeps it bounded. 0 if no bound is needed.
    fn frequency(&self, tet: usize, vertices: &[[f64; 3]; 4]) -> f64;
}
