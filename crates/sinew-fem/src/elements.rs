//! The tetrahedra of a model, one by one.

use sinew_core::ElementStiffness;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::{SpringRule, springs, tetra};

/// How a tetrahedron resists, calibration included.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ElementLaw {
    Continuum {
        /// Lame's constants (Pa).
        lame: (f64, f64),
    },
    Springs {
        youngs_modulus: f64,
        rule: SpringRule,
    },
}

/// What is needed to make each tetrahedron's matrix again.
#[derive(Clone, Debug)]
pub(crate) struct Tetrahedra {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) tets: Vec<[u32; 4]>,
    tags: Vec<u64>,
    region_of: Vec<u32>,
    laws: Vec<ElementLaw>,
}

impl Tetrahedra {
    pub(crate) fn new(mesh: &TetMesh, region_of: &[usize], laws: Vec<ElementLaw>) -> Self {
        Self {
            points: mesh.points.clone(),
            tets: mesh.tets.clone(),
            tags: mesh.tet_tags.clone(),
            region_of: region_of.iter().map(|region| *region as u32).collect(),
            laws,
        }
    }

    pub(crate) fn name(&self, element: usize) -> String {
        match self.tags.get(element) {
            Some(tag) => format!("tetrahedron {tag}"),
            None => format!("tetrahedron number {element}"),
        }
    }

    /// Rows and columns of those vertices that are cells; held components are zero.
    pub(crate) fn stiffness(&self, element: usize, cells: &Cells, out: &mut ElementStiffness) {
        let tet = &self.tets[element];
        let whole = self.whole_matrix(element);
        let moving: Vec<(usize, u32)> = tet
            .iter()
            .enumerate()
            .filter_map(|(vertex, node)| Some((vertex, cells.of_node(*node)?)))
            .collect();
        // Position in the whole matrix of each row that is kept, and whether it is held.
        let rows: Vec<(usize, bool)> = moving
            .iter()
            .flat_map(|&(vertex, cell)| {
                (0..3).map(move |axis| (3 * vertex + axis, 3 * cell as usize + axis))
            })
            .map(|(row, dof)| (row, cells.pinned[dof]))
            .collect();
        out.cells.clear();
        out.cells.extend(moving.iter().map(|(_, cell)| *cell));
        out.matrix.clear();
        for &(row, row_held) in &rows {
            out.matrix.extend(rows.iter().map(|&(column, held)| {
                if row_held || held {
                    0.0
                } else {
                    whole[12 * row + column]
                }
            }));
        }
    }

    /// 12 x 12, row-major and vertex-major.
    fn whole_matrix(&self, element: usize) -> [f64; 144] {
        let tet = &self.tets[element];
        match self.laws[self.region_of[element] as usize] {
            ElementLaw::Continuum { lame: (lambda, mu) } => {
                let vertices = tet.map(|node| self.points[node as usize]);
                // Assembly refused flat tetrahedra.
                tetra::stiffness(&vertices, lambda, mu).unwrap_or([0.0; 144])
            }
            ElementLaw::Springs {
                youngs_modulus,
                rule,
            } => {
                let mut matrix = [0.0; 144];
                let parts = springs::of_tetrahedron(&self.points, tet, youngs_modulus, rule);
                for (spring, [a, b]) in parts.iter().zip(springs::EDGES) {
                    let (n, _) = springs::direction(&self.points, spring.nodes);
                    for (row, i) in [(a, 1.0), (b, -1.0)] {
                        for (column, j) in [(a, 1.0), (b, -1.0)] {
                            for at in 0..9 {
                                let entry = 12 * (3 * row + at / 3) + 3 * column + at % 3;
                                matrix[entry] += i * j * spring.stiffness * n[at / 3] * n[at % 3];
                            }
                        }
                    }
                }
                matrix
            }
        }
    }
}
