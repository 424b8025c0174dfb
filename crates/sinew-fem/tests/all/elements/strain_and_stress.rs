//! Strain and stress against closed forms.

use crate::common::{
    at_most, body, build, dot, figure, jitter, linear, on_cells, springs, stiffness_times,
};
use nalgebra::{Matrix3, Vector3};
use sinew_core::System;
use sinew_fem::stress::von_mises;
use sinew_fem::{FieldError, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const YOUNGS_MODULUS: f64 = 3500.0;

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
