//! Uniform strain: the patch test, rigid motions and confined compression.

use sinew_core::System;
use sinew_core::vectors::largest;
use sinew_fem::tetra::lame;
use sinew_fem::{Course, Model, Moving, On};
use sinew_mesh::TetMesh;

use crate::verify::bodies::{YOUNGS_MODULUS, body, equilibrium, held, stiffness_times};
use crate::verify::check::{Asked, Check, Source};
use crate::verify::error::VerifyError;
use crate::verify::kinds::Kind;
use crate::verify::places::{nodes_where, on_surface};
use crate::verify::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "uniform-strain",
    title: "Uniform strain",
    says: "Every element reproduces every uniform strain on a mesh of gmsh: forces within the body vanish beside those on its surface, a \
           body that is moved at its surface follows within, rigid motions cost nothing. nu = .499.",
    checks,
    quoted: &[],
};

const POISSONS_RATIO: f64 = 0.499;
/// Compression of the confined body.
const STRAIN: f64 = -0.1;

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    let patch_test = Source::ClosedForm(
        "Irons 1965; Zienkiewicz and Taylor, The Finite Element Method, chapter 9",
    );
    for kind in Kind::ALL {
        let case = format!("{kind}, cube-8.msh");
        let figures = [
            (
                "largest force within over largest on the surface",
                Asked::at_most(1e-12),
            ),
            (
                "largest force of a rigid motion over that of strain of its size",
                Asked::at_most(1e-12),
            ),
        ];
        checks.push(Check::several(
            case.clone(),
            figures,
            patch_test,
            move |inputs| forces(&inputs.mesh("cube-8")?, kind),
        ));
        let confined =
            Source::ClosedForm("P = (lambda + 2 mu) (l - 1), l = .9, with u_x = u_y = 0");
        let (lambda, mu) = lame(1.0, POISSONS_RATIO);
        let asked = Asked::relative((lambda + 2.0 * mu) * STRAIN, 1e-9);
        checks.push(Check::one(
            format!("{case}, E = 1"),
            "reaction of confined compression (N)",
            asked,
            confined,
            move |inputs| confined_compression(&inputs.mesh("cube-8")?, kind),
        ));
    }
    checks
}

/// Largest forces inside under uniform strain, and anywhere under a rotation.
fn forces(mesh: &TetMesh, kind: Kind) -> Result<Vec<f64>, VerifyError> {
    let model = Model::build(
        mesh,
        &body(YOUNGS_MODULUS, POISSONS_RATIO, kind.element(None)),
    )?;
    let under = |rows: [[f64; 3]; 3]| -> Result<Vec<f64>, VerifyError> {
        let at = |point: &[f64; 3]| rows.map(|row| row.iter().zip(point).map(|(a, x)| a * x).sum());
        let field: Vec<[f64; 3]> = mesh.points.iter().map(at).collect();
        let mut u = vec![0.0; model.dofs()];
        model.to_dofs(&field, &mut u)?;
        Ok(stiffness_times(&model, &u))
    };
    let strained = under([[1.0, 0.3, -0.7], [0.2, -0.4, 0.5], [0.9, -0.6, 0.8]])?;
    let turned = under([[0.0, 0.3, -0.7], [-0.3, 0.0, 0.5], [0.7, -0.5, 0.0]])?;
    let surface = on_surface(mesh);
    let within = strained.chunks_exact(3).zip(&surface);
    let within = within.filter(|(_, outer)| !**outer);
    let within = within.map(|(force, _)| largest(force));
    let largest_of_all = largest(&strained);
    Ok(vec![
        within.fold(0.0, f64::max) / largest_of_all,
        largest(&turned) / largest_of_all,
    ])
}

/// The reaction (N) at the top of a unit cube that is pressed down by a tenth, with u_x = u_y = 0 at its surface.
fn confined_compression(mesh: &TetMesh, kind: Kind) -> Result<f64, VerifyError> {
    let (low, high) = mesh.bounding_box();
    let face =
        |axis: usize, value: f64| nodes_where(mesh, |point| (point[axis] - value).abs() <= 1e-9);
    let mut problem = body(1.0, POISSONS_RATIO, kind.element(None));
    for axis in [0, 1] {
        let mut axes = [false; 3];
        axes[axis] = true;
        for value in [low[axis], high[axis]] {
            problem.fixed.push(held(On::Nodes(face(axis, value)), axes));
        }
    }
    problem
        .fixed
        .push(held(On::Nodes(face(2, low[2])), [false, false, true]));
    let top = On::Nodes(face(2, high[2]));
    problem.moves.push(
        Moving::new(
            top.clone(),
            [Course::new(
                [0.0, 0.0, STRAIN * (high[2] - low[2])],
                sinew_core::Ramp::Step,
            )],
        )
        .along([false, false, true]),
    );
    let model = Model::build(mesh, &problem)?;
    let u = equilibrium(&model)?;
    let at_rest = vec![0.0; u.len()];
    Ok(model.reaction(0.0, &u, &at_rest, &top)?[2])
}
