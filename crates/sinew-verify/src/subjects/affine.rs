//! Uniform strain: the patch test, rigid motions and confined compression.

use nalgebra::{DMatrix, Matrix3, Vector3};
use sinew_core::vectors::largest;
use sinew_core::{LinearSystem, System};
use sinew_fem::tetra::lame;
use sinew_fem::{Course, Element, Law, Model, Moving, On, SpringRule};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::Split;

use crate::bodies::{
    YOUNGS_MODULUS, body, equilibrium, held, linear, of_law, springs, stiffness_times,
};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::places::{nodes_where, on_surface};
use crate::subject::Subject;
use crate::uniform::{ELEMENTS, name, uneven_cube};

pub(super) const SUBJECT: Subject = Subject {
    id: "uniform-strain",
    title: "Uniform strain",
    says: "Every element reproduces every uniform strain, on a mesh of gmsh (nu = .499) and on uneven cubes: \
           forces within the body vanish beside those on its surface, a body that is moved at its surface \
           follows within, rigid motions cost nothing.",
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
    for element in ELEMENTS {
        for nu in [0.0, 0.3, 0.45, 0.49, 0.499] {
            checks.push(on_uneven_cubes(element, nu, patch_test));
        }
    }
    let six = Source::ClosedForm("a free body resists every motion but the six rigid ones");
    for (name, law) in [
        ("nu = -.5", linear(-0.5)),
        ("nu = .3", linear(0.3)),
        ("nu = .49", linear(0.49)),
        ("Lloyd's springs", springs(SpringRule::Lloyd)),
        ("Van Gelder's springs", springs(SpringRule::VanGelder)),
    ] {
        let figures = [
            (
                "largest force of a rigid motion over the largest row of K",
                Asked::at_most(1e-14),
            ),
            (
                "largest asymmetry of K over its largest entry",
                Asked::at_most(1e-15),
            ),
            (
                "largest of six eigenvalues over the largest of all",
                Asked::at_most(1e-13),
            ),
            ("seventh eigenvalue over the largest", Asked::at_least(1e-4)),
        ];
        let case = format!("{name}, p1, uneven cubes of 3 cells a side");
        checks.push(Check::several(case, figures, six, move |_| {
            free_bodies(&law)
        }));
    }
    checks
}

/// Uneven cubes, three with each of both splits.
fn uneven_cubes(cells: usize) -> impl Iterator<Item = Result<TetMesh, LabError>> {
    let splits = [Split::Kuhn, Split::Mirrored].into_iter();
    splits.flat_map(move |split| (1..=3).map(move |seed| uneven_cube(cells, split, seed)))
}

/// The patch test of an element: residual forces, stresses and energies of a uniform strain.
fn on_uneven_cubes(element: Element, nu: f64, source: Source) -> Check {
    let figures = [
        "largest force beside that of the uniform stress, over the largest",
        "displacement within a body that is moved at its surface, over the largest",
        "strain of any tetrahedron beside the uniform one, over its size",
        "stress of any tetrahedron beside the uniform one, over its size",
        "strain of a small rotation over it",
        "largest force of a rigid motion over the largest row of K",
        "largest asymmetry of K over its largest entry",
    ];
    let figures = figures.map(|name| (name, Asked::at_most(1e-11)));
    let case = format!(
        "{}, nu = {nu}, uneven cubes of 4 cells a side",
        name(element)
    );
    Check::several(case, figures, source, move |_| {
        let mut worst = vec![0.0_f64; figures.len()];
        for mesh in uneven_cubes(4) {
            let found = patch_test(&mesh?, element, nu)?;
            for (worst, found) in worst.iter_mut().zip(found) {
                *worst = worst.max(if found.is_nan() { f64::INFINITY } else { found });
            }
        }
        Ok(worst)
    })
}

/// xx, yy, zz, xy, yz, zx.
const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];

fn patch_test(mesh: &TetMesh, element: Element, nu: f64) -> Result<[f64; 7], LabError> {
    let gradient = Matrix3::new(1.0, 0.3, -0.7, 0.2, -0.4, 0.5, 0.9, -0.6, 0.8) * 1e-3;
    let strain = (gradient + gradient.transpose()) / 2.0;
    let (lambda, mu) = lame(YOUNGS_MODULUS, nu);
    let stress = Matrix3::identity() * (lambda * strain.trace()) + strain * (2.0 * mu);
    let mut problem = body(YOUNGS_MODULUS, nu, element);
    let model = Model::build(mesh, &problem)?;
    let dofs = |model: &Model, field: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
        let field: Vec<[f64; 3]> = mesh
            .points
            .iter()
            .map(|point| field(Vector3::from(*point)).into())
            .collect();
        let mut out = vec![0.0; model.dofs()];
        model.to_dofs(&field, &mut out).map(|()| out)
    };
    let u = dofs(&model, &|point| gradient * point)?;
    // sigma n A/3 from each triangle of the surface.
    let mut expected = vec![0.0; u.len()];
    for triangle in mesh.boundary(None) {
        let [a, b, c] = triangle.map(|node| Vector3::from(mesh.points[node as usize]));
        let share = stress * (b - a).cross(&(c - a)) / 6.0;
        for node in triangle {
            for axis in 0..3 {
                expected[3 * node as usize + axis] += share[axis];
            }
        }
    }
    let forces = stiffness_times(&model, &u);

    let surface = on_surface(mesh);
    let outer = (0..).zip(&surface).filter(|(_, outer)| **outer);
    problem.fixed = vec![held(
        On::Nodes(outer.map(|(node, _)| node).collect()),
        [true; 3],
    )];
    let inner = Model::build(mesh, &problem)?;
    let is_outer = u.iter().zip(surface.iter().flat_map(|outer| [*outer; 3]));
    let on_outside: Vec<f64> = is_outer
        .map(|(u, outer)| if outer { *u } else { 0.0 })
        .collect();
    let pull = stiffness_times(&model, &on_outside);
    let is_inner = pull
        .iter()
        .zip(surface.iter().flat_map(|outer| [*outer; 3]));
    let pull: Vec<f64> = is_inner
        .filter(|(_, outer)| !outer)
        .map(|(pull, _)| -pull)
        .collect();
    let within = static_solution(&inner, &pull)?;
    let exact = dofs(&inner, &|point| gradient * point)?;

    let mut tensors = vec![[0.0; 6]; mesh.tets.len()];
    let off = |expected: Matrix3<f64>, found: &[[f64; 6]]| {
        let pairs = found.iter().flat_map(|found| PLACES.into_iter().zip(found));
        pairs.fold(0.0, |most: f64, (at, found)| {
            most.max((found - expected[at]).abs())
        })
    };
    model.strain(0.0, &u, &mut tensors)?;
    let of_strain = off(strain, &tensors) / strain.amax();
    model.stress(0.0, &u, &mut tensors)?;
    let of_stress = off(stress, &tensors) / stress.amax();
    let spin = Vector3::new(1e-3, -2e-3, 0.5e-3);
    let turned = dofs(&model, &|point| spin.cross(&point))?;
    model.strain(0.0, &turned, &mut tensors)?;
    let of_turn = off(Matrix3::zeros(), &tensors) / spin.amax();
    let [of_rigid, asymmetry] = rigid_and_symmetric(&model, &mesh.points)?;
    Ok([
        relative(&forces, &expected),
        relative(&within, &exact),
        of_strain,
        of_stress,
        of_turn,
        of_rigid,
        asymmetry,
    ])
}

/// The largest difference over the largest entry of the second.
fn relative(found: &[f64], expected: &[f64]) -> f64 {
    let difference: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(expected)
}

/// The largest force of a rigid motion of 1 at some node over the largest sum of a row of K, and the largest asymmetry
/// of K over its largest entry.
fn rigid_and_symmetric(model: &Model, points: &[[f64; 3]]) -> Result<[f64; 2], LabError> {
    let stiffness = model.operators().stiffness();
    let (mut row_sum, mut entry, mut asymmetry) = (0.0_f64, 0.0_f64, 0.0_f64);
    for row in 0..stiffness.pattern().cells() {
        let mut sums = [0.0; 3];
        for (column, block) in stiffness.row_blocks(row) {
            let mirrored = stiffness.block(column, row).ok_or_else(LabError::no_body)?;
            for (k, value) in block.iter().enumerate() {
                sums[k / 3] += value.abs();
                entry = entry.max(value.abs());
                asymmetry = asymmetry.max((value - mirrored[3 * (k % 3) + k / 3]).abs());
            }
        }
        row_sum = row_sum.max(largest(&sums));
    }
    let centre = Vector3::repeat(0.05);
    let mut worst = 0.0_f64;
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        for turns in [false, true] {
            let at = |point: &[f64; 3]| -> [f64; 3] {
                match turns {
                    true => axis.cross(&(Vector3::from(*point) - centre)).into(),
                    false => axis.into(),
                }
            };
            let field: Vec<[f64; 3]> = points.iter().map(at).collect();
            let mut u = vec![0.0; model.dofs()];
            model.to_dofs(&field, &mut u)?;
            let force = largest(&stiffness_times(model, &u));
            worst = worst.max(force / (row_sum * largest(&u)));
        }
    }
    Ok([worst, asymmetry / entry])
}

/// The worst of [`rigid_and_symmetric`] and of the eigenvalues of free bodies.
fn free_bodies(law: &Law) -> Result<Vec<f64>, LabError> {
    let (mut worst, mut seventh) = ([0.0_f64; 3], f64::INFINITY);
    for mesh in uneven_cubes(3).step_by(3) {
        let mesh = mesh?;
        let model = Model::build(&mesh, &of_law(law.clone(), Element::P1))?;
        let stiffness = model.operators().stiffness();
        let dense = DMatrix::from_fn(model.dofs(), model.dofs(), |i, j| {
            let block = stiffness.block(i / 3, j / 3);
            block.map_or(0.0, |block| block[3 * (i % 3) + j % 3])
        });
        let mut eigenvalues: Vec<f64> = dense.symmetric_eigenvalues().iter().copied().collect();
        eigenvalues.sort_by(f64::total_cmp);
        let most = eigenvalues[eigenvalues.len() - 1];
        let [rigid, asymmetry] = rigid_and_symmetric(&model, &mesh.points)?;
        let found = [rigid, asymmetry, largest(&eigenvalues[..6]) / most];
        worst = std::array::from_fn(|figure| worst[figure].max(found[figure]));
        seventh = seventh.min(eigenvalues[6] / most);
    }
    Ok([worst.as_slice(), &[seventh]].concat())
}

/// Largest forces inside under uniform strain, and anywhere under a rotation.
fn forces(mesh: &TetMesh, kind: Kind) -> Result<Vec<f64>, LabError> {
    let model = Model::build(
        mesh,
        &body(YOUNGS_MODULUS, POISSONS_RATIO, kind.element(None)),
    )?;
    let under = |rows: [[f64; 3]; 3]| -> Result<Vec<f64>, LabError> {
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

/// The reaction (N) at the top of a unit cube that is compressed by a tenth, with u_x = u_y = 0 at its surface.
fn confined_compression(mesh: &TetMesh, kind: Kind) -> Result<f64, LabError> {
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
    problem.moves.push(Moving {
        on: top.clone(),
        axes: [false, false, true],
        courses: vec![Course {
            displacement: [0.0, 0.0, STRAIN * (high[2] - low[2])],
            ramp: sinew_core::Ramp::Step,
        }],
    });
    let model = Model::build(mesh, &problem)?;
    let u = equilibrium(&model)?;
    let at_rest = vec![0.0; u.len()];
    Ok(model.reaction(0.0, &u, &at_rest, &top)?[2])
}
