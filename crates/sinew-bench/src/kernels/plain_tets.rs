//! A plain scalar loop over deformed tetrahedra, of about forty lines, for comparison.

use sinew_core::LinearSystem;
use sinew_fem::{Model, tetra};
use sinew_mesh::TetMesh;

/// Central difference for plain neo-Hookean tetrahedra in f64: one after the other, each force added to its nodes.
pub(super) struct PlainTets {
    nodes: Vec<[usize; 4]>,
    /// Gradients (1/m) of the last three shape functions.
    gradients: Vec<[[f64; 3]; 3]>,
    /// Volumes (m^3).
    volumes: Vec<f64>,
    lame: [f64; 2],
    /// Inverse masses (1/kg), 0 at fixed nodes.
    inverse: Vec<f64>,
    /// Loads (N).
    loads: Vec<[f64; 3]>,
    u: Vec<[f64; 3]>,
    v: Vec<[f64; 3]>,
    force: Vec<[f64; 3]>,
}

impl PlainTets {
    /// Number of operations of a step for a tetrahedron: 9 differences of corners, H (45), F (3), its cofactor (27), J
    /// (5), the law (7, a division as one), the stress (27), three corners (45) and the fourth (9), and 12 sums at
    /// nodes.
    pub(super) const OPERATIONS: f64 = 189.0;

    /// The tetrahedra of a mesh with the masses, supports and constant loads of a model, and Lame's constants (Pa).
    pub(super) fn new(mesh: &TetMesh, model: &Model, lame: [f64; 2]) -> Self {
        let count = mesh.points.len();
        let (mut inverse, mut loads) = (vec![0.0; count], vec![[0.0; 3]; count]);
        let operators = model.operators();
        for (cell, node) in model.nodes().iter().enumerate() {
            inverse[*node as usize] = 1.0 / operators.mass()[3 * cell];
        }
        for (dof, force) in operators.loads().iter().flat_map(|load| &load.entries) {
            let node = model.nodes()[*dof as usize / 3] as usize;
            loads[node][*dof as usize % 3] += force;
        }
        let mut plain = Self {
            nodes: mesh
                .tets
                .iter()
                .map(|tet| tet.map(|node| node as usize))
                .collect(),
            gradients: Vec::new(),
            volumes: (0..mesh.tets.len()).map(|tet| mesh.volume(tet)).collect(),
            lame,
            inverse,
            loads,
            u: vec![[0.0; 3]; count],
            v: vec![[0.0; 3]; count],
            force: vec![[0.0; 3]; count],
        };
        for nodes in &plain.nodes {
            let vertices = nodes.map(|node| mesh.points[node]);
            let [_, others @ ..] = tetra::gradients(&vertices).unwrap_or_default();
            plain.gradients.push(others);
        }
        plain
    }

    /// Starts from rest with velocities half a step of `dt` (s) behind.
    pub(super) fn begin(&mut self, dt: f64) {
        for ((v, load), inverse) in self.v.iter_mut().zip(&self.loads).zip(&self.inverse) {
            *v = load.map(|load| -0.5 * dt * inverse * load);
        }
    }

    /// Takes steps of `dt` (s).
    pub(super) fn steps(&mut self, steps: usize, dt: f64) {
        for _ in 0..steps {
            self.force.copy_from_slice(&self.loads);
            for tet in 0..self.nodes.len() {
                self.subtract_force(tet);
            }
            for node in 0..self.u.len() {
                for axis in 0..3 {
                    self.v[node][axis] += dt * self.inverse[node] * self.force[node][axis];
                    self.u[node][axis] += dt * self.v[node][axis];
                }
            }
        }
    }

    fn subtract_force(&mut self, tet: usize) {
        let ([a, b, c, d], [g, h, k]) = (self.nodes[tet], self.gradients[tet]);
        let [lambda, mu] = self.lame;
        let volume = self.volumes[tet];
        let mut f = [[0.0; 3]; 3];
        for (row, f) in f.iter_mut().enumerate() {
            let own = self.u[a][row];
            let [x, y, z] = [b, c, d].map(|node| self.u[node][row] - own);
            for (column, f) in f.iter_mut().enumerate() {
                *f = x * g[column] + y * h[column] + z * k[column];
            }
            f[row] += 1.0;
        }
        let cofactor = [cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])];
        let ratio = f[0][0] * cofactor[0][0] + f[0][1] * cofactor[0][1] + f[0][2] * cofactor[0][2];
        let of_volume = volume * (lambda * (ratio - 1.0) - mu / ratio);
        let of_shape = volume * mu;
        for row in 0..3 {
            let p = [0, 1, 2].map(|i| of_shape * f[row][i] + of_volume * cofactor[row][i]);
            let on = |g: [f64; 3]| p[0] * g[0] + p[1] * g[1] + p[2] * g[2];
            let forces = [on(g), on(h), on(k)];
            self.force[a][row] += forces[0] + forces[1] + forces[2];
            for (node, force) in [b, c, d].into_iter().zip(forces) {
                self.force[node][row] -= force;
            }
        }
    }

    /// Displacements (m) of the cells of a model.
    pub(super) fn of_cells<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = f64> + 'a {
        model.nodes().iter().flat_map(|node| self.u[*node as usize])
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
