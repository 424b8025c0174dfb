//! Orders of convergence of the plain tetrahedron.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use sinew_core::System;
use sinew_fem::tetra::lame;
use sinew_fem::{Element, Model};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{YOUNGS_MODULUS, body, held};
use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::quadrature::rule;
use crate::sources::PROTOTYPE;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "convergence",
    title: "How fast errors fall with the mesh",
    says: "Manufactured solution u = a sin(pi x) sin(pi y) sin(pi z), a = (1, -.4, .3), on the unit cube, held \
           on its surface (Roache, J. Fluids Eng. 124, 2002), by plain tetrahedra. The body force is integrated \
           with the shape functions, not lumped: lumping hides errors of its own among those of the element. \
           Where all diagonals point one way, errors along them fall faster than anywhere else, so a does not. \
           Near incompressibility locking costs half an order.",
    checks,
    quoted: &[],
};

const AMPLITUDE: Vector3<f64> = Vector3::new(1.0, -0.4, 0.3);

/// Cells along each edge of the meshes.
const MESHES: [usize; 4] = [4, 8, 12, 16];

/// Poisson's ratio, orders in L2 and H1 from mesh to mesh, and half a unit of their last digit.
const ORDERS: &[(f64, [[f64; 2]; 3], f64)] = &[
    (0.3, [[1.74, 0.93], [1.88, 0.98], [1.94, 0.99]], 0.006),
    (0.49, [[1.4, 0.9], [1.4, 0.95], [1.4, 1.0]], 0.05),
];

fn checks() -> Vec<Check> {
    let checks = ORDERS.iter().map(|&(nu, orders, tolerance)| {
        let figures = MESHES.windows(2).zip(orders).flat_map(|(meshes, orders)| {
            ["L2", "H1"]
                .into_iter()
                .zip(orders)
                .map(move |(norm, order)| {
                    let name = format!(
                        "order in {norm}, {} to {} cells a side",
                        meshes[0], meshes[1]
                    );
                    (name, Asked::value(order, tolerance))
                })
        });
        Check::several(format!("p1, nu = {nu}"), figures, PROTOTYPE, move |_| {
            let errors = MESHES.map(|cells| errors(cells, nu));
            let errors = errors.into_iter().collect::<Result<Vec<_>, _>>()?;
            let mut found = Vec::new();
            for (meshes, errors) in MESHES.windows(2).zip(errors.windows(2)) {
                let refinement = (meshes[1] as f64 / meshes[0] as f64).ln();
                found.extend(
                    [0, 1].map(|norm| (errors[0][norm] / errors[1][norm]).ln() / refinement),
                );
            }
            Ok(found)
        })
    });
    checks.collect()
}

fn sines(x: &Vector3<f64>) -> Vector3<f64> {
    x.map(|x| (PI * x).sin())
}

fn cosines(x: &Vector3<f64>) -> Vector3<f64> {
    x.map(|x| (PI * x).cos())
}

fn displacement(x: &Vector3<f64>) -> Vector3<f64> {
    AMPLITUDE * sines(x).product()
}

/// du_i/dx_j.
fn gradient(x: &Vector3<f64>) -> Matrix3<f64> {
    let (s, c) = (sines(x), cosines(x));
    let slopes = Vector3::new(c.x * s.y * s.z, s.x * c.y * s.z, s.x * s.y * c.z);
    AMPLITUDE * slopes.transpose() * PI
}

/// -(lambda + mu) grad div u - mu div grad u (N/m^3).
fn body_force(x: &Vector3<f64>, (lambda, mu): (f64, f64)) -> Vector3<f64> {
    let (s, c) = (sines(x), cosines(x));
    let curvature = |i, j| match i == j {
        true => -s.product(),
        false => c[i] * c[j] * s[3 - i - j],
    };
    let curvatures = Matrix3::from_fn(curvature) * (PI * PI);
    -(curvatures * AMPLITUDE * (lambda + mu) + AMPLITUDE * (mu * curvatures.trace()))
}

/// A point of a tetrahedron given by the weights of its vertices.
fn mean(vertices: &[Vector3<f64>; 4], weights: &[f64; 4]) -> Vector3<f64> {
    let pairs = vertices.iter().zip(weights);
    pairs.map(|(x, weight)| x * *weight).sum()
}

/// Columns: the values at the last three vertices less the one at the first.
fn differences([first, second, third, fourth]: &[Vector3<f64>; 4]) -> Matrix3<f64> {
    Matrix3::from_columns(&[second - first, third - first, fourth - first])
}

fn corners(mesh: &TetMesh, tet: usize) -> [Vector3<f64>; 4] {
    mesh.tets[tet].map(|node| Vector3::from(mesh.points[node as usize]))
}

/// Norm of the error in L2, seminorm in H1.
fn errors(cells: usize, nu: f64) -> Result<[f64; 2], LabError> {
    let mesh = cube(cells, 1.0, Split::Kuhn)?;
    let mut problem = body(YOUNGS_MODULUS, nu, Element::P1);
    problem.fixed = ["sides", "top", "bottom"]
        .map(|group| held(group, [true; 3]))
        .to_vec();
    let model = Model::build(&mesh, &problem)?;
    let rule = rule(3);
    let mut load = vec![[0.0; 3]; mesh.points.len()];
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let vertices = corners(&mesh, tet);
        for (shape, weight) in &rule {
            let force = body_force(&mean(&vertices, shape), lame(YOUNGS_MODULUS, nu));
            for (node, value) in nodes.iter().zip(shape) {
                for (sum, force) in load[*node as usize].iter_mut().zip(&force) {
                    *sum += weight * mesh.volume(tet) * value * force;
                }
            }
        }
    }
    let mut force = vec![0.0; model.dofs()];
    model.to_dofs(&load, &mut force)?;
    let mut moved = vec![[0.0; 3]; mesh.points.len()];
    model.to_nodes(&static_solution(&model, &force)?, &mut moved)?;
    let (mut values, mut slopes) = (0.0, 0.0);
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let vertices = corners(&mesh, tet);
        let moved = nodes.map(|node| Vector3::from(moved[node as usize]));
        let inverse = differences(&vertices).try_inverse();
        let slope = differences(&moved) * inverse.ok_or_else(LabError::no_body)?;
        for (shape, weight) in &rule {
            let x = mean(&vertices, shape);
            let share = weight * mesh.volume(tet);
            values += share * (mean(&moved, shape) - displacement(&x)).norm_squared();
            slopes += share * (slope - gradient(&x)).norm_squared();
        }
    }
    Ok([values.sqrt(), slopes.sqrt()])
}
