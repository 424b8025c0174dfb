//! The cube that all programs simulate.

use serde_json::json;
use sinew_core::LinearSystem;
use sinew_fem::{Element, LoadKind, Model};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};
use sinew_verify::bodies::load;
use sinew_verify::{LabError, tissue};

/// Simulated time (s).
pub(super) const DURATION: f64 = 0.5;

/// Instants at which displacements are compared.
pub(super) const INSTANTS: usize = 10;

/// Poisson's ratio.
const POISSONS_RATIO: f64 = 0.45;

/// Cases with the sudden dead traction (Pa) on the top, upwards.
const CASES: [(&str, f64); 2] = [("pulled", 600.0), ("pressed", -300.0)];

/// The laws that other simulators have.
const LAWS: [&str; 2] = ["stvk", "stable-neo-hookean-log"];

/// A cube of soft tissue that stands on its bottom and is pulled or pressed at its top, under each law.
pub struct SharedCube {
    mesh: TetMesh,
    pub(super) bodies: Vec<CubeBody>,
    pub(super) laps: usize,
}

/// The cube in one case under one law.
pub(super) struct CubeBody {
    pub(super) case: &'static str,
    pub(super) law: &'static str,
    pub(super) model: Model,
    /// Nodes, fixed ones included.
    pub(super) nodes: usize,
}

impl SharedCube {
    /// The cube of 6000 tetrahedra, or a small one to check that everything runs.
    ///
    /// # Errors
    /// [`LabError`].
    pub fn new(is_quick: bool) -> Result<Self, LabError> {
        let (cells, laps) = if is_quick { (4, 1) } else { (10, 3) };
        let mesh = cube(cells, tissue::EDGE, Split::Kuhn)?;
        let mut bodies = Vec::new();
        for (case, traction) in CASES {
            for law in LAWS {
                let of = tissue::law(law, tissue::YOUNGS_MODULUS, POISSONS_RATIO);
                let mut problem = tissue::standing(of, Element::P1);
                let pull = LoadKind::Traction([0.0, 0.0, traction]);
                problem.loads = vec![load("top", pull)];
                bodies.push(CubeBody {
                    case,
                    law,
                    model: Model::build(&mesh, &problem)?,
                    nodes: mesh.points.len(),
                });
            }
        }
        Ok(Self { mesh, bodies, laps })
    }

    /// The file that scripts of other programs read: mesh, masses, moduli, loads of each case, all in SI units.
    #[must_use]
    pub fn json(&self) -> Vec<u8> {
        // Masses, supports and loads are the same under all laws.
        let mut cases = self.bodies.iter().filter(|body| body.law == LAWS[0]);
        let forces = cases
            .clone()
            .map(|body| json!({ "name": body.case, "forces_n": body.forces() }));
        let forces: Vec<_> = forces.collect();
        let body = cases.next();
        json!({
            "points_m": self.mesh.points,
            "tets": self.mesh.tets,
            "fixed": body.map(CubeBody::fixed),
            "mass_kg": body.map(CubeBody::masses),
            "youngs_modulus_pa": tissue::YOUNGS_MODULUS,
            "poissons_ratio": POISSONS_RATIO,
            "duration_s": DURATION,
            "instants": INSTANTS,
            "laps": self.laps,
            "cases": forces,
        })
        .to_string()
        .into_bytes()
    }
}

impl CubeBody {
    /// Values of degrees of freedom by node, 0 at fixed nodes.
    pub(super) fn by_node(&self, values: &[f64]) -> Vec<f64> {
        let mut by_node = vec![0.0; 3 * self.nodes];
        for (node, values) in self.model.nodes().iter().zip(values.chunks(3)) {
            let first = 3 * *node as usize;
            by_node[first..first + 3].copy_from_slice(values);
        }
        by_node
    }

    fn fixed(&self) -> Vec<usize> {
        let mut is_free = vec![false; self.nodes];
        for node in self.model.nodes() {
            is_free[*node as usize] = true;
        }
        let nodes = is_free.iter().enumerate();
        nodes
            .filter(|(_, free)| !**free)
            .map(|(node, _)| node)
            .collect()
    }

    /// Mass (kg) of each node, 0 if it is fixed.
    fn masses(&self) -> Vec<f64> {
        let by_node = self.by_node(self.model.operators().mass());
        by_node.chunks(3).map(|mass| mass[0]).collect()
    }

    /// Forces (N) of each node, 0 if it is fixed.
    fn forces(&self) -> Vec<[f64; 3]> {
        let by_node = self.by_node(&sinew_verify::bodies::loads(&self.model));
        let (forces, _) = by_node.as_chunks();
        forces.to_vec()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    #[test]
    fn the_file_has_the_whole_load_and_the_mass_of_what_moves() {
        let cube = SharedCube::new(true).unwrap();
        let file: Value = serde_json::from_slice(&cube.json()).unwrap();
        assert_eq!(file["points_m"].as_array().unwrap().len(), 125);
        assert_eq!(file["tets"].as_array().unwrap().len(), 6 * 64);
        assert_eq!(file["fixed"].as_array().unwrap().len(), 25);
        let masses = file["mass_kg"].as_array().unwrap().iter();
        let mass: f64 = masses.map(|mass| mass.as_f64().unwrap()).sum();
        // The nodes of the bottom have an eighth of it.
        assert!((mass - 1.06 * 7.0 / 8.0).abs() < 1e-9, "{mass}");
        for (case, expected) in [(0, 6.0), (1, -3.0)] {
            let forces = file["cases"][case]["forces_n"].as_array().unwrap().iter();
            let force: f64 = forces.map(|force| force[2].as_f64().unwrap()).sum();
            assert!((force - expected).abs() < 1e-9, "{force}");
        }
    }
}
