//! Manufactured solution u = a sin(pi x) sin(pi y) sin(pi z) on the unit cube, held on its surface
//! (Roache, J. Fluids Eng. 124, 2002): how fast the errors fall as the mesh is refined.
//!
//! The body force is integrated with the shape functions, not lumped: lumping hides errors of its own
//! among those of the element. Which way `a` points matters on a mesh whose diagonals all point one way;
//! along them, a = (1, 1, 1), the errors fall faster than anywhere else.

use std::f64::consts::PI;

use crate::common::{body, build, figure, held, linear, on_cells, solve};
use nalgebra::{Matrix3, Vector3};
use sinew_fem::tetra::lame;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;
const AMPLITUDE: Vector3<f64> = Vector3::new(1.0, -0.4, 0.3);
/// Cells along each edge of the meshes.
const MESHES: [usize; 4] = [4, 8, 12, 16];

/// The sines or cosines of pi x_i.
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
fn displacement_gradient(x: &Vector3<f64>) -> Matrix3<f64> {
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

/// Barycentric points and weights of the rule of degree 7 of Grundmann and Moeller, SIAM J. Numer.
/// Anal. 15(2), 1978.
fn quadrature() -> Vec<([f64; 4], f64)> {
    const S: i32 = 3;
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    let mut rule = Vec::new();
    for i in 0..=S {
        let (degree, side) = (2 * S + 1, 2 * S + 4 - 2 * i);
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let scale = 6.0 * sign / 4.0_f64.powi(S);
        let weight =
            scale * f64::from(side).powi(degree) / factorial(i) / factorial(degree + 3 - i);
        for a in 0..=S - i {
            for b in 0..=S - i - a {
                for c in 0..=S - i - a - b {
                    let corners = [a, b, c, S - i - a - b - c];
                    rule.push((
                        corners.map(|k| f64::from(2 * k + 1) / f64::from(side)),
                        weight,
                    ));
                }
            }
        }
    }
    rule
}

/// A point of a tetrahedron given by the weights of its vertices.
fn mean(vertices: &[Vector3<f64>; 4], weights: &[f64; 4]) -> Vector3<f64> {
    vertices
        .iter()
        .zip(weights)
        .map(|(x, weight)| x * *weight)
        .sum()
}

/// Columns: the values at the last three vertices less the one at the first.
fn differences([first, second, third, fourth]: &[Vector3<f64>; 4]) -> Matrix3<f64> {
    Matrix3::from_columns(&[second - first, third - first, fourth - first])
}

/// The integral of the body force times each shape function.
fn consistent_load(mesh: &TetMesh, lame: (f64, f64)) -> Vec<Vector3<f64>> {
    let rule = quadrature();
    let mut load = vec![Vector3::zeros(); mesh.points.len()];
    for (tet, volume) in mesh.tets.iter().zip(mesh.signed_volumes()) {
        let vertices = tet.map(|node| Vector3::from(mesh.points[node as usize]));
        for (shape, weight) in &rule {
            let force = body_force(&mean(&vertices, shape), lame) * (weight * volume);
            for (node, value) in tet.iter().zip(shape) {
                load[*node as usize] += force * *value;
            }
        }
    }
    load
}

/// Norm of the error in L2, seminorm in H1.
fn errors(cells: usize, poissons_ratio: f64) -> [f64; 2] {
    let mesh = structured::cube(cells, 1.0, Split::Kuhn).unwrap();
    let mut problem = body(linear(YOUNGS_MODULUS, poissons_ratio));
    problem.fixed = ["sides", "top", "bottom"].map(held).to_vec();
    let model = build(&mesh, &problem);
    let load = consistent_load(&mesh, lame(YOUNGS_MODULUS, poissons_ratio));
    let u = solve(&model, &on_cells(&model, |node| load[node].into()));

    let rule = quadrature();
    let (mut values, mut slopes) = (0.0, 0.0);
    for (tet, volume) in mesh.tets.iter().zip(mesh.signed_volumes()) {
        let vertices = tet.map(|node| Vector3::from(mesh.points[node as usize]));
        let moved = tet.map(|node| Vector3::from(model.node_displacement(0.0, &u, node).unwrap()));
        let slope = differences(&moved) * differences(&vertices).try_inverse().unwrap();
        for (shape, weight) in &rule {
            let x = mean(&vertices, shape);
            let share = weight * volume;
            values += share * (mean(&moved, shape) - displacement(&x)).norm_squared();
            slopes += share * (slope - displacement_gradient(&x)).norm_squared();
        }
    }
    [values.sqrt(), slopes.sqrt()]
}

/// Compares the orders of convergence from mesh to mesh, in L2 and H1.
fn converges(poissons_ratio: f64, expected: [[f64; 2]; 3], tolerance: f64) {
    let reached = MESHES.map(|cells| errors(cells, poissons_ratio));
    for (step, expected) in expected.into_iter().enumerate() {
        let (coarse, fine) = (MESHES[step], MESHES[step + 1]);
        let refinement = (fine as f64 / coarse as f64).ln();
        for (norm, name) in ["L2", "H1"].into_iter().enumerate() {
            let rate = (reached[step][norm] / reached[step + 1][norm]).ln() / refinement;
            let name = format!("nu = {poissons_ratio}, {coarse} to {fine} cells: order in {name}");
            figure(&name, rate, expected[norm], tolerance);
        }
    }
}

#[test]
fn quadrature_is_exact_to_degree_seven() {
    // The mean of x^a y^b z^c over the unit tetrahedron is 6 a! b! c!/(a + b + c + 3)!.
    let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
    for (a, b, c) in [(0, 0, 0), (7, 0, 0), (2, 3, 2), (0, 1, 4)] {
        let expected = 6.0 * factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
        let terms = quadrature()
            .into_iter()
            .map(|([x, y, z, _], weight)| weight * x.powi(a) * y.powi(b) * z.powi(c));
        figure(
            &format!("mean of x^{a} y^{b} z^{c}"),
            terms.sum(),
            expected,
            1e-14,
        );
    }
}

#[test]
fn errors_fall_at_the_orders_of_linear_elements() {
    converges(0.3, [[1.74, 0.93], [1.88, 0.98], [1.94, 0.99]], 0.006);
}

/// Locking: the order in L2 falls short of 2.
#[test]
fn near_incompressibility_costs_half_an_order() {
    converges(0.49, [[1.4, 0.9], [1.4, 0.95], [1.4, 1.0]], 0.05);
}
