//! Patch test (Irons 1965; Zienkiewicz and Taylor, The Finite Element Method, chapter 9): distorted
//! tetrahedra reproduce every uniform strain.

use crate::common::{
    at_most, body, build, held, is_inside, jitter, linear, max_abs, on_cells, relative_difference,
    solve, stiffness_times,
};
use nalgebra::{Matrix3, Vector3};
use sinew_fem::tetra::lame;
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{GroupMembers, TetMesh};

const CELLS: usize = 5;
const EDGE: f64 = 0.1;
const YOUNGS_MODULUS: f64 = 3500.0;
const POISSONS_RATIOS: [f64; 4] = [0.0, 0.3, 0.45, 0.49];
const SURFACE: [&str; 3] = ["sides", "top", "bottom"];

fn distorted_cubes() -> Vec<TetMesh> {
    let mut cubes = Vec::new();
    for split in [Split::Kuhn, Split::Mirrored] {
        for seed in 1..=3 {
            let mut mesh = structured::cube(CELLS, EDGE, split).unwrap();
            jitter(&mut mesh, 0.2 * EDGE / CELLS as f64, seed);
            cubes.push(mesh);
        }
    }
    cubes
}

/// Gradient of the displacement; its antisymmetric part is a small rotation.
fn gradient() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.3, -0.7, 0.2, -0.4, 0.5, 0.9, -0.6, 0.8) * 1e-3
}

fn linear_field(mesh: &TetMesh, node: usize) -> [f64; 3] {
    (gradient() * Vector3::from(mesh.points[node])).into()
}

/// The force of the linear field's stress on each node: sigma n A/3 from each surface triangle.
fn surface_forces(mesh: &TetMesh, poissons_ratio: f64) -> Vec<f64> {
    let (lambda, mu) = lame(YOUNGS_MODULUS, poissons_ratio);
    let strain = (gradient() + gradient().transpose()) / 2.0;
    let stress = Matrix3::identity() * (lambda * strain.trace()) + strain * (2.0 * mu);
    let mut forces = vec![0.0; 3 * mesh.points.len()];
    for name in SURFACE {
        let GroupMembers::Triangles(triangles) = &mesh.group(name).unwrap().members else {
            panic!("{name} is no surface");
        };
        for triangle in mesh.outward_triangles(triangles).unwrap() {
            let [a, b, c] = triangle.map(|node| Vector3::from(mesh.points[node as usize]));
            let share = stress * (b - a).cross(&(c - a)) / 6.0;
            for node in triangle {
                for axis in 0..3 {
                    forces[3 * node as usize + axis] += share[axis];
                }
            }
        }
    }
    forces
}

/// The worst error over all distorted cubes.
fn worst(name: &str, poissons_ratio: f64, error: impl Fn(&TetMesh) -> f64) {
    let errors = distorted_cubes().iter().map(error).collect::<Vec<f64>>();
    at_most(
        &format!("patch test, {name}, nu = {poissons_ratio}"),
        max_abs(&errors),
        1e-12,
    );
}

#[test]
fn uniform_strain_leaves_no_force_inside_and_its_stress_on_the_surface() {
    for poissons_ratio in POISSONS_RATIOS {
        worst("forces", poissons_ratio, |mesh| {
            let model = build(mesh, &body(linear(YOUNGS_MODULUS, poissons_ratio)));
            let u = on_cells(&model, |node| linear_field(mesh, node));
            let forces = stiffness_times(&model, &u);
            relative_difference(&forces, &surface_forces(mesh, poissons_ratio))
        });
    }
}

#[test]
fn a_linear_field_on_the_surface_makes_it_linear_inside() {
    for poissons_ratio in POISSONS_RATIOS {
        worst("displacement", poissons_ratio, |mesh| {
            let mut problem = body(linear(YOUNGS_MODULUS, poissons_ratio));
            let free = build(mesh, &problem);
            problem.fixed = SURFACE.map(held).to_vec();
            let inner = build(mesh, &problem);

            let on_surface = on_cells(&free, |node| match is_inside(mesh, node) {
                true => [0.0; 3],
                false => linear_field(mesh, node),
            });
            // K_ii u_i = -K_is u_s, with both blocks out of the free body's K.
            let pull = stiffness_times(&free, &on_surface);
            let force = on_cells(&inner, |node| {
                std::array::from_fn(|axis| -pull[3 * node + axis])
            });
            let expected = on_cells(&inner, |node| linear_field(mesh, node));
            relative_difference(&solve(&inner, &force), &expected)
        });
    }
}
