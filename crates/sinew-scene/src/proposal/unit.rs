//! The length unit of a mesh, guessed from its extent.

use sinew_mesh::TetMesh;

/// A unit of length.
pub(super) struct Unit {
    /// Its name in the plural.
    pub(super) name: &'static str,
    /// Its length (m).
    pub(super) metres: f64,
}

/// Units, with the largest extent of a body for which each is chosen: no body in surgery is 5 m long.
const UNITS: [(f64, &str, f64); 3] = [
    (5.0, "metres", 1.0),
    (5e3, "millimetres", 1e-3),
    (f64::INFINITY, "micrometres", 1e-6),
];

impl Unit {
    pub(super) fn guessed(mesh: &TetMesh) -> Self {
        let (low, high) = mesh.bounding_box();
        let extent = (0..3)
            .map(|axis| high[axis] - low[axis])
            .fold(0.0, f64::max);
        let fits = UNITS.iter().find(|(greatest, ..)| extent <= *greatest);
        let (_, name, metres) = *fits.unwrap_or(&UNITS[0]);
        Self { name, metres }
    }
}
