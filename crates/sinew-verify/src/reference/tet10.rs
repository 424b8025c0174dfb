//! The 10-node tetrahedron with quadratic displacement and straight edges.
//!
//! It bends without locking and has little volumetric locking, so that its figures converge fast. It shares only sparse
//! matrices and their factors with the library's elements.

use std::collections::BTreeMap;
use std::sync::Arc;

use sinew_core::{BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Pattern};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;

use crate::error::LabError;
use crate::modes::lowest_omega;
use crate::vector::{cross, difference, dot, norm};

/// Corners of the edges, in the order of the nodes 4 to 9.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Barycentric coordinates of four points of equal weight, each near one corner: a rule that is exact for polynomials
/// of degree 2 (Hammer, Marlowe and Stroud, Math. Tables Aids Comput. 10, 1956), such as the energy of straight
/// elements.
const NEAR: f64 = 0.585_410_196_624_968_5;
const FAR: f64 = 0.138_196_601_125_010_5;

/// A body of 10-node tetrahedra.
pub struct Tet10 {
    /// Positions (m) of the nodes: those of the mesh, then the middles of its edges.
    pub points: Vec<[f64; 3]>,
    tets: Vec<[u32; 10]>,
    /// The node in the middle of each edge, by the edge's ends in increasing order.
    middles: BTreeMap<[u32; 2], u32>,
}

/// An isotropic linear material.
#[derive(Clone, Copy, Debug)]
pub struct Tissue {
    /// Young's modulus (Pa).
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density (kg/m^3).
    pub density: f64,
}

impl Tet10 {
    /// The body on the tetrahedra of a mesh.
    pub fn new(mesh: &TetMesh) -> Self {
        let mut points = mesh.points.clone();
        let mut middles = BTreeMap::new();
        let mut tets = Vec::with_capacity(mesh.tets.len());
        for tet in &mesh.tets {
            let mut nodes = [0; 10];
            nodes[..4].copy_from_slice(tet);
            for (node, [a, b]) in nodes[4..].iter_mut().zip(EDGES) {
                *node = *middles.entry(sorted([tet[a], tet[b]])).or_insert_with(|| {
                    let [a, b] = [a, b].map(|corner| mesh.points[tet[corner] as usize]);
                    points.push([0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0));
                    points.len() as u32 - 1
                });
            }
            tets.push(nodes);
        }
        Self {
            points,
            tets,
            middles,
        }
    }

    /// The force (N) on each node of a traction (Pa) on triangles of corners: a third of the force on each triangle
    /// acts on each middle of its edges and none on its corners, as follows from the integrals of quadratic shape
    /// functions.
    pub fn traction(&self, triangles: &[[u32; 3]], traction: [f64; 3]) -> Vec<[f64; 3]> {
        let mut force = vec![[0.0; 3]; self.points.len()];
        for triangle in triangles {
            let [a, b, c] = triangle.map(|node| self.points[node as usize]);
            let area = norm(cross(difference(b, a), difference(c, a))) / 2.0;
            for (first, second) in [(0, 1), (1, 2), (0, 2)] {
                let ends = sorted([triangle[first], triangle[second]]);
                if let Some(middle) = self.middles.get(&ends) {
                    for axis in 0..3 {
                        force[*middle as usize][axis] += area / 3.0 * traction[axis];
                    }
                }
            }
        }
        force
    }

    /// The body of this material with all nodes fixed at positions for which `is_held` is true.
    ///
    /// # Errors
    /// [`LabError`].
    pub fn held(
        &self,
        tissue: Tissue,
        is_held: impl Fn([f64; 3]) -> bool,
    ) -> Result<HeldTet10, LabError> {
        let mut moving = Vec::new();
        let cell_of: Vec<Option<u32>> = (0..)
            .zip(&self.points)
            .map(|(node, point)| {
                (!is_held(*point)).then(|| {
                    moving.push(node);
                    moving.len() as u32 - 1
                })
            })
            .collect();
        let cells = |tet: &[u32; 10]| -> Vec<(usize, u32)> {
            let nodes = tet.iter().enumerate();
            let cells = nodes.map(|(at, node)| Some((at, cell_of[*node as usize]?)));
            cells.flatten().collect()
        };
        let elements = self.tets.iter().map(|tet| {
            let cells = cells(tet).into_iter().map(|(_, cell)| cell);
            cells.collect::<Vec<u32>>()
        });
        let pattern = Arc::new(Pattern::from_elements(moving.len(), elements)?);
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::Three);
        let mut mass = BlockMatrix::zeros(pattern, Layers::Three);
        for tet in &self.tets {
            let element = Element::new([0, 1, 2, 3].map(|k| self.points[tet[k] as usize]), tissue);
            for (a, row) in cells(tet) {
                for (b, column) in cells(tet) {
                    stiffness.add_block(row, column, &element.stiffness(a, b))?;
                    let share = element.mass(a, b);
                    let block =
                        std::array::from_fn::<_, 9, _>(|k| if k % 4 == 0 { share } else { 0.0 });
                    mass.add_block(row, column, &block)?;
                }
            }
        }
        let unused = vec![1.0; stiffness.dofs()];
        let operators = LinearOperators::new(unused, stiffness, Damping::default(), Vec::new())?;
        Ok(HeldTet10 {
            system: LinearModel::new(operators),
            mass,
            moving,
        })
    }
}

/// A body of 10-node tetrahedra with its supports.
pub struct HeldTet10 {
    /// The stiffness of the free nodes. Its lumped mass has no meaning.
    system: LinearModel,
    /// The consistent mass (kg).
    mass: BlockMatrix,
    /// The free nodes.
    moving: Vec<usize>,
}

impl HeldTet10 {
    /// The displacement (m) of each node under a force (N) on each.
    ///
    /// # Errors
    /// [`LabError`].
    pub fn equilibrium(&self, force: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, LabError> {
        let acting: Vec<f64> = self.moving.iter().flat_map(|node| force[*node]).collect();
        let solution = static_solution(&self.system, &acting)?;
        let mut u = vec![[0.0; 3]; force.len()];
        for (node, values) in self.moving.iter().zip(solution.as_chunks().0) {
            u[*node] = *values;
        }
        Ok(u)
    }

    /// The lowest angular frequency (rad/s).
    ///
    /// # Errors
    /// [`LabError`].
    pub fn lowest_omega(&self) -> Result<f64, LabError> {
        lowest_omega(&self.system, |x, out| self.mass.multiply(x, out))
    }
}

/// The matrices of one element.
struct Element {
    /// Gradients (1/m) of the barycentric coordinates.
    slopes: [[f64; 3]; 4],
    volume: f64,
    lame: (f64, f64),
    density: f64,
}

impl Element {
    fn new([a, b, c, d]: [[f64; 3]; 4], tissue: Tissue) -> Self {
        let [p, q, r] = [b, c, d].map(|corner| difference(corner, a));
        let six_volumes = dot(p, cross(q, r));
        let [of_b, of_c, of_d] =
            [cross(q, r), cross(r, p), cross(p, q)].map(|v| v.map(|x| x / six_volumes));
        let of_a = [0, 1, 2].map(|axis| -(of_b[axis] + of_c[axis] + of_d[axis]));
        let mu = tissue.youngs_modulus / (2.0 * (1.0 + tissue.poissons_ratio));
        let lambda = 2.0 * mu * tissue.poissons_ratio / (1.0 - 2.0 * tissue.poissons_ratio);
        Self {
            slopes: [of_a, of_b, of_c, of_d],
            volume: six_volumes / 6.0,
            lame: (lambda, mu),
            density: tissue.density,
        }
    }

    /// Gradient (1/m) of a node's shape function: L (2 L - 1) at corners, 4 L L' at the middles.
    fn gradient(&self, node: usize, place: [f64; 4]) -> [f64; 3] {
        let combined = |p: f64, a: usize, q: f64, b: usize| {
            [0, 1, 2].map(|axis| p * self.slopes[a][axis] + q * self.slopes[b][axis])
        };
        match node.checked_sub(4).map(|edge| EDGES[edge]) {
            None => combined(4.0 * place[node] - 1.0, node, 0.0, node),
            Some([a, b]) => combined(4.0 * place[b], a, 4.0 * place[a], b),
        }
    }

    /// The block (N/m) of two nodes: the integral of `lambda g h' + mu h g' + mu g.h I` with their gradients g and h.
    fn stiffness(&self, a: usize, b: usize) -> [f64; 9] {
        let (lambda, mu) = self.lame;
        let mut block = [0.0; 9];
        for corner in 0..4 {
            let mut place = [FAR; 4];
            place[corner] = NEAR;
            let [g, h] = [a, b].map(|node| self.gradient(node, place));
            for (k, entry) in block.iter_mut().enumerate() {
                let (i, j) = (k / 3, k % 3);
                let along = if i == j { mu * dot(g, h) } else { 0.0 };
                *entry += self.volume / 4.0 * (lambda * g[i] * h[j] + mu * h[i] * g[j] + along);
            }
        }
        block
    }

    /// The consistent mass (kg) between two nodes.
    fn mass(&self, a: usize, b: usize) -> f64 {
        let ends = |node: usize| match node.checked_sub(4) {
            None => [node; 2],
            Some(edge) => EDGES[edge],
        };
        let shared = ends(a).iter().filter(|end| ends(b).contains(end)).count();
        let weight = match (a < 4, b < 4) {
            (true, true) if a == b => 6.0,
            (true, true) => 1.0,
            (false, false) => [8.0, 16.0, 32.0][shared],
            _ if shared > 0 => -4.0,
            _ => -6.0,
        };
        self.density * self.volume * weight / 420.0
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::*;

    const TISSUE: Tissue = Tissue {
        youngs_modulus: 3500.0,
        poissons_ratio: 0.45,
        density: 1060.0,
    };

    /// K u, with u given by a function of the position.
    fn forces(body: &Tet10, u: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let free = body.held(TISSUE, |_| false).unwrap();
        let u: Vec<f64> = body.points.iter().flat_map(|point| u(*point)).collect();
        let mut force = vec![0.0; u.len()];
        let operators = sinew_core::LinearSystem::operators(&free.system);
        operators.stiffness().multiply(&u, &mut force);
        force
    }

    fn distorted() -> Tet10 {
        let mut mesh = cube(3, 0.1, Split::Kuhn).unwrap();
        for (k, point) in mesh.points.iter_mut().enumerate() {
            point[k % 3] += 0.004 * (7.0 * k as f64).sin();
        }
        Tet10::new(&mesh)
    }

    #[test]
    fn rigid_motions_cost_no_force() {
        let body = distorted();
        for motion in [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, -2.0, 0.5]] {
            let [shift, x, y, z] = motion;
            let turned = |p: [f64; 3]| cross([x, y, z], p).map(|u| u + shift);
            let largest = forces(&body, turned)
                .into_iter()
                .fold(0.0, |max: f64, f| max.max(f.abs()));
            assert!(largest < 1e-11 * TISSUE.youngs_modulus, "{largest}");
        }
    }

    /// The element represents quadratic fields exactly: u = (x^2, 0, 0) has div sigma = (2 (lambda + 2 mu), 0, 0), and
    /// the work of the force in a rigid translation of inner nodes is the integral of div sigma.
    #[test]
    fn the_energy_of_a_quadratic_field_is_exact() {
        let mesh = cube(2, 1.0, Split::Kuhn).unwrap();
        let body = Tet10::new(&mesh);
        let u = |[x, y, _]: [f64; 3]| [x * x, x * y, 0.0];
        let energy: f64 = forces(&body, u)
            .iter()
            .zip(body.points.iter().flat_map(|p| u(*p)))
            .map(|(f, u)| 0.5 * f * u)
            .sum();
        // Strains: xx = 2 x, yy = x, xy = y/2. Integrals over the unit cube of 9 x^2 and 5 x^2 + y^2/2.
        let (mu, nu) = (3500.0 / 2.9, 0.45);
        let lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        let expected = lambda / 2.0 * 3.0 + mu * (5.0 / 3.0 + 1.0 / 6.0);
        assert!(
            (energy / expected - 1.0).abs() < 1e-12,
            "{energy} {expected}"
        );
    }

    #[test]
    fn the_mass_of_linear_velocities_is_that_of_the_body() {
        let mesh = cube(2, 0.1, Split::Kuhn).unwrap();
        let body = Tet10::new(&mesh).held(TISSUE, |_| false).unwrap();
        // Twice the kinetic energy with v = (x, 0, 0): the integral of rho x^2.
        let v: Vec<f64> = Tet10::new(&mesh)
            .points
            .iter()
            .flat_map(|p| [p[0], 0.0, 0.0])
            .collect();
        let mut momentum = vec![0.0; v.len()];
        body.mass.multiply(&v, &mut momentum);
        let twice: f64 = momentum.iter().zip(&v).map(|(p, v)| p * v).sum();
        let expected = TISSUE.density * 1e-5 / 3.0;
        assert!((twice / expected - 1.0).abs() < 1e-12, "{twice} {expected}");
    }
}
