//! A soft cube on the ground, pressed from above, with one flat tetrahedron in it.

use sinew_core::{OptionValue, Options};
use sinew_fem::{LoadKind, LoadSpec, Model, Problem, Rayleigh};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

use super::tissue::{body, held, linear};

pub(crate) fn model(mesh: &TetMesh, damping: Rayleigh) -> Model {
    let problem = Problem {
        damping,
        fixed: vec![held("bottom", [true; 3])],
        loads: vec![LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, -20.0]))],
        ..body(linear(3500.0, 0.3))
    };
    Model::build(mesh, &problem).unwrap()
}

pub(crate) const MASS_DAMPING: Rayleigh = Rayleigh::new(20.0, 0.0);

/// A cube of edge .1 m with one vertex moved towards the opposite face of one tetrahedron until
/// that is `thinness` times thinner.
pub(crate) fn with_sliver(thinness: f64) -> TetMesh {
    let mut mesh = structured::cube(6, 0.1, Split::Kuhn).unwrap();
    let inside = |node: u32| {
        mesh.points[node as usize]
            .iter()
            .all(|x| *x > 0.02 && *x < 0.08)
    };
    let element = mesh
        .tets
        .iter()
        .position(|tet| tet.iter().all(|node| inside(*node)))
        .unwrap();
    let [a, b, c, apex] = mesh.tets[element].map(|node| mesh.points[node as usize]);
    // Towards the centre of the face, so that elements beside the face stay as they are.
    let centre: [f64; 3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
    let moved = std::array::from_fn(|i| centre[i] + (apex[i] - centre[i]) / thinness);
    let node = mesh.tets[element][3] as usize;
    mesh.points[node] = moved;
    mesh
}

/// `patches = "auto"`.
pub(crate) fn auto() -> Options {
    Options::new().with("patches", OptionValue::Text("auto".into()))
}
