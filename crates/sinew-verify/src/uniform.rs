//! Bodies under uniform deformations, which every element represents exactly.

use sinew_core::vectors::{largest, noise};
use sinew_core::{ElasticLaw, LoadTime, System, Trial};
use sinew_fem::hyperelastic::Tensor;
use sinew_fem::{Element, Model, Problem};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

use crate::error::LabError;
use crate::places::on_surface;
use crate::vector::{cross, dot};

/// An element of each kind, with patches of the default size and of other sizes.
pub(crate) const ELEMENTS: [Element; 5] = [
    Element::P1,
    Element::Fbar { patch: None },
    Element::Fbar { patch: Some(12) },
    Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    },
    Element::FbarEdge {
        edge_share: 1.0,
        patch: Some(8),
    },
];

/// Name of an element, with the size of its patches if that is not the default.
pub(crate) fn name(element: Element) -> String {
    match element {
        Element::Fbar { patch: Some(patch) }
        | Element::FbarEdge {
            patch: Some(patch), ..
        } => format!("{element}, patches of {patch}"),
        element => element.to_string(),
    }
}

/// Edge (m) of the cubes.
pub(crate) const EDGE: f64 = 0.1;

/// A cube whose inner nodes are displaced at random.
pub(crate) fn uneven_cube(cells: usize, split: Split, seed: u64) -> Result<TetMesh, LabError> {
    let mut mesh = cube(cells, EDGE, split)?;
    let surface = on_surface(&mesh);
    let shifts = noise(3 * mesh.points.len(), seed);
    let moved = mesh.points.iter_mut().zip(shifts.as_chunks::<3>().0);
    for ((point, shift), _) in moved.zip(&surface).filter(|(_, outer)| !**outer) {
        for (x, shift) in point.iter_mut().zip(shift) {
            *x += 0.2 * EDGE / cells as f64 * shift;
        }
    }
    Ok(mesh)
}

/// A free body, uniformly deformed.
pub(crate) struct Uniform {
    pub(crate) model: Model,
    pub(crate) u: Vec<f64>,
}

impl Uniform {
    /// An uneven cube whose displacement has this gradient.
    pub(crate) fn new(problem: &Problem, h: Tensor<f64>) -> Result<Self, LabError> {
        let model = Model::build(&uneven_cube(3, Split::Kuhn, 1)?, problem)?;
        let at = |point: &[f64; 3]| {
            h.0.map(|row| (0..3).map(|axis| row[axis] * point[axis]).sum())
        };
        let field: Vec<[f64; 3]> = model.mesh().points.iter().map(at).collect();
        let mut u = vec![0.0; model.dofs()];
        model.to_dofs(&field, &mut u)?;
        Ok(Self { model, u })
    }

    /// Elastic energy (J), and the forces (N) of the body at its nodes.
    pub(crate) fn forces(&self) -> Result<(f64, Vec<f64>), LabError> {
        let (mut force, v) = (vec![0.0; self.u.len()], vec![0.0; self.u.len()]);
        let trial = Trial {
            load: LoadTime::at(0.0),
            dt: 0.0,
            u: &self.u,
            v: &v,
            internal: &[],
        };
        let found = self.model.elastic_force(&trial, &mut force)?;
        Ok((found.energy, force))
    }

    /// The sum of the forces (N) along an axis at the end of another axis.
    pub(crate) fn at_end(&self, force: &[f64], end: usize, axis: usize) -> f64 {
        let nodes = self
            .model
            .mesh()
            .points
            .iter()
            .zip(force.as_chunks::<3>().0);
        let nodes = nodes.filter(|(point, _)| point[end] > EDGE * (1.0 - 1e-9));
        nodes.map(|(_, force)| force[axis]).sum()
    }

    /// The largest force (N) within the body.
    pub(crate) fn within(&self, force: &[f64]) -> f64 {
        let surface = on_surface(self.model.mesh());
        let inner = force.as_chunks::<3>().0.iter().zip(&surface);
        let inner = inner.filter(|(_, outer)| !**outer);
        inner.fold(0.0, |most: f64, (force, _)| most.max(largest(force)))
    }

    /// The largest difference between any tetrahedron's stress and that of a first Piola-Kirchhoff stress, over the
    /// size of the latter.
    pub(crate) fn off(&self, h: Tensor<f64>, p: Tensor<f64>) -> Result<f64, LabError> {
        let f = h + Tensor::identity();
        let [a, b, c] = f.0;
        let volume = dot(a, cross(b, c));
        let cauchy = p.times_transposed(f).scaled(volume.recip()).0;
        let expected = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|(i, j)| cauchy[i][j]);
        let mut stress = vec![[0.0; 6]; self.model.mesh().tets.len()];
        self.model.stress(0.0, &self.u, &mut stress)?;
        let pairs = stress.iter().flat_map(|found| found.iter().zip(expected));
        let worst = pairs.fold(0.0, |most: f64, (found, expected)| {
            most.max((found - expected).abs())
        });
        Ok(worst / largest(&expected))
    }
}
