//! Strain and stress against closed forms.

use crate::common::{
    add_node_group, at_most, body, build, dot, equilibrium, figure, held_along, jitter, linear,
    load, on_cells, springs, stiffness_times,
};
use nalgebra::{Matrix3, Vector3};
use sinew_core::System;
use sinew_fem::stress::von_mises;
use sinew_fem::{FieldError, LoadKind, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const YOUNGS_MODULUS: f64 = 3500.0;
const POISSONS_RATIOS: [f64; 3] = [0.0, 0.3, 0.45];

fn distorted(split: Split) -> TetMesh {
    let mut mesh = structured::block([4, 3, 5], [0.04, 0.03, 0.1], split).unwrap();
    jitter(&mut mesh, 0.002, 7);
    mesh
}

fn strain(model: &Model, u: &[f64]) -> Vec<[f64; 6]> {
    let mut out = vec![[f64::NAN; 6]; model.region_of().len()];
    model.strain(0.0, u, &mut out).unwrap();
    out
}

fn stress(model: &Model, u: &[f64]) -> Vec<[f64; 6]> {
    let mut out = vec![[f64::NAN; 6]; model.region_of().len()];
    model.stress(0.0, u, &mut out).unwrap();
    out
}

/// xx, yy, zz, xy, yz, zx.
fn components(tensor: &Matrix3<f64>) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|at| tensor[at])
}

/// The same tensor in every tetrahedron, up to rounding of `size`.
#[track_caller]
fn everywhere(name: &str, reached: &[[f64; 6]], expected: &Matrix3<f64>, size: f64) {
    let expected = components(expected);
    let worst = reached.as_flattened().chunks(6).flat_map(|tensor| {
        let pairs = tensor.iter().zip(&expected);
        pairs.map(|(reached, expected)| (reached - expected).abs())
    });
    let worst = worst.fold(0.0, |worst: f64, off| {
        worst.max(if off.is_nan() { f64::MAX } else { off })
    });
    at_most(name, worst / size, 1e-12);
}

/// Every affine displacement has one strain and one stress, whatever the tetrahedra (patch test,
/// Zienkiewicz and Taylor, The Finite Element Method, chapter 9).
#[test]
fn affine_displacements_have_uniform_strain_and_stress() {
    let gradient = Matrix3::new(1.0, 0.3, -0.7, 0.2, -0.4, 0.5, 0.9, -0.6, 0.8) * 1e-3;
    let symmetric = (gradient + gradient.transpose()) / 2.0;
    for split in [Split::Kuhn, Split::Mirrored] {
        let mesh = distorted(split);
        for nu in POISSONS_RATIOS {
            let model = build(&mesh, &body(linear(YOUNGS_MODULUS, nu)));
            let u = on_cells(&model, |node| {
                (gradient * Vector3::from(mesh.points[node])).into()
            });
            everywhere("strain", &strain(&model, &u), &symmetric, 1e-3);
            // Timoshenko and Goodier, Theory of Elasticity: stress by E and nu.
            let bulk = nu / (1.0 - 2.0 * nu) * symmetric.trace();
            let stiff = YOUNGS_MODULUS / (1.0 + nu);
            let expected = (symmetric + Matrix3::identity() * bulk) * stiff;
            let name = format!("stress, nu = {nu}");
            everywhere(&name, &stress(&model, &u), &expected, expected.amax());
        }
    }
}

#[test]
fn small_rotations_strain_nothing() {
    let mesh = distorted(Split::Kuhn);
    let model = build(&mesh, &body(linear(YOUNGS_MODULUS, 0.45)));
    let turn = Vector3::new(1e-3, -2e-3, 0.5e-3);
    let u = on_cells(&model, |node| {
        turn.cross(&Vector3::from(mesh.points[node])).into()
    });
    everywhere("rotation", &strain(&model, &u), &Matrix3::zeros(), 2e-3);
}

/// Half of the engineering shear gamma, and tau = G gamma.
#[test]
fn shear_is_the_tensors_half_of_the_engineering_shear() {
    let (mesh, gamma, nu) = (distorted(Split::Mirrored), 1e-3, 0.3);
    let model = build(&mesh, &body(linear(YOUNGS_MODULUS, nu)));
    let tau = YOUNGS_MODULUS / (2.0 * (1.0 + nu)) * gamma;
    for (entry, (moved, along)) in [(3, (0, 1)), (4, (1, 2)), (5, (2, 0))] {
        let u = on_cells(&model, |node| {
            let mut u = [0.0; 3];
            u[moved] = gamma * mesh.points[node][along];
            u
        });
        let (strain, stress) = (strain(&model, &u), stress(&model, &u));
        for tet in [0, strain.len() / 2] {
            figure("shear / gamma", strain[tet][entry] / gamma, 0.5, 1e-12);
            figure("stress / (G gamma)", stress[tet][entry] / tau, 1.0, 1e-12);
            let equivalent = von_mises(&stress[tet]);
            figure("von Mises / tau", equivalent / tau, 3.0_f64.sqrt(), 1e-11);
        }
    }
}

/// Uniaxial stress: sigma_zz = T, strain T/E along and -nu T/E across.
#[test]
fn a_pulled_bar_is_in_uniaxial_stress() {
    let traction = 70.0;
    for nu in POISSONS_RATIOS {
        let mut mesh = distorted(Split::Kuhn);
        let mut problem = body(linear(YOUNGS_MODULUS, nu));
        for (axis, name) in ["x = 0", "y = 0", "z = 0"].into_iter().enumerate() {
            add_node_group(&mut mesh, name, |point| point[axis] == 0.0);
            let axes = std::array::from_fn(|other| other == axis);
            problem.fixed.push(held_along(name, axes));
        }
        problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, traction]))];
        let model = build(&mesh, &problem);
        let u = equilibrium(&model);
        let along = traction / YOUNGS_MODULUS;
        let strains = Matrix3::from_diagonal(&Vector3::new(-nu * along, -nu * along, along));
        everywhere("bar: strain", &strain(&model, &u), &strains, along);
        let stresses = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, traction));
        let reached = stress(&model, &u);
        everywhere("bar: stress", &reached, &stresses, traction);
        for (tet, stress) in reached.iter().enumerate() {
            assert_eq!(model.tet_stress(0.0, &u, tet), Ok(*stress));
            assert!((von_mises(stress) / traction - 1.0).abs() < 1e-12);
        }
    }
}

/// The lower half of springs, the upper of a continuum.
fn half_springs() -> (TetMesh, Model) {
    let mut mesh = structured::cube(4, 0.1, Split::Kuhn).unwrap();
    let height =
        |tet: &[u32; 4]| -> f64 { tet.map(|node| mesh.points[node as usize][2]).iter().sum() };
    let is_low = |tet: &u32| height(&mesh.tets[*tet as usize]) < 4.0 * 0.05;
    let (low, high) = (0..mesh.tets.len() as u32).partition(is_low);
    for (name, tag, members) in [("low", 11, low), ("high", 12, high)] {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag,
            members: GroupMembers::Tets(members),
        });
    }
    let region = |group: &str, law| Region::new(law, 1000.0).on(group);
    let problem = Problem::of([
        region("high", linear(YOUNGS_MODULUS, 0.3)),
        region("low", springs(YOUNGS_MODULUS, SpringRule::Lloyd, true)),
    ]);
    let model = build(&mesh, &problem);
    (mesh, model)
}

#[test]
fn springs_have_strain_but_no_stress() {
    let (mesh, model) = half_springs();
    let u = on_cells(&model, |node| [0.0, 0.0, 1e-3 * mesh.points[node][2]]);
    let pull = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1e-3));
    everywhere("mixed body: strain", &strain(&model, &u), &pull, 1e-3);
    let mut out = vec![[0.0; 6]; mesh.tets.len()];
    let refused = model.stress(0.0, &u, &mut out);
    assert_eq!(refused, Err(FieldError::NoStress { region: 1 }));
    assert_eq!(
        refused.unwrap_err().to_string(),
        "region 2 is a network of springs, whose law gives forces along edges and no stress"
    );
    for (tet, region) in model.region_of().iter().enumerate() {
        let low = mesh.tets[tet]
            .iter()
            .all(|node| mesh.points[*node as usize][2] < 0.051);
        assert_eq!(*region, u32::from(low));
        assert_eq!(model.tet_stress(0.0, &u, tet).is_ok(), *region == 0);
    }
    let (tet, tets) = (mesh.tets.len(), mesh.tets.len());
    let beyond = model.tet_stress(0.0, &u, tet);
    assert_eq!(beyond, Err(FieldError::TetOutOfRange { tet, tets }));
    let short = model.strain(0.0, &u, &mut out[1..]);
    assert!(matches!(short, Err(FieldError::Length { .. })));
}

/// u'Ku = sum k (n . (u_b - u_a))^2.
#[test]
fn springs_given_out_are_those_of_the_matrix() {
    for calibrate in [false, true] {
        let mut mesh = distorted(Split::Kuhn);
        mesh.groups.clear();
        let law = springs(YOUNGS_MODULUS, SpringRule::Lloyd, calibrate);
        let model = build(&mesh, &body(law));
        let u: Vec<f64> = (0..model.dofs()).map(|i| (1.3 * i as f64).sin()).collect();
        let stored = dot(&u, &stiffness_times(&model, &u));
        let springs = model.springs(0).unwrap();
        let energies = springs.iter().map(|spring| {
            let [a, b] = spring.nodes;
            let at = |node: u32| Vector3::from(mesh.points[node as usize]);
            let moved = |node: u32| Vector3::from(model.node_displacement(0.0, &u, node).unwrap());
            let along = (at(b) - at(a)).normalize().dot(&(moved(b) - moved(a)));
            spring.stiffness * along * along
        });
        figure(
            "energy of springs / u'Ku",
            energies.sum::<f64>() / stored,
            1.0,
            1e-12,
        );
        assert!(model.springs(1).is_none());
    }
    let (_, mixed) = half_springs();
    assert!(mixed.springs(0).is_none());
    assert!(mixed.springs(1).is_some());
}
